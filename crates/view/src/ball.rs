//! The ball around a scene: where it is, and how large.

use glam::DVec3;
use luminaire::scene::Scene;

/// Two points are kept apart by this part of their largest coordinate, so that they stay distinct in `f32`.
pub const NEAREST: f64 = 1e-5;

/// A ball around a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its middle, in world space.
    pub center: DVec3,
    /// Its radius in the scene's unit; never 0.
    pub radius: f64,
}

impl Ball {
    /// The ball around a scene's box, without a ground that was made for it.
    pub fn around(scene: &Scene) -> Self {
        let (low, high) = scene.model_bounds();
        let reach = low.abs().max(high.abs()).max_element();
        Ball { center: 0.5 * (low + high), radius: (0.5 * low.distance(high)).max(NEAREST * reach) }
    }
}
