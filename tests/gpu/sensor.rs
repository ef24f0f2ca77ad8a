//! The sensor and the samplers, the kernel's against the reference's.

use super::*;
use crate::common::scenes::*;
use glam::{DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::Reference;
use luminaire::sampling::{Sampler, coverage, ray_salt};
use luminaire::scene::{Filter, Lens, Projection};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Both samplers, and the numbers that decide about partly transparent surfaces.
#[test]
fn numbers_are_the_same_bits() {
    let mut rng = StdRng::seed_from_u64(1);
    let mut calls: Vec<Call> = (0..100_000).map(|_| rng.random()).collect();
    calls.extend((0..4096u32).map(|i| [[i % 64, i / 64, i % 5, 0], [i % 7, i % 11, 0, 0]]));
    calls.push([[u32::MAX; 4], [u32::MAX; 4]]);
    for sampler in [Sampler::Independent, Sampler::Sobol] {
        let mut scene = cornell_like(4, 4);
        scene.settings.sampler = sampler;
        on_every_backend(|backend| {
            let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
            let numbers = probe.call(Function::Numbers, &calls).expect("the probe runs");
            let coverages = probe.call(Function::Coverage, &calls).expect("the probe runs");
            for ((call, result), covered) in calls.iter().zip(numbers).zip(coverages) {
                let [[pixel, sample, block, seed], [object, triangle, ..]] = *call;
                assert_eq!(result[0], sampler.numbers(pixel, sample, block, seed), "{sampler:?}: {call:?}");
                let salt = ray_salt(pixel, sample, block, seed);
                assert_eq!(covered[0][..2], [salt, coverage(salt, object, triangle)], "{call:?}");
            }
        });
    }
}

/// Camera rays of all projections, lenses and filters, to a few roundings of the origin's coordinates and of a unit vector's.
#[test]
fn sensor_rays_match_to_rounding() {
    let (width, height) = (64, 48);
    let disk = Lens { radius: 0.25, focus_distance: 3.0, blades: 0, rotation: 0.0 };
    let blades = |blades, rotation| Some(Lens { blades, rotation, ..disk });
    let perspective = Projection::Perspective { fov: 50.0 };
    let parallel = Projection::Orthographic { height: 4.0 };
    let cases = [
        (perspective, None, Filter::Box, 0.5, Sampler::Sobol),
        (perspective, Some(disk), Filter::Gaussian, 1.5, Sampler::Independent),
        (perspective, blades(3, 200.0), Filter::BlackmanHarris, 1.5, Sampler::Sobol),
        (parallel, None, Filter::Tent, 1.0, Sampler::Independent),
        (parallel, blades(9, -7.0), Filter::Box, 2.0, Sampler::Independent),
    ];
    let calls: Vec<Call> = (0..width * height * 4)
        .map(|i| {
            let pixel = i / 4;
            [[pixel % width, pixel / width, pixel, i % 4], [0; 4]]
        })
        .collect();
    for (projection, lens, filter, radius, sampler) in cases {
        let mut scene = cornell_like(width, height);
        scene.sensor = pinhole(Vec3::new(1.0, 0.5, 1.5), Vec3::new(-0.5, 0.0, -1.0), Vec3::Y, 60.0);
        (scene.sensor.projection, scene.sensor.lens) = (projection, lens);
        (scene.film.filter, scene.film.filter_radius) = (filter, radius);
        scene.settings.sampler = sampler;
        let reference = Reference::new(&scene);
        on_every_backend(|backend| {
            let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
            let results = probe.call(Function::SensorRay, &calls).expect("the probe runs");
            for (call, result) in calls.iter().zip(results) {
                let [origin, direction] =
                    result.map(|r| DVec3::from([0, 1, 2].map(|k| f64::from(f32::from_bits(r[k])))));
                let (o, d) = reference.sensor_ray(call[0][2], call[0][3]);
                let what = || format!("{projection:?}, {lens:?}, {filter:?}, {call:?}");
                assert!((origin - o).abs().max_element() < 1e-6, "{}: origin {origin}, {o}", what());
                assert!((direction - d).abs().max_element() < 1e-6, "{}: direction {direction}, {d}", what());
            }
        });
    }
}
