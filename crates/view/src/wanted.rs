//! What the window asks of the worker.

use super::shown::Shown;
use super::sight::Sight;

/// What the window wants.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// Camera and film.
    pub sight: Sight,
    /// Whether the camera is on its way, so that quick is better than fine.
    pub moving: bool,
    /// What is shown.
    pub shown: Shown,
    /// In stops.
    pub exposure: f32,
    /// Whether to leave the film as it is.
    pub paused: bool,
}

/// What is to be done once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Trace with the next backend that works here.
    NextBackend,
    /// Trace with the next estimator.
    NextEstimator,
    /// Save a picture.
    Save(Saved),
    /// Write the camera down.
    SaveCamera,
    /// End.
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
