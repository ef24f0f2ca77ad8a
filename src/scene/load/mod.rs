//! From a path to a [`Scene`].

mod alike;
mod bare_mesh;
mod bodies;
mod camera;
mod choices;
mod environment;
mod far;
mod footing;
mod format;
mod ground;
mod ies;
mod lamplight;
mod loader;
mod map_draft;
mod map_file;
mod mapped_number;
mod material_draft;
mod metals;
mod model;
mod mtl;
mod named_file;
mod near_name;
mod obj;
mod other_formats;
mod physical_draft;
mod polygon;
mod reach;
mod scene_file;
mod texel_faults;
mod text_file;
mod texture;
mod toml;

pub use camera::use_camera;
pub use choices::{Choices, Sky, Up};
pub use format::{is_bare, is_scene};
pub use metals::metal_name;
pub use scene_file::{SceneFile, scene_file};

use crate::scene::Scene;
use crate::{Error, Result};
use format::{ENDINGS, Format};
use near_name::instead_of;
use std::path::Path;

/// Loads a scene file (`.toml`), or a model (an OBJ, `.obj`), which then gets a camera and, if next to nothing in it
/// emits, a sky and a ground.
///
/// # Errors
/// [`Error::Usage`] for another format; otherwise if a file cannot be read or is wrong, with file and line.
pub fn load(path: &Path) -> Result<Scene> {
    load_with(path, &Choices::default())
}

/// [`load`], with choices in place of what a file says or of what a bare model would get.
///
/// # Errors
/// As for [`load`]; also [`Error::Usage`] for a scene file with a choice that is for bare models only, and where the image of a chosen sky
/// cannot be read.
pub fn load_with(path: &Path, choices: &Choices) -> Result<Scene> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let mut scene = match Format::of(path) {
        Some(Format::SceneFile) => {
            choices.check_for_scene_file(path)?;
            toml::load(path, choices).map_err(with_what_is_there(path))?
        }
        Some(model) => bare_mesh::load(path, model, choices).map_err(with_what_is_there(path))?.scene,
        None => {
            // Who names a picture first has swapped two words, and is told so.
            let foreign = if is_picture(&ending) { None } else { other_formats::named(path) };
            let otherwise = what_else(path, &ending);
            // A name of which nothing is known is that of a file which is not there.
            if foreign.is_none() && otherwise.is_empty() && !path.exists() {
                let why = std::fs::metadata(path).map_or_else(|e| e.to_string(), |_| "it came this moment".into());
                return Err(with_what_is_there(path)(Error::read(path, why)));
            }
            let what = foreign.unwrap_or("not a scene".into());
            return Err(Error::Usage(format!(
                "{}: {what}; expected a scene file ending in .toml or a mesh ending in .obj{}",
                path.display(),
                otherwise
            )));
        }
    };
    finish(&mut scene)?;
    Ok(scene)
}

/// What is done with every scene, wherever it comes from.
fn finish(scene: &mut Scene) -> Result<()> {
    let merged = scene.merge_overlapping_lamps();
    scene.warnings.extend(merged);
    let parted = scene.part_touching_glass();
    scene.warnings.extend(parted);
    // Of the triangles that there are now.
    let untangled = scene.add_tangents();
    scene.warnings.extend(untangled);
    // What was there twice may be gone by now.
    scene.warnings.extend(bodies::warnings(scene));
    alike::shorten(&mut scene.warnings);
    for warning in scene.warnings.iter_mut().chain(&mut scene.notes) {
        // Names come from files, and a terminal would obey.
        if warning.contains(char::is_control) {
            *warning = warning.replace(char::is_control, "\u{fffd}");
        }
    }
    reach::check(scene)
}

/// Names what is there in the place of a scene that is missing.
fn with_what_is_there(scene: &Path) -> impl Fn(Error) -> Error {
    move |error| match error {
        Error::Read { path, reason } if path == scene => Error::Read { reason: reason + &instead_of(scene), path },
        other => other,
    }
}

/// What somebody may mean who names no scene.
fn what_else(path: &Path, ending: &str) -> String {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        let mut scenes: Vec<_> = entries.map(|entry| entry.path()).filter(|path| has_ending(path)).collect();
        // A scene file knows its camera and its light.
        scenes.sort_by_key(|path| {
            (!path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")), path.clone())
        });
        return match scenes.first() {
            Some(scene) => format!("; this is a folder, in which there is {}", scene.display()),
            None => "; this is a folder".into(),
        };
    }
    if is_picture(ending) {
        return "; the scene comes first, and the picture behind -o: luminaire render SCENE -o PICTURE".into();
    }
    let with_ending = ENDINGS.map(|ending| std::path::PathBuf::from(format!("{}.{ending}", path.display())));
    match with_ending.iter().find(|path| path.is_file()) {
        Some(scene) if ending.is_empty() => format!(": there is {}", scene.display()),
        _ => String::new(),
    }
}

/// Whether a file is a picture by the ending of its name.
fn is_picture(ending: &str) -> bool {
    ["png", "exr", "hdr", "jpg", "jpeg"].contains(&ending)
}

/// Whether a file is one that is read, by its name.
fn has_ending(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}
