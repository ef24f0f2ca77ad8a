//! What is wrong with a picture before it is rendered.

use luminaire::reference::lost_light::lost_light;
use luminaire::scene::Scene;

/// Adds to a scene's warnings what single precision cannot draw of its picture, and what light the picture will lack; returns whether it lacks any. Only when the
/// film has its size.
pub fn warn_of_the_picture(scene: &mut Scene) -> bool {
    scene.warnings.extend(scene.blurred_because());
    let lost = lost_light(scene);
    let lacks_light = !lost.is_empty();
    scene.warnings.extend(lost);
    lacks_light
}
