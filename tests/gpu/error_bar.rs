//! What a render knows of its own error, on every backend: dropped samples, the estimated error.

use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, Vec3};
use luminaire::film::{Batch, Film, Tile};
use luminaire::picture::Picture;
use luminaire::reference::Reference;
use luminaire::render::{End, Limits, Rendered, Tracer, render};
use luminaire::scene::{Luminaire, Material, Scene};
use luminaire_measure::metrics::compare;
use std::sync::atomic::AtomicBool;

/// A floor below a point luminaire whose radiance overflows `f32` in some pixels: in the reference, which computes in `f64`, when it is
/// rounded to the picture's `f32`.
fn overflowing(size: u32) -> Scene {
    let mut scene = empty(size, size);
    add(
        &mut scene,
        quad(Vec3::new(-4.0, -1.0, -6.0), Vec3::Z * 8.0, Vec3::X * 8.0),
        matte(Vec3::splat(0.5)),
        Affine3A::IDENTITY,
    );
    scene.sensor = pinhole(Vec3::ZERO, Vec3::new(0.0, -1.0, -3.0), Vec3::Y, 15.0);
    scene.luminaires.push(Luminaire::Point { position: Vec3::new(0.0, -0.75, -3.0), intensity: Vec3::splat(3e38) });
    estimator(&mut scene).max_bounces = Some(0);
    scene
}

#[test]
fn samples_that_are_not_finite_are_dropped_and_named() {
    let scene = overflowing(32);
    let tile = Tile { x: 0, y: 0, width: 32, height: 32 };
    let batch = Batch { tile, samples: 0..8, group: 2 };
    let expected = luminaire::reference::Reference::new(&scene).trace(&batch).expect("the reference works");
    let count = |sums: &[luminaire::film::PixelSum]| sums.iter().map(|s| s.dropped).sum::<u32>();
    assert!(count(&expected.sums) > 20 && expected.dropped.len() == count(&expected.sums) as usize);
    on_every_backend(|backend| {
        let mut tracer = backend.tracer(&scene);
        let traced = tracer.trace(&batch).expect("the tracer works");
        // Here the irradiance is too large already, before the albedo makes the radiance smaller.
        assert!(count(&traced.sums) >= count(&expected.sums), "{}", backend.name());
        assert!(traced.sums.iter().all(|s| s.radiance.iter().all(|v| v.is_finite())));
        assert_eq!(traced.dropped.len(), 15, "as many as there is room for");
        assert!(traced.dropped.is_sorted());
        // By its name a sample is found again.
        for id in &traced.dropped {
            let tile = Tile { x: id.pixel % 32, y: id.pixel / 32, width: 1, height: 1 };
            let samples = id.sample..id.sample + 1;
            let alone = tracer.trace(&Batch { tile, samples, group: 1 }).expect("the tracer works");
            assert_eq!(alone.dropped, [*id]);
        }
    });
}

/// The picture of what is left is finite, and the same samples are dropped however the render is cut.
#[test]
fn a_film_with_dropped_samples_is_finite() {
    let scene = overflowing(16);
    on_every_backend(|backend| {
        let limits = Limits { spp: Some(16), ..Limits::default() };
        let rendered = render(&mut backend.tracer(&scene), (16, 16), limits, &mut |_| {}, &AtomicBool::new(false))
            .expect("the film fits");
        assert!(rendered.dropped > 20 && !rendered.dropped_samples.is_empty(), "{}", rendered.dropped);
        assert_eq!(rendered.film.dropped.values().map(|n| u64::from(*n)).sum::<u64>(), rendered.dropped);
        assert!(rendered.film.to_linear().iter().all(|v| v.is_finite()));
    });
}

/// `Limits::noise` ends a render, and the error is then about what was promised.
#[test]
fn a_noise_limit_is_met() {
    let scene = |seed| {
        let mut scene = cornell_like(32, 32);
        scene.settings.sampler = luminaire::scene::Sampler::Sobol;
        scene.settings.seed = seed;
        scene
    };
    on_every_backend(|backend| {
        let run = |seed, limits| {
            render(&mut backend.tracer(&scene(seed)), (32, 32), limits, &mut |_| {}, &AtomicBool::new(false))
                .expect("it fits")
        };
        let promise = 0.1;
        let rendered = run(0, Limits { noise: Some(promise), ..Limits::default() });
        assert!(matches!(rendered.end, End::Noise));
        let error = rendered.progress.error.expect("an estimate");
        // Between two looks the error falls by a tenth at most.
        assert!(error.careful() <= promise && error.careful() > 0.85 * promise, "{error:?}");
        // Against 16 times as many other samples.
        let spp = rendered.film.most_samples();
        let truth = run(1, Limits { spp: Some(16 * spp), ..Limits::default() }).film;
        let fireflies = rendered.film.error_map().expect("an estimate").firefly;
        let pixels = (0..truth.pixels()).filter(|pixel| !fireflies[*pixel]);
        let values = pixels.flat_map(|pixel| std::iter::zip(rendered.film.mean(pixel), truth.mean(pixel)));
        let (mut sum, mut n, brightness) = (0.0, 0.0, truth.brightness());
        for (found, expected) in values {
            sum += brightness.relative_square(found - expected, expected);
            n += 1.0;
        }
        let relative = (sum / n).sqrt();
        println!("{}: {spp} samples, {error:?}, against 16 times as many {relative}", backend.name());
        // The truth's own error adds 3 %. The limit is met with care, so the error is below it.
        assert!((0.7..1.1).contains(&(relative / promise)), "{relative}");
    });
}

/// Runs a test on the reference and on every backend: a name, and what makes a tracer of a scene.
fn on_the_reference_and_every_backend(test: impl Fn(&str, &dyn Fn(&Scene) -> Box<dyn Tracer>)) {
    test("reference", &|scene| Box::new(Reference::new(scene)));
    on_every_backend(|backend| test(backend.name(), &|scene| Box::new(backend.tracer(scene))));
}

fn rendered(tracer: &mut dyn Tracer, size: u32, limits: Limits) -> Rendered {
    render(tracer, (size, size), limits, &mut |_| {}, &AtomicBool::new(false)).expect("the film fits")
}

fn picture(film: &Film) -> Picture {
    let rgb = film.to_linear().as_chunks().0.to_vec();
    Picture { width: film.width, height: film.height, rgb, error: None, clamped: false, warnings: vec![] }
}

/// The same scene in another unit of light: the same error, the same map of it, the same fireflies, the same end by a limit of the noise, and the same distance
/// from another picture. Powers of two change no digit, powers of ten only roundings.
#[test]
fn the_unit_of_light_does_not_show() {
    const SIZE: u32 = 16;
    // Points, lamps, glass and mirrors; the sky.
    let scenes = [
        (glass_room(SIZE, SIZE), [(1e-6f32, 1e-3), (2f32.powi(20), 1e-9)]),
        (open_air(SIZE, SIZE), [(1e6, 1e-3), (0.5f32.powi(20), 1e-9)]),
    ];
    for (mut scene, units) in scenes {
        estimator(&mut scene).max_bounces = Some(8);
        on_the_reference_and_every_backend(|name, open| {
            let numbers = |unit: f32| {
                let mut tracer = open(&brighter(&scene, unit));
                let film = rendered(tracer.as_mut(), SIZE, Limits { spp: Some(32), ..Limits::default() }).film;
                let errors = film.error_map().expect("samples");
                let total = errors.total.expect("light");
                let limits = Limits { noise: Some(0.8 * total.relative()), ..Limits::default() };
                let quiet = rendered(tracer.as_mut(), SIZE, limits).film;
                let apart = compare(&picture(&film), &picture(&quiet), 0).expect("one size");
                let map = errors.relative.iter().map(|e| f64::from(e * e)).sum::<f64>();
                let counts = [total.fireflies, quiet.most_samples().into()];
                (counts, [total.rel_mse, total.rel_mse_with_fireflies, map, apart.relmse, total.rmse / f64::from(unit)])
            };
            let (counts, expected) = numbers(1.0);
            assert!(counts[1] > 32, "{name}: the limit of the noise was met at once: {counts:?}");
            for (unit, slack) in units {
                let (found_counts, found) = numbers(unit);
                assert_eq!(found_counts, counts, "{name} in units of {unit}");
                for (found, expected) in found.iter().zip(expected) {
                    assert!(
                        (found / expected - 1.0).abs() < slack,
                        "{name} in units of {unit}: {found} for {expected}"
                    );
                }
            }
        });
    }
}

/// A point luminaire in a ball of glass: black on every backend, and no error is estimated of that.
#[test]
fn a_picture_without_its_light_has_no_estimate() {
    let mut scene = empty(8, 8);
    let floor = quad(Vec3::new(-4.0, -1.0, -8.0), Vec3::Z * 8.0, Vec3::X * 8.0);
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let glass = Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::ZERO) };
    add(&mut scene, icosphere(1), glass, Affine3A::from_translation(Vec3::new(0.0, 0.0, -4.0)));
    scene.luminaires.push(Luminaire::Point { position: Vec3::new(0.0, 0.0, -4.0), intensity: Vec3::ONE });
    on_the_reference_and_every_backend(|name, tracer| {
        let black = rendered(tracer(&scene).as_mut(), 8, Limits { noise: Some(0.1), ..Limits::default() });
        assert!(matches!(black.end, End::NoEstimate), "{name}: {:?}", black.end);
        assert_eq!((black.film.error(), black.film.black_share()), (None, Some(1.0)), "{name}");
        // A flat lamp that fills the film has no noise, and that is another thing.
        let mut flat = scene.clone();
        let wall = quad(Vec3::new(-9.0, -9.0, -0.5), Vec3::X * 18.0, Vec3::Y * 18.0);
        add(&mut flat, wall, lamp(Vec3::ONE), Affine3A::IDENTITY);
        let flat = rendered(tracer(&flat).as_mut(), 8, Limits { noise: Some(0.1), ..Limits::default() });
        assert!(matches!(flat.end, End::Noise), "{name}: {:?}", flat.end);
        assert_eq!(flat.film.error().map(|error| error.rel_mse), Some(0.0), "{name}");
    });
}
