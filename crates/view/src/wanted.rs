//! What the window asks of the worker: [`Wanted`], a state to keep to until it changes, and [`Order`], something to do once.

use super::shown::Shown;
use super::sight::Sight;
use luminaire::picture::Development;

/// The state that the worker keeps to.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// Camera and film.
    pub sight: Sight,
    /// Whether the camera is moving: then a quick picture is better than a fine one.
    pub moving: bool,
    /// What of the film is shown.
    pub shown: Shown,
    /// How the picture is developed.
    pub development: Development,
    /// Whether to add no more samples.
    pub paused: bool,
}

/// Something to do once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Trace with the next backend that works here.
    NextBackend,
    /// Trace with the next estimator.
    NextEstimator,
    /// Find an exposure for what is seen.
    Expose,
    /// Save a picture.
    Save(Saved),
    /// Write the camera, exposure and tone to a file, as a scene file's `[sensor]` and `[render]`.
    SaveCamera,
    /// End the thread.
    Quit,
}

/// Which picture is saved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Saved {
    /// What is shown, as a PNG.
    Png,
    /// The film, as an EXR.
    Exr,
}
