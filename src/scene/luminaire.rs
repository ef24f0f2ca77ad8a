//! Points and parallel light: luminaires without an area. What has one is a triangle whose material emits.

use glam::Vec3;

/// A luminaire without an area.
#[derive(Debug, Clone, PartialEq)]
pub enum Luminaire {
    /// An impulse in space.
    Point {
        /// World position.
        position: Vec3,
        /// Radiant intensity, in radiance times length squared.
        intensity: Vec3,
    },
    /// An impulse in direction: parallel light that does not attenuate.
    Infinite {
        /// Unit vector in which the light travels.
        direction: Vec3,
        /// Irradiance on a surface perpendicular to `direction`.
        irradiance: Vec3,
    },
}
