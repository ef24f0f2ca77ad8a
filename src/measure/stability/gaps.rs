//! Surfaces close to each other.

use super::geometry::{Stand, Worse, add, chart, decades, describe, per_million};
use super::{Definition, Findings, Sweep};
use crate::Result;
use crate::measure::Workbench;
use crate::measure::chart::Axis;
use crate::measure::rays::{Random, Ray};
use crate::scene::Scene;
use crate::scene::build::{self, empty, matte, quad};
use glam::{Affine3A, Vec3};

/// The sweep.
pub const DEFINITION: Definition =
    Definition { name: "gaps", title: "Two walls from 0.1 to 1e-8 of their size apart", run };

const T_MIN: &str = "f32 watertight, t_min 1e-4";

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(-8, -1, bench), 40_000)
}

/// A floor from -0.5 to 0.5 at y = 0, a wall over it at y = `gap`, and one behind that at y = 0.5.
fn scene(gap: f64, map: Affine3A, by_vertices: bool) -> Scene {
    let mut scene = empty(1, 1);
    for (size, y) in [(1.0f32, 0.0), (2.0, gap as f32), (4.0, 0.5)] {
        let mut mesh = quad(Vec3::new(-0.5 * size, y, -0.5 * size), Vec3::X * size, Vec3::Z * size);
        let mut place = map;
        if by_vertices {
            mesh.positions.iter_mut().for_each(|p| *p = map.transform_point3(*p));
            place = Affine3A::IDENTITY;
        }
        build::add(&mut scene, mesh, matte(Vec3::ZERO), place);
    }
    scene
}

/// The sweep over some gaps with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, gaps: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("gap in sizes of the floor");
    let million = "rays a million";
    let turned = Affine3A::from_translation(Vec3::new(0.8, -0.5, 0.3))
        * Affine3A::from_rotation_x(0.3)
        * Affine3A::from_rotation_z(0.7);
    let mut charts = Vec::new();
    for way in ["vertices", "instance"] {
        let title = format!("Rays from the floor of the gap that get past the wall over it, placed by {way}");
        let mut leaks = chart(&format!("leaks-{way}"), &title, x(), million);
        let title = format!("Rays from the floor that meet the floor, placed by {way}");
        let mut self_hits = chart(&format!("self-hits-{way}"), &title, x(), million);
        let title = format!("Rays from below that meet the wall before the floor, placed by {way}");
        let mut order = chart(&format!("order-{way}"), &title, x(), million);
        for &gap in gaps {
            let scene = scene(gap, turned, way == "vertices");
            let stand = Stand::new(bench, &scene)?;
            let rays = rays_in_gap(turned, gap, rays);
            let first = stand.hits(&rays, false)?;
            let mut leaves = stand.leaves(&rays)?;
            let expected = leaves[0].1.clone();
            let mut firsts: Vec<_> = first.iter().map(|(_, found)| found.clone()).collect();
            if way == "vertices" {
                leaves.push((T_MIN, stand.watertight.leaves(&rays, 1e-4)));
                firsts.push(stand.watertight.hits(&rays, 0.0));
            }
            // The walls' corners are rounded too: only what the reference has in its right order counts.
            let right: Vec<bool> = first[0]
                .1
                .iter()
                .zip(&expected)
                .map(|(f, s)| matches!((f, s), (Some(f), Some(s)) if f.object == 0 && s.object == 1))
                .collect();
            let all = right.iter().filter(|right| **right).count();
            for ((method, second), first) in leaves.iter().zip(&firsts) {
                let of = |object: &dyn Fn(Option<u32>) -> bool| {
                    let rays = right.iter().zip(first).zip(second);
                    rays.filter(|((right, first), second)| {
                        **right && first.is_some_and(|f| f.object == 0) && object(second.map(|s| s.object))
                    })
                    .count()
                };
                add(&mut leaks, method, per_million(gap, of(&|o| o.is_none_or(|o| o == 2)), all));
                add(&mut self_hits, method, per_million(gap, of(&|o| o == Some(0)), all));
            }
            let rays = rays_from_below(turned, rays.len());
            let hits = stand.hits(&rays, way == "vertices")?;
            let (_, expected) = &hits[0];
            let all = expected.iter().flatten().filter(|hit| hit.object == 0).count();
            for (method, found) in &hits[1..] {
                let pairs = found.iter().zip(expected);
                let wrong = |f: &Option<_>, e: &Option<crate::reference::intersect::Hit>| {
                    let object = |hit: &Option<crate::reference::intersect::Hit>| hit.map(|hit| hit.object);
                    object(e) == Some(0) && object(f) != Some(0)
                };
                add(&mut order, method, per_million(gap, pairs.filter(|(f, e)| wrong(f, e)).count(), all));
            }
        }
        charts.extend([leaks, self_hits, order]);
    }
    let findings = findings(&charts);
    Ok(Sweep { charts, findings })
}

/// Rays from the middle of the gap down to the floor, up to 70 degrees off its normal.
fn rays_in_gap(map: Affine3A, gap: f64, n: usize) -> Vec<Ray> {
    let mut random = Random::new(25);
    let ray = |_| {
        let (sine, cosine) = random.between(0.0, std::f64::consts::TAU).sin_cos();
        let slope = random.between(0.0, 70f64.to_radians()).tan();
        let from = Vec3::new(random.between(-0.2, 0.2) as f32, (0.5 * gap) as f32, random.between(-0.2, 0.2) as f32);
        let direction = Vec3::new((slope * cosine) as f32, -1.0, (slope * sine) as f32).normalize();
        let direction = map.transform_vector3(direction).normalize();
        Ray { origin: map.transform_point3(from), direction, t_max: f32::INFINITY }
    };
    (0..n).map(ray).collect()
}

/// Rays from half a size below the floor to points of it.
fn rays_from_below(map: Affine3A, n: usize) -> Vec<Ray> {
    let mut random = Random::new(26);
    let ray = |_| {
        let mut place = |y: f32| Vec3::new(random.between(-0.4, 0.4) as f32, y, random.between(-0.4, 0.4) as f32);
        Ray::through(map.transform_point3(place(-0.5)), map.transform_point3(place(0.0)))
    };
    (0..n).map(ray).collect()
}

fn findings(charts: &[crate::measure::chart::Chart]) -> Findings {
    let w = Worse::Upwards;
    Findings { starts: charts.iter().map(|c| describe(c, 0.0, w)).collect::<Vec<_>>().join("\n"), how: String::new(), mends: String::new(), sees: String::new() }
}
