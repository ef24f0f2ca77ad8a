//! Another camera for a scene: one of its own by name, or that of a file.

use super::bare_mesh::FIRST_VIEW;
use super::near_name::near_name;
use super::toml::{NO_SENSOR, camera_file};
use super::with_what_is_there;
use crate::scene::{Camera, Scene};
use crate::{Error, Result};
use std::path::Path;

/// The most names in an error.
const MOST_NAMES: usize = 24;

/// Looks at a scene through another camera: the one of this name, or that of a file ending in `.toml` (a `[sensor]` in the coordinates of the scene's
/// files, and perhaps an exposure and a tone curve in `[render]`).
///
/// # Errors
/// [`Error::Usage`] if there is no such camera, with the names that there are; otherwise if the file cannot be read or is wrong.
pub fn use_camera(scene: &mut Scene, wanted: &str) -> Result<()> {
    if let Some(camera) = scene.cameras.iter().find(|camera| camera.name == wanted && !wanted.is_empty()) {
        scene.sensor = camera.sensor.clone();
        return Ok(());
    }
    let path = Path::new(wanted);
    if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("toml")) {
        return Err(Error::Usage(format!("--camera {wanted}: {}", no_such_camera(&scene.cameras, wanted))));
    }
    let file = camera_file(path, scene.origin).map_err(with_what_is_there(path))?;
    let mut warn = |what: String| scene.warnings.push(format!("{}: {what}", path.display()));
    if let [first, others @ ..] = &file.cameras[..]
        && !others.is_empty()
    {
        warn(format!("it has {} cameras; the first, `{}`, is taken", file.cameras.len(), first.name));
    }
    if !file.others.is_empty() {
        warn(format!("only its camera and how its pictures are shown count here, not its {}", file.others.join(", ")));
    }
    if let Some(camera) = file.cameras.into_iter().next() {
        scene.sensor = camera.sensor;
    }
    scene.settings.exposure = file.exposure.unwrap_or(scene.settings.exposure);
    scene.settings.tone = file.tone.unwrap_or(scene.settings.tone);
    scene.files.push(path.to_owned());
    scene.warnings.retain(|warning| !warning.contains(NO_SENSOR));
    scene.notes.retain(|note| !note.starts_with(FIRST_VIEW));
    Ok(())
}

/// Which cameras there are instead.
fn no_such_camera(cameras: &[Camera], wanted: &str) -> String {
    let names: Vec<&str> = cameras.iter().map(|camera| &*camera.name).filter(|name| !name.is_empty()).collect();
    if names.is_empty() {
        return "the scene has no camera with a name; a [sensor] gets one by `name = \"...\"`, and a file with another \
                [sensor] (key C of `luminaire view` writes one) ends in .toml"
            .into();
    }
    let same = names.iter().find(|name| name.eq_ignore_ascii_case(wanted)).copied();
    let near = same.or_else(|| near_name(wanted, names.iter().copied()));
    let hint = near.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default();
    let more = if names.len() > MOST_NAMES { ", ..." } else { "" };
    let list: Vec<String> = names.iter().take(MOST_NAMES).map(|name| format!("`{name}`")).collect();
    format!("no camera has this name; there are {}{more}{hint}", list.join(", "))
}
