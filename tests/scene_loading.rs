//! What a user relies on when a scene is loaded: what loads, what is repaired with a warning, and what each error says.

use glam::{Affine3A, Vec3};
use luminaire::Error;
use luminaire::scene::{Integrator, Luminaire, Material, Scene, load};
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

// --- the scenes of the project ---

fn own(name: &str) -> Scene {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_projects_scenes_load_without_a_warning() {
    for (name, triangles) in [
        ("cornell/cornell.toml", 38),
        ("furnace/furnace.toml", 320),
        ("instances/instances.toml", 4 + 3 * 1280),
        ("simple/simple.toml", 38),
    ] {
        let scene = own(name);
        assert_eq!(scene.warnings, Vec::<String>::new(), "{name}");
        assert_eq!(scene.triangle_count(), triangles, "{name}");
    }
}

#[test]
fn the_cornell_box_is_closed_but_for_its_front_and_faces_inwards() {
    let scene = own("cornell/cornell.toml");
    let mesh = &scene.meshes[0];
    let lamp: f64 = mesh
        .triangles
        .iter()
        .filter(|triangle| scene.material_of(&scene.objects[0], triangle).emission != Vec3::ZERO)
        .map(|triangle| {
            let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
            let normal = (b - a).cross(c - a);
            assert!(normal.y < 0.0, "the lamp faces down");
            0.5 * normal.length()
        })
        .sum();
    assert!((lamp - 130.0 * 105.0).abs() < 1e-6, "{lamp}");
    // Consistent winding: every edge is shared in opposite directions, but for the room's front and the feet of the blocks.
    let mut edges = std::collections::HashMap::new();
    for triangle in &mesh.triangles {
        let corners = triangle.vertices.map(|v| mesh.positions[v as usize].to_array().map(f32::to_bits));
        for i in 0..3 {
            *edges.entry((corners[i], corners[(i + 1) % 3])).or_insert(0) += 1;
        }
    }
    let open = edges.iter().filter(|((a, b), _)| !edges.contains_key(&(*b, *a))).count();
    assert_eq!(open, 4 + 2 * 4, "edges without a neighbour of the opposite direction");
    assert!(edges.values().all(|count| *count == 1), "an edge is used twice in one direction");
}

#[test]
fn the_furnace_is_closed_and_faces_inwards() {
    let scene = own("furnace/furnace.toml");
    let mesh = &scene.meshes[0];
    assert_eq!(first_material(&scene).lambert, Vec3::splat(0.5));
    assert_eq!(first_material(&scene).emission, Vec3::ONE);
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!((-4.19..-3.9).contains(&volume), "negative, and nearly that of the ball: {volume}");
}

#[test]
fn instances_share_a_mesh_and_keep_their_transforms() {
    let scene = own("instances/instances.toml");
    assert_eq!(scene.meshes.len(), 2);
    let [_, bird, tall, mirrored] = &scene.objects[..] else { panic!("{:?}", scene.objects) };
    assert_eq!((bird.mesh, tall.mesh, mirrored.mesh), (1, 1, 1));
    assert!(mirrored.object_to_world.matrix3.determinant() < -0.99);
    assert!((tall.object_to_world.matrix3.determinant() - 0.6 * 1.3 * 0.6).abs() < 1e-5);
    assert_eq!(scene.materials[tall.material.expect("blue") as usize].name, "blue");
    let mesh = &scene.meshes[1];
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-6));
    assert!(matches!(scene.luminaires[..], [Luminaire::Point { .. }, Luminaire::Infinite { .. }]));
}

#[test]
fn the_simple_scene_switches_the_lamp_off() {
    let scene = own("simple/simple.toml");
    assert_eq!(material(&scene, "lamp").emission, Vec3::ZERO);
    assert!(matches!(scene.integrator, Integrator::Simple { .. }));
}

// --- OBJ: what loads ---

#[test]
fn endings_of_lines_and_files_do_not_matter() {
    for text in [
        TRIANGLE.replace('\n', "\r\n"),
        format!("\u{feff}{TRIANGLE}"),
        TRIANGLE.trim_end().to_owned(),
        format!("# a comment that ends in a backslash \\\n{TRIANGLE}"),
        TRIANGLE.replace("f 1 2 3", "f 1 \\\n  2 3   # a comment"),
        TRIANGLE.replace("v 1 0 0", "v\t+1e0   .0  0. "),
    ] {
        let scene = obj(&text).load("mesh.obj");
        assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y], "{text:?}");
        assert_eq!(scene.triangle_count(), 1);
    }
}

#[test]
fn the_ending_of_the_name_is_compared_without_case() {
    assert_eq!(Folder::new().with("MESH.OBJ", TRIANGLE).load("MESH.OBJ").triangle_count(), 1);
}

#[test]
fn indices_may_be_negative_or_point_ahead() {
    let behind = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nf -3//-1 -2//-1 -1//-1\n").load("mesh.obj");
    assert_eq!(behind.meshes[0].normals, [Vec3::Z; 3]);
    let ahead = obj("usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").load("mesh.obj");
    assert_eq!(ahead.triangle_count(), 2);
}

#[test]
fn polygons_become_fans() {
    let quad = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").load("mesh.obj");
    let corners: Vec<_> = quad.meshes[0].triangles.iter().map(|triangle| triangle.vertices).collect();
    assert_eq!(corners, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn all_groups_are_one_mesh() {
    let scene = obj(format!("o a\n{TRIANGLE}o b\ng c d\nv 5 5 5\nf 1 2 4\ns 1\nl 1 2 3\np 1\n")).load("mesh.obj");
    assert_eq!((scene.meshes.len(), scene.triangle_count()), (1, 2));
    assert_eq!(scene.meshes[0].name, "mesh.obj");
}

#[test]
fn corners_without_a_normal_have_the_zero_normal() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 3\nf 1//1 2 3//1\nf 1 2 4\n";
    let mesh = &obj(text).load("mesh.obj").meshes[0];
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    let normals = mesh.triangles[0].vertices.map(|v| mesh.normals[v as usize]);
    assert_eq!(normals, [Vec3::Z, Vec3::ZERO, Vec3::Z]);
    assert!(mesh.triangles[1].vertices.iter().all(|v| mesh.normals[*v as usize] == Vec3::ZERO));
}

#[test]
fn useless_normals_are_none() {
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 1 inf 0\nf 1//1 2//2 3//1\n").load("mesh.obj");
    assert!(scene.meshes[0].normals.is_empty());
    warned(&scene, &["mesh.obj:5", "normal", "finite"]);
    let tiny = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1e-30\nf 1//1 2//1 3//1\n").load("mesh.obj");
    assert_eq!(tiny.meshes[0].normals, [Vec3::Z; 3], "short is not zero");
}

#[test]
fn indices_into_what_the_file_lacks_are_a_warning() {
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/2 3/3/3\n").load("mesh.obj");
    assert!(scene.meshes[0].normals.is_empty());
    warned(&scene, &["mesh.obj:4", "no normals", "2 more"]);
}

#[test]
fn colours_and_weights_of_vertices() {
    let scene = obj("v 0 0 0 1 nan 0\nv 2 0 0 2\nv 0 1 0\nf 1 2 3\n").load("mesh.obj");
    assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn degenerate_faces_are_dropped_with_one_warning() {
    let scene = obj(format!("{TRIANGLE}f 1 1 2\nf 2 3 2\nv 2 0 0\nf 1 2 4\nf 1 2\nf\nf 3\n")).load("mesh.obj");
    assert_eq!(scene.triangle_count(), 1);
    warned(&scene, &["3 zero-area"]);
    warned(&scene, &["mesh.obj:9", "fewer than 3", "2 more"]);
}

#[test]
fn unknown_keywords_are_one_warning() {
    let scene = obj(format!("{TRIANGLE}bleh 1\nvt3 1\np6\n")).load("mesh.obj");
    warned(&scene, &["mesh.obj:5", "`bleh`", "2 more"]);
}

#[test]
fn bytes_that_are_not_utf8_do_no_harm() {
    let mut text = b"# caf\xe9\nmtllib mesh.mtl\nusemtl caf\xe9\n".to_vec();
    text.extend(TRIANGLE.as_bytes());
    let folder = obj(text).with("mesh.mtl", b"newmtl caf\xe9\nKd 0.1 0.2 0.3\n");
    assert_eq!(first_material(&folder.load("mesh.obj")).lambert, Vec3::new(0.1, 0.2, 0.3));
}

// --- OBJ: what is refused ---

#[test]
fn a_file_that_is_not_there() {
    let error = Folder::new().error("mesh.obj");
    assert!(matches!(&error, Error::Read { path, .. } if path.ends_with("mesh.obj")), "{error}");
    assert!(error.to_string().contains("No such file"), "{error}");
    assert!(matches!(Folder::new().error("scene.toml"), Error::Read { .. }));
}

#[test]
fn an_ending_that_is_no_scene() {
    for name in ["mesh.ply", "mesh", "mesh.obj.gz", ""] {
        let error = Folder::new().with("mesh.ply", TRIANGLE).error(name);
        let Error::Usage(message) = &error else { panic!("{error}") };
        assert!(message.contains(".toml") && message.contains(".obj"), "{message}");
        assert_eq!(error.exit_code(), 2);
    }
}

#[test]
fn wrong_numbers_are_found_with_their_line() {
    obj_fails(&format!("{TRIANGLE}v 1 2 x\n"), 5, &["`x`", "not a number"]);
    obj_fails(&format!("{TRIANGLE}v 1 3.1+e2 0\n"), 5, &["`3.1+e2`"]);
    obj_fails(&format!("{TRIANGLE}vn 0 1,5 0\n"), 5, &["`1,5`"]);
    obj_fails(&format!("{TRIANGLE}vt ?\n"), 5, &["`?`"]);
    obj_fails(&format!("{TRIANGLE}v 1 2\n"), 5, &["vertex needs 3 numbers", "found 2"]);
    obj_fails(&format!("{TRIANGLE}v 1 2 3 4 5\n"), 5, &["vertex needs 3 numbers", "found 5"]);
    obj_fails(&format!("{TRIANGLE}vn 1 2\n"), 5, &["normal needs 3 numbers", "found 2"]);
    obj_fails(&format!("{TRIANGLE}vt\n"), 5, &["texture coordinate", "none"]);
}

#[test]
fn vertices_that_are_not_finite() {
    for vertex in ["nan 0 0", "0 inf 0", "0 0 -inf", "3E4570711268 0 0", "1 0 0 0", "0 0 0 nan"] {
        obj_fails(&format!("v {vertex}\n{TRIANGLE}"), 1, &["not finite"]);
    }
}

#[test]
fn wrong_indices_are_found_with_their_line() {
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 0"), 4, &["vertex index is 0", "count from 1"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 4"), 4, &["vertex index 4", "out of range", "3 vertex lines"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f -4 -3 -2"), 4, &["relative vertex index -4", "3 vertex lines precede"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 three"), 4, &["`three`", "whole number"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 3.0"), 4, &["`3.0`", "whole number"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1/1/1/1 2 3"), 4, &["`1/1/1/1`", "v/vt/vn"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f /1 2 3"), 4, &["`/1`"]);
    obj_fails(&format!("vt 0 0\n{}", TRIANGLE.replace("f 1", "f 1/2")), 5, &["texture coordinate index 2"]);
    obj_fails(&format!("vn 0 0 1\n{}", TRIANGLE.replace("f 1", "f 1//0")), 5, &["normal index is 0"]);
    obj_fails(&format!("vn 0 0 1\n{}", TRIANGLE.replace("f 1", "f 1//-2")), 5, &["relative normal index -2"]);
}

#[test]
fn huge_indices_do_not_wrap_around() {
    // 2^32 + 1, (2^64 + 2) / 3 and the like would come back into range in 32 bits or when multiplied by 3.
    for index in ["4294967297", "6148914691236517207", "9223372036854775807", "18446744073709551617"] {
        obj_fails(&TRIANGLE.replace("f 1 2 3", &format!("f 1 2 {index}")), 4, &[index]);
        let text = format!("vn 0 0 1\n{}", TRIANGLE.replace("f 1 2 3", &format!("f 1 2 3//{index}")));
        obj_fails(&text, 5, &[index]);
    }
    obj_fails(&TRIANGLE.replace("f 1", "f -9223372036854775808"), 4, &["-9223372036854775808"]);
}

#[test]
fn a_mesh_without_triangles() {
    for text in ["", "v 0 0 0\nv 1 0 0\n", "v 0 0 0\nv 1 0 0\nl 1 2 1\n", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"] {
        let error = obj(text).error("mesh.obj");
        assert!(matches!(&error, Error::Scene { message, .. } if message.contains("nothing to trace")), "{error}");
    }
}

#[test]
fn text_in_the_wrong_encoding() {
    let utf16: Vec<u8> = "\u{feff}v 0 0 0\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let error = obj(utf16).error("mesh.obj");
    assert!(error.to_string().contains("UTF-16"), "{error}");
    obj_fails("v 0 0 0\nv 1\0 0 0\n", 2, &["NUL"]);
}

#[test]
fn coordinates_beyond_what_single_precision_can_square() {
    let error = obj("v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n").error("mesh.obj");
    assert!(matches!(&error, Error::Scene { message, .. } if message.contains("too large")), "{error}");
}

// --- MTL ---

#[test]
fn every_modelled_statement_is_read() {
    let scene = with_mtl("newmtl m\nKa .1 .2 .3\nKd .4 .3 .2 # c\nKs 0.5\nNs 96\nKe 7 8 9\nillum 2\nNi 1.5\nd 1\n")
        .load("mesh.obj");
    let expected = Material {
        name: "m".into(),
        ambient: Vec3::new(0.1, 0.2, 0.3),
        lambert: Vec3::new(0.4, 0.3, 0.2),
        glossy: Vec3::splat(0.5),
        exponent: 96.0,
        emission: Vec3::new(7.0, 8.0, 9.0),
    };
    assert_eq!(first_material(&scene), &expected);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn what_is_absent_has_a_default() {
    let grey = with_mtl("newmtl m\n").load("mesh.obj");
    assert_eq!(first_material(&grey).lambert, Vec3::splat(0.8));
    assert_eq!(first_material(&grey).ambient, Vec3::splat(0.8));
    let lamp = with_mtl("newmtl m\nKe 1 1 1\n").load("mesh.obj");
    assert_eq!(first_material(&lamp).lambert, Vec3::ZERO);
    let glossy = with_mtl("newmtl m\nKs 1 1 1\n").load("mesh.obj");
    assert_eq!((first_material(&glossy).lambert, first_material(&glossy).exponent), (Vec3::ZERO, 10.0));
    warned(&glossy, &["`m`", "no exponent"]);
}

#[test]
fn highlights_need_illum_2() {
    for (illum, glossy) in [("", 0.2), ("illum 0", 0.0), ("illum 1", 0.0), ("illum 2", 0.2)] {
        let scene = with_mtl(format!("newmtl m\nKd .5 .5 .5\nKs .2 .2 .2\nNs 5\n{illum}\n")).load("mesh.obj");
        assert_eq!(first_material(&scene).glossy, Vec3::splat(glossy), "{illum}");
    }
}

#[test]
fn albedos_above_one_are_scaled_down() {
    let scene = with_mtl("newmtl m\nKd 0.9 0.2 0.2\nKs 0.6 0.6 0.6\nNs 10\nillum 2\n").load("mesh.obj");
    let material = first_material(&scene);
    assert!((material.lambert + material.glossy).max_element() <= 1.0);
    assert!((material.lambert.x - 0.6).abs() < 1e-6 && (material.glossy.x - 0.4).abs() < 1e-6, "{material:?}");
    warned(&scene, &["`m`", "create energy", "0.6667"]);
}

#[test]
fn a_bad_mtl_is_a_warning_with_its_line() {
    let text = "Kd 1 1 1\nnewmtl m\nKd 0.1 x 0.3\nKs 0.1 0.2\nNs -3\nKa -1 0 0\nKe nan 0 0\nillum two\nfoo 1\nNs inf\n";
    let scene = with_mtl(text).load("mesh.obj");
    assert_eq!(first_material(&scene).lambert, Vec3::splat(0.8));
    assert_eq!(first_material(&scene).ambient, Vec3::ZERO);
    for (line, words) in [
        (1, "newmtl"),
        (3, "`0.1 x 0.3`"),
        (4, "`0.1 0.2`"),
        (5, "Ns"),
        (6, "negative"),
        (7, "Ke"),
        (8, "illum"),
        (9, "`foo`"),
        (10, "Ns"),
    ] {
        warned(&scene, &[&format!("mesh.mtl:{line}:"), words]);
    }
}

#[test]
fn what_is_not_modelled_is_one_warning_for_each_material_in_use() {
    let feature = "map_Kd a.png\nmap_Kd a.png\nbump b.png\nd 0.5\nTr 0.5\nillum 7\n";
    let scene = with_mtl(format!("newmtl m\n{feature}newmtl unused\n{feature}")).load("mesh.obj");
    let warnings: Vec<_> = scene.warnings.iter().filter(|warning| warning.contains("not modelled")).collect();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    warned(&scene, &["`m`", "map_Kd, bump", "illum 7", "d 0.5"]);
    assert!(!warnings[0].contains("Tr"), "d wins over Tr: {warnings:?}");
}

#[test]
fn a_missing_mtl_and_unknown_materials_fall_back() {
    let scene = obj(format!("mtllib no.mtl\nusemtl a\n{TRIANGLE}usemtl b\nf 1 2 3\nf 3 2 1\n")).load("mesh.obj");
    assert_eq!(first_material(&scene).name, "default");
    assert_eq!(first_material(&scene).lambert, Vec3::splat(0.8));
    warned(&scene, &["mesh.obj:1", "no.mtl", "No such file"]);
    warned(&scene, &["mesh.obj:2", "`a`, `b`", "`default`"]);
    assert_eq!(scene.warnings.iter().filter(|warning| warning.contains("no MTL file")).count(), 1);
}

#[test]
fn names_of_mtl_files_and_materials_may_hold_blanks() {
    let text = format!("mtllib one file.mtl sub\\two.mtl\nusemtl  a  b \n{TRIANGLE}usemtl c\nf 1 2 3\n");
    let scene = obj(text)
        .with("one file.mtl", "newmtl a  b\nKd .1 .1 .1\n")
        .with("sub/two.mtl", "newmtl c\nKd .2 .2 .2\n")
        .load("mesh.obj");
    let albedos: Vec<f32> = scene.meshes[0]
        .triangles
        .iter()
        .map(|triangle| scene.material_of(&scene.objects[0], triangle).lambert.x)
        .collect();
    assert_eq!(albedos, [0.1, 0.2]);
}

// --- a bare OBJ ---

#[test]
fn a_bare_obj_that_is_dark_gets_a_light_and_a_framing_camera() {
    let scene = obj("v 10 0 0\nv 14 0 0\nv 10 3 0\nf 1 2 3\n").load("mesh.obj");
    assert!(matches!(scene.luminaires[..], [Luminaire::Infinite { .. }]));
    assert!(matches!(scene.integrator, Integrator::Simple { ambient } if ambient != Vec3::ZERO));
    warned(&scene, &["mesh.obj", "key light", "ambient"]);
    // Every vertex lies inside the cone of view.
    let sensor = &scene.sensor;
    let view = (sensor.target - sensor.position).normalize();
    for position in &scene.meshes[0].positions {
        let angle = (*position - sensor.position).angle_between(view).to_degrees();
        assert!(angle <= sensor.fov / 2.0 + 1e-3, "{angle}");
    }
    assert!(view.z < 0.0 && view.y < 0.0, "from the front and above");
}

#[test]
fn a_bare_obj_that_emits_is_path_traced() {
    let scene = with_mtl("newmtl m\nKe 1 2 3\n").load("mesh.obj");
    assert!(scene.luminaires.is_empty());
    assert_eq!(scene.integrator, Integrator::Path { max_bounces: None });
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn a_small_mesh_far_away_still_has_a_camera() {
    let scene = obj("v 1e7 0 0\nv 10000001 0 0\nv 1e7 1 0\nf 1 2 3\n").load("mesh.obj");
    assert_ne!(scene.sensor.position, scene.sensor.target);
}

// --- scene files: what loads ---

#[test]
fn a_minimal_scene_file_has_the_documented_defaults() {
    let scene = scene("").load("scene.toml");
    assert_eq!((scene.film.width, scene.film.height), (512, 512));
    assert_eq!((scene.settings.spp, scene.settings.seed, scene.settings.exposure), (64, 0, 0.0));
    assert_eq!(scene.integrator, Integrator::Path { max_bounces: None });
    assert_eq!((scene.sensor.up, scene.objects[0].name.as_str()), (Vec3::Y, "mesh"));
    assert_eq!(scene.objects[0].object_to_world, Affine3A::IDENTITY);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn every_key_is_read() {
    let text = "\u{feff}[film]\r\nwidth = 30\r\nheight = 20\r\nfilter = \"box\"\r\n[sensor]\r\nposition = [0, 1, 5.5]\r\n\
                target = [0, 0, 0]\r\nup = [1, 0, 0]\r\nfov = 33\r\n[integrator]\r\nkind = \"path\"\r\nmax_bounces = 7\r\n\
                [render]\r\nspp = 9\r\nseed = 4294967295\r\nexposure = -1.5\r\n[[object]]\r\nmesh = \"sub/mesh.obj\"\r\n\
                name = \"x\"\r\nmaterial = \"y\"\r\n[[material]]\r\nname = \"y\"\r\nambient = [0.1, 0.1, 0.1]\r\n\
                diffuse = [0.2, 0.2, 0.2]\r\nglossy = [0.3, 0.3, 0.3]\r\nexponent = 40\r\nemission = [1, 2, 3]\r\n\
                [[luminaire]]\r\nkind = \"infinite\"\r\ndirection = [0, -2, 0]\r\nirradiance = [1, 2, 3]\r\n";
    let scene = Folder::new().with("sub/mesh.obj", TRIANGLE).with("scene.toml", text).load("scene.toml");
    assert_eq!((scene.film.width, scene.film.height), (30, 20));
    assert_eq!((scene.sensor.position, scene.sensor.up, scene.sensor.fov), (Vec3::new(0.0, 1.0, 5.5), Vec3::X, 33.0));
    assert_eq!(scene.integrator, Integrator::Path { max_bounces: Some(7) });
    assert_eq!((scene.settings.spp, scene.settings.seed, scene.settings.exposure), (9, u32::MAX, -1.5));
    assert_eq!(scene.objects[0].name, "x");
    let y = &scene.materials[scene.objects[0].material.expect("y") as usize];
    assert_eq!((y.ambient.x, y.lambert.x, y.glossy.x, y.exponent), (0.1, 0.2, 0.3, 40.0));
    let light = Luminaire::Infinite { direction: Vec3::NEG_Y, irradiance: Vec3::new(1.0, 2.0, 3.0) };
    assert_eq!(scene.luminaires, [light]);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn a_mesh_named_twice_is_loaded_once() {
    let scene = scene("[[object]]\nmesh = \"./mesh.obj\"\nscale = [-1, 1, 1]\n").load("scene.toml");
    assert_eq!((scene.meshes.len(), scene.objects.len()), (1, 2));
    assert_eq!(scene.triangle_count(), 2);
    assert!(scene.objects[1].object_to_world.matrix3.determinant() < 0.0, "mirrored");
}

#[test]
fn transforms_scale_then_rotate_about_x_y_z_then_translate() {
    let scene = scene("scale = [2, 3, 4]\nrotate = [90, 90, 0]\ntranslate = [10, 0, 0]\n").load("scene.toml");
    let to_world = scene.objects[0].object_to_world;
    // x is left alone by the turn about x and goes to -z about y; y goes to z about x and then to x about y.
    for (from, to) in [
        (Vec3::X, Vec3::new(10.0, 0.0, -2.0)),
        (Vec3::Y, Vec3::new(13.0, 0.0, 0.0)),
        (Vec3::Z, Vec3::new(10.0, -4.0, 0.0)),
    ] {
        assert!(to_world.transform_point3(from).distance(to) < 1e-5, "{from} -> {}", to_world.transform_point3(from));
    }
}

#[test]
fn a_matrix_is_three_rows() {
    let scene = scene("matrix = [[0, -1, 0, 5], [2, 0, 0, 6], [0, 0, 1, 7]]\n").load("scene.toml");
    let to_world = scene.objects[0].object_to_world;
    assert_eq!(to_world.transform_point3(Vec3::new(1.0, 2.0, 3.0)), Vec3::new(3.0, 8.0, 10.0));
}

#[test]
fn materials_are_overridden_by_name() {
    let folder = Folder::new()
        .with("a.obj", format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}usemtl lost\nf 1 2 3\n"))
        .with("a.mtl", "newmtl m\nKd .5 .4 .3\nKe 0 0 0\n")
        .with("b.obj", format!("mtllib b.mtl\nusemtl m\n{TRIANGLE}"))
        .with("b.mtl", "newmtl m\nKd .1 .1 .1\n")
        .with("c.obj", TRIANGLE)
        .with(
            "scene.toml",
            format!(
                "{SENSOR}[[object]]\nmesh = \"a.obj\"\n[[object]]\nmesh = \"b.obj\"\n[[object]]\nmesh = \"c.obj\"\n\
                 [[material]]\nname = \"m\"\nemission = [5, 5, 5]\n[[material]]\nname = \"lost\"\ndiffuse = [0.25, 0.0, 0.0]\n\
                 [[material]]\nname = \"default\"\ndiffuse = [0.3, 0.3, 0.3]\n[[material]]\nname = \"typo\"\n"
            ),
        );
    let scene = folder.load("scene.toml");
    let of = |object: usize, triangle: usize| {
        let object = &scene.objects[object];
        scene.material_of(object, &scene.meshes[object.mesh as usize].triangles[triangle])
    };
    assert_eq!((of(0, 0).lambert, of(0, 0).emission), (Vec3::new(0.5, 0.4, 0.3), Vec3::splat(5.0)));
    assert_eq!(
        (of(1, 0).lambert, of(1, 0).emission),
        (Vec3::splat(0.1), Vec3::splat(5.0)),
        "every material of that name"
    );
    assert_eq!(
        (of(0, 1).name.as_str(), of(0, 1).lambert.x),
        ("lost", 0.25),
        "the scene file defines what the MTL lacks"
    );
    assert_eq!((of(2, 0).name.as_str(), of(2, 0).lambert.x), ("default", 0.3));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    warned(&scene, &["`typo`", "not used"]);
}

#[test]
fn an_object_takes_the_material_of_its_own_mtl_first() {
    let folder = Folder::new()
        .with("a.obj", format!("mtllib a.mtl\n{TRIANGLE}"))
        .with("a.mtl", "newmtl m\nKd .5 .5 .5\n")
        .with("b.obj", format!("mtllib b.mtl\n{TRIANGLE}"))
        .with("b.mtl", "newmtl m\nKd .1 .1 .1\n")
        .with(
            "scene.toml",
            format!(
                "{SENSOR}{LIGHT}[[object]]\nmesh = \"a.obj\"\nmaterial = \"m\"\n[[object]]\nmesh = \"b.obj\"\nmaterial = \"m\"\n"
            ),
        );
    let scene = folder.load("scene.toml");
    let albedo = |object: usize| scene.materials[scene.objects[object].material.expect("m") as usize].lambert.x;
    assert_eq!((albedo(0), albedo(1)), (0.5, 0.1));
}

#[test]
fn what_is_missing_from_a_scene_file_is_said() {
    let text = "[[object]]\nmesh = \"mesh.obj\"\n";
    let scene = obj(TRIANGLE).with("scene.toml", text).load("scene.toml");
    warned(&scene, &["no [sensor]"]);
    warned(&scene, &["will be black"]);
    let ambient = format!("{SENSOR}[integrator]\nkind = \"simple\"\nambient = [1, 1, 1]\n{text}");
    let scene = obj(TRIANGLE).with("scene.toml", ambient).load("scene.toml");
    assert_eq!(scene.warnings, Vec::<String>::new(), "ambient light shows something");
}

// --- scene files: what is refused ---

#[test]
fn unknown_keys_are_found_with_line_and_column() {
    toml_fails("[film]\nwidth = 3\n  heigth = 4\n", (3, 3), &["heigth", "height"]);
    toml_fails("[cameras]\n", (1, 2), &["cameras"]);
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nscales = 3\n", (3, 1), &["scales"]);
    toml_fails("[[luminaire]]\nkind = \"area\"\n", (2, 8), &["area", "point", "infinite"]);
    toml_fails("[film]\nfilter = \"gauss\"\n", (2, 10), &["gauss", "box"]);
    toml_fails("[integrator]\nkind = \"bidirectional\"\n", (2, 8), &["bidirectional"]);
}

#[test]
fn wrong_toml_is_found_with_line_and_column() {
    toml_fails("[film]\nwidth = = 3\n", (2, 9), &[]);
    toml_fails("[film]\nwidth = 3\nwidth = 4\n", (3, 1), &["duplicate"]);
    toml_fails("[[object]]\nname = \"x\"\n", (1, 1), &["missing field", "mesh"]);
    toml_fails("[film]\nwidth = \"wide\"\n", (2, 9), &["expected"]);
    toml_fails("# \u{e9}\u{e9}\n[film]\nwidth = 1.5\n", (3, 9), &[]);
    let mut bytes = b"[film]\nwidth = 3 # ".to_vec();
    bytes.extend([0xe9, b'\n']);
    Folder::new().with("scene.toml", bytes).fails_at("scene.toml", "scene.toml", (2, 0), &["UTF-8"]);
}

#[test]
fn numbers_out_of_range_are_found_with_line_and_column() {
    let sensor = |key: &str, value: &str| {
        let text = "[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n";
        let line = text.lines().find(|line| line.starts_with(key)).expect("a line with the key");
        text.replace(line, &format!("{key} = {value}"))
    };
    toml_fails("[film]\nwidth = 0\n", (2, 9), &["1 to 65536"]);
    toml_fails("[film]\nheight = 65537\n", (2, 10), &["1 to 65536"]);
    toml_fails("[film]\nwidth = -1\n", (2, 9), &["1 to 65536"]);
    toml_fails("[film]\nwidth = 65536\nheight = 65536\n", (1, 1), &["2^32"]);
    toml_fails("[render]\nspp = 0\n", (2, 7), &["1 to"]);
    toml_fails("[render]\nseed = -1\n", (2, 8), &["from 0 to 4294967295"]);
    toml_fails("[render]\nexposure = nan\n", (2, 12), &["-64 to 64"]);
    toml_fails(&sensor("fov", "0"), (5, 7), &["between 0 and 180"]);
    toml_fails(&sensor("fov", "180"), (5, 7), &["between 0 and 180"]);
    toml_fails(&sensor("fov", "nan"), (5, 7), &["between 0 and 180"]);
    toml_fails(&sensor("position", "[0, inf, 0]"), (2, 12), &["finite"]);
    toml_fails(&sensor("position", "[0, 1e300, 0]"), (2, 12), &["finite"]);
    toml_fails(&sensor("position", "[0, 1]"), (2, 12), &["length"]);
    toml_fails("[[material]]\nname = \"m\"\ndiffuse = [0.5, -0.1, 0]\n", (3, 11), &["negative"]);
    toml_fails("[[material]]\nname = \"m\"\nexponent = -1\n", (3, 12), &["at least 0"]);
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nscale = \"big\"\n", (3, 9), &["a number or three numbers"]);
    toml_fails("[integrator]\nkind = \"path\"\nmax_bounces = -1\n", (3, 15), &["from 0 to 4294967295"]);
}

#[test]
fn impossible_cameras() {
    let object = "[[object]]\nmesh = \"mesh.obj\"\n";
    let camera = |rest: &str| format!("{object}[sensor]\nposition = [0, 0, 5]\nfov = 40\n{rest}");
    toml_fails(&camera("target = [0, 0, 5]\n"), (3, 1), &["same point"]);
    toml_fails(&camera("target = [0, 3, 5]\n"), (3, 1), &["parallel"]);
    toml_fails(&camera("target = [0, 0, 0]\nup = [0, 0, -2]\n"), (3, 1), &["parallel"]);
    toml_fails(&camera("target = [0, 0, 0]\nup = [0, 0, 0]\n"), (3, 1), &["zero vector"]);
}

#[test]
fn transforms_that_cannot_be_inverted() {
    for transform in [
        "scale = 0",
        "scale = [1, 0, 1]",
        "scale = 1e-30",
        "matrix = [[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]]",
        "matrix = [[0.1, 0.2, 0.3, 0], [0.3, 0.6, 0.9, 0], [0.7, 0.1, 0.4, 0]]",
    ] {
        toml_fails(&format!("[[object]]\nmesh = \"mesh.obj\"\n{transform}\n"), (1, 1), &["cannot be inverted"]);
    }
    let both = "[[object]]\nmesh = \"mesh.obj\"\nscale = 2\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\n";
    toml_fails(both, (1, 1), &["either"]);
}

#[test]
fn small_and_large_transforms_are_fine() {
    for transform in ["scale = 1e-9", "scale = 1e9", "scale = [1e-6, 1e6, 1]"] {
        assert_eq!(scene(&format!("{transform}\n")).load("scene.toml").objects.len(), 1, "{transform}");
    }
}

#[test]
fn a_mesh_that_is_missing_or_wrong_is_named() {
    toml_fails("\n[[object]]\nmesh = \"no.obj\"\n", (3, 8), &["no.obj", "No such file"]);
    toml_fails("[[object]]\nmesh = \"mesh.ply\"\n", (2, 8), &["mesh.ply", ".obj"]);
    let folder = obj("v 0 0 0\nv 0 0 nan\n").with("scene.toml", "[[object]]\nmesh = \"mesh.obj\"\n");
    folder.fails_at("scene.toml", "mesh.obj", (2, 0), &["not finite"]);
}

#[test]
fn a_scene_without_objects() {
    let error = Folder::new().with("scene.toml", SENSOR).error("scene.toml");
    assert!(matches!(&error, Error::Scene { message, .. } if message.contains("[[object]]")), "{error}");
    assert!(matches!(Folder::new().with("scene.toml", "").error("scene.toml"), Error::Scene { .. }));
}

#[test]
fn materials_and_luminaires_that_make_no_sense() {
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nmaterial = \"gold\"\n", (3, 12), &["`gold`"]);
    toml_fails("[[material]]\nname = \"m\"\n[[material]]\nname = \"m\"\n", (4, 8), &["second", "`m`"]);
    toml_fails("[[luminaire]]\nkind = \"point\"\nposition = [0, 0, 0]\n", (1, 1), &["`position` and `intensity`"]);
    let mixed =
        "[[luminaire]]\nkind = \"infinite\"\ndirection = [0, 1, 0]\nirradiance = [1, 1, 1]\nposition = [0, 0, 0]\n";
    toml_fails(mixed, (1, 1), &["`direction` and `irradiance`"]);
    let zero = "[[luminaire]]\nkind = \"infinite\"\ndirection = [0, 0, 0]\nirradiance = [1, 1, 1]\n";
    toml_fails(zero, (1, 1), &["zero vector"]);
    toml_fails("[integrator]\nkind = \"path\"\nambient = [1, 1, 1]\n", (3, 11), &["simple"]);
    toml_fails("[integrator]\nkind = \"simple\"\nmax_bounces = 1\n", (3, 15), &["path"]);
}
