//! How long the phases of a run took.

use serde::Serialize;

/// Wall-clock seconds of the phases of a run.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Seconds {
    /// Reading the scene.
    pub load: f64,
    /// Opening the device, with `build`.
    pub open: f64,
    /// Building the acceleration structures and uploading.
    pub build: f64,
    /// Rendering.
    pub render: f64,
    /// Rendering, by the device's own clock; 0 if it has none.
    pub device: f64,
    /// Writing the pictures.
    pub write: f64,
}
