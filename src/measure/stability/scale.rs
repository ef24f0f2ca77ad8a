//! How large or small a scene may be.

use super::geometry::{
    REFERENCE, Stand, Worse, add, baked, chart, decades, describe, lost, name_of, per_million, rays_to_features,
    self_hits_and_escapes,
};
use super::{Definition, Findings, Sweep};
use crate::Result;
use crate::measure::Workbench;
use crate::measure::chart::{Axis, Point};
use crate::measure::intersect_f32::{Test, Triangles};
use crate::measure::rays::Random;
use crate::measure::statistics::{render, total};
use crate::scene::build::{add as add_mesh, cube, empty, icosphere, lamp, matte, pinhole, quad, transformed};
use crate::scene::{Luminaire, Scene};
use glam::{Affine3A, Vec3};

/// The sweep.
pub const DEFINITION: Definition = Definition { name: "scale", title: "Size of the scene, 1e-8 to 1e8 units", run };

/// The program that comes with the paper of Möller and Trumbore takes determinants up to 1e-6 for zero.
const AS_PUBLISHED: &str = "f32 Möller-Trumbore, as published";
const T_MIN: &str = "f32 watertight, t_min 1e-4";
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
        "Mean of a picture of a room, off from the reference's at size 1",
        x(),
        "relative difference, the same random numbers",
    );
    let room = room();
    let expected = mean(bench, &room, crate::backend::Backend::Cpu)?;
    for &size in sizes {
        let mut random = Random::new(22);
        let map = Affine3A::from_scale(Vec3::splat(size as f32))
            * Affine3A::from_translation(Vec3::new(0.8, -0.5, 0.3))
            * Affine3A::from_rotation_x(0.3)
            * Affine3A::from_rotation_z(0.7)
            * Affine3A::from_scale(Vec3::new(0.5, 0.01, 0.5));
        let scene = baked(icosphere(3), map);
        let rays = rays_to_features(&scene, map * Affine3A::from_scale(Vec3::splat(0.4)), rays, &mut random);
        let stand = Stand::new(bench, &scene)?;
        let mut hits = stand.hits(&rays, true)?;
        let published = Triangles::new(&scene, Test::MoellerTrumbore { epsilon: 1e-6 }, true);
        hits.push((AS_PUBLISHED, published.hits(&rays, 0.0)));
        for (name, found) in &hits {
            add(&mut lost_chart, name, per_million(size, lost(found), rays.len()));
        }
        let mut leaves = stand.leaves(&rays)?;
        let first = stand.watertight.hits(&rays, 0.0);
        let fixed = [(T_MIN, 1e-4), (T_MIN_OF_SIZE, 1e-4 * size as f32)];
        for (name, t_min) in fixed {
            leaves.push((name, stand.watertight.leaves(&rays, t_min)));
        }
        for (name, second) in &leaves {
            let first = hits.iter().find(|(method, _)| method == name).map_or(&first, |(_, found)| found);
            let [same, out] = self_hits_and_escapes(first, second);
            add(&mut self_hits, name, per_million(size, same, rays.len()));
            add(&mut escapes, name, per_million(size, out, rays.len()));
        }
        let room = transformed(&room, size as f32, Vec3::ZERO);
        for backend in bench.backends() {
            let y = (mean(bench, &room, backend)? / expected - 1.0).abs();
            add(&mut picture, name_of(backend), Point { x: size, y, error: None });
        }
    }
    let charts = vec![lost_chart, self_hits, escapes, picture];
    let findings = findings(&charts);
    Ok(Sweep { charts, findings })
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

fn mean(bench: &Workbench, scene: &Scene, backend: crate::backend::Backend) -> Result<f64> {
    let image = render(bench.tracer(scene, backend)?.as_mut(), scene.film.width, scene.film.height, 16, 2);
    Ok(total(&image).mean)
}

fn findings(charts: &[crate::measure::chart::Chart]) -> Findings {
    let w = Worse::Upwards;
    Findings { starts: charts.iter().map(|c| describe(c, 0.0, w)).collect::<Vec<_>>().join("\n"), how: String::new(), mends: String::new(), sees: String::new() }
}
