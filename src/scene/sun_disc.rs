//! A disc at infinity, as tracers see it.

use super::luminaire::one_minus_cos;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// A disc at infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunDisc {
    /// Unit vector to its middle.
    pub towards: Vec3,
    /// One minus the cosine of its angular radius.
    pub extent: f64,
    /// Radiance, the same all over it.
    pub radiance: DVec3,
}

impl SunDisc {
    /// The disc of a diameter in degrees, above 0 and at most 180, that gives this irradiance where it stands in the zenith: the integral of the cosine over it
    /// is `pi sin^2` of its radius.
    pub fn new(direction: Vec3, irradiance: Vec3, angle: f32) -> Self {
        let extent = one_minus_cos(0.5 * f64::from(angle));
        let unit = SunDisc { towards: -direction, extent, radiance: DVec3::ONE };
        SunDisc { radiance: irradiance.as_dvec3() / unit.irradiance(), ..unit }
    }

    /// The squared sine of its angular radius.
    fn sine2(&self) -> f64 {
        self.extent * (2.0 - self.extent)
    }

    /// Irradiance on a surface that faces its middle.
    pub fn irradiance(&self) -> DVec3 {
        self.radiance * (PI * self.sine2())
    }

    /// Its diameter in degrees.
    pub fn angle(&self) -> f64 {
        2.0 * self.sine2().sqrt().atan2(1.0 - self.extent).to_degrees()
    }

    /// Density of an even choice of its directions, per steradian.
    pub fn density(&self) -> f64 {
        1.0 / (2.0 * PI * self.extent)
    }
}
