//! A base under a smooth dielectric, or in glass, in the reference and on every backend.

use super::functions::{call, floats, vector};
use super::glass::{in_white_light, on_every_tracer, trace};
use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::surfel::Surfel;
use luminaire::scene::{LightSampling, Material, Mesh, coat_transmittance};

fn ball(subdivisions: u32, smooth: bool) -> Mesh {
    let mut ball = icosphere(subdivisions);
    if smooth {
        ball.normals = ball.positions.clone();
    }
    ball
}

fn white_base(eta: f32) -> Material {
    Material { reflection: Vec3::ONE, eta: Some(eta), ..matte(Vec3::ONE) }
}

/// In white light a white base under a clear coat is white. With vertex normals, where some of its light would go through the triangles and is lost,
/// it is less, and never more: of an index below 1, whose critical cones about two normals differ, too.
#[test]
fn a_white_base_under_a_clear_coat_is_no_more_than_white() {
    const SAMPLES: u32 = 200;
    for (body, least, eta) in [
        (ball(0, true), 0.8, 0.7),
        (ball(1, true), 0.93, 0.7),
        (ball(1, false), 1.0, 0.7),
        (ball(0, true), 0.8, 1.5),
        (ball(1, false), 1.0, 1.5),
    ] {
        let (flat, triangles) = (body.normals.is_empty(), body.triangles.len());
        let mut scene = in_white_light(body, white_base(eta));
        (scene.film.width, scene.film.height) = (12, 12);
        // Nothing but the ball.
        scene.sensor = pinhole(Vec3::Z * 4.0, Vec3::ZERO, Vec3::Y, 12.0);
        on_every_tracer(&scene, |backend, tracer| {
            let traced = trace(tracer, &scene, SAMPLES);
            let count = f64::from(12 * 12 * SAMPLES);
            let mean = traced.sums.iter().map(|sum| sum.radiance[1]).sum::<f64>() / count;
            // Samples are 0 or 1 over the share of the sphere's cosines that the coat lets through.
            let error = 4.0 * (1.0 / coat_transmittance(eta.into()) - 1.0).max(0.01).sqrt() / count.sqrt();
            let what = format!("{triangles} triangles, flat: {flat}, eta {eta}, {backend}: {mean} +- {error}");
            println!("{what}");
            assert!(error < 0.03 && mean <= 1.0 + error && mean >= least - error, "{what}");
        });
    }
}

/// What transmits is no coat: base and glass lie beside each other, and every sample of a body that is white is 1, however often its inner side
/// scatters.
#[test]
fn white_glass_with_a_base_is_white() {
    for eta in [1.5, 0.7] {
        let base = matte(Vec3::splat(0.75));
        let glass = Material { reflection: Vec3::splat(0.25), transmission: Vec3::splat(0.25), eta: Some(eta), ..base };
        assert!(!glass.is_coated());
        let mut scene = in_white_light(ball(1, false), glass);
        estimator(&mut scene).light_sampling = LightSampling::None;
        on_every_tracer(&scene, |backend, tracer| {
            let traced = trace(tracer, &scene, 8);
            assert_eq!(traced.dropped, [], "{backend}");
            for sum in &traced.sums {
                let white = sum.radiance.iter().all(|r| (r - 1.0).abs() < 1e-4);
                assert!(white, "eta {eta}, {backend}: {sum:?}");
            }
        });
    }
}

/// A coat that reflects nearly all keeps its digits: the little that comes back up from below is not one minus nearly one.
#[test]
fn coats_of_extreme_indices_keep_their_digits() {
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let first = scene.materials.len() as u32;
    let etas = [0.01f32, 0.1, 100.0];
    scene.materials.extend(etas.map(white_base));
    // Within the critical cone, of 0.57 degrees.
    let directions = [Vec3::Z, Vec3::new(0.002, 0.0, 1.0).normalize(), Vec3::new(0.0, -0.003, 1.0).normalize()];
    let mut calls: Vec<Call> = vec![];
    let mut expected = vec![];
    for (index, eta) in etas.into_iter().enumerate() {
        for wo in directions {
            for wi in directions {
                let mut arguments = call([wo.x, wo.y, wo.z, 0.0], [wi.x, wi.y, wi.z, 0.0]);
                arguments[0][3] = first + index as u32;
                calls.push(arguments);
                let surfel = Surfel {
                    reflection: DVec3::ONE,
                    eta: Some(eta.into()),
                    coat_transmittance: coat_transmittance(eta.into()),
                    ..flat_surfel(DVec3::ONE, DVec3::ZERO, 0.0)
                };
                expected.push(surfel.bsdf(wo.as_dvec3(), wi.as_dvec3()));
            }
        }
    }
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let found = probe.call(Function::Bsdf, &calls).expect("the probe runs");
        for ((arguments, result), expected) in calls.iter().zip(found).zip(&expected) {
            let (wo, f) = (floats(arguments[0]), vector(result[0]));
            assert!(expected.x > 0.0 && (f / *expected - 1.0).abs().max_element() < 1e-4, "{wo:?}: {f} {expected}");
        }
    });
}
