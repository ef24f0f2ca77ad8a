//! Impulses: mirrors and glass (slides "Impulse Reflection", "Adding Transmission").
//!
//! Here, and wherever a pair of media is named, `eta` is the index of refraction on the far side of the surface, seen from
//! `wo`, over that on the side of `wo`.

pub use super::fresnel::{fresnel, reflect, refract, thin_reflectance};
use super::physical::Lobes;
use super::surfel::{Surfel, mean};
use glam::DVec3;

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
    /// Of a metallic-roughness surface, the albedo of all that is no impulse, about.
    pub scattered: Option<f64>,
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
        if let Some(lobes) = &self.lobes {
            return self.physical_impulses(lobes, wo);
        }
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

    /// The same of a metallic-roughness surface, by the same rule.
    fn physical_impulses(&self, lobes: &Lobes, wo: DVec3) -> Impulses {
        let scattered = lobes.scattered_albedo();
        let about = |normal: DVec3, lobes: &Lobes| {
            let ([reflection, transmission], eta) = (lobes.impulses(), lobes.bend());
            let [reflected, transmitted] = lobes.impulse_directions(normal, wo);
            // Microfacets may let through what the surface as a whole would not.
            let transmission = if transmitted == DVec3::ZERO { DVec3::ZERO } else { transmission };
            Impulses { reflection, reflected, transmission, transmitted, eta, scattered: Some(scattered) }
        };
        let bent = about(lobes.impulse_normal(), lobes);
        let is_reflected = self.geometric_normal.dot(bent.reflected) > 0.0;
        if !lobes.is_clear() {
            let reflected = if is_reflected { bent.reflected } else { reflect(wo, self.geometric_normal) };
            return Impulses { reflected, ..bent };
        }
        if is_reflected && self.geometric_normal.dot(bent.transmitted) < 0.0 {
            return bent;
        }
        about(self.geometric_normal, &lobes.about(self.geometric_normal, self.front, wo))
    }

    fn impulses_about(&self, normal: DVec3, wo: DVec3) -> Impulses {
        let reflected = reflect(wo, normal);
        let Some(index) = self.eta else {
            let (transmission, transmitted) = (DVec3::ZERO, DVec3::ZERO);
            return Impulses {
                reflection: self.reflection,
                reflected,
                transmission,
                transmitted,
                eta: 1.0,
                scattered: None,
            };
        };
        if self.thin {
            let (reflectance, transmitted) = (thin_reflectance(fresnel(index, normal.dot(wo))), -wo);
            let (reflection, transmission) = (self.reflection * reflectance, self.transmission * (1.0 - reflectance));
            return Impulses { reflection, reflected, transmission, transmitted, eta: 1.0, scattered: None };
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
            scattered: None,
        }
    }

    /// The probability with which a path that arrives from `wo` goes on by an impulse (slide "Impulse Reflection": 60 %).
    pub fn impulse_probability(&self, impulses: &Impulses) -> f64 {
        let impulse = mean(impulses.reflection + impulses.transmission);
        let coat = if self.is_coated() { DVec3::ONE - impulses.reflection } else { DVec3::ONE };
        let other = match impulses.scattered {
            Some(albedo) => albedo,
            None => mean((self.lambert + self.glossy) * coat),
        };
        if impulse == 0.0 {
            0.0
        } else if other == 0.0 {
            1.0
        } else {
            self.impulse_probability.unwrap_or(impulse / (impulse + other))
        }
    }
}
