//! Whole paths: closed forms for closed rooms, self-intersection, and what the result may depend on.

use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::film::{Batch, PixelSum, Rays, Tile};
use luminaire::reference::Reference;
use luminaire::reference::warp::{cosine_hemisphere, uniform_triangle};
use luminaire::render::Tracer;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Estimator, Integrator, Luminaire, LuminaireTable, Material, SampledLuminaire, Scene};
use rayon::prelude::*;
use std::f64::consts::PI;

/// A closed shell around the sensor that emits 1.
pub fn furnace(albedo: Vec3) -> Scene {
    let mut scene = empty(16, 16);
    scene.integrator = preset("cosine");
    scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    scene.sensor.target = Vec3::new(0.5, -1.0, 0.25);
    let glowing = Material { emission: Vec3::ONE, ..matte(albedo) };
    add(&mut scene, icosphere(3), glowing, Affine3A::IDENTITY);
    scene
}

pub fn preset(name: &str) -> Integrator {
    Integrator::Path(Estimator::preset(name).expect("a preset"))
}

/// Mean of each channel over all pixels and samples.
pub fn means(scene: &Scene, samples: u32) -> [Estimate; 3] {
    let tracer = Reference::new(scene);
    let pixels = scene.film.width * scene.film.height;
    let all: Vec<DVec3> =
        (0..samples * pixels).into_par_iter().map(|i| tracer.radiance(i % pixels, i / pixels).0).collect();
    [0, 1, 2].map(|channel| Estimate::new(all.iter().map(|l| l[channel])))
}

/// `Le / (1 - a)`, in any closed shell, whatever the albedo of the other channels.
#[test]
fn furnace_of_any_albedo() {
    for albedo in [Vec3::splat(0.5), Vec3::splat(0.8), Vec3::new(0.2, 0.5, 0.8)] {
        let found = means(&furnace(albedo), 250);
        for (channel, estimate) in found.into_iter().enumerate() {
            estimate.assert_is(1.0 / (1.0 - f64::from(albedo[channel])), 5e-3);
        }
    }
}

/// A limit of `k` bounces cuts the furnace's series after `a^(k + 1)`.
#[test]
fn furnace_with_limited_bounces() {
    for bounces in [0, 1, 2, 5] {
        let mut scene = furnace(Vec3::splat(0.7));
        estimator(&mut scene).max_bounces = Some(bounces);
        let a = f64::from(0.7f32);
        means(&scene, 200)[0].assert_is((0..=bounces as i32 + 1).map(|k| a.powi(k)).sum(), 5e-3);
    }
}

/// A point luminaire of intensity pi at the centre of a unit sphere of albedo 0.5: radiance 1.
///
/// Corners lie on the sphere and facets at a distance of at least `h` inside it, so the irradiance `pi h' / d^3` is
/// between `pi h` and `pi / h^2`, and with it (the reflected light is an average) the radiance between `h` and `1 / h^2`.
#[test]
fn point_luminaire_in_a_sphere() {
    let mut scene = empty(16, 16);
    let ball = icosphere(5);
    let h = ball.triangles.iter().map(|t| {
        let [a, b, c] = t.vertices.map(|v| ball.positions[v as usize].as_dvec3());
        (b - a).cross(c - a).normalize().dot(a).abs()
    });
    let h = h.fold(1.0, f64::min);
    assert!(h > 1.0 - 5e-4);
    add(&mut scene, ball, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    let intensity = Vec3::splat(std::f32::consts::PI);
    scene.luminaires.push(Luminaire::Point { position: Vec3::ZERO, intensity });
    for estimate in means(&scene, 800) {
        estimate.assert_within(h, h.powi(-2), 3e-3);
    }
}

/// Which random number decides what: two bounces in a shell with two lamps, step by step.
#[test]
fn random_numbers_decide_what_the_table_says() {
    let mut scene = empty(16, 16);
    add(&mut scene, icosphere(2), matte(Vec3::new(0.5, 0.6, 0.7)), Affine3A::IDENTITY);
    for (x, light) in [(0.25, Vec3::new(3.0, 2.0, 1.0)), (-0.5, Vec3::new(1.0, 1.0, 4.0))] {
        let place = Affine3A::from_translation(Vec3::new(x, 0.0, -0.5)) * Affine3A::from_scale(Vec3::splat(0.2));
        add(&mut scene, mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]), lamp(light), place);
    }
    scene.integrator = preset("cosine");
    estimator(&mut scene).max_bounces = Some(1);
    let table = LuminaireTable::new(&scene);
    let (mut lit, mut second) = (0, 0);
    for seed in [0, 77] {
        scene.settings.seed = seed;
        let tracer = Reference::new(&scene);
        for (pixel, sample) in (0..1024).map(|i| (i % 256, 3 * i)) {
            let numbers = |block: u32| random4(pixel, sample, block, seed);
            let (mut origin, mut direction) = tracer.sensor_ray(pixel, sample);
            let (mut expected, mut throughput) = (DVec3::ZERO, DVec3::ONE);
            for bounce in [0, 1] {
                let hit = tracer.closest_hit(origin, direction, f64::INFINITY, 0).expect("a closed shell");
                let surfel = tracer.surfel(&hit, -direction);
                if bounce == 0 {
                    expected += surfel.emission;
                }
                let light = numbers(1 + 2 * bounce);
                let chosen = table.choice.choose(light[2]);
                let SampledLuminaire::Area(triangle) = &table.entries[chosen] else { panic!("lamps only") };
                let weights = uniform_triangle(uniform(light[0]), uniform(light[1]));
                let point: DVec3 = (0..3).map(|i| weights[i] * triangle.vertices[i]).sum();
                let d = point - surfel.position;
                let cosines = d.normalize().dot(surfel.geometric_normal).max(0.0) * d.normalize().z.abs();
                if !tracer.occluded(point - 0.999 * d, d, 0.998, 0) {
                    let share = cosines * triangle.area() / d.length_squared() / table.choice.pdf[chosen];
                    let emission = scene.materials[triangle.material as usize].emission.as_dvec3();
                    expected += throughput * surfel.lambert / PI * emission * share;
                    lit += 1;
                }
                let survival = surfel.lambert.max_element();
                let turn = numbers(2 + 2 * bounce);
                if uniform(turn[3]) >= survival {
                    break;
                }
                direction = cosine_hemisphere(surfel.shading_normal, uniform(turn[0]), uniform(turn[1]));
                origin = surfel.offset_ray_origin(direction);
                throughput *= surfel.lambert / survival;
                second += bounce;
            }
            let (found, _) = tracer.radiance(pixel, sample);
            assert!((found - expected).length() <= 1e-12 * expected.length(), "{found} instead of {expected}");
        }
    }
    assert!(lit > 2000 && second > 500, "{lit} and {second}: the test tests little");
}

/// The simple ray tracer: emission, direct light and the ambient term; one ray and one shadow ray.
#[test]
fn simple_integrator_adds_the_ambient_term() {
    let mut scene = empty(4, 4);
    let material =
        Material { ambient: Vec3::new(0.1, 0.2, 0.3), emission: Vec3::splat(0.25), ..matte(Vec3::splat(0.5)) };
    add(&mut scene, quad(Vec3::new(-9.0, -9.0, -2.0), Vec3::X * 18.0, Vec3::Y * 18.0), material, Affine3A::IDENTITY);
    scene.luminaires.push(Luminaire::Infinite { direction: -Vec3::Z, irradiance: Vec3::splat(std::f32::consts::PI) });
    scene.integrator = Integrator::Simple { ambient: Vec3::splat(2.0) };
    let tracer = Reference::new(&scene);
    // The panel does not light itself, but is chosen now and then in place of the luminaire at infinity.
    let all: Vec<_> = (0..20_000).map(|sample| tracer.radiance(5, sample)).collect();
    assert!(all.iter().all(|(_, rays)| rays.all == 1 || rays.all == 2));
    for (channel, ambient) in [0.1f32, 0.2, 0.3].into_iter().enumerate() {
        let mean = Estimate::new(all.iter().map(|(radiance, _)| radiance[channel]));
        let direct = 0.5 * f64::from(std::f32::consts::PI) / std::f64::consts::PI;
        mean.assert_is(0.25 + direct + 2.0 * f64::from(ambient), 3e-3);
    }
}

/// In a convex shell every point sees the centre and no point sees its own triangle, at any scale, place and angle.
#[test]
fn surfaces_do_not_shadow_or_hit_themselves() {
    let stretched = Affine3A::from_rotation_x(0.5) * Affine3A::from_scale(Vec3::new(1.0, 0.01, 1.0));
    let mut shell = empty(32, 32);
    add(&mut shell, icosphere(3), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    shell.luminaires.push(Luminaire::Point { position: Vec3::ZERO, intensity: Vec3::ONE });
    shell.sensor.projection = luminaire::scene::Projection::Perspective { fov: 150.0 };
    let mut flat = shell.clone();
    flat.objects[0].object_to_world = stretched;
    for (scale, shift) in [
        (1.0, Vec3::ZERO),
        (1.0, Vec3::new(1e5, -1e5, 1e5)),
        (1e3, Vec3::ZERO),
        (1e-3, Vec3::ZERO),
        (1e-3, Vec3::X * 8.0),
    ] {
        for scene in [&shell, &flat] {
            let scene = transformed(scene, scale, shift);
            let tracer = Reference::new(&scene);
            for i in 0..20_000 {
                let (origin, direction) = tracer.sensor_ray(i % 1024, i / 1024);
                let hit = tracer.closest_hit(origin, direction, f64::INFINITY, 0).expect("a closed shell");
                let surfel = tracer.surfel(&hit, -direction);
                let mut rays = Rays::default();
                let light = tracer.direct_light(&surfel, -direction, DVec3::ONE, [0; 4], 0, &mut rays);
                assert!(
                    light.x > 0.0 && rays == Rays { all: 1, shadow: 1 },
                    "the shell shadows itself at {}",
                    surfel.position
                );
                // Along the normal, slanted, and grazing down to a millionth.
                let (tangent, _) = luminaire::reference::warp::frame(surfel.geometric_normal);
                for rise in [1.0, 0.1, 1e-3, 1e-6] {
                    let wi = (tangent + rise * surfel.geometric_normal).normalize();
                    let next = tracer.closest_hit(surfel.offset_ray_origin(wi), wi, f64::INFINITY, 0);
                    let next = next.unwrap_or_else(|| panic!("a ray leaves the shell at {}", surfel.position));
                    assert_ne!(next.triangle, hit.triangle, "hits itself at rise {rise}, t = {}", next.t);
                }
            }
        }
    }
}

/// Largest difference of two pictures relative to their mean.
fn largest_difference(a: &Image, b: &Image) -> f64 {
    let differences = a.mean.iter().flatten().zip(b.mean.iter().flatten()).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / total(a).mean
}

/// A room is as bright when it stands elsewhere or is built larger, sample by sample.
#[test]
fn pictures_do_not_depend_on_place_and_scale() {
    let scene = cornell_like(24, 24);
    let picture = |scene: &Scene| render(&mut Reference::new(scene), 24, 24, 16, 4);
    let here = picture(&scene);
    // Powers of two are exact. The others round the f32 scene: 1e-5 of a pixel's mean is what that may change, where no
    // sample crosses an edge.
    for (scale, shift, tolerance) in [
        (1.0 / 1024.0, Vec3::ZERO, 1e-12),
        (1024.0, Vec3::ZERO, 1e-12),
        (1.0, Vec3::new(131_072.0, -131_072.0, 65_536.0), 1e-6),
        (1.0, Vec3::new(1e5, -1e5, 1e5), 1e-6),
        (1e3, Vec3::ZERO, 1e-3),
        (1e-3, Vec3::ZERO, 1e-3),
    ] {
        let there = picture(&transformed(&scene, scale, shift));
        let largest = largest_difference(&here, &there);
        assert!(largest <= tolerance, "scale {scale}, shift {shift}: {largest:e}");
    }
}

/// Trees or brute force, few or many threads, tiles, groups: the same samples to the last bit.
#[test]
fn the_partition_of_the_work_does_not_matter() {
    let scene = cornell_like(12, 10);
    let mut tracer = Reference::new(&scene);
    let all = Tile { x: 0, y: 0, width: 12, height: 10 };
    let whole = tracer.trace(&Batch { tile: all, samples: 3..19, group: 2 }).expect("traced").sums;
    // The first begins in the middle, and the last ends there.
    assert_eq!(whole.len(), 9 * 120);

    let brute =
        Reference::brute_force(&scene).trace(&Batch { tile: all, samples: 3..19, group: 2 }).expect("traced").sums;
    assert_eq!(whole, brute);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let single = pool.install(|| tracer.trace(&Batch { tile: all, samples: 3..19, group: 2 })).expect("traced").sums;
    assert_eq!(whole, single);

    for (x, y, width, height) in [(0, 0, 5, 10), (5, 0, 7, 3), (5, 3, 7, 7)] {
        let tile = Tile { x, y, width, height };
        let sums = tracer.trace(&Batch { tile, samples: 3..19, group: 2 }).expect("traced").sums;
        for (index, sum) in sums.iter().enumerate() {
            let (group, in_tile) = (index / tile.pixels(), index % tile.pixels());
            let (row, column) = (in_tile / width as usize, in_tile % width as usize);
            assert_eq!(*sum, whole[group * 120 + (y as usize + row) * 12 + x as usize + column]);
        }
    }
    // One by one; then groups that do not divide the samples.
    let single = tracer.trace(&Batch { tile: all, samples: 3..19, group: 1 }).expect("traced").sums;
    let uneven = tracer.trace(&Batch { tile: all, samples: 3..19, group: 3 }).expect("traced").sums;
    let add = |sums: &[PixelSum], groups: &[usize], pixel: usize| {
        groups.iter().fold(PixelSum::default(), |mut total, group| {
            let sum = sums[group * 120 + pixel];
            total.radiance = [0, 1, 2].map(|c| total.radiance[c] + sum.radiance[c]);
            total.rays += sum.rays;
            total
        })
    };
    for pixel in 0..120 {
        // Groups begin at multiples of their length.
        assert_eq!(add(&single, &[0], pixel), whole[pixel]);
        assert_eq!(add(&single, &[1, 2], pixel), whole[120 + pixel]);
        assert_eq!(add(&single, &[13, 14], pixel), whole[7 * 120 + pixel]);
        assert_eq!(add(&single, &[15], pixel), whole[8 * 120 + pixel]);
        assert_eq!(add(&single, &[0, 1, 2], pixel), uneven[pixel]);
        assert_eq!(add(&single, &[12, 13, 14], pixel), uneven[4 * 120 + pixel]);
        assert_eq!(add(&single, &[15], pixel), uneven[5 * 120 + pixel]);
    }
}

/// Samples that are not finite are left out, counted and named.
#[test]
fn non_finite_samples_are_counted() {
    let mut scene = furnace(Vec3::splat(0.5));
    scene.materials[0].emission = Vec3::new(f32::NAN, 1.0, 1.0);
    estimator(&mut scene).max_bounces = Some(0);
    let tile = Tile { x: 0, y: 0, width: 16, height: 16 };
    let traced = Reference::new(&scene).trace(&Batch { tile, samples: 0..3, group: 3 }).expect("traced");
    assert_eq!(traced.dropped.len(), 3 * 256);
    assert!(traced.sums.iter().all(|s| s.radiance == [0.0; 3] && s.rays.all > 0 && s.dropped == 3));
}

/// Pictures with different seeds agree within their own uncertainty, and one with a slightly different wall does not.
#[test]
fn pictures_agree_within_their_uncertainty() {
    let picture = |seed: u32, wall: f32| {
        let mut scene = cornell_like(16, 16);
        scene.settings.seed = seed;
        scene.materials[0].lambert = Vec3::splat(wall);
        render(&mut Reference::new(&scene), 16, 16, 1024, 32)
    };
    let first = picture(1, 0.7);
    let p = compare(&first, &picture(2, 0.7));
    assert!(p >= SIGNIFICANCE, "p = {p:.1e}");
    let p = compare(&first, &picture(2, 0.9));
    assert!(p < SIGNIFICANCE, "a brighter floor goes unnoticed: p = {p:.1e}");
}
