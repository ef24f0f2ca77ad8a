//! The numbers of [`AlbedoTable`] by quadrature: how much light leaves rough surfaces at once, and how much of it where.

use super::fresnel::{fresnel, reflect, refract};
use super::microfacet::Ggx;
use crate::scene::albedo_table::{
    AlbedoTable, COSINES, DielectricAlbedo, INDICES, ROUGH, ROUGHNESSES, ROW, STEEP, cosine_of_steepness, index_of_bent,
};
use glam::DVec3;
use rayon::prelude::*;

/// In place of a width of 0, where the albedo depends on the cosine over the width alone.
const NARROWEST: f64 = 1e-4;
/// In place of a cosine of 0.
const GRAZING: f64 = 1e-6;

/// The mean of a function of the microfacets that are seen at a cosine from the normal, by the midpoint rule with `n^2` of them. They lie about the plane of
/// incidence alike on both sides.
fn mean_of_visible<const N: usize>(
    alpha: f64,
    cosine: f64,
    n: u32,
    of: impl Fn(&Ggx, DVec3, DVec3) -> [f64; N],
) -> [f64; N] {
    let ggx = Ggx { x: alpha, y: alpha };
    let wo = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let mut sums = [0.0; N];
    for i in 0..n {
        for j in 0..n {
            let [u, v] = [i, j].map(|i| (f64::from(i) + 0.5) / f64::from(n));
            let one = of(&ggx, wo, ggx.visible_normal(wo, 0.5 * u, v));
            sums.iter_mut().zip(one).for_each(|(sum, one)| *sum += one);
        }
    }
    sums.map(|sum| sum / f64::from(n * n))
}

/// What of the light that a microfacet reflects meets another one.
fn shadowed(ggx: &Ggx, wo: DVec3, wi: DVec3) -> f64 {
    let lambda = ggx.lambda(wi);
    if wi.z > 0.0 { lambda / (1.0 + lambda + ggx.lambda(wo)) } else { 1.0 }
}

/// [`AlbedoTable::missing`].
pub fn missing(cosine: f64, alpha: f64, n: u32) -> f64 {
    let [missing] =
        mean_of_visible(alpha, cosine.max(GRAZING * alpha), n, |ggx, wo, h| [shadowed(ggx, wo, reflect(wo, h))]);
    missing
}

/// [`AlbedoTable::dielectric`].
pub fn dielectric_albedo(cosine: f64, alpha: f64, eta: f64, n: u32) -> DielectricAlbedo {
    let normal = fresnel(eta, 1.0);
    let edge = |f: f64| (f - normal) / (1.0 - normal);
    if alpha == 0.0 {
        let cosine = cosine.max(GRAZING);
        let (f, inside) = (fresnel(eta, cosine), fresnel(1.0 / eta, cosine));
        return DielectricAlbedo { edge: edge(f), transmitted: 1.0 - f, inside: 1.0, transmitted_inside: 1.0 - inside };
    }
    let both = |ggx: &Ggx, wo: DVec3, h: DVec3, eta: f64| {
        let cosine = wo.dot(h).min(1.0);
        let f = fresnel(eta, cosine);
        let transmitted = refract(wo, h, eta).filter(|wi| wi.z < 0.0).map_or(0.0, |wi| 1.0 / (1.0 + ggx.lambda(wi)));
        (f, 1.0 - shadowed(ggx, wo, reflect(wo, h)), (1.0 - f) * transmitted)
    };
    let [all, edge, transmitted, inside, transmitted_inside] =
        mean_of_visible(alpha, cosine.max(GRAZING * alpha), n, |ggx, wo, h| {
            let (f, reflected, transmitted) = both(ggx, wo, h, eta);
            let (f_inside, _, transmitted_inside) = both(ggx, wo, h, 1.0 / eta);
            [reflected, edge(f) * reflected, transmitted, f_inside * reflected + transmitted_inside, transmitted_inside]
        });
    let [edge, transmitted, inside, transmitted_inside] =
        [edge, transmitted, inside, transmitted_inside].map(|x| x / all);
    DielectricAlbedo { edge, transmitted, inside, transmitted_inside }
}

/// `2 int_0^1 of(cosine) cosine dcosine`, finer towards grazing.
fn average(of: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 2048;
    let at = |step: u32| {
        let x = (f64::from(step) + 0.5) / f64::from(STEPS);
        of(x * x) * 4.0 * x * x * x / f64::from(STEPS)
    };
    (0..STEPS).map(at).sum()
}

/// The whole table, each number by `n^2` microfacets. Means are those of what is read between its numbers.
pub fn albedo_table(n: u32) -> AlbedoTable {
    let axis = |i: usize, numbers: usize| i as f64 / (numbers - 1) as f64;
    let alpha_of = |i: usize, numbers: usize| axis(i, numbers).powi(2);
    let lost = (0..ROUGH * STEEP).into_par_iter().map(|k| {
        let alpha = alpha_of(k / STEEP, ROUGH).max(NARROWEST);
        missing(cosine_of_steepness(axis(k % STEEP, STEEP), alpha), alpha, n).sqrt()
    });
    let mut table = AlbedoTable { missing: lost.collect(), missing_average: vec![], dielectric: vec![] };
    let narrow = |i: usize| alpha_of(i, ROUGH).max(NARROWEST);
    let mean = |i: usize| average(|cosine| table.missing(cosine, narrow(i))) / narrow(i).powi(2);
    table.missing_average = (0..ROUGH).map(mean).collect();
    let rows = (0..INDICES * ROUGHNESSES * ROW).into_par_iter().map(|k| {
        let (eta, alpha) =
            (index_of_bent(axis(k / ROW / ROUGHNESSES, INDICES)), alpha_of(k / ROW % ROUGHNESSES, ROUGHNESSES));
        if k % ROW == COSINES {
            return [0.0; 4];
        }
        let cosine = axis(k % ROW, COSINES).powi(2);
        let DielectricAlbedo { edge, transmitted, inside, transmitted_inside } =
            dielectric_albedo(cosine, alpha, eta, n);
        [edge, transmitted, inside, transmitted_inside]
    });
    table.dielectric = rows.collect();
    for row in 0..INDICES * ROUGHNESSES {
        let (eta, alpha) = (index_of_bent(axis(row / ROUGHNESSES, INDICES)), alpha_of(row % ROUGHNESSES, ROUGHNESSES));
        // Where there is no roughness, nothing is read from the table.
        let at = |cosine: f64| match alpha {
            0.0 => dielectric_albedo(cosine, 0.0, eta, 0),
            _ => table.dielectric(cosine, alpha, eta),
        };
        let all = |cosine: f64| if alpha == 0.0 { 1.0 } else { 1.0 - table.missing(cosine, alpha) };
        let edge = average(|cosine| all(cosine) * at(cosine).edge);
        table.dielectric[row * ROW + COSINES] = [edge, 0.0, 0.0, 0.0];
    }
    table
}
