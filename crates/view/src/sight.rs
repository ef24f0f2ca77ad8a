//! [`Sight`]: a camera and the film that it is traced to.

use luminaire::scene::{FilmSettings, Sensor};

/// A camera and a film: when either changes, tracing starts anew.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    /// The camera.
    pub sensor: Sensor,
    /// The film: as large as the window.
    pub film: FilmSettings,
}
