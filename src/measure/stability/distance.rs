//! How far from the origin a scene may lie.

use super::geometry::{
    COMPUTE_BVH, Stand, Worse, add, baked, chart, decades, describe, distance_error, lost, per_million, placed,
    rays_to_features, self_hits_and_escapes,
};
use super::{Definition, Findings, Sweep};
use crate::Result;
use crate::measure::Workbench;
use crate::measure::chart::{Axis, Point};
use crate::measure::rays::Random;
use crate::scene::build::icosphere;
use glam::{Affine3A, Vec3};

/// The sweep.
pub const DEFINITION: Definition =
    Definition { name: "distance", title: "Distance of the scene from the origin, 0.1 to 1e7 of its size", run };

/// A tracer that has no bound on its errors uses some fixed smallest distance; this one, in units of the body's size.
const T_MIN: &str = "f32 watertight, t_min 1e-4";

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(-1, 7, bench), 30_000)
}

/// The sweep over some distances with so many rays each.
pub fn sweep(bench: &Workbench, distances: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("distance from the origin in sizes of the body");
    let million = "rays a million";
    let mut charts = Vec::new();
    for way in ["vertices", "instance"] {
        let mut lost_chart = chart(
            &format!("lost-{way}"),
            &format!("Rays lost by a closed body, placed by its {way}"),
            x(),
            million,
        );
        let mut error = chart(
            &format!("error-{way}"),
            &format!("99.9th percentile of the hits' error along the ray, placed by its {way}"),
            x(),
            "error in sizes of the body",
        );
        let mut self_hits = chart(
            &format!("self-hits-{way}"),
            &format!("Rays that meet the triangle that they leave, placed by its {way}"),
            x(),
            million,
        );
        let mut escapes = chart(
            &format!("escapes-{way}"),
            &format!("Rays that leave a face inwards and get out, placed by its {way}"),
            x(),
            million,
        );
        for &distance in distances {
            let mut random = Random::new(21);
            // One unit across, in a direction along which no coordinate is special.
            let shift = Vec3::new(0.8, -0.5, 0.33).normalize() * distance as f32;
            let map = Affine3A::from_translation(shift)
                * Affine3A::from_rotation_x(0.3)
                * Affine3A::from_rotation_z(0.7)
                * Affine3A::from_scale(Vec3::splat(0.5));
            let scene = if way == "vertices" { baked(icosphere(3), map) } else { placed(icosphere(3), map) };
            let rays = rays_to_features(&scene, map * Affine3A::from_scale(Vec3::splat(0.4)), rays, &mut random);
            let stand = Stand::new(bench, &scene)?;
            let hits = stand.hits(&rays, way == "vertices")?;
            let leaves = stand.leaves(&rays)?;
            let n = rays.len();
            for (name, found) in &hits {
                add(&mut lost_chart, name, per_million(distance, lost(found), n));
            }
            for (name, found) in &hits[1..] {
                add(&mut error, name, Point { x: distance, y: distance_error(found, &hits[0].1), error: None });
            }
            let fixed = (T_MIN, stand.watertight.hits(&rays, 0.0), stand.watertight.leaves(&rays, 1e-4));
            let ours = hits.iter().zip(&leaves).map(|((name, first), (_, second))| (*name, first, second));
            for (name, first, second) in ours.chain([(fixed.0, &fixed.1, &fixed.2)]) {
                let [same, out] = self_hits_and_escapes(first, second);
                add(&mut self_hits, name, per_million(distance, same, n));
                add(&mut escapes, name, per_million(distance, out, n));
            }
        }
        charts.extend([lost_chart, error, self_hits, escapes]);
    }
    let starts = charts.iter().filter(|c| !c.name.starts_with("error")).map(|c| describe(c, 0.0, Worse::Upwards));
    let findings = Findings { starts: starts.collect::<Vec<_>>().join(" "), how: COMPUTE_BVH.into(), mends: "".into(), sees: "".into() };
    Ok(Sweep { charts, findings })
}
