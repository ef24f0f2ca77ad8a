//! The sensor and the samplers, the kernel's against the reference's.

use super::pictures::{differing, pixels};
use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::Reference;
use luminaire::sampling::{Sampler, coverage, ray_salt};
use luminaire::scene::{Filter, Lens, Material, Projection, Scene};
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
        (parallel, blades(9, -7.0), Filter::Tent, 1.0, Sampler::Independent),
        (parallel, None, Filter::Box, 2.0, Sampler::Independent),
    ];
    let calls: Vec<Call> = (0..width * height * 4)
        .map(|i| {
            let pixel = i / 4;
            [[pixel % width, pixel / width, pixel, i % 4], [0; 4]]
        })
        .collect();
    // Every other one is shifted.
    let shifts = [Vec2::ZERO, Vec2::new(0.5, -1.25)].into_iter().cycle();
    for ((projection, lens, filter, radius, sampler), shift) in cases.into_iter().zip(shifts) {
        let mut scene = cornell_like(width, height);
        scene.sensor = pinhole(Vec3::new(1.0, 0.5, 1.5), Vec3::new(-0.5, 0.0, -1.0), Vec3::Y, 60.0);
        (scene.sensor.projection, scene.sensor.lens, scene.sensor.shift) = (projection, lens, shift);
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
                let what = || format!("{projection:?}, {lens:?}, {shift}, {filter:?}, {call:?}");
                assert!((origin - o).abs().max_element() < 1e-6, "{}: origin {origin}, {o}", what());
                assert!((direction - d).abs().max_element() < 1e-6, "{}: direction {direction}, {d}", what());
            }
        });
    }
}

/// A chequered sheet of a quarter each way, of 64 x 64 fields; seen from `distance`, aslant, so that it fills the picture: what a lens of 0.05
/// degrees sees of it from 707 units.
pub fn distant_sheet(distance: f32, parallel: bool, lens: Option<f32>) -> Scene {
    let mut scene = empty(64, 64);
    let position = Vec3::new(0.0, 1.0, 1.0).normalize() * distance;
    let height = 0.617;
    let fov = 2.0 * (0.5 * f64::from(height) / f64::from(distance)).atan().to_degrees();
    scene.sensor = pinhole(position, Vec3::ZERO, Vec3::Z, fov as f32);
    if parallel {
        scene.sensor.projection = Projection::Orthographic { height };
    }
    // Sharp in the middle, half a field blurred at the edges.
    scene.sensor.lens =
        lens.map(|blur| Lens { radius: blur * distance, focus_distance: distance, blades: 0, rotation: 0.0 });
    let field = 1.0 / 128.0;
    for colour in 0..2u32 {
        let (mut positions, mut triangles) = (vec![], vec![]);
        for i in (0..64 * 64u32).filter(|i| (i % 64 + i / 64) % 2 == colour) {
            let corner = Vec3::new((i % 64) as f32 * field - 0.25, (i / 64) as f32 * field - 0.25, 0.0);
            let first = positions.len() as u32;
            let (a, b) = (Vec3::X * field, Vec3::Y * field);
            positions.extend([corner, corner + a, corner + a + b, corner + b]);
            triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        let emission = [Vec3::ONE, Vec3::new(0.1, 0.0, 0.0)][colour as usize];
        let material = Material { emission, ..matte(Vec3::ZERO) };
        add(&mut scene, mesh(positions, &triangles), material, Affine3A::IDENTITY);
    }
    scene
}

/// Long lenses far away: rays start in front of the scene, so that a picture of a pixel's size in 1e-8 of the distance is the reference's,
/// sample by sample. Cameras near by start where they did.
#[test]
fn distant_cameras_see_what_the_reference_sees() {
    let centred = Vec2::ZERO;
    for (distance, parallel, lens, shift) in [
        (707.0, false, None, centred),
        (7e5, false, None, Vec2::new(0.25, -0.125)),
        (7e5, true, None, centred),
        (7e4, false, Some(0.1), centred),
        (7e6, true, Some(0.01), Vec2::new(-0.25, 0.125)),
    ] {
        let mut scene = distant_sheet(distance, parallel, lens);
        scene.sensor.shift = shift;
        let bounds = scene.world_bounds();
        let start = scene.sensor.start(&scene.film, bounds);
        assert_eq!(start > 0.0, distance > 1000.0, "{distance}: {start}");
        assert!(!scene.sensor.is_beyond_single_precision(&scene.film, bounds));
        let reference = Reference::new(&scene);
        let expected = pixels(&mut Reference::new(&scene), &scene, 8);
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 8);
            // An edge within a thousandth of a pixel.
            let count = differing(&found, &expected, 2e-4);
            println!("{distance}, {parallel}, {lens:?}, {}: {count} of {} differ", backend.name(), found.len());
            assert!(count <= found.len() / 50, "{distance}, {parallel}, {lens:?}, {}: {count}", backend.name());
            let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
            let calls: Vec<Call> = (0..4096).map(|pixel| [[pixel % 64, pixel / 64, pixel, 1], [0; 4]]).collect();
            for (call, result) in calls.iter().zip(probe.call(Function::SensorRay, &calls).expect("the probe runs")) {
                let [origin, direction] =
                    result.map(|r| DVec3::from([0, 1, 2].map(|k| f64::from(f32::from_bits(r[k])))));
                let (o, d) = reference.sensor_ray(call[0][2], call[0][3]);
                // Where both meet the sheet: to a hundredth of a pixel.
                let [found, expected] = [(origin, direction), (o, d)].map(|(o, d)| o - d * (o.z / d.z));
                assert!((found - expected).length() < 1e-4, "{distance}, {parallel}, {lens:?}: {found} {expected}");
            }
        });
    }
    // With something beside the camera there is no way.
    let mut scene = distant_sheet(7e5, false, None);
    let beside = scene.sensor.position + Vec3::X;
    add(&mut scene, cube(), matte(Vec3::ONE), Affine3A::from_translation(beside));
    assert!(scene.sensor.is_beyond_single_precision(&scene.film, scene.world_bounds()));
}

/// Depths are from the eye point, wherever rays start.
#[test]
fn depths_of_a_distant_camera() {
    use luminaire::film::Tile;
    use luminaire::render::Tracer;
    let mut scene = distant_sheet(7e5, false, None);
    scene.sensor.shift = Vec2::new(0.125, 0.25);
    let tile = Tile { x: 0, y: 0, width: 64, height: 64 };
    let expected = Reference::new(&scene).aovs(tile, 0..1).expect("first hits");
    on_every_backend(|backend| {
        let found = backend.tracer(&scene).aovs(tile, 0..1).expect("first hits");
        for (found, expected) in found.iter().zip(&expected).filter(|(a, b)| a.hits == b.hits) {
            assert!((found.depth - expected.depth).abs() <= 1e-6 * expected.depth, "{found:?} {expected:?}");
        }
        assert!(found.iter().filter(|sum| sum.hits > 0).count() > 1000);
    });
}
