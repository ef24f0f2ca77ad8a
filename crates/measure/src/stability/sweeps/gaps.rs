//! Surfaces close to each other.

use crate::Workbench;
use crate::chart::Axis;
use crate::random::Random;
use crate::rays::Ray;
use crate::stability::geometry::{COMPUTE_BVH, Departures, Stand, T_MIN, add, chart, decades, per_million};
use crate::stability::judge::{geometric, safe_until, up_to};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Verdict, Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::reference::hit::Hit;
use luminaire::scene::Scene;
use luminaire::scene::build::{self, empty, matte, quad};

/// The sweep.
pub const DEFINITION: Definition =
    Definition { name: "gaps", family: Family::Geometry, title: "Two walls from 0.1 to 1e-8 of their size apart", run };

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
            let fixed = [(T_MIN, 1e-4)];
            let leaves = stand.leaves(&rays, if way == "vertices" { &fixed } else { &[] })?;
            let object = |hit: &Option<Hit>| hit.map(|hit| hit.object);
            // The walls' corners are rounded too: only what the reference has in its right order counts.
            let pairs = leaves[0].first.iter().zip(&leaves[0].second);
            let right: Vec<bool> = pairs.map(|(f, s)| (object(f), object(s)) == (Some(0), Some(1))).collect();
            let all = right.iter().filter(|right| **right).count();
            for Departures { name, first, second } in &leaves {
                let rays = || right.iter().zip(first).zip(second).filter(|((r, f), _)| **r && object(f) == Some(0));
                let past = rays().filter(|(_, s)| object(s).is_none_or(|o| o == 2)).count();
                add(&mut leaks, name, per_million(gap, past, all));
                add(&mut self_hits, name, per_million(gap, rays().filter(|(_, s)| object(s) == Some(0)).count(), all));
            }
            let rays = rays_from_below(turned, rays.len());
            let hits = stand.hits(&rays, way == "vertices")?;
            let (_, expected) = &hits[0];
            let all = expected.iter().flatten().filter(|hit| hit.object == 0).count();
            for (method, found) in &hits[1..] {
                let pairs = found.iter().zip(expected);
                let wrong = pairs.filter(|(f, e)| object(e) == Some(0) && object(f) != Some(0)).count();
                add(&mut order, method, per_million(gap, wrong, all));
            }
        }
        charts.extend([leaks, self_hits, order]);
    }
    let verdicts = geometric(&charts.iter().collect::<Vec<_>>(), &[], Worse::Downwards);
    let range = stretch(gaps.iter().copied(), Worse::Downwards, "of the size");
    let summary = up_to(&verdicts, COMPUTE_BVH, |end| {
        format!("Keep surfaces {end} of their size apart, or leave out the hidden one.")
    });
    Ok(Sweep { charts, range, summary, findings: findings(&verdicts), verdicts })
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

fn findings(verdicts: &[Verdict]) -> Findings {
    let nothing = safe_until(verdicts, COMPUTE_BVH).map_or(String::new(), |end| {
        format!("By the compute BVH nothing for gaps of {end} of the size and more. In narrower ones ")
    });
    Findings {
        starts: String::new(),
        how: "A ray leaves a surface some way off it, lest it meets it again. A wall that is nearer than that is passed. A fixed distance passes \
             it at the distance itself, and at slanting angles before. The bound of the rounding is some units in the last place of the largest of the \
             surface's size and its coordinates; nearer surfaces than that have corners that round into each other."
            .into(),
        mends: "The distance by which a ray is moved is the bound of its own rounding, no more: of the triangle's size, not of the scene's.".into(),
        sees: format!(
            "{nothing}light shines through double walls, and surfaces that lie on each other flicker between the two materials. Leave out the \
             inner one."
        ),
    }
}
