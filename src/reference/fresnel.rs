//! Smooth surfaces between two media: where light goes, and how much of it (slides "Impulse Reflection", "Adding Transmission").

use crate::scene::conductor_reflectance;
use glam::DVec3;

/// Mirror direction of `wo` about the unit vector `n`. The slide's `2 n - wo` holds for `wo = n` only.
pub fn reflect(wo: DVec3, n: DVec3) -> DVec3 {
    2.0 * n.dot(wo) * n - wo
}

/// Cosine of the angle between the refracted direction and the normal on the far side; none at total internal reflection
/// (Snell's law).
fn transmitted_cosine(eta: f64, cos_i: f64) -> Option<f64> {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    (sin2_t < 1.0).then(|| (1.0 - sin2_t).sqrt())
}

/// The direction, away from the surface, from which light would have to come to be refracted into `wo`; `n` is the unit normal
/// on the side of `wo`. None at total internal reflection.
pub fn refract(wo: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = n.dot(wo);
    let cos_t = transmitted_cosine(eta, cos_i)?;
    Some(-wo / eta + (cos_i / eta - cos_t) * n)
}

/// Reflectance of a smooth surface between two dielectrics for unpolarised light: Fresnel's equations. `cos_i`, in [0, 1], is the
/// cosine between the normal and `wo`.
pub fn fresnel(eta: f64, cos_i: f64) -> f64 {
    let Some(cos_t) = transmitted_cosine(eta, cos_i) else { return 1.0 };
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// Reflectance of a sheet between two parallel surfaces of this reflectance, with all that goes to and fro between them:
/// `F + (1 - F)^2 F (1 + F^2 + ...)`.
pub fn thin_reflectance(fresnel: f64) -> f64 {
    2.0 * fresnel / (1.0 + fresnel)
}

/// Reflectance of a smooth metal for unpolarised light, channel by channel: Fresnel's equations for an index of refraction `eta` with the extinction
/// coefficient `k`, both over the index in front (Born and Wolf, "Principles of Optics", section 14.2).
pub fn fresnel_conductor([eta, k]: [DVec3; 2], cos_i: f64) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|i| conductor_reflectance(eta[i], k[i], cos_i)))
}
