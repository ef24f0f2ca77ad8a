//! The pixel filter against its density, the lens against its shape and the plane of focus, both projections.

use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec2, DVec3, Vec2, Vec3};
use luminaire::reference::Reference;
use luminaire::reference::sensor::lens_point;
use luminaire::sampling::{SENSOR_BLOCK, Sampler, random4, uniform};
use luminaire::scene::{Filter, Lens, Projection, Scene};
use std::f64::consts::{PI, TAU};

const FILTERS: [Filter; 4] = [Filter::Box, Filter::Tent, Filter::Gaussian, Filter::BlackmanHarris];

/// A filter's density, not normalised; the radius is 1.
fn density(filter: Filter, x: f64) -> f64 {
    match filter {
        _ if x.abs() > 1.0 => 0.0,
        Filter::Box => 1.0,
        Filter::Tent => 1.0 - x.abs(),
        Filter::Gaussian => (-4.5 * x * x).exp(),
        Filter::BlackmanHarris => {
            let wave = |k: f64| (PI * k * (x + 1.0)).cos();
            0.35875 - 0.48829 * wave(1.0) + 0.14128 * wave(2.0) - 0.01168 * wave(3.0)
        }
    }
}

/// Share of a filter's weight between two places (Simpson's rule with 2000 steps: to 1e-12; the kink of the tent is at a step).
fn weight(filter: Filter, from: f64, to: f64) -> f64 {
    let integral = |from: f64, to: f64| {
        let h = (to - from) / 2000.0;
        let odd: f64 = (0..1000).map(|i| density(filter, from + h * f64::from(2 * i + 1))).sum();
        let even: f64 = (1..1000).map(|i| density(filter, from + h * f64::from(2 * i))).sum();
        (density(filter, from) + 4.0 * odd + 2.0 * even + density(filter, to)) * h / 3.0
    };
    let halves = |from: f64, to: f64| integral(from.min(0.0), to.min(0.0)) + integral(from.max(0.0), to.max(0.0));
    halves(from, to) / halves(-1.0, 1.0)
}

/// Share of the samples below `x`, from the table.
fn table_weight(table: &[f32], x: f64) -> f64 {
    let knot = |i: usize| f64::from(table[i]);
    let i = table.partition_point(|k| f64::from(*k) <= x).clamp(1, 256) - 1;
    ((i as f64 + (x - knot(i)) / (knot(i + 1) - knot(i))) / 256.0).clamp(0.0, 1.0)
}

/// A scene with nothing to see but a distant triangle.
fn scene(width: u32, height: u32) -> Scene {
    let mut scene = empty(width, height);
    add(&mut scene, cube(), matte(Vec3::ONE), Affine3A::from_translation(Vec3::Z * 100.0));
    scene
}

/// Film points of a pixel's samples, in pixels from the pixel's left upper corner, back from the rays of a pinhole.
fn film_points(filter: Filter, radius: f32, samples: u32) -> Vec<DVec2> {
    let mut scene = scene(1, 1);
    (scene.film.filter, scene.film.filter_radius) = (filter, radius);
    scene.sensor = pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, 90.0);
    let tracer = Reference::brute_force(&scene);
    let point = |sample| {
        let (_, d) = tracer.sensor_ray(0, sample);
        DVec2::new(0.5 - 0.5 * d.x / d.z, 0.5 + 0.5 * d.y / d.z)
    };
    (0..samples).map(point).collect()
}

/// Rising, symmetric, from edge to edge, and the inverse of the filter's distribution to the rounding of `f32`.
#[test]
fn filter_table_inverts_the_distribution() {
    for filter in FILTERS {
        for radius in [0.5f32, 1.0, 1.5, 3.7] {
            let table = filter.inverse_cdf(radius);
            assert_eq!(table.len(), 257);
            assert_eq!((table[0], table[128], table[256]), (-radius, 0.0, radius));
            assert!(table.is_sorted_by(|a, b| a < b), "{filter:?}: not rising");
            for (i, x) in table.iter().enumerate() {
                assert_eq!(*x, -table[256 - i], "{filter:?}: not symmetric");
                let found = weight(filter, -1.0, f64::from(*x) / f64::from(radius));
                // Half a unit in the last place of x, times the density, which is at most 2.8.
                assert!((found - i as f64 / 256.0).abs() < 2e-7, "{filter:?}, knot {i}: {found}");
            }
        }
    }
}

/// Between its knots the table is straight. That takes less than 1/512 of a filter's weight to a wrong place (within the outermost
/// of the 256 intervals).
#[test]
fn filter_table_is_fine_enough() {
    for filter in FILTERS {
        let table = filter.inverse_cdf(1.0);
        let off = |i: u32| {
            let x = f64::from(i) / 500.0 - 1.0;
            (table_weight(&table, x) - weight(filter, -1.0, x)).abs()
        };
        let worst = (0..=1000).map(off).fold(0.0, f64::max);
        assert!(worst < 1.0 / 512.0, "{filter:?}: {worst}");
        assert_eq!(worst < 1e-7, filter == Filter::Box, "{filter:?}: {worst}");
    }
}

/// Film points have the filter's density in both coordinates, independently: 20 x 20 cells whose edges have equal shares of the filter's
/// exact weight between them. With 100 000 points the table's straight pieces add less than 2 to the expected chi square (399 +- 28).
#[test]
fn film_points_have_the_filter_s_density() {
    for (filter, radius) in [
        (Filter::Box, 0.5),
        (Filter::Box, 1.25),
        (Filter::Tent, 1.0),
        (Filter::Gaussian, 1.5),
        (Filter::BlackmanHarris, 2.0),
    ] {
        let edges: Vec<f64> = (1..20)
            .map(|i| {
                let (mut low, mut high) = (-1.0, 1.0);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    let below = weight(filter, -1.0, middle) < f64::from(i) / 20.0;
                    *(if below { &mut low } else { &mut high }) = middle;
                }
                low
            })
            .collect();
        let table = filter.inverse_cdf(1.0);
        let shares: Vec<f64> = (0..20)
            .map(|i| {
                let below =
                    |i: usize| if i == 0 { 0.0 } else { edges.get(i - 1).map_or(1.0, |e| table_weight(&table, *e)) };
                below(i + 1) - below(i)
            })
            .collect();
        let excess: f64 =
            shares.iter().flat_map(|a| shares.iter().map(move |b| (a * b - 0.0025).powi(2) / 0.0025)).sum::<f64>()
                * 1e5;
        assert!(excess < 2.0, "{filter:?}: {excess}");
        let mut counts = vec![0u32; 400];
        for p in film_points(filter, radius, 100_000) {
            let p = (p - 0.5) / f64::from(radius);
            assert!(p.abs().max_element() <= 1.0 + 1e-6, "{filter:?}: {p}");
            let [x, y] = [p.x, p.y].map(|x| edges.partition_point(|e| *e < x));
            counts[y * 20 + x] += 1;
        }
        let p = chi_square(&counts);
        assert!(p >= SIGNIFICANCE, "{filter:?}, radius {radius}: p = {p:.1e}");
    }
}

/// The pixel's own square needs no table: the film points are the numbers themselves.
#[test]
fn box_of_one_pixel_is_even_over_the_pixel() {
    for (sample, p) in film_points(Filter::Box, 0.5, 1000).into_iter().enumerate() {
        let random = random4(0, sample as u32, SENSOR_BLOCK, 0);
        assert!((p - DVec2::new(uniform(random[0]), uniform(random[1]))).abs().max_element() < 1e-12);
    }
    // The table of a box only rounds differently.
    let wide = film_points(Filter::Box, 0.5f32.next_up(), 1000);
    for (a, b) in film_points(Filter::Box, 0.5, 1000).into_iter().zip(wide) {
        assert!((a - b).abs().max_element() < 1e-6);
    }
}

/// Another sampler gives other rays, of the same pixel.
#[test]
fn rays_follow_the_sampler() {
    let mut scene = scene(4, 4);
    scene.settings.sampler = Sampler::Sobol;
    let tracer = Reference::brute_force(&scene);
    // The film points of an aligned run of 16 samples fall one in each sixteenth of the pixel.
    let mut seen = [false; 16];
    for sample in 32..48 {
        let (_, d) = tracer.sensor_ray(5, sample);
        let scale = 2.0 / 30f64.to_radians().tan();
        let cell = DVec2::new(1.0 - d.x / d.z * scale, 1.0 + d.y / d.z * scale) * 4.0;
        seen[(cell.y as usize) * 4 + cell.x as usize] = true;
    }
    assert_eq!(seen, [true; 16]);
}

/// Apertures are covered evenly: in the disk, squared radius and azimuth are uniform and independent; in a polygon, so are the squared
/// distance towards the edge (1 at it), the place along that edge, and the blade.
#[test]
fn lens_points_are_uniform() {
    for (blades, rotation) in [(0, 0.0), (0, 33.0), (3, 0.0), (4, 45.0), (5, 10.0), (6, 0.0), (7, -400.0), (17, 3.0)] {
        let lens = Lens { radius: 0.75, focus_distance: 3.0, blades, rotation };
        let sectors = blades.max(1);
        let mut counts = vec![0u32; 100 * sectors as usize];
        let cell = |x: f64| ((x * 10.0) as usize).min(9);
        for i in 0..20_000 * sectors {
            let random = random4(i, 0, SENSOR_BLOCK, blades);
            let p = lens_point(&lens, random[2], random[3]) / 0.75;
            let (a, b, sector) = if blades == 0 {
                (p.length_squared(), p.to_angle() / TAU + 0.5, 0)
            } else {
                // Turned back, the first corner is at (1, 0); within its sector, the edge is at x = cos(half).
                let half = PI / f64::from(blades);
                let angle = (p.to_angle() - f64::from(rotation).to_radians()).rem_euclid(TAU);
                let sector = ((angle / (2.0 * half)) as u32).min(blades - 1);
                let local = DVec2::from_angle(angle - half * f64::from(2 * sector + 1)) * p.length();
                let towards = local.x / half.cos();
                (towards * towards, 0.5 + 0.5 * local.y / (towards * half.sin()), sector)
            };
            assert!(
                (-1e-9..1.0 + 1e-9).contains(&a) && (-1e-9..1.0 + 1e-9).contains(&b),
                "{blades} blades: {p} ({a}, {b})"
            );
            counts[sector as usize * 100 + cell(a) * 10 + cell(b)] += 1;
        }
        let p = chi_square(&counts);
        assert!(p >= SIGNIFICANCE, "{blades} blades: p = {p:.1e}");
    }
    // Every number gives a point, the extremes included.
    for blades in [0, 3, 8, 1000] {
        let lens = Lens { radius: 1.0, focus_distance: 1.0, blades, rotation: 0.0 };
        for [u, v] in [[0, 0], [u32::MAX, 0], [0, u32::MAX], [u32::MAX; 2], [1 << 31; 2]] {
            assert!(lens_point(&lens, u, v).length() <= 1.0 + 1e-12);
        }
    }
    // The first corner lies to the right, turned counter-clockwise by the rotation.
    let lens = Lens { radius: 2.0, focus_distance: 1.0, blades: 4, rotation: 30.0 };
    let corner = DVec2::from_angle(30f64.to_radians()) * 2.0;
    assert!(
        (0..100_000)
            .any(|i| lens_point(&lens, (i * 40_000) << 2, i.wrapping_mul(40_503 << 16)).distance(corner) < 0.05)
    );
}

/// A camera that looks along no axis, with a lens: (scene, unit axes: right, up, forward).
fn with_lens(projection: Projection, lens: Option<Lens>) -> (Scene, [DVec3; 3]) {
    let mut scene = scene(16, 8);
    scene.sensor = pinhole(Vec3::new(1.0, 2.0, -3.0), Vec3::new(4.0, 1.5, 2.0), Vec3::new(0.1, 1.0, 0.0), 40.0);
    (scene.sensor.projection, scene.sensor.lens) = (projection, lens);
    let forward = (scene.sensor.target.as_dvec3() - scene.sensor.position.as_dvec3()).normalize();
    let right = forward.cross(scene.sensor.up.as_dvec3()).normalize();
    (scene, [right, right.cross(forward), forward])
}

/// The same pixel and sample with and without a lens have the same film point: their rays meet in the plane of focus, and start in
/// the aperture.
#[test]
fn rays_of_a_film_point_meet_in_the_plane_of_focus() {
    for projection in [Projection::Perspective { fov: 40.0 }, Projection::Orthographic { height: 3.0 }] {
        for (blades, shift) in [(0, Vec2::ZERO), (5, Vec2::ZERO), (5, Vec2::new(0.75, -1.5))] {
            let lens = Lens { radius: 0.3, focus_distance: 5.0, blades, rotation: 20.0 };
            let (mut scene, [right, up, forward]) = with_lens(projection, Some(lens));
            let (mut sharp, _) = with_lens(projection, None);
            (scene.sensor.shift, sharp.sensor.shift) = (shift, shift);
            let (through, pinhole) = (Reference::brute_force(&scene), Reference::brute_force(&sharp));
            let position = scene.sensor.position.as_dvec3();
            for pixel in 0..128 {
                for sample in 0..20 {
                    let (o, d) = through.sensor_ray(pixel, sample);
                    let (o0, d0) = pinhole.sensor_ray(pixel, sample);
                    assert!((d.length() - 1.0).abs() < 1e-14);
                    let at_focus = |o: DVec3, d: DVec3| o + d * (5.0 - (o - position).dot(forward)) / d.dot(forward);
                    assert!(at_focus(o, d).distance(at_focus(o0, d0)) < 1e-13);
                    let random = random4(pixel, sample, SENSOR_BLOCK, 0);
                    let point = lens_point(&lens, random[2], random[3]);
                    assert!((o - o0).distance(right * point.x + up * point.y) < 1e-14);
                }
            }
        }
    }
}

/// A point at distance `d` in front of a lens of radius `R` that is focused at `f` spreads over a disk in the picture: seen from the lens
/// point `l` (at distance `|l|` from the axis) it covers the point `l (1 - f / d)` of the plane of focus, so its radius there is
/// `R |d - f| / d`, and that over `f` in the picture at distance 1.
#[test]
fn circle_of_confusion() {
    let (width, height, fov, focus, radius) = (64, 64, 30f32, 4.0, 0.5f32);
    let pixels = f64::from(height) / (2.0 * f64::from(0.5 * fov).to_radians().tan());
    for d in [2.0, 3.0, 6.0, 40.0] {
        let mut scene = scene(width, height);
        scene.sensor = pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, fov);
        let pinhole = Reference::brute_force(&scene);
        scene.sensor.lens = Some(Lens { radius, focus_distance: focus, blades: 0, rotation: 0.0 });
        let tracer = Reference::brute_force(&scene);
        let f = f64::from(focus);
        let confusion = f64::from(radius) * (d - f).abs() / (d * f) * pixels;
        assert!(confusion > 4.0 && confusion < 20.0, "{confusion} pixels are no test");
        // A bright disk at that distance, 0.3 times as large as the circle.
        let bright = 0.3 * confusion * d / pixels;
        let mut seen = Vec::new();
        for pixel in 0..width * height {
            for sample in 0..600 {
                let (o, direction) = tracer.sensor_ray(pixel, sample);
                let p = o + direction * (d / -direction.z);
                if p.truncate().length() < bright {
                    let (_, film) = pinhole.sensor_ray(pixel, sample);
                    seen.push((film.truncate() / film.z).length_squared() * pixels * pixels);
                }
            }
        }
        // Mean square distance in an even disk is half its squared radius, and those of independent offsets add up.
        let expected = 0.5 * confusion * confusion * 1.09;
        Estimate::new(seen.into_iter()).assert_is(expected, 0.02);
        // In space: rays of one film point cover a disk of radius R |d - f| / f around the line through the eye point.
        let mut largest = 0.0f64;
        for sample in 0..20_000 {
            let (o, direction) = tracer.sensor_ray(20 * width + 40, sample);
            let at = |distance: f64| o + direction * ((distance + o.z) / -direction.z);
            largest = largest.max(at(d).distance(at(f) * (d / f)));
        }
        let expected = f64::from(radius) * (d - f).abs() / f;
        assert!((0.99..1.0 + 1e-12).contains(&(largest / expected)), "{largest} {expected}");
    }
}

/// A shift of one height upwards shows what is above the picture, and is no turn: a vertical line stays vertical.
#[test]
fn a_shift_moves_the_picture_and_turns_nothing() {
    let mut scene = scene(8, 8);
    scene.film.filter_radius = 1e-6;
    scene.sensor = pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, 90.0);
    scene.sensor.shift = Vec2::new(0.5, 1.0);
    let tracer = Reference::brute_force(&scene);
    for pixel in 0..64 {
        let (o, d) = tracer.sensor_ray(pixel, 0);
        let (column, row) = (f64::from(pixel % 8) + 0.5, f64::from(pixel / 8) + 0.5);
        // The picture at distance 1 is 2 wide and high: from 0 to 2 to the right, from 1 to 3 above.
        let expected = DVec3::new(column / 4.0, 3.0 - row / 4.0, -1.0);
        assert!(o == DVec3::ZERO && (d / -d.z).distance(expected) < 1e-5, "{pixel}: {d}");
    }
}

/// Parallel rays along the line of sight, whose origins lie in the plane through the eye point, spaced by the picture's height over the
/// film's: square pixels, the first at the upper left.
#[test]
fn parallel_rays() {
    let (scene, [right, up, forward]) = with_lens(Projection::Orthographic { height: 3.0 }, None);
    let tracer = Reference::brute_force(&scene);
    let position = scene.sensor.position.as_dvec3();
    for pixel in 0..128 {
        for sample in 0..20 {
            let (o, d) = tracer.sensor_ray(pixel, sample);
            assert!(d.distance(forward) < 1e-15);
            let random = random4(pixel, sample, SENSOR_BLOCK, 0);
            let x = f64::from(pixel % 16) + uniform(random[0]) - 8.0;
            let y = 4.0 - f64::from(pixel / 16) - uniform(random[1]);
            assert!(o.distance(position + (right * x + up * y) * (3.0 / 8.0)) < 1e-14);
        }
    }
}
