//! Impulses: mirrors and glass (slides "Impulse Reflection", "Adding Transmission").
//!
//! Here, and wherever a pair of media is named, `eta` is the index of refraction on the far side of the surface, seen from
//! `wo`, over that on the side of `wo`.

use super::surfel::{Surfel, mean};
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

/// The impulses of a surfel, as seen from one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulses {
    /// Albedo of the reflection, Fresnel's reflectance included.
    pub reflection: DVec3,
    /// Where reflected light comes from.
    pub reflected: DVec3,
    /// Albedo of the transmission, one minus Fresnel's reflectance included.
    pub transmission: DVec3,
    /// Where transmitted light comes from; zero if none does.
    pub transmitted: DVec3,
    /// Index of refraction behind the surface over that in front of it, as seen from `wo`.
    pub eta: f64,
}

impl Surfel {
    /// The impulses towards `wo`. They are about the shading normal, unless one of the two directions would then be on the wrong side
    /// of the triangle, or glass would reflect all: in that case both directions, and the reflectance, are about the geometric
    /// normal. Reflectance and transmittance so always add up to 1. Where nothing is transmitted the reflectance, of which a coat leaves the rest to
    /// its base, stays that about the shading normal: then mirror and base add up to no more than 1.
    ///
    /// Total reflection about interpolated normals would be a trap: such reflections do not preserve the volume of phase space, and paths that
    /// entered a coarse ball of glass would be drawn to its rim and stay there for ever. About the triangles' own normals they leave.
    pub fn impulses(&self, wo: DVec3) -> Impulses {
        let about_shading_normal = self.impulses_about(self.shading_normal, wo);
        let Impulses { reflected, transmitted, .. } = about_shading_normal;
        let is_reflected = self.geometric_normal.dot(reflected) > 0.0;
        if self.transmission == DVec3::ZERO {
            let reflected = if is_reflected { reflected } else { reflect(wo, self.geometric_normal) };
            return Impulses { reflected, ..about_shading_normal };
        }
        // Nothing transmitted is the zero vector.
        if is_reflected && self.geometric_normal.dot(transmitted) < 0.0 {
            about_shading_normal
        } else {
            self.impulses_about(self.geometric_normal, wo)
        }
    }

    fn impulses_about(&self, normal: DVec3, wo: DVec3) -> Impulses {
        let reflected = reflect(wo, normal);
        let Some(index) = self.eta else {
            let (transmission, transmitted) = (DVec3::ZERO, DVec3::ZERO);
            return Impulses { reflection: self.reflection, reflected, transmission, transmitted, eta: 1.0 };
        };
        if self.thin {
            let (reflectance, transmitted) = (thin_reflectance(fresnel(index, normal.dot(wo))), -wo);
            let (reflection, transmission) = (self.reflection * reflectance, self.transmission * (1.0 - reflectance));
            return Impulses { reflection, reflected, transmission, transmitted, eta: 1.0 };
        }
        // Nobody is inside of what transmits nothing.
        let eta = if self.front || self.transmission == DVec3::ZERO { index } else { 1.0 / index };
        let fresnel = fresnel(eta, normal.dot(wo));
        Impulses {
            reflection: self.reflection * fresnel,
            reflected,
            transmission: self.transmission * (1.0 - fresnel),
            transmitted: refract(wo, normal, eta).unwrap_or(DVec3::ZERO),
            eta,
        }
    }

    /// The probability with which a path that arrives from `wo` goes on by an impulse (slide "Impulse Reflection": 60 %).
    pub fn impulse_probability(&self, impulses: &Impulses) -> f64 {
        let impulse = mean(impulses.reflection + impulses.transmission);
        let coat = if self.is_coated() { DVec3::ONE - impulses.reflection } else { DVec3::ONE };
        let other = mean((self.lambert + self.glossy) * coat);
        if impulse == 0.0 {
            0.0
        } else if other == 0.0 {
            1.0
        } else {
            self.impulse_probability.unwrap_or(impulse / (impulse + other))
        }
    }
}
