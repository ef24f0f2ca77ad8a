//! Indirect light: which way a path goes on, and whether it does.

use super::surfel::Surfel;
use super::warp::cosine_hemisphere;
use glam::DVec3;
use std::f64::consts::PI;

/// No surface lets every path live, so that every path ends.
const MAX_SURVIVAL: f64 = 0.9999;

/// The probability that a path goes on: one minus the extinction coefficient, for the channel that loses least.
pub fn survival(surfel: &Surfel) -> f64 {
    (surfel.lambert + surfel.glossy).max_element().min(MAX_SURVIVAL)
}

/// A direction with density `cos / pi` about the shading normal, and its weight `f cos / pdf = pi f`.
pub fn scatter(surfel: &Surfel, wo: DVec3, u: f64, v: f64) -> (DVec3, DVec3) {
    let wi = cosine_hemisphere(surfel.shading_normal, u, v);
    (wi, PI * surfel.bsdf(wo, wi))
}
