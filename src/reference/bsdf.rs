//! The BSDF without its impulses: its value, its directions and their density, which belong together. Lambert and normalised Blinn-Phong (slide "Surface
//! Element Class"), under a coat where there is one; how directions are chosen (slides "Inefficient Integration", "More Efficient Integration").

use super::impulse::{fresnel, reflect};
use super::physical::{Lobes, PhysicalSurface};
use super::surfel::{Surfel, mean};
use super::warp::{cosine_hemisphere, glossy_half_vector, uniform_hemisphere};
use crate::scene::Directions;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

impl Surfel {
    /// The scattering function without the cosine, per steradian: Lambert and normalised Blinn-Phong.
    ///
    /// Zero unless `wi` is above the triangle *and* above the shading normal's plane: light would leak through walls.
    /// Of a metallic-roughness surface the value of its lobes; what is refracted comes from below both.
    pub fn bsdf(&self, wo: DVec3, wi: DVec3) -> DVec3 {
        if let Some(lobes) = &self.lobes {
            return if self.is_on_one_side(wi) { lobes.value_and_pdf(wi).0 } else { DVec3::ZERO };
        }
        if !self.is_above(wi) {
            return DVec3::ZERO;
        }
        let [lambert_coat, glossy_coat] = self.coat(wo, wi);
        let mut f = lambert_coat * self.lambert / PI;
        if self.glossy != DVec3::ZERO {
            let h = (wi + wo).normalize_or_zero();
            let lobe = self.shading_normal.dot(h).max(0.0).powf(self.exponent);
            f += glossy_coat * self.glossy * (glossy_normalization(self.exponent) * lobe);
        }
        f
    }

    /// What a coat, which reflects the share `F` of light, makes of the base's two lobes. Without a coat all is 1.
    ///
    /// Of even light from all sides the base gets `1 - F` on average over the cosine, and sends `1 - F` of what it gets out again. Light that the
    /// coat holds back below gets its next chance there (no colour shift: as if the base were white): so Lambert's lobe is `(1 - F(wi)) (1 -
    /// F(wo))` over that average, and scatters `1 - F(wo)` of its albedo, which with `F(wo)`, the mirror, is at most 1. The glossy lobe, which has no
    /// such average, gets the lesser of the two. Both are the same for light that goes the other way. A reflection that is tinted or less than 1
    /// holds back as much as it reflects, in each channel. `F` is about the shading normal in both directions, as the mirror's is: the average is
    /// over one hemisphere.
    fn coat(&self, wo: DVec3, wi: DVec3) -> [DVec3; 2] {
        let Some(eta) = self.eta.filter(|_| self.is_coated()) else { return [DVec3::ONE; 2] };
        let passed = |w: DVec3| DVec3::ONE - self.reflection * fresnel(eta, self.shading_normal.dot(w));
        let (out, into) = (passed(wo), passed(wi));
        // One less what the coat reflects on average, written so that it does not cancel where that is nearly all.
        let average = (DVec3::ONE - self.reflection) + self.reflection * self.coat_transmittance;
        [out * into / average, out.min(into)]
    }

    /// Whether light is scattered in other ways than by impulses, so that light sampling makes sense.
    pub fn scatters(&self) -> bool {
        self.lambert != DVec3::ZERO
            || self.glossy != DVec3::ZERO
            || self.physical().is_some_and(PhysicalSurface::scatters)
    }
}

/// The factor that makes the glossy lobe's directional albedo 1 at normal incidence and less elsewhere, for `m >= 0`.
pub fn glossy_normalization(m: f64) -> f64 {
    (m + 2.0) * (m + 4.0) / (8.0 * PI * ((-0.5 * m).exp2() + m))
}

/// A direction that the BSDF without its impulses scatters to: two numbers choose it within a lobe, which `lobe` chooses, all in [0, 1). [`bsdf_pdf`] is its
/// density.
pub fn bsdf_direction(surfel: &Surfel, wo: DVec3, directions: Directions, [u, v]: [f64; 2], lobe: f64) -> DVec3 {
    let n = surfel.shading_normal;
    if let Some(lobes) = &surfel.lobes {
        // Half of them from below, if light from there is scattered.
        let side = if lobes.scatters_through() && lobe < 0.5 { -n } else { n };
        return match directions {
            Directions::Uniform => uniform_hemisphere(side, u, v),
            Directions::Cosine => cosine_hemisphere(side, u, v),
            Directions::Bsdf => lobes.direction([u, v], lobe),
        };
    }
    match directions {
        Directions::Uniform => uniform_hemisphere(n, u, v),
        Directions::Bsdf if lobe < glossy_share(surfel) => reflect(wo, glossy_half_vector(n, surfel.exponent, u, v)),
        Directions::Cosine | Directions::Bsdf => cosine_hemisphere(n, u, v),
    }
}

/// The value and the density ([`Surfel::bsdf`], [`bsdf_pdf`]), which have most of their numbers in common.
pub fn bsdf_and_pdf(surfel: &Surfel, wo: DVec3, wi: DVec3, directions: Directions) -> (DVec3, f64) {
    let Some(lobes) = surfel.lobes.as_ref().filter(|_| surfel.is_on_one_side(wi)) else {
        return (surfel.bsdf(wo, wi), bsdf_pdf(surfel, wo, wi, directions));
    };
    let (value, pdf) = lobes.value_and_pdf(wi);
    (value, physical_pdf(surfel, lobes, wo, wi, directions, || pdf))
}

/// The density with which [`scatter`](super::scatter::scatter) chooses `wi`, per steradian, out of all there is to choose from: impulses take their
/// share. Zero where nothing is scattered to, though the glossy lobe chooses such directions too.
pub fn bsdf_pdf(surfel: &Surfel, wo: DVec3, wi: DVec3, directions: Directions) -> f64 {
    if !surfel.scatters() {
        return 0.0;
    }
    let n = surfel.shading_normal;
    if let Some(lobes) = &surfel.lobes {
        return physical_pdf(surfel, lobes, wo, wi, directions, || lobes.value_and_pdf(wi).1);
    }
    if !surfel.is_above(wi) {
        return 0.0;
    }
    let cosine = n.dot(wi) / PI;
    let pdf = match directions {
        Directions::Uniform => 1.0 / TAU,
        Directions::Cosine => cosine,
        Directions::Bsdf => {
            let g = glossy_share(surfel);
            g * glossy_pdf(n, surfel.exponent, wo, wi) + (1.0 - g) * cosine
        }
    };
    (1.0 - surfel.impulse_probability(&surfel.impulses(wo))) * pdf
}

/// The same of a metallic-roughness surface, where `by_lobes` is the density by which its lobes are.
fn physical_pdf(
    surfel: &Surfel,
    lobes: &Lobes,
    wo: DVec3,
    wi: DVec3,
    directions: Directions,
    by_lobes: impl Fn() -> f64,
) -> f64 {
    let both = lobes.scatters_through();
    if !surfel.scatters() || !surfel.is_on_one_side(wi) || (!both && !surfel.is_above(wi)) {
        return 0.0;
    }
    let sides = if both { 0.5 } else { 1.0 };
    let pdf = match directions {
        Directions::Uniform => sides / TAU,
        Directions::Cosine => sides * surfel.cosine(wi) / PI,
        Directions::Bsdf => by_lobes(),
    };
    (1.0 - surfel.impulse_probability(&surfel.impulses(wo))) * pdf
}

/// Density of the direction `wi` in which [`glossy_half_vector`] reflects `wo`, per steradian.
pub fn glossy_pdf(n: DVec3, m: f64, wo: DVec3, wi: DVec3) -> f64 {
    let h = (wo + wi).normalize_or_zero();
    let half_vector = (m + 1.0) / TAU * n.dot(h).max(0.0).powf(m);
    half_vector / (4.0 * wo.dot(h).abs())
}

/// The probability of the glossy lobe among the two: its share of the albedo.
fn glossy_share(surfel: &Surfel) -> f64 {
    mean(surfel.glossy) / mean(surfel.lambert + surfel.glossy)
}
