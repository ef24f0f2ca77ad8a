//! Rays at edges and vertices, from straight on to grazing.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point};
use crate::random::Random;
use crate::rays::Ray;
use crate::stability::geometry::{
    COMPUTE_BVH, Stand, add, baked, chart, decades, distance_error, named, per_million, value,
};
use crate::stability::judge::{geometric, up_to};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::scene::Mesh;
use luminaire::scene::build::mesh;

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "edges",
    family: Family::Geometry,
    title: "Rays at edges and vertices, at angles to the surface from 90 to 1e-7 degrees",
    run,
};

fn run(bench: &Workbench) -> Result<Sweep> {
    let mut angles = decades(-7, 1, bench);
    angles.extend([30.0, 90.0]);
    sweep(bench, &angles, 30_000)
}

/// Cells of the floor along each side.
const CELLS: u32 = 16;

/// A closed box from (-1, 0, -1) to (1, 1, 1) whose floor is a grid of triangles.
fn box_with_floor() -> Mesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let at = |i: u32| -1.0 + 2.0 * i as f32 / CELLS as f32;
    let side = CELLS + 1;
    for z in 0..side {
        for x in 0..side {
            positions.push(Vec3::new(at(x), 0.0, at(z)));
        }
    }
    for z in 0..CELLS {
        for x in 0..CELLS {
            let a = z * side + x;
            triangles.extend([[a, a + side, a + side + 1], [a, a + side + 1, a + 1]]);
        }
    }
    // Walls down to each point of the floor's border, so that they share its edges; and the lid.
    let border: Vec<u32> = (0..CELLS)
        .chain((0..CELLS).map(|z| z * side + CELLS))
        .chain((0..CELLS).map(|x| CELLS * side + CELLS - x))
        .chain((0..CELLS).map(|z| (CELLS - z) * side))
        .collect();
    let first = positions.len() as u32;
    positions.extend(border.iter().map(|&v| positions[v as usize] + Vec3::Y).collect::<Vec<_>>());
    let top = positions.len() as u32;
    positions.push(Vec3::Y);
    let count = border.len() as u32;
    for i in 0..count {
        let j = (i + 1) % count;
        let (a, b) = (border[i as usize], border[j as usize]);
        triangles.extend([[a, b, first + j], [a, first + j, first + i], [first + i, first + j, top]]);
    }
    mesh(positions, &triangles)
}

/// The sweep over some angles in degrees with so many rays each, half of them at edges and half at vertices.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, angles: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("angle between ray and surface in degrees");
    let turned = Affine3A::from_rotation_x(0.3) * Affine3A::from_rotation_z(0.7);
    let mut charts = Vec::new();
    for (name, words, map) in [("aligned", "along the axes", Affine3A::IDENTITY), ("turned", "turned", turned)] {
        let scene = baked(box_with_floor(), map);
        let stand = Stand::new(bench, &scene)?;
        let title = format!("Rays lost by a closed box, {words}");
        let mut lost = chart(&format!("lost-{name}"), &title, x(), "rays a million");
        let title = format!("99.9th percentile of the hits' error along the ray, {words}");
        let mut error = chart(&format!("error-{name}"), &title, x(), "error in sizes of the floor's edge");
        for &angle in angles {
            let rays = rays_at_floor(map, angle, rays);
            let hits = stand.hits(&rays, true)?;
            let expected = &hits[0].1;
            // A ray that rounding put below the floor meets nothing, and should not.
            let inside = expected.iter().flatten().count();
            for (method, found) in &hits[1..] {
                let count = found.iter().zip(expected).filter(|(f, e)| f.is_none() && e.is_some()).count();
                add(&mut lost, method, per_million(angle, count, inside));
                add(&mut error, method, Point { x: angle, y: 0.5 * distance_error(found, expected), error: None });
            }
        }
        charts.extend([lost, error]);
    }
    // The error along the ray is left out: a grazing ray is off along the surface, where nothing is seen of it.
    let counts: Vec<_> = charts.iter().filter(|chart| chart.name.starts_with("lost")).collect();
    let verdicts = geometric(&counts, &[], Worse::Downwards);
    let range = stretch(angles.iter().copied(), Worse::Downwards, "degrees to the surface");
    let summary = up_to(&verdicts, COMPUTE_BVH, |end| {
        format!("If edges look dotted, take the compute BVH: it loses nothing down to {end} degrees.")
    });
    let findings = findings(&charts);
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// Rays from inside the box to vertices and edges of its floor, well away from the walls.
fn rays_at_floor(map: Affine3A, degrees: f64, n: usize) -> Vec<Ray> {
    let mut random = Random::new(23);
    let (rise, level) = degrees.to_radians().sin_cos();
    let ray = |i: usize| {
        let half = CELLS / 2;
        let mut cell = || (random.below(half as usize) as f64 - f64::from(half / 2)) * 2.0 / f64::from(CELLS);
        let (mut x, mut z) = (cell(), cell());
        if i % 2 == 1 {
            // On an edge: along x, along z, or along the diagonal.
            let along = random.uniform() * 2.0 / f64::from(CELLS);
            let which = random.below(3);
            x += if which == 1 { 0.0 } else { along };
            z += if which == 0 { 0.0 } else { along };
        }
        let (sine, cosine) = random.between(0.0, std::f64::consts::TAU).sin_cos();
        let length = random.between(0.2, 0.6);
        let height = (length * rise) as f32;
        let from = Vec3::new((x - length * level * cosine) as f32, height, (z - length * level * sine) as f32);
        // In the box's space, where the height above the floor is exact.
        let direction = Vec3::new((level * cosine) as f32, -rise as f32, (level * sine) as f32);
        let direction = map.transform_vector3(direction);
        Ray { origin: map.transform_point3(from), direction, t_max: f32::INFINITY }
    };
    (0..n).map(ray).collect()
}

fn findings(charts: &[Chart]) -> Findings {
    let error = |x: f64| value(named(charts, "error-turned"), COMPUTE_BVH, x);
    Findings {
        starts: format!(
            "The error along the ray, turned, is {} at 1 degree, {} at 1e-3 and {} at 1e-5; no verdict goes by it, because a ray at a small angle to \
             the surface is off along the surface, where nothing is seen of it. Rays that are lost:",
            error(1.0),
            error(1e-3),
            error(1e-5)
        ),
        how: "Two triangles that share an edge must come to the same verdict about it. Möller and Trumbore's test computes it from \
             different numbers for each of them; the watertight test from the same. Then it is the boxes: the ray meets an edge exactly where the \
             box ends, and rounding may put it outside. That hits floors along the axes hardest, whose boxes have no height. A ray \
             at a small angle meets the plane where its rounded height is used up: the error grows as one over the angle, and below \
             1e-5 degrees (the last digit of single precision) the plane is no longer met where it is."
            .into(),
        mends: "The compute BVH has the watertight test, computed without fused multiply-add, in boxes padded by eight units in the last place. What the driver's ray \
             query does is the driver's; the compute BVH can be asked for instead."
            .into(),
        sees: "With a method that loses rays: dotted light or dark lines along the edges of a mesh, a pixel here and there, which more \
             samples do not remove. Of the error along grazing rays: nothing."
            .into(),
    }
}
