//! From a path to a [`Scene`].

mod bare_mesh;
mod bodies;
mod environment;
mod far;
mod loader;
mod material_draft;
mod mtl;
mod obj;
mod other_formats;
mod polygon;
mod texel_faults;
mod text_file;
mod texture;
mod toml;

use crate::scene::Scene;
use crate::{Error, Result};
use std::path::Path;

/// World coordinates beyond this are refused: their squares would leave the range of `f32`.
const LARGEST_COORDINATE: f64 = 1e18;

/// Loads a scene file (`.toml`), or any OBJ (`.obj`), which then gets a camera and, if next to nothing in it
/// emits, a light.
///
/// # Errors
/// [`Error::Usage`] for another ending; otherwise if a file cannot be read or is wrong, with file and line.
pub fn load(path: &Path) -> Result<Scene> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let mut scene = match ending.as_str() {
        "toml" => toml::load(path)?,
        "obj" => bare_mesh::load(path)?,
        _ => {
            let what = other_formats::named(path).unwrap_or("not a scene".into());
            return Err(Error::Usage(format!(
                "{}: {what}; expected a scene file ending in .toml or a mesh ending in .obj",
                path.display()
            )));
        }
    };
    scene.warnings.extend(bodies::warnings(&scene));
    let merged = scene.merge_overlapping_lamps();
    scene.warnings.extend(merged);
    for warning in &mut scene.warnings {
        // Names come from files, and a terminal would obey.
        if warning.contains(char::is_control) {
            *warning = warning.replace(char::is_control, "\u{fffd}");
        }
    }
    let (low, high) = scene.world_bounds();
    let largest = (low + scene.origin).abs().max((high + scene.origin).abs()).max_element();
    if largest > LARGEST_COORDINATE {
        let message = format!("a coordinate of {largest:e} is too large; scale the scene to stay within 1e18");
        return Err(Error::scene(path, message));
    }
    if scene.sensor.is_beyond_single_precision(&scene.film, (low, high)) {
        scene.warnings.push(format!(
            "{}: a pixel is smaller than what single precision tells apart at these distances and coordinates, so that a GPU's picture is \
             blurred or shifted: take --backend cpu, or bring the scene nearer to the camera and to the origin",
            path.display()
        ));
    }
    Ok(scene)
}
