//! What can be said of a picture before it is rendered: what it will lack, and how it is to be exposed.

use luminaire::picture::Development;
use luminaire::reference::lost_light::lost_light_by;
use luminaire::reference::{AutoExposure, Reference};
use luminaire::scene::{Exposure, FilmSettings, Scene};

/// What is foreseen of a scene's picture.
#[derive(Debug, Clone)]
pub struct Foreseen {
    /// Whether a warning tells of light that no estimator finds.
    pub lacks_light: bool,
    /// How the picture is developed.
    pub development: Development,
    /// The exposure in words, where it was found here and not given.
    pub found: Option<String>,
}

/// Adds to a scene's warnings what single precision cannot draw of its picture, and what light the picture will lack; finds its exposure, where that is left to the program,
/// and puts it into the scene. Only when the film has its size; `own` is what the scene itself says of it, so that options change nothing of the exposure.
pub fn foresee(scene: &mut Scene, own: &FilmSettings) -> Foreseen {
    scene.warnings.extend(scene.blurred_because());
    let mut tracer = None;
    let lost = lost_light_by(scene, &mut tracer);
    let lacks_light = !lost.is_empty();
    scene.warnings.extend(lost);
    let mut found = None;
    let exposure = scene.settings.exposure.stops().unwrap_or_else(|| {
        let auto = expose(scene, own, tracer);
        found = Some(auto.in_words());
        scene.warnings.extend(auto.warning);
        auto.stops
    });
    scene.settings.exposure = Exposure::Stops(exposure);
    Foreseen { lacks_light, development: Development { exposure, tone: scene.settings.tone }, found }
}

/// Finds the exposure of a scene, with the tracer of it if there is one already.
fn expose(scene: &Scene, own: &FilmSettings, tracer: Option<Reference>) -> AutoExposure {
    match tracer {
        Some(tracer) => tracer.auto_exposure(own),
        None => AutoExposure::of(scene, own),
    }
}
