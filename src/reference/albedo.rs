//! The numbers of [`AlbedoTable`] by quadrature: how much light leaves rough surfaces at once, and how much of it where.

use super::fresnel::{fresnel, reflect, refract};
use super::microfacet::Ggx;
use crate::scene::albedo_table::{
    AlbedoTable, COSINES, DielectricAlbedo, INDICES, ROUGH, ROUGHNESSES, ROW, STEEP, cosine_of_steepness, index_of_bent,
};
use crate::scene::brushed_table::{
    ALONG, AROUND, BRUSHED_ALONG, BRUSHED_ASIDE, BRUSHED_INDICES, BRUSHED_RATIOS, BRUSHED_ROW, BRUSHED_TILTS,
    BrushedTable, MEANS_ALONG, MEANS_RATIOS, RATIOS, TILTS, direction_of_dielectric_place, direction_of_place,
    seen_width,
};
use glam::DVec3;
use half::f16;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// In place of a width of 0, where the albedo depends on the cosine over the width alone.
const NARROWEST: f64 = 1e-4;
/// In place of a cosine of 0.
const GRAZING: f64 = 1e-6;

/// In place of an index of 1, where nothing is bent: the place of another one on its axis.
const LEAST_BENT: f64 = 0.1;

/// The mean of a function of the microfacets that are seen at a cosine from the normal, by the midpoint rule with `n^2` of them. They lie about the plane of
/// incidence alike on both sides. Of narrow distributions only the few that are tilted most send light to other microfacets: they are taken more densely.
fn mean_of_visible<const N: usize>(
    alpha: f64,
    cosine: f64,
    n: u32,
    of: impl Fn(&Ggx, DVec3, DVec3) -> [f64; N],
) -> [f64; N] {
    let wo = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    mean_over_turn(&Ggx { x: alpha, y: alpha }, wo, 0.5, n, of)
}

/// The same for any widths and directions, over so many turns of the microfacets.
fn mean_over_turn<const N: usize>(
    ggx: &Ggx,
    wo: DVec3,
    turn: f64,
    n: u32,
    of: impl Fn(&Ggx, DVec3, DVec3) -> [f64; N],
) -> [f64; N] {
    let (mut sums, mut weights) = ([0.0; N], 0.0);
    for i in 0..n {
        for j in 0..n {
            let [u, t] = [i, j].map(|i| (f64::from(i) + 0.5) / f64::from(n));
            let (v, weight) = (1.0 - (1.0 - t).powi(3), 3.0 * (1.0 - t).powi(2));
            let one = of(ggx, wo, ggx.visible_normal(wo, turn * u, v));
            sums.iter_mut().zip(one).for_each(|(sum, one)| *sum += weight * one);
            weights += weight;
        }
    }
    sums.map(|sum| sum / weights)
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

/// [`BrushedTable::missing`].
pub fn brushed_missing(widths: [f64; 2], wo: DVec3, n: u32) -> f64 {
    let ggx = Ggx { x: widths[0], y: widths[1] };
    let [missing] = mean_over_turn(&ggx, wo, 1.0, n, |ggx, wo, h| [shadowed(ggx, wo, reflect(wo, h))]);
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
    of_shares(mean_of_visible(alpha, cosine.max(GRAZING * alpha), n, |ggx, wo, h| shares(ggx, wo, h, eta)))
}

/// Of a microfacet: what it sends away at once if it reflects all, and of that what [`DielectricAlbedo`] has, not yet divided.
fn shares(ggx: &Ggx, wo: DVec3, h: DVec3, eta: f64) -> [f64; 5] {
    let normal = fresnel(eta, 1.0);
    let edge = |f: f64| (f - normal) / (1.0 - normal);
    let both = |eta: f64| {
        let cosine = wo.dot(h).min(1.0);
        let f = fresnel(eta, cosine);
        let transmitted = refract(wo, h, eta).filter(|wi| wi.z < 0.0).map_or(0.0, |wi| 1.0 / (1.0 + ggx.lambda(wi)));
        (f, 1.0 - shadowed(ggx, wo, reflect(wo, h)), (1.0 - f) * transmitted)
    };
    let (f, reflected, transmitted) = both(eta);
    let (f_inside, _, transmitted_inside) = both(1.0 / eta);
    [reflected, edge(f) * reflected, transmitted, f_inside * reflected + transmitted_inside, transmitted_inside]
}

fn of_shares([all, edge, transmitted, inside, transmitted_inside]: [f64; 5]) -> DielectricAlbedo {
    let [edge, transmitted, inside, transmitted_inside] =
        [edge, transmitted, inside, transmitted_inside].map(|x| x / all);
    DielectricAlbedo { edge, transmitted, inside, transmitted_inside }
}

/// [`BrushedTable::dielectric`].
pub fn brushed_dielectric_albedo(widths: [f64; 2], wo: DVec3, eta: f64, n: u32) -> DielectricAlbedo {
    let ggx = Ggx { x: widths[0], y: widths[1] };
    of_shares(mean_over_turn(&ggx, wo, 1.0, n, |ggx, wo, h| shares(ggx, wo, h, eta)))
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

/// The mean over directions in proportion to their cosine, finer towards grazing, of what is alike on both sides of x and of y.
fn average_around(of: impl Fn(DVec3) -> f64) -> f64 {
    const TURNS: u32 = 48;
    const STEPS: u32 = 256;
    let mut sum = 0.0;
    for turn in 0..TURNS {
        let (y, x) = (FRAC_PI_2 * (f64::from(turn) + 0.5) / f64::from(TURNS)).sin_cos();
        for step in 0..STEPS {
            let root = (f64::from(step) + 0.5) / f64::from(STEPS);
            let cosine = root * root;
            let sine = (1.0 - cosine * cosine).sqrt();
            sum += of(DVec3::new(sine * x, sine * y, cosine)) * root * cosine;
        }
    }
    4.0 * sum / f64::from(STEPS * TURNS)
}

/// The table of two widths, each number by `n^2` microfacets. Means are those of what is read between its numbers.
pub fn brushed_table(n: u32) -> BrushedTable {
    let axis = |i: usize, numbers: usize| i as f64 / (numbers - 1) as f64;
    let widths = |along: f64, ratio: f64| {
        let along = along.powi(2).max(NARROWEST);
        [along, along * ratio.max(NARROWEST)]
    };
    let missing = (0..ALONG * RATIOS * AROUND * TILTS).into_par_iter().map(|k| {
        let [tilt, around] = [axis(k % TILTS, TILTS), axis(k / TILTS % AROUND, AROUND)];
        let k = k / TILTS / AROUND;
        let widths = widths(axis(k / RATIOS, ALONG), axis(k % RATIOS, RATIOS));
        // As it is kept, so that the means are of what is kept.
        f16::from_f64(brushed_missing(widths, direction_of_place(widths, around, tilt), n).sqrt()).to_f64()
    });
    let mut table = BrushedTable { missing: missing.collect(), missing_average: vec![], dielectric: vec![] };
    let means = (0..MEANS_ALONG * MEANS_RATIOS).into_par_iter().map(|k| {
        let widths = widths(axis(k / MEANS_RATIOS, MEANS_ALONG), axis(k % MEANS_RATIOS, MEANS_RATIOS));
        average_around(|w| table.missing(widths, w)) / widths[0].powi(2)
    });
    let means = means.collect();
    table.missing_average = means;
    let dielectric = (0..BRUSHED_INDICES * BRUSHED_ROW).into_par_iter().map(|k| {
        let (tilt, k) = (axis(k % BRUSHED_TILTS, BRUSHED_TILTS), k / BRUSHED_TILTS);
        let (aside, k) = (axis(k % BRUSHED_ASIDE, BRUSHED_ASIDE), k / BRUSHED_ASIDE);
        let (ratio, k) = (axis(k % BRUSHED_RATIOS, BRUSHED_RATIOS).powi(2), k / BRUSHED_RATIOS);
        let (along, k) = (axis(k % BRUSHED_ALONG, BRUSHED_ALONG), k / BRUSHED_ALONG);
        let (widths, eta) = (widths(along, ratio), index_of_bent(axis(k, BRUSHED_INDICES).max(LEAST_BENT)));
        let wo = direction_of_dielectric_place(widths[0], aside, tilt);
        let brushed = brushed_dielectric_albedo(widths, wo, eta, n / 2);
        let round = dielectric_albedo(wo.z, seen_width(widths, wo), eta, n / 2);
        [
            brushed.edge - round.edge,
            brushed.transmitted - round.transmitted,
            brushed.inside - round.inside,
            brushed.transmitted_inside - round.transmitted_inside,
        ]
    });
    let dielectric = dielectric.collect();
    table.dielectric = dielectric;
    table
}
