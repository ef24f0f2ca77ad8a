//! `--camera`: which of a scene's cameras, or one from a file.

use super::printing::Notes;
use luminaire::Result;
use luminaire::scene::{Scene, use_camera};

/// The most names in a note.
const MOST_NAMES: usize = 12;

/// The camera to look through.
#[derive(Debug, clap::Args)]
pub struct CameraOption {
    /// Which camera: the name of one of the scene's [[sensor]], or a file ending in .toml with a [sensor] and perhaps `exposure` and `tone` in
    /// [render], as the window writes with the key C [default: the scene's first].
    #[arg(long, value_name = "NAME|FILE.toml", help_heading = "Framing")]
    pub camera: Option<String>,
}

impl CameraOption {
    /// Looks at the scene through the camera that is asked for; where none is and there are several, a note names the others.
    ///
    /// # Errors
    /// As for [`use_camera`].
    pub fn choose(&self, scene: &mut Scene, notes: Notes) -> Result<()> {
        if let Some(wanted) = &self.camera {
            return use_camera(scene, wanted);
        }
        if let [first, others @ ..] = &scene.cameras[..]
            && !others.is_empty()
        {
            let names: Vec<String> =
                others.iter().take(MOST_NAMES).map(|camera| format!("`{}`", camera.name)).collect();
            let more = if others.len() > MOST_NAMES { ", ... (`luminaire inspect` lists all)" } else { "" };
            notes.note(&format!(
                "camera `{}`, the first of {}; --camera NAME takes another: {}{more}",
                first.name,
                scene.cameras.len(),
                names.join(", ")
            ));
        }
        Ok(())
    }
}
