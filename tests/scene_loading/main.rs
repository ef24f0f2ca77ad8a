//! What a user relies on when a scene is loaded: what loads, what is repaired with a warning, and what each error says.

mod bare_models;
mod bodies;
mod colours;
mod far;
mod first_view;
mod free_form;
mod hostile;
mod ies;
mod lamps;
mod mapped_numbers;
mod mtl;
mod mtl_slips;
mod obj;
mod own_scenes;
mod physical;
mod physical_keys;
mod pictures;
mod polygons;
mod relief;
mod scene_files;
mod settings;
mod smoothing;
mod textures;
mod toml;
mod touching;

use luminaire::Error;
use luminaire::scene::{Material, Scene, load};
use std::path::{Path, PathBuf};

/// A folder of input files that goes away after the test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file and returns the folder, so that calls can be chained.
    fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("inside the folder")).expect("a folder");
        std::fs::write(path, content).expect("a file");
        self
    }

    fn load(&self, name: &str) -> Scene {
        load(&self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn error(&self, name: &str) -> Error {
        match load(&self.path(name)) {
            Ok(scene) => panic!("{name} loaded: {scene:?}"),
            Err(error) => error,
        }
    }

    /// The error has to be in `name` at `line`, and its message has to hold `words`.
    #[track_caller]
    fn fails_at(&self, file: &str, name: &str, at: (usize, usize), words: &[&str]) {
        let error = self.error(file);
        let Error::Parse { path, line, column, message } = &error else { panic!("not a parse error: {error}") };
        assert_eq!(path.file_name(), Path::new(name).file_name(), "{error}");
        assert_eq!((*line, *column), at, "{error}");
        assert!(words.iter().all(|word| message.contains(word)), "{error}");
        assert_eq!(error.exit_code(), 1);
    }
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const SENSOR: &str = "[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40\n";
const LIGHT: &str = "[[luminaire]]\nkind = \"point\"\nposition = [0, 0, 3]\nintensity = [1, 1, 1]\n";

/// A bare OBJ of this text.
fn obj(text: impl AsRef<[u8]>) -> Folder {
    Folder::new().with("mesh.obj", text)
}

/// An OBJ with `usemtl m` and an MTL.
fn with_mtl(mtl: impl AsRef<[u8]>) -> Folder {
    obj(format!("mtllib mesh.mtl\nusemtl m\n{TRIANGLE}")).with("mesh.mtl", mtl)
}

/// A scene file in front of the triangle, with sensor, light and one object.
fn scene(extra: &str) -> Folder {
    obj(TRIANGLE).with("scene.toml", format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n{extra}"))
}

#[track_caller]
fn obj_fails(text: &str, line: usize, words: &[&str]) {
    obj(text).fails_at("mesh.obj", "mesh.obj", (line, 0), words);
}

/// `text` is the whole scene file.
#[track_caller]
fn toml_fails(text: &str, at: (usize, usize), words: &[&str]) {
    obj(TRIANGLE).with("scene.toml", text).fails_at("scene.toml", "scene.toml", at, words);
}

#[track_caller]
fn warned(scene: &Scene, words: &[&str]) {
    let found = scene.warnings.iter().any(|warning| words.iter().all(|word| warning.contains(word)));
    assert!(found, "no warning with {words:?} in {:#?}", scene.warnings);
}

fn material<'a>(scene: &'a Scene, name: &str) -> &'a Material {
    scene.materials.iter().find(|material| material.name == name).unwrap_or_else(|| panic!("no material {name}"))
}

/// The material of the first triangle of the first object.
fn first_material(scene: &Scene) -> &Material {
    scene.material_of(&scene.objects[0], &scene.meshes[0].triangles[0])
}
