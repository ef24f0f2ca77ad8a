//! How large or small a scene may be.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point};
use crate::intersect_f32::{Test, Triangles};
use crate::random::Random;
use crate::stability::geometry::{
    COMPUTE_BVH, Stand, T_MIN, add, baked, chart, decades, lost, name_of, named, per_million, rays_to_faces,
    rays_to_features, value,
};
use crate::stability::judge::{everywhere, geometric};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::scene::build::{add as add_mesh, cube, empty, icosphere, lamp, matte, pinhole, quad, transformed};
use luminaire::scene::{Luminaire, Scene};

/// The sweep.
pub const DEFINITION: Definition =
    Definition { name: "scale", family: Family::Geometry, title: "Size of the scene, 1e-8 to 1e8 units", run };

/// The program that comes with the paper of Möller and Trumbore takes determinants up to 1e-6 for zero.
const AS_PUBLISHED: &str = "f32 Möller-Trumbore, as published";
const T_MIN_OF_SIZE: &str = "f32 watertight, t_min 1e-4 of the size";

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(-8, 8, bench), 15_000)
}

/// The sweep over some sizes with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, sizes: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("size in units");
    let million = "rays a million";
    let mut lost_chart = chart("lost", "Rays lost by a closed body", x(), million);
    let mut self_hits = chart("self-hits", "Rays that meet the triangle that they leave", x(), million);
    let mut escapes = chart(
        "escapes",
        "Rays that leave a face inwards and get out through the near side of a flat body (1 : 50)",
        x(),
        million,
    );
    let mut picture = chart(
        "picture",
        "Mean of a picture of a room, off from the reference's at size 1 (both with the same random numbers)",
        x(),
        "relative difference of the mean",
    );
    let room = room();
    let expected = mean(bench, &room, Backend::Cpu)?;
    for &size in sizes {
        let mut random = Random::new(22);
        let map = Affine3A::from_scale(Vec3::splat(size as f32))
            * Affine3A::from_translation(Vec3::new(0.8, -0.5, 0.3))
            * Affine3A::from_rotation_x(0.3)
            * Affine3A::from_rotation_z(0.7)
            * Affine3A::from_scale(Vec3::new(0.5, 0.01, 0.5));
        let scene = baked(icosphere(3), map);
        let inner = map * Affine3A::from_scale(Vec3::splat(0.4));
        let rays = rays_to_features(&scene, inner, rays, &mut random);
        let stand = Stand::new(bench, &scene)?;
        let mut hits = stand.hits(&rays, true)?;
        let published = Triangles::new(&scene, Test::MoellerTrumbore { epsilon: 1e-6 }, true);
        hits.push((AS_PUBLISHED, published.hits(&rays, 0.0)));
        for (name, found) in &hits {
            add(&mut lost_chart, name, per_million(size, lost(found), rays.len()));
        }
        let inwards = rays_to_faces(&scene, inner, rays.len(), &mut random);
        for departures in stand.leaves(&inwards, &[(T_MIN, 1e-4), (T_MIN_OF_SIZE, 1e-4 * size as f32)])? {
            let [same, out] = departures.self_hits_and_escapes();
            add(&mut self_hits, departures.name, per_million(size, same, rays.len()));
            add(&mut escapes, departures.name, per_million(size, out, rays.len()));
        }
        let room = transformed(&room, size as f32, Vec3::ZERO);
        for backend in bench.backends() {
            let y = (mean(bench, &room, backend)? / expected - 1.0).abs();
            add(&mut picture, name_of(backend), Point { x: size, y, error: None });
        }
    }
    let charts = vec![lost_chart, self_hits, escapes, picture];
    let (pictures, counts): (Vec<&Chart>, Vec<_>) = charts.iter().partition(|chart| chart.name == "picture");
    let verdicts = geometric(&counts, &pictures, Worse::Upwards);
    let range = stretch(sizes.iter().copied(), Worse::Upwards, "units");
    let summary =
        everywhere(&verdicts, COMPUTE_BVH, "Any unit will do: a model may be in millimetres or in kilometres.");
    let findings = findings(&charts);
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// A closed room with a lamp, a point luminaire and a ball.
fn room() -> Scene {
    let mut scene = empty(16, 16);
    add_mesh(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let small = Affine3A::from_translation(Vec3::new(-0.3, -0.6, -0.2)) * Affine3A::from_scale(Vec3::splat(0.4));
    add_mesh(&mut scene, icosphere(2), matte(Vec3::new(0.7, 0.5, 0.3)), small);
    let ceiling = quad(Vec3::new(-0.3, 0.98, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6);
    add_mesh(&mut scene, ceiling, lamp(Vec3::splat(5.0)), Affine3A::IDENTITY);
    scene.luminaires = vec![Luminaire::Point { position: Vec3::new(0.5, 0.2, 0.3), intensity: Vec3::splat(0.3) }];
    scene.sensor = pinhole(Vec3::new(0.1, 0.0, 0.95), Vec3::new(0.0, -0.2, -1.0), Vec3::Y, 70.0);
    scene
}

/// Mean of a picture, over all channels.
fn mean(bench: &Workbench, scene: &Scene, backend: Backend) -> Result<f64> {
    const SAMPLES: u32 = 16;
    let tile = Tile { x: 0, y: 0, width: scene.film.width, height: scene.film.height };
    let batch = Batch { tile, samples: 0..SAMPLES, group: SAMPLES };
    let traced = bench.tracer(scene, backend)?.trace(&batch)?;
    let sum: f64 = traced.sums.iter().flat_map(|sum| sum.radiance).sum();
    Ok(sum / (3.0 * f64::from(SAMPLES) * tile.pixels() as f64))
}

fn findings(charts: &[Chart]) -> Findings {
    let picture = named(charts, "picture");
    let (smallest, largest) = (value(picture, COMPUTE_BVH, 1e-8), value(picture, COMPUTE_BVH, 1e8));
    Findings {
        starts: String::new(),
        how: format!(
            "A fixed smallest distance of 1e-4 units is smaller than the rounding of a scene of 1e3 units, and larger than the gaps of a scene of 0.01 units. In \
             proportion to the size it is the same for every size, and still larger than the thin parts. The determinant of Möller and \
             Trumbore's test is a length to the third power (the direction is a unit vector: squared): compared with a fixed 1e-6 it calls all \
             triangles of about 1e-3 units edge-on. What scales all numbers of a computation alike changes no digit of it: the picture is off by {smallest} at \
             1e-8 and by {largest} at 1e8 units."
        ),
        mends: "No length in the kernel is fixed: the rounding bound by which a ray leaves a surface scales with the scene. Squares of short vectors are taken after a division."
            .into(),
        sees: "Nothing: a model may be in millimetres or in kilometres.".into(),
    }
}
