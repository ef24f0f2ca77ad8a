//! From two uniform random numbers to points and directions.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Evenly over the unit disk: Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
pub fn concentric_disk(u: f64, v: f64) -> DVec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return DVec2::ZERO;
    }
    let (r, phi) = if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, FRAC_PI_2 - FRAC_PI_4 * (a / b)) };
    DVec2::new(r * phi.cos(), r * phi.sin())
}

/// A direction about `normal` with density `cos / pi`: the disk, lifted to the hemisphere.
pub fn cosine_hemisphere(normal: DVec3, u: f64, v: f64) -> DVec3 {
    let disk = concentric_disk(u, v);
    let z = (1.0 - disk.length_squared()).max(0.0).sqrt();
    let (tangent, bitangent) = frame(normal);
    disk.x * tangent + disk.y * bitangent + z * normal
}

/// Two unit vectors that form a right-handed frame with the unit vector `n`: Duff et al., "Building an Orthonormal Basis,
/// Revisited", JCGT 6(1), 2017.
pub fn frame(n: DVec3) -> (DVec3, DVec3) {
    // Zero of either sign counts as positive, as in the shader.
    let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// Weights of a triangle's corners, evenly over its area: Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
pub fn uniform_triangle(u: f64, v: f64) -> [f64; 3] {
    let (b0, b1) = if u < v { (0.5 * u, v - 0.5 * u) } else { (u - 0.5 * v, 0.5 * v) };
    [b0, b1, 1.0 - b0 - b1]
}
