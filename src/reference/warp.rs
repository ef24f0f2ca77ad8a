//! From two uniform random numbers to points and directions.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

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

/// A direction about `normal` with density `1 / 2 pi` (slide "Inefficient Integration").
pub fn uniform_hemisphere(normal: DVec3, u: f64, v: f64) -> DVec3 {
    let z = 1.0 - u;
    about(normal, z, 1.0 - z * z, v)
}

/// A half vector about `normal` with density `(m + 1) / 2 pi * cos^m`: the lobe of Blinn-Phong
/// (Pharr and Humphreys, "Physically Based Rendering", first edition, section 14.5.2).
pub fn glossy_half_vector(normal: DVec3, m: f64, u: f64, v: f64) -> DVec3 {
    let z2 = (1.0 - u).powf(2.0 / (m + 1.0));
    about(normal, z2.sqrt(), 1.0 - z2, v)
}

/// The direction with cosine `z` and squared sine `sin2` to `normal`, at `v` of a full turn.
fn about(normal: DVec3, z: f64, sin2: f64, v: f64) -> DVec3 {
    let (tangent, bitangent) = frame(normal);
    let (sin_phi, cos_phi) = (TAU * v).sin_cos();
    sin2.sqrt() * (cos_phi * tangent + sin_phi * bitangent) + z * normal
}

/// Solid angle of the triangle with these corners, which are unit vectors (van Oosterom and Strackee, "The Solid Angle of a Plane
/// Triangle", 1983). Accurate for triangles of any size and shape.
pub fn solid_angle([v0, v1, v2]: [DVec3; 3]) -> f64 {
    let [g0, g1, g2] = triangle_terms(v0, v1, v2);
    2.0 * g0.atan2(g1 + g2)
}

/// Tangent of half the solid angle is the first over the sum of the others.
fn triangle_terms(v0: DVec3, v1: DVec3, v2: DVec3) -> [f64; 3] {
    [v0.dot(v1.cross(v2)).abs(), v0.dot(v2) + v1.dot(v2), 1.0 + v0.dot(v1)]
}

/// A direction evenly over the solid angle of a triangle whose corners are unit vectors: Peters, "BRDF Importance Sampling for
/// Polygonal Lights", 2021, section 4. Along the edge from `v0` to `v2` the point `new` cuts off the share `u` of the solid
/// angle; the direction is on the arc from `v1` to there.
pub fn spherical_triangle([v0, v1, v2]: [DVec3; 3], u: f64, v: f64) -> DVec3 {
    let [g0, g1, g2] = triangle_terms(v0, v1, v2);
    let (sin, cos) = (0.5 * u * solid_angle([v0, v1, v2])).sin_cos();
    let offset = (g0 * cos - g1 * sin) * v0 + g2 * sin * v2;
    let new = 2.0 * v0.dot(offset) / offset.length_squared() * offset - v0;
    let s2 = v1.dot(new);
    let z = 1.0 - v * (1.0 - s2);
    z * v1 + (1.0 - z * z).max(0.0).sqrt() * (new - s2 * v1).normalize_or_zero()
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
