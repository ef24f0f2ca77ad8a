//! How pictures of a scene are developed.

use crate::picture::Development;
use crate::reference::AutoExposure;
use crate::scene::Scene;

/// How pictures of a scene are developed, as it says itself. Where it leaves the exposure to the program ([`Exposure::Auto`](crate::scene::Exposure::Auto)), that is
/// found here, in a fraction of a second; 0 stops if the scene is black.
pub fn development(scene: &Scene) -> Development {
    let exposure = scene.settings.exposure.stops().unwrap_or_else(|| AutoExposure::of(scene, &scene.film).stops);
    Development { exposure, tone: scene.settings.tone }
}
