//! Triangles that are long and narrow, that have no area, or that lie on each other.

use super::geometry::{
    Answers, REFERENCE, Stand, Worse, add, baked, chart, decades, describe, lost, per_million, rays_to_features,
    self_hits_and_escapes,
};
use super::{Definition, Findings, Sweep};
use crate::Result;
use crate::measure::Workbench;
use crate::measure::chart::Axis;
use crate::measure::rays::{Random, Ray};
use crate::scene::Mesh;
use crate::scene::build::{icosphere, mesh};
use glam::{Affine3A, Vec3};

/// The sweep.
pub const DEFINITION: Definition =
    Definition { name: "slivers", title: "Triangles 1 to 1e8 times as long as they are wide", run };

const T_MIN: &str = "f32 watertight, t_min 1e-4";

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(0, 8, bench), 40_000)
}

/// Quads side by side that are cut into two slivers each.
const SLIVERS: u32 = 64;

/// A floor at y = 0, x from -0.5 to 0.5, whose middle is a strip of slivers of length 1 and some width along z; wide quads that share the strip's
/// long edges make the rest, so that a ray which misses a sliver has lost its way.
fn floor(width: f64) -> Mesh {
    let half = f64::from(SLIVERS / 2);
    let mut lines: Vec<f64> = (0..=SLIVERS).map(|i| (f64::from(i) - half) * width).collect();
    lines.insert(0, -half * width - 1.0);
    lines.push(half * width + 1.0);
    let positions = lines.iter().flat_map(|&z| [Vec3::new(-0.5, 0.0, z as f32), Vec3::new(0.5, 0.0, z as f32)]);
    let quads = (0..lines.len() as u32 - 1).map(|i| 2 * i);
    let triangles: Vec<_> = quads.flat_map(|a| [[a, a + 2, a + 3], [a, a + 3, a + 1]]).collect();
    mesh(positions.collect(), &triangles)
}

/// The sweep over some aspects (length over width) with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, aspects: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("length over width of the triangles");
    let million = "rays a million";
    let turned = Affine3A::from_translation(Vec3::new(0.8, -0.5, 0.3))
        * Affine3A::from_rotation_x(0.3)
        * Affine3A::from_rotation_z(0.7);
    let level = Affine3A::from_translation(Vec3::Y * 0.3);
    let mut charts = Vec::new();
    for (name, words, map) in [("level", "level", level), ("turned", "turned", turned)] {
        let title = format!("Rays that pass through a floor of slivers, {words}");
        let mut lost_chart = chart(&format!("lost-{name}"), &title, x(), million);
        let title = format!("Hits off by more than 1e-3 of the slivers' length, {words}");
        let mut wrong = chart(&format!("wrong-{name}"), &title, x(), million);
        let title = format!("Rays that meet the floor which they leave, {words}");
        let mut self_hits = chart(&format!("self-hits-{name}"), &title, x(), million);
        for &aspect in aspects {
            let scene = baked(floor(1.0 / aspect), map);
            let stand = Stand::new(bench, &scene)?;
            let rays = rays_to_strip(map, 1.0 / aspect, rays);
            let hits = stand.hits(&rays, true)?;
            for (method, found) in &hits {
                add(&mut lost_chart, method, per_million(aspect, lost(found), rays.len()));
            }
            for (method, found) in &hits[1..] {
                let both = found.iter().zip(&hits[0].1).filter_map(|(f, e)| Some((f.as_ref()?, e.as_ref()?)));
                let count = both.filter(|(f, e)| (f.t - e.t).abs() > 1e-3).count();
                add(&mut wrong, method, per_million(aspect, count, rays.len()));
            }
            let mut leaves = stand.leaves(&rays)?;
            leaves.push((T_MIN, stand.watertight.leaves(&rays, 1e-4)));
            for (method, second) in &leaves {
                // A floor is not met again, wherever on it.
                add(&mut self_hits, method, per_million(aspect, second.iter().flatten().count(), rays.len()));
            }
        }
        charts.extend([lost_chart, wrong, self_hits]);
    }
    let findings = findings(bench, &charts)?;
    Ok(Sweep { charts, findings })
}

/// Rays from above to points of the strip: in its triangles, on their edges and on their corners.
fn rays_to_strip(map: Affine3A, width: f64, n: usize) -> Vec<Ray> {
    let mut random = Random::new(24);
    let half = f64::from(SLIVERS / 2);
    let ray = |i: usize| {
        let line = (random.below(SLIVERS as usize) as f64 - half) * width;
        let z = line + if i % 2 == 0 { 0.0 } else { random.uniform() * width };
        let target = Vec3::new(random.between(-0.49, 0.49) as f32, 0.0, z as f32);
        let from = Vec3::new(random.between(-1.0, 1.0) as f32, random.between(0.3, 1.0) as f32, random.between(-1.0, 1.0) as f32);
        Ray::through(map.transform_point3(from), map.transform_point3(target))
    };
    (0..n).map(ray).collect()
}

fn findings(bench: &Workbench, charts: &[crate::measure::chart::Chart]) -> Result<Findings> {
    let w = Worse::Upwards;
    Ok(Findings { starts: charts.iter().map(|c| describe(c, 0.0, w)).collect::<Vec<_>>().join("\n"), how: String::new(), mends: String::new(), sees: String::new() })
}
