//! Whole pictures: the kernel against the reference and against closed forms, and the two intersectors against each other.

use super::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::film::{Batch, Tile};
use luminaire::reference::Reference;
use luminaire::render::Tracer;
use luminaire::scene::{Integrator, Luminaire, Material, Projection, Scene};

/// Mean of every pixel over samples 0 to `samples`.
pub fn pixels(tracer: &mut dyn Tracer, scene: &Scene, samples: u32) -> Vec<DVec3> {
    let tile = Tile { x: 0, y: 0, width: scene.film.width, height: scene.film.height };
    // Short groups, as a film's are: Mesa before 23 ends the loops of a shader after 65 535 rounds.
    let batch = Batch { tile, samples: 0..samples, group: samples.min(16) };
    let traced = tracer.trace(&batch).expect("the tracer works");
    assert_eq!(traced.dropped, []);
    assert_eq!(traced.sums.iter().map(|sum| sum.dropped).sum::<u32>(), 0, "samples are lost");
    let mut means = vec![DVec3::ZERO; tile.pixels()];
    for (i, sum) in traced.sums.iter().enumerate() {
        means[i % tile.pixels()] += DVec3::from(sum.radiance) / f64::from(samples);
    }
    means
}

/// How many pixels of two pictures differ by more than `tolerance` of the brighter one (or of a hundredth of the mean). Prints by how much: rounding
/// that a device does more of shows as many small differences, a choice that falls otherwise as few large ones.
pub fn differing(a: &[DVec3], b: &[DVec3], tolerance: f64) -> usize {
    let floor = a.iter().map(|p| p.element_sum() / 3.0).sum::<f64>() / a.len() as f64 * 0.01;
    let relative = |(a, b): (&DVec3, &DVec3)| {
        let off = (*a - *b) / a.max(*b).max(DVec3::splat(floor));
        [off.x, off.y, off.z].into_iter().max_by(|x, y| x.abs().total_cmp(&y.abs())).expect("three channels")
    };
    let mut off: Vec<(usize, f64)> = a.iter().zip(b).map(relative).enumerate().collect();
    off.retain(|(_, off)| off.abs() > tolerance);
    off.sort_by(|x, y| y.1.abs().total_cmp(&x.1.abs()));
    if let (Some((worst, largest)), Some((_, middle))) = (off.first(), off.get(off.len() / 2)) {
        let brighter = off.iter().filter(|(_, off)| *off > 0.0).count();
        println!(
            "    {} pixels are off, {brighter} of them brighter, by {:.1e} in the middle; pixel {worst} by {largest:.1e}: {} for {}",
            off.len(),
            middle.abs(),
            a[*worst],
            b[*worst]
        );
    }
    off.len()
}

pub fn mean(pixels: &[DVec3]) -> DVec3 {
    pixels.iter().sum::<DVec3>() / pixels.len() as f64
}

/// Every kind of scene: instances and everything else, a plain mesh, and the simple ray tracer.
fn scenes() -> Vec<(&'static str, Scene)> {
    let room = cornell_like(96, 96);
    let mut sun = cornell_like(96, 96);
    // Without the ceiling and its lamp: open to a luminaire at infinity.
    sun.objects.remove(1);
    sun.objects.remove(5);
    sun.luminaires =
        vec![Luminaire::Infinite { direction: Vec3::new(0.3, -1.0, -0.2).normalize(), irradiance: Vec3::splat(3.0) }];
    let mut plain = empty(96, 96);
    add(
        &mut plain,
        icosphere(3),
        Material { emission: Vec3::splat(0.1), ..matte(Vec3::splat(0.6)) },
        Affine3A::IDENTITY,
    );
    plain.objects[0].material = None;
    plain.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    let mut simple = cornell_like(96, 96);
    simple.integrator = Integrator::Simple { ambient: Vec3::splat(0.3) };
    simple.materials.iter_mut().for_each(|m| m.ambient = m.lambert);
    vec![("room", room), ("sun", sun), ("furnace", plain), ("simple", simple)]
}

/// Same random numbers, at most one bounce: pixel by pixel the picture of the reference, to 2e-4: a direction to a near lamp may be off by
/// 1e-5 (`densities`), which at a grazing angle is more of its cosine. A sample that the two put on different sides of an edge, or whose
/// choice falls on different sides of a limit, shows as a whole: allowed to 1 pixel in 500.
#[test]
fn one_bounce_equals_the_reference_pixel_by_pixel() {
    for (name, mut scene) in scenes() {
        if let Integrator::Path(estimator) = &mut scene.integrator {
            estimator.max_bounces = Some(1);
        }
        let expected = pixels(&mut Reference::new(&scene), &scene, 8);
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 8);
            let count = differing(&found, &expected, 2e-4);
            println!("{name}, {}: {count} of {} pixels differ", backend.name(), found.len());
            assert!(count <= found.len() / 500, "{name}, {}: {count} pixels differ", backend.name());
            let (a, b) = (mean(&found), mean(&expected));
            assert!((a - b).abs().cmple(b * 1e-3).all(), "{name}, {}: means {a} and {b}", backend.name());
        });
    }
}

/// Full paths, other seeds: no pixel differs significantly (Welch's test, corrected for their number), and the means are equal. The mean of a picture
/// is sharp to 1 %, so that one that is off by 6 % is found with a probability above 95 %; most scenes are several times sharper.
#[test]
fn full_paths_have_the_reference_s_distribution() {
    for (name, mut scene) in scenes() {
        scene.film.width = 24;
        scene.film.height = 24;
        let samples = 640;
        let expected = render(&mut Reference::new(&scene), 24, 24, samples, 16);
        scene.settings.seed = 1;
        on_every_backend(|backend| {
            let found = render(&mut backend.tracer(&scene), 24, 24, samples, 16);
            let p = compare(&found, &expected);
            let (a, b) = (total(&found), total(&expected));
            let p_mean = two_sided((a.mean - b.mean) / a.error.hypot(b.error).max(1e-7 * b.mean));
            println!("{name}, {}: pixels p = {p:.3}, means {} and {} p = {p_mean:.3}", backend.name(), a.mean, b.mean);
            assert!(a.error < 1e-2 * a.mean && b.error < 1e-2 * b.mean, "not sharp enough: {a:?} {b:?}");
            assert!(p >= SIGNIFICANCE, "{name}, {}: p = {p:e}", backend.name());
            assert!(p_mean >= SIGNIFICANCE, "{name}, {}: {a:?} {b:?}", backend.name());
        });
    }
}

/// Ray query and compute BVH give one picture: full paths at equal seeds differ only where a ray grazes an edge, which at 16
/// samples and a handful of bounces may touch 1 pixel in 100.
#[test]
fn both_intersectors_give_one_picture() {
    let all = backends();
    let [bvh, query] = all.as_slice() else { return };
    for (name, scene) in scenes() {
        let a = pixels(&mut bvh.tracer(&scene), &scene, 16);
        let b = pixels(&mut query.tracer(&scene), &scene, 16);
        let count = differing(&a, &b, 1e-3);
        println!("{name}: {count} of {} pixels differ", a.len());
        assert!(count <= a.len() / 100, "{name}: {count} pixels differ");
        assert!((mean(&a) - mean(&b)).abs().cmple(mean(&a) * 2e-3).all(), "{name}: {} {}", mean(&a), mean(&b));
    }
    assert_eq!(validation_messages(), 0, "the validation layer complained; see above");
}

/// `Le / (1 - a)` in a closed shell.
#[test]
fn furnace() {
    for albedo in [0.5f32, 0.8] {
        let mut scene = empty(20, 20);
        scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
        let glowing = Material { emission: Vec3::ONE, ..matte(Vec3::splat(albedo)) };
        add(&mut scene, icosphere(3), glowing, Affine3A::IDENTITY);
        on_every_backend(|backend| {
            let image = render(&mut backend.tracer(&scene), 20, 20, 512, 16);
            total(&image).assert_is(1.0 / (1.0 - f64::from(albedo)), 3e-3);
        });
    }
}

/// A point luminaire of intensity pi at the centre of a unit sphere of albedo 0.5: radiance 1 (facets lie inside the sphere by
/// at most 5e-4; see the reference's own test).
#[test]
fn point_luminaire_in_a_sphere() {
    let mut scene = empty(32, 32);
    add(&mut scene, icosphere(5), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    let intensity = Vec3::splat(std::f32::consts::PI);
    scene.luminaires.push(Luminaire::Point { position: Vec3::ZERO, intensity });
    on_every_backend(|backend| {
        let image = render(&mut backend.tracer(&scene), 32, 32, 512, 16);
        total(&image).assert_within(1.0 - 5e-4, 1.0 + 1e-3, 3e-3);
    });
}

/// Light behind a wall stays there, though the wall's vertex normals lean so far that its shading normal sees it.
#[test]
fn light_does_not_leak_through_a_wall() {
    let mut scene = empty(8, 8);
    scene.sensor.projection = Projection::Perspective { fov: 10.0 };
    let mut wall = quad(Vec3::new(-1.0, -1.0, -2.0), Vec3::X * 2.0, Vec3::Y * 2.0);
    wall.normals = vec![Vec3::new(0.0, 0.9, 0.43589).normalize(); 4];
    add(&mut scene, wall, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    for (from, lit) in [(Vec3::new(0.0, 1.0, -0.2), false), (Vec3::new(0.0, 1.0, 0.2), true)] {
        scene.luminaires = vec![Luminaire::Infinite { direction: -from.normalize(), irradiance: Vec3::ONE }];
        let expected = pixels(&mut Reference::new(&scene), &scene, 1);
        assert!(expected.iter().all(|p| (p.x > 0.0) == lit));
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 1);
            assert!(
                found.iter().all(|p| (p.x > 0.0) == lit),
                "{}, light from {from}: {}",
                backend.name(),
                mean(&found)
            );
        });
    }
}

/// Lamps as narrow as a tube light or a finely cut sphere do not shadow themselves: at equal seeds the reference's light.
#[test]
fn narrow_lamps_do_not_shadow_themselves() {
    for width in [1e-2f32, 1e-3, 1e-4] {
        let mut scene = empty(32, 32);
        estimator(&mut scene).max_bounces = Some(0);
        scene.sensor.position = Vec3::new(0.0, 2.0, 3.0);
        scene.sensor.target = Vec3::ZERO;
        let floor = quad(Vec3::new(-2.0, 0.0, -2.0), Vec3::Z * 4.0, Vec3::X * 4.0);
        add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::from_rotation_y(0.3));
        let tilt =
            Affine3A::from_translation(Vec3::Y) * Affine3A::from_rotation_x(0.5) * Affine3A::from_rotation_z(0.4);
        let strip = quad(Vec3::new(-0.5, 0.0, -0.5 * width), Vec3::X, Vec3::Z * width);
        for baked in [false, true] {
            let mut scene = scene.clone();
            let mut strip = strip.clone();
            if baked {
                strip.positions.iter_mut().for_each(|p| *p = tilt.transform_point3(*p));
            }
            add(&mut scene, strip, lamp(Vec3::ONE), if baked { Affine3A::IDENTITY } else { tilt });
            let expected = mean(&pixels(&mut Reference::new(&scene), &scene, 16)).x;
            on_every_backend(|backend| {
                let found = mean(&pixels(&mut backend.tracer(&scene), &scene, 16)).x;
                println!("width {width}, baked {baked}, {}: {:.2e}", backend.name(), found / expected - 1.0);
                assert!((found / expected - 1.0).abs() < 2e-3, "width {width}, {}: {found} {expected}", backend.name());
            });
        }
    }
}

/// Irradiance of a uniform triangle on a floor: Lambert's polygon formula, `E = Le / 2 * sum of angle_i * (n . normal_i)`.
#[test]
fn irradiance_of_a_triangle_lamp() {
    let corners = [Vec3::new(-0.5, 1.0, -0.25), Vec3::new(0.75, 1.5, 0.0), Vec3::new(0.0, 1.25, 1.0)];
    let c = corners.map(|c| c.as_dvec3().normalize());
    let expected = (0..3)
        .map(|i| {
            let (a, b) = (c[i], c[(i + 1) % 3]);
            a.dot(b).acos() * a.cross(b).normalize().y
        })
        .sum::<f64>()
        .abs()
        / 2.0
        * 0.5
        / std::f64::consts::PI;
    let mut scene = empty(16, 16);
    // All pixels look at the origin: the field of view is a speck.
    scene.sensor = pinhole(Vec3::new(0.0, 0.5, -0.25), Vec3::ZERO, Vec3::Z, 1e-3);
    let floor = quad(Vec3::new(-10.0, 0.0, -10.0), Vec3::X * 20.0, Vec3::Z * 20.0);
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    add(&mut scene, mesh(corners.to_vec(), &[[0, 1, 2]]), lamp(Vec3::ONE), Affine3A::IDENTITY);
    on_every_backend(|backend| {
        let image = render(&mut backend.tracer(&scene), 16, 16, 1024, 16);
        total(&image).assert_is(expected, 1e-3);
    });
}

/// A point luminaire straight above a floor: `kd / pi * I / d^2`; and one at infinity: `kd / pi * E cos`.
#[test]
fn inverse_square_and_none_at_infinity() {
    let mut scene = empty(1, 1);
    scene.sensor = pinhole(Vec3::new(0.0, 0.5, -0.25), Vec3::ZERO, Vec3::Z, 1e-3);
    let floor = quad(Vec3::new(-10.0, 0.0, -10.0), Vec3::X * 20.0, Vec3::Z * 20.0);
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let diffuse = 0.5 / std::f64::consts::PI;
    let mut cases = Vec::new();
    for distance in [0.125f32, 1.0, 10.0, 1000.0] {
        let point = Luminaire::Point { position: Vec3::Y * distance, intensity: Vec3::splat(2.0) };
        cases.push((point, diffuse * 2.0 / f64::from(distance).powi(2)));
    }
    for angle in [0.0f32, 0.5, 1.5] {
        let direction = Vec3::new(angle.sin(), -angle.cos(), 0.0);
        cases.push((
            Luminaire::Infinite { direction, irradiance: Vec3::splat(2.0) },
            diffuse * 2.0 * f64::from(angle).cos(),
        ));
    }
    for (luminaire, expected) in cases {
        scene.luminaires = vec![luminaire];
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 1)[0].x;
            // The pixel is a speck around the origin, not a point: 1e-4.
            assert!((found / expected - 1.0).abs() < 1e-4, "{}: {found}, expected {expected}", backend.name());
        });
    }
}

/// Tiles, groups and what ran before do not matter: the same bits.
#[test]
fn the_partition_of_the_work_does_not_matter() {
    let scene = cornell_like(24, 20);
    on_every_backend(|backend| {
        let mut tracer = backend.tracer(&scene);
        let all = Tile { x: 0, y: 0, width: 24, height: 20 };
        let whole = tracer.trace(&Batch { tile: all, samples: 3..19, group: 2 }).expect("traced").sums;
        for (x, y, width, height) in [(0, 0, 5, 20), (5, 0, 19, 3), (5, 3, 19, 17)] {
            let tile = Tile { x, y, width, height };
            // From within what an invocation of the whole takes.
            let part = tracer.trace(&Batch { tile, samples: 6..19, group: 2 }).expect("traced").sums;
            for (index, sum) in part.iter().enumerate() {
                let (group, in_tile) = (2 + index / tile.pixels(), index % tile.pixels());
                let (row, column) = (in_tile / width as usize, in_tile % width as usize);
                assert_eq!(*sum, whole[group * 480 + (y as usize + row) * 24 + x as usize + column]);
            }
        }
    });
}
