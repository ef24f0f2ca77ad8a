//! Discs at infinity: where they are, and directions to them.

use super::warp::{concentric_disk, frame};
use crate::scene::SunDisc;
use glam::DVec3;

/// One minus the cosine of the angle between two unit vectors: half the square of the chord, which does not cancel where they are close.
pub fn one_minus_cosine(a: DVec3, b: DVec3) -> f64 {
    0.5 * (a - b).length_squared()
}

/// A unit direction to a disc, chosen by two numbers, evenly over its solid angle: `1 - cos` goes as the square of the radius in the unit disk.
pub fn sample_sun(sun: &SunDisc, u: f64, v: f64) -> DVec3 {
    let disk = concentric_disk(u, v);
    let below = sun.extent * disk.length_squared();
    let across = disk * (sun.extent * (2.0 - below)).sqrt();
    let towards = sun.towards.as_dvec3();
    let (tangent, bitangent) = frame(towards);
    across.x * tangent + across.y * bitangent + (1.0 - below) * towards
}
