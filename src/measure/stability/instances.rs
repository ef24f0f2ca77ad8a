//! Instances that are stretched, mirrored and sheared.

use super::geometry::{
    Stand, Worse, add, chart, decades, describe, lost, per_million, placed, rays_to_features, self_hits_and_escapes,
};
use super::{Definition, Findings, Sweep};
use crate::Result;
use crate::measure::Workbench;
use crate::measure::chart::{Axis, Point};
use crate::measure::rays::Random;
use crate::scene::build::icosphere;
use glam::{Affine3A, Mat3, Vec3};

/// The sweep.
pub const DEFINITION: Definition =
    Definition { name: "instances", title: "Instances stretched, mirrored and sheared by 1 to 1e6", run };

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(0, 6, bench), 30_000)
}

/// A unit ball flattened by some factor, turned before and after.
fn map(kind: &str, factor: f64) -> Affine3A {
    let before = Affine3A::from_rotation_y(0.4) * Affine3A::from_rotation_z(0.9);
    let after = Affine3A::from_translation(Vec3::new(1.6, -1.0, 0.6))
        * Affine3A::from_rotation_x(0.3)
        * Affine3A::from_rotation_z(0.7);
    let factor = factor as f32;
    let shape = match kind {
        "mirrored" => Affine3A::from_scale(Vec3::new(-1.0, 1.0 / factor, 1.0)),
        // A shear by k stretches by about k and 1 / k: the same anisotropy as that of 1 : k^2.
        "sheared" => {
            let k = factor.sqrt();
            Affine3A::from_mat3(Mat3::from_cols(Vec3::X, Vec3::new(k, 1.0, 0.0), Vec3::Z) * (1.0 / k))
        }
        _ => Affine3A::from_scale(Vec3::new(1.0, 1.0 / factor, 1.0)),
    };
    after * shape * before
}

/// The sweep over some anisotropies (longest over shortest axis) with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, factors: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("longest over shortest axis");
    let million = "rays a million";
    let mut charts = Vec::new();
    for kind in ["stretched", "mirrored", "sheared"] {
        let mut lost_chart = chart(&format!("lost-{kind}"), &format!("Rays lost by a {kind} ball"), x(), million);
        let title = format!("99.9th percentile of the hits' distance from the surface of a {kind} ball");
        let mut error = chart(&format!("error-{kind}"), &title, x(), "distance in units of its rounding");
        let title = format!("Rays that meet the triangle of a {kind} ball that they leave");
        let mut self_hits = chart(&format!("self-hits-{kind}"), &title, x(), million);
        let title = format!("Rays that leave a face inwards and get out of a {kind} ball");
        let mut escapes = chart(&format!("escapes-{kind}"), &title, x(), million);
        for &factor in factors {
            let map = map(kind, factor);
            let scene = placed(icosphere(3), map);
            let mut random = Random::new(27);
            let inner = map * Affine3A::from_scale(Vec3::splat(0.4));
            let rays = rays_to_features(&scene, inner, rays, &mut random);
            let stand = Stand::new(bench, &scene)?;
            let hits = stand.hits(&rays, true)?;
            let leaves = stand.leaves(&rays)?;
            for (name, found) in &hits {
                add(&mut lost_chart, name, per_million(factor, lost(found), rays.len()));
            }
            for (name, found) in &hits[1..] {
                let y = super::geometry::distance_error(found, &hits[0].1);
                add(&mut error, name, Point { x: factor, y, error: None });
            }
            for ((name, first), (_, second)) in hits.iter().zip(&leaves) {
                let [same, out] = self_hits_and_escapes(first, second);
                add(&mut self_hits, name, per_million(factor, same, rays.len()));
                add(&mut escapes, name, per_million(factor, out, rays.len()));
            }
        }
        charts.extend([lost_chart, error, self_hits, escapes]);
    }
    let findings = findings(&charts);
    Ok(Sweep { charts, findings })
}

fn findings(charts: &[crate::measure::chart::Chart]) -> Findings {
    let w = Worse::Upwards;
    Findings { starts: charts.iter().map(|c| describe(c, 0.0, w)).collect::<Vec<_>>().join("\n"), how: String::new(), mends: String::new(), sees: String::new() }
}
