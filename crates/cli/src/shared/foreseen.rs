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
    foresee_by(scene, own, None)
}

/// The same with a tracer of the scene, if there is one already.
pub fn foresee_by(scene: &mut Scene, own: &FilmSettings, mut tracer: Option<Reference>) -> Foreseen {
    scene.warnings.extend(scene.blurred_because());
    scene.warnings.extend(below_the_ground(scene));
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

/// A number with six decimals at most.
fn short(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

/// What is said of a camera below the ground that the loader made: it looks at the ground from below, which hides the model.
fn below_the_ground(scene: &Scene) -> Option<String> {
    let ground = &scene.objects[scene.ground? as usize];
    let corner = scene.meshes[ground.mesh as usize].positions.first()?;
    let height = f64::from(ground.object_to_world.transform_point3(*corner).y);
    let camera = f64::from(scene.sensor.position.y);
    (camera < height).then(|| {
        format!(
            "{}: the camera stands below the ground (at a height of {}, the ground at {}), and sees it from below: move one of them, or leave the ground out \
             (--ground off)",
            scene.path.display(),
            short(camera + scene.origin.y),
            short(height + scene.origin.y)
        )
    })
}

/// Finds the exposure of a scene, with the tracer of it if there is one already.
fn expose(scene: &Scene, own: &FilmSettings, tracer: Option<Reference>) -> AutoExposure {
    match tracer {
        Some(tracer) => tracer.auto_exposure(own),
        None => AutoExposure::of(scene, own),
    }
}
