//! What is looked at.

use luminaire::scene::{FilmSettings, Sensor};

/// What is traced: a camera and a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    /// The camera.
    pub sensor: Sensor,
    /// The film: as large as the window.
    pub film: FilmSettings,
}
