//! Directions of microfacets against their density, over grids of roughness, angle, anisotropy and index.

use crate::common::facets::{FacetCells, grid};
use crate::common::statistics::*;
use glam::DVec3;
use luminaire::reference::microfacet::Ggx;
use luminaire::sampling::{random4, uniform};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Samples of a case.
const N: u32 = 20_000;

/// Visible normals have their density, in closed form: in cells that are stretched as the distribution is, it is that of a hemisphere, `2 max(w . h, 0) /
/// (pi (1 + w.z))`. Widths from 1e-4 to 1, up to 1e4 times as wide along as across, from straight to a tenth of a degree above the horizon, from all around.
#[test]
fn visible_normals_have_their_density_in_closed_form() {
    let mut cases = vec![];
    for y in [1e-4, 0.01, 0.1, 0.5, 1.0f64] {
        for ratio in [1.0, 10.0, 1e4] {
            let x = y * ratio;
            for (degrees, turn) in
                [(0.0, 0.0), (30.0, 1.0), (60.0, 0.0), (60.0, 2.0), (85.0, 1.3), (89.9, 0.4), (89.9, 3.0f64)]
            {
                if x <= 1.0 {
                    let (sin, cos) = f64::to_radians(degrees).sin_cos();
                    cases.push((Ggx { x, y }, DVec3::new(sin * turn.cos(), sin * turn.sin(), cos)));
                }
            }
        }
    }
    let tests: Vec<_> = (0u32..)
        .zip(&cases)
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|(seed, &(ggx, wo))| {
            let cells = FacetCells { ggx, wo };
            let seen = DVec3::new(wo.x * ggx.x, wo.y * ggx.y, wo.z).normalize();
            let expected = cells.integrate(|h| {
                let stretched = DVec3::new(h.x / ggx.x, h.y / ggx.y, h.z);
                // The density over stretched normals, over those that are not.
                let per_solid_angle = 1.0 / (ggx.x * ggx.y * stretched.length().powi(3));
                let closed = 2.0 * seen.dot(stretched.normalize()).max(0.0) / (PI * (1.0 + seen.z)) * per_solid_angle;
                // The one that the microfacets' pdf goes by.
                let claimed = ggx.density(h) * wo.dot(h).max(0.0) / (wo.z * (1.0 + ggx.lambda(wo)));
                assert!((closed - claimed).abs() <= 1e-9 * closed + 1e-12, "{ggx:?} {wo} {h}: {closed} {claimed}");
                f64::from(N) * closed
            });
            let mass = expected.iter().sum::<f64>() / f64::from(N);
            assert!((mass - 1.0).abs() < 2e-3, "{ggx:?} {wo}: a density of {mass}");
            let mut counts = vec![0; FacetCells::COUNT];
            for i in 0..N {
                let [u, v, ..] = random4(i, seed, 1, 18).map(uniform);
                let h = ggx.visible_normal(wo, u, v);
                assert!((h.length() - 1.0).abs() < 1e-9 && h.z >= 0.0, "{ggx:?} {wo}: {h}");
                counts[cells.cell(h)] += 1;
            }
            (format!("widths {} {}, seen from {wo}", ggx.x, ggx.y), chi_square_against(&counts, &expected))
        })
        .collect();
    assert_plausible(&tests);
}

/// Reflection and refraction, from both sides, brushed, through sheets, by coats and by mixtures of all: directions are chosen by the density that is claimed, which
/// integrates to 1 less the share that is chosen below the horizon and lost.
#[test]
fn directions_have_their_density_over_a_grid() {
    let grid = grid(&[0.02, 0.05, 0.15, 0.4, 0.7, 1.0], &[0.0, 35.0, 70.0, 88.0]);
    let found: Vec<_> = grid
        .par_iter()
        .enumerate()
        .map(|(seed, case)| {
            let lobes = case.surfel().lobes.expect("it scatters");
            let directions = (0..N).map(|i| {
                let [u, v, lobe, _] = random4(i, seed as u32, 2, 18).map(uniform);
                lobes.direction([u, v], lobe)
            });
            let (p, mass) = case.plausibility(directions);
            assert!((0.2..1.0 + 3e-3).contains(&mass), "{}: a density of {mass}", case.name);
            ((case.name.clone(), p), mass)
        })
        .collect();
    let (tests, masses): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let least = masses.iter().copied().fold(1.0, f64::min);
    println!("densities integrate to {least:.3} to {:.4}", masses.iter().copied().fold(0.0, f64::max));
    assert_plausible(&tests);
}
