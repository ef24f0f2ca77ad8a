//! Which way a path goes on from a surface, and whether it does: impulses, the BSDF, extinction.
//!
//! Three numbers decide. The third, as the slide "Impulse Reflection" has it, is first compared with the probability of an
//! impulse; what is left of it decides between reflection and transmission, or between the lobes. The first two choose a
//! direction in the lobe.

use super::bsdf::{bsdf_and_pdf, bsdf_direction};
use super::surfel::{Surfel, mean};
use crate::scene::{Directions, Estimator, Extinction};
use glam::DVec3;

/// Russian roulette lets a path live with its throughput over this as the probability: surely as long as it is larger. With 1 paths would end so early that their variance costs more than their rays save; `docs/performance.md` has the measurement.
pub const SURE_THROUGHPUT: f64 = 0.25;

/// Roulette begins behind the first surface whose lobes scatter the path: how dark that surface is makes the whole pixel dark, and ending most of
/// its paths there would be noise relative to all that it shows. The mirrors and the glass in front of it do not count either, but for chains
/// of them as long as this, so that two dark mirrors that face each other cost no more.
pub const SURE_IMPULSES: u32 = 8;

/// The throughput that roulette is told of before it begins: so large that no lobe makes it small.
pub const AMPLE_THROUGHPUT: f64 = 1e20;

/// The throughput by which roulette decides at the surface number `bounce` of a path, counted from 0. `throughput` is without `eta^2`;
/// `scattered` says whether a lobe has scattered the path at a surface before this one.
pub fn roulette_throughput(throughput: DVec3, bounce: u32, scattered: bool) -> DVec3 {
    if scattered || bounce >= SURE_IMPULSES { throughput } else { DVec3::splat(AMPLE_THROUGHPUT) }
}

/// The probability that a path goes on: one minus the extinction coefficient (slide "Extinction Coefficient"), for the channel
/// that loses least. Fresnel aside, so that it is the same for all directions. Never above 1: nothing makes a path heavier than the light it
/// stands for.
pub fn survival(surfel: &Surfel) -> f64 {
    if let Some(surface) = surfel.physical() {
        return surface.hemispherical_albedo().max_element().min(1.0);
    }
    let base = surfel.lambert + surfel.glossy;
    let albedo = if surfel.is_coated() {
        surfel.reflection.max(base)
    } else {
        base + surfel.reflection.max(surfel.transmission)
    };
    albedo.max_element().min(1.0)
}

/// How a path goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattered {
    /// Unit direction from which the light comes.
    pub wi: DVec3,
    /// Factor to the light from there: `f |cos| / pdf`; for an impulse its albedo over its probability. Zero ends the path.
    pub weight: DVec3,
    /// Density of `wi`, per steradian; none for an impulse.
    pub pdf: Option<f64>,
    /// `eta^2` where light was transmitted, else 1: by this, `weight` is smaller than the share of energy.
    pub eta2: f64,
}

/// Chooses how a path that arrived from `wo` goes on, by three numbers in [0, 1).
pub fn scatter(surfel: &Surfel, wo: DVec3, directions: Directions, [u, v, lobe]: [f64; 3]) -> Scattered {
    let impulses = surfel.impulses(wo);
    let p = surfel.impulse_probability(&impulses);
    if lobe < p {
        let (reflection, transmission) = (mean(impulses.reflection), mean(impulses.transmission));
        let q = reflection / (reflection + transmission);
        return if lobe / p < q {
            let weight = impulses.reflection / (p * q);
            Scattered { wi: impulses.reflected, weight, pdf: None, eta2: 1.0 }
        } else {
            // Light that enters a denser medium is concentrated into a smaller solid angle, and spread out again on its way
            // back: radiance over the squared index is what is kept (Veach 1997, section 5.2).
            let eta2 = impulses.eta * impulses.eta;
            let weight = impulses.transmission / (p * (1.0 - q)) / eta2;
            Scattered { wi: impulses.transmitted, weight, pdf: None, eta2 }
        };
    }

    let lobe = (lobe - p) / (1.0 - p);
    let wi = bsdf_direction(surfel, wo, directions, [u, v], lobe);
    let (value, pdf) = bsdf_and_pdf(surfel, wo, wi, directions);
    let weight = if pdf > 0.0 { value * surfel.cosine(wi) / pdf } else { DVec3::ZERO };
    Scattered { wi, weight, pdf: Some(pdf), eta2: surfel.dilution(wi) }
}

/// The density with which a path goes on to a direction that it chooses with the density `pdf`, per steradian: extinction has to let it live. What the power
/// heuristic has to know: a path that seldom survives seldom finds the light, and counts for the more when it does. Literal extinction is
/// left out: its survivors do not stand for those that ended.
///
/// `scattered` is the throughput of the path so far, as [`roulette_throughput`] has it, times `f cos eta^2`.
pub fn path_pdf(pdf: f64, scattered: DVec3, surfel: &Surfel, estimator: &Estimator) -> f64 {
    match estimator.extinction {
        Extinction::Off | Extinction::Literal => pdf,
        Extinction::Surface => pdf * survival(surfel),
        // The throughput behind the surface is `scattered` over `pdf`.
        Extinction::Throughput => (scattered.max_element() / SURE_THROUGHPUT).min(pdf),
    }
}
