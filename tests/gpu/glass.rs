//! Bodies of glass with vertex normals, panes, and light that nothing absorbs, in the reference and on every backend.

use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, Vec3};
use luminaire::film::{Batch, Tile};
use luminaire::reference::Reference;
use luminaire::reference::path::LONGEST_PATH;
use luminaire::render::{Traced, Tracer};
use luminaire::scene::{Environment, Extinction, LightSampling, Material, Mesh, Scene};
use std::f32::consts::{PI, TAU};

/// The surface of revolution of a line of radii and heights from the lower end of the axis to the upper.
fn lathe(line: &[(f32, f32)], segments: u32) -> Mesh {
    let ends = [line[0], line[line.len() - 1]].map(|(_, y)| Vec3::new(0.0, y, 0.0));
    let mut positions = ends.to_vec();
    let mut triangles = vec![];
    let rings = &line[1..line.len() - 1];
    for (r, y) in rings {
        positions.extend((0..segments).map(|s| {
            let (sine, cosine) = (s as f32 / segments as f32 * TAU).sin_cos();
            Vec3::new(r * sine, *y, r * cosine)
        }));
    }
    let last = rings.len() as u32 - 1;
    for s in 0..segments {
        let v = |ring: u32, s: u32| 2 + ring * segments + s % segments;
        triangles.push([0, v(0, s + 1), v(0, s)]);
        for ring in 0..last {
            let (a, b, c, d) = (v(ring, s), v(ring, s + 1), v(ring + 1, s + 1), v(ring + 1, s));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([1, v(last, s), v(last, s + 1)]);
    }
    mesh(positions, &triangles)
}

/// Vertex normals: the means of the faces'.
fn smooth(mut mesh: Mesh) -> Mesh {
    let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize]);
        triangle.vertices.iter().for_each(|v| normals[*v as usize] += (b - a).cross(c - a).normalize());
    }
    mesh.normals = normals.into_iter().map(Vec3::normalize).collect();
    mesh
}

fn ball(rings: u32, segments: u32) -> Mesh {
    let angle = |i: u32| i as f32 / rings as f32 * PI;
    lathe(&(0..=rings).map(|i| (angle(i).sin(), -angle(i).cos())).collect::<Vec<_>>(), segments)
}

fn glass() -> Material {
    Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::ZERO) }
}

/// A body in white light.
pub fn in_white_light(body: Mesh, material: Material) -> Scene {
    let mut scene = empty(24, 24);
    scene.sensor = pinhole(Vec3::new(0.4, 1.5, 5.0), Vec3::ZERO, Vec3::Y, 26.0);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    add(&mut scene, body, material, Affine3A::IDENTITY);
    scene
}

pub fn trace(tracer: &mut dyn Tracer, scene: &Scene, samples: u32) -> Traced {
    let tile = Tile { x: 0, y: 0, width: scene.film.width, height: scene.film.height };
    tracer.trace(&Batch { tile, samples: 0..samples, group: 1 }).expect("the tracer works")
}

/// The tracers that are here, the reference first.
pub fn on_every_tracer(scene: &Scene, test: impl Fn(&str, &mut dyn Tracer)) {
    test("reference", &mut Reference::new(scene));
    on_every_backend(|backend| test(backend.name(), &mut backend.tracer(scene)));
}

/// Nothing is lost and nothing gained at any bounce: every sample is 1. Total reflection about interpolated normals drew paths to the rim, where they
/// stayed for ever; now they are no longer than those of the flat body.
#[test]
fn smooth_glass_is_white_in_white_light_and_traced_as_fast_as_flat_glass() {
    let tumbler = [(0.0, -1.0), (0.6, -1.0), (0.8, 0.9), (0.75, 1.0), (0.7, 0.9), (0.52, -0.8), (0.0, -0.8)];
    let bodies = [
        ("ball of 5 rings", ball(5, 8)),
        ("ball of 16 rings", ball(16, 32)),
        ("icosphere", icosphere(1)),
        ("tumbler", lathe(&tumbler, 12)),
        ("cylinder", lathe(&[(0.0, -1.0), (0.7, -1.0), (0.7, 1.0), (0.0, 1.0)], 24)),
        ("cube", cube()),
    ];
    for (name, body) in bodies {
        let rays = |traced: &Traced| traced.sums.iter().map(|sum| f64::from(sum.rays.all)).sum::<f64>();
        let flat_scene = in_white_light(body.clone(), glass());
        let flat = rays(&trace(&mut Reference::new(&flat_scene), &flat_scene, 8));
        let scene = in_white_light(smooth(body), glass());
        on_every_tracer(&scene, |backend, tracer| {
            let traced = trace(tracer, &scene, 8);
            assert_eq!(traced.dropped, [], "{name}, {backend}");
            for sum in &traced.sums {
                // 1e-4: the products of eta^2 of a few hundred bounces in f32.
                assert!(sum.radiance.iter().all(|r| (r - 1.0).abs() < 1e-4), "{name}, {backend}: {sum:?}");
            }
            let ratio = rays(&traced) / flat;
            println!("{name}, {backend}: {ratio:.3} of the rays of the flat body");
            assert!(ratio < 1.3, "{name}, {backend}: {ratio} times the rays of the flat body");
        });
    }
}

/// A white room without a way out: every path ends all the same, and is counted and named.
#[test]
fn light_that_nothing_absorbs_is_lost_and_counted() {
    // Mesa before 23 ends a kernel whose loops have 65 535 rounds in all, those of the intersection among them: such paths end there before their time.
    if on_the_old_driver() {
        return;
    }
    for extinction in [Extinction::Throughput, Extinction::Surface] {
        let mut scene = empty(2, 1);
        add(&mut scene, cube(), matte(Vec3::ONE), Affine3A::IDENTITY);
        estimator(&mut scene).extinction = extinction;
        on_every_tracer(&scene, |backend, tracer| {
            let traced = trace(tracer, &scene, 2);
            assert_eq!(traced.dropped.len(), 4, "{backend}");
            for sum in &traced.sums {
                assert_eq!((sum.dropped, sum.rays.all, sum.radiance), (1, LONGEST_PATH, [0.0; 3]), "{backend}");
            }
        });
    }
}

/// A pane as a single quad, seen at an angle: what is in front is reflected by 2 F / (1 + F), what is behind comes through by the rest, whichever way it faces,
/// and direct light finds a lamp behind it no less than chance does.
#[test]
fn a_pane_lets_through_what_two_surfaces_do() {
    for (degrees, fresnel, turned, sampling) in [
        (0.0f32, 0.04, false, LightSampling::Mis),
        (60.0, 0.089_186, true, LightSampling::Mis),
        (80.0, 0.387_66, false, LightSampling::None),
    ] {
        {
            let mut scene = empty(32, 32);
            let (u, v) = if turned { (Vec3::X, Vec3::Y) } else { (Vec3::Y, Vec3::X) };
            let pane = quad(Vec3::new(-64.0, -64.0, 0.0), u * 128.0, v * 128.0);
            let tint = Vec3::new(1.0, 0.5, 0.0);
            add(&mut scene, pane, Material { thin: true, transmission: tint, ..glass() }, Affine3A::IDENTITY);
            let behind = quad(Vec3::new(-512.0, -512.0, -16.0), Vec3::X * 1024.0, Vec3::Y * 1024.0);
            add(&mut scene, behind, lamp(Vec3::ONE), Affine3A::IDENTITY);
            let (sine, cosine) = degrees.to_radians().sin_cos();
            scene.sensor = pinhole(Vec3::new(sine, 0.0, cosine), Vec3::ZERO, Vec3::Y, 1e-2);
            estimator(&mut scene).light_sampling = sampling;
            let through: f64 = 1.0 - 2.0 * fresnel / (1.0 + fresnel);
            on_every_tracer(&scene, |backend, tracer| {
                let traced = trace(tracer, &scene, 16);
                let samples = traced.sums.len() as f64;
                for (channel, tint) in tint.to_array().into_iter().enumerate() {
                    let mean = traced.sums.iter().map(|sum| sum.radiance[channel]).sum::<f64>() / samples;
                    let expected = through * f64::from(tint);
                    // Four standard errors: of 16384 samples no one is above 1.6, as rarely as it may be.
                    let slack = 4.0 * (1.6 * expected / samples).sqrt() + 1e-5;
                    assert!((mean - expected).abs() <= slack, "{degrees} degrees, {backend}: {mean}, {expected}");
                }
            });
        }
    }
}

/// No pane, however it is placed, makes white light more or less.
#[test]
fn panes_are_white_in_white_light() {
    let mut scene = in_white_light(cube(), glass());
    scene.materials[0].thin = true;
    let mut ball = smooth(ball(5, 8));
    ball.triangles.iter_mut().step_by(3).for_each(|triangle| triangle.vertices.swap(0, 1));
    add(&mut scene, ball, Material { thin: true, ..glass() }, Affine3A::from_scale(Vec3::splat(0.6)));
    on_every_tracer(&scene, |backend, tracer| {
        for sum in trace(tracer, &scene, 8).sums {
            assert!(sum.radiance.iter().all(|r| (r - 1.0).abs() < 1e-5), "{backend}: {sum:?}");
        }
    });
}
