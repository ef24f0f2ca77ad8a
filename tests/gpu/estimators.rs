//! The estimators against each other and against closed forms, on the kernel's own output.

use super::pictures::pixels;
use super::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, Vec3};
use luminaire::render::Tracer;
use luminaire::scene::{
    AreaSampling, Directions, Environment, Estimator, Extinction, Integrator, LightChoice, LightSampling, Material,
    Scene,
};

/// Mean radiance over the picture: 512 samples of 32 x 32 pixels.
fn measure(backend: &Intersector, scene: &Scene) -> Estimate {
    let tracer: &mut dyn Tracer = &mut backend.tracer(scene);
    total(&render(tracer, 32, 32, 512, 16))
}

/// Holds the means of other estimators, each with its own seed, against one: two-sided t-tests, corrected for so many tests. They have to be known to the share `sharp`.
fn assert_one_mean(
    name: &str,
    backend: &Intersector,
    scene: &mut Scene,
    reference: Estimate,
    others: &[Estimator],
    tests: usize,
    sharp: f64,
) {
    for (seed, estimator) in (1..).zip(others) {
        scene.integrator = Integrator::Path(*estimator);
        scene.settings.seed = seed;
        let found = measure(backend, scene);
        let z = (found.mean - reference.mean) / found.error.hypot(reference.error);
        println!(
            "{name}, {estimator:?}: {} +- {} for {} +- {}, z = {z:.2}",
            found.mean, found.error, reference.mean, reference.error
        );
        assert!(
            sidak(two_sided(z), tests) >= SIGNIFICANCE,
            "{name}, {estimator:?}: {found:?} and {reference:?}, z = {z:.2}"
        );
        assert!(found.error < sharp * found.mean, "{name}, {estimator:?}: not sharp");
    }
}

/// The same mean from light sampling, none and both, by the light tree (which the default has here, two lamps) and by power; from uniform, cosine and BSDF directions; from every termination that is unbiased; by
/// area and by solid angle. Two-sided t-tests against the default, each with its own seed, corrected for their number.
#[test]
fn every_unbiased_estimator_has_one_mean() {
    if on_the_old_driver() {
        return;
    }
    let default = Estimator::default();
    let others = [
        Estimator { light_sampling: LightSampling::Direct, ..default },
        Estimator { light_sampling: LightSampling::Direct, area_sampling: AreaSampling::Area, ..default },
        Estimator { light_sampling: LightSampling::Direct, directions: Directions::Uniform, ..default },
        Estimator { area_sampling: AreaSampling::Area, ..default },
        Estimator { light_choice: LightChoice::Power, ..default },
        Estimator { light_sampling: LightSampling::Direct, light_choice: LightChoice::Power, ..default },
        Estimator { directions: Directions::Uniform, ..default },
        Estimator { directions: Directions::Cosine, ..default },
        Estimator { extinction: Extinction::Surface, ..default },
        // So many bounces that what is cut is below 1e-4 of the mean.
        Estimator { extinction: Extinction::Off, max_bounces: Some(40), ..default },
        Estimator { light_sampling: LightSampling::None, ..default },
        Estimator { light_sampling: LightSampling::None, directions: Directions::Uniform, ..default },
    ];
    // Closed, with a glossy ball, and lamps large enough to be met by chance.
    let mut scene = cornell_like(32, 32);
    scene.luminaires.clear();
    let panel = quad(Vec3::new(-1.9375, -1.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0);
    add(&mut scene, panel, Material { emission: Vec3::splat(1.5), ..matte(Vec3::splat(0.3)) }, Affine3A::IDENTITY);
    let Some(backend) = backends().into_iter().next() else { return };
    let reference = measure(&backend, &scene);
    assert!(reference.error < 3e-3 * reference.mean);
    let count = others.len();
    assert_one_mean("closed room", &backend, &mut scene, reference, &others, count, 3e-2);
    assert_eq!(validation_messages(), 0);
}

/// Under skies of which all, a part, or nothing is sampled: of one colour, alone and beside a lamp; with a sun. Dark and glossy boxes, in a room with
/// one wall, or seen through a window. Every choice that is unbiased has the mean of the one that samples all of the sky.
#[test]
fn under_a_sky_every_estimator_has_one_mean() {
    if on_the_old_driver() {
        return;
    }
    let direct = Estimator { light_sampling: LightSampling::Direct, ..Estimator::default() };
    let others = [
        Estimator::default(),
        Estimator { directions: Directions::Cosine, ..Estimator::default() },
        Estimator { extinction: Extinction::Surface, ..Estimator::default() },
        Estimator { light_sampling: LightSampling::None, ..direct },
    ];
    let Some(backend) = backends().into_iter().next() else { return };
    for (name, lamp_emission, one_colour) in [
        ("one colour", 0.0, true),
        ("one colour and a lamp", 20.0, true),
        ("sun", 0.0, false),
        ("sun and a lamp", 20.0, false),
    ] {
        let mut scene = open_air(32, 32);
        scene.film.filter_radius = 0.5;
        scene.film.filter = luminaire::scene::Filter::Box;
        let sky = scene.environment.as_mut().expect("a sky");
        if one_colour {
            sky.image = None;
        } else {
            // A sun that is found by chance often enough for a sharp mean.
            let mut image = luminaire::scene::EnvironmentImage::clone(sky.image.as_ref().expect("an image"));
            image.texels.iter_mut().for_each(|texel| *texel = texel.min(Vec3::splat(8.0)));
            sky.image = Some(image.into());
        }
        if lamp_emission > 0.0 {
            let panel = quad(Vec3::new(-1.0, -0.75, -1.75), Vec3::X * 0.75, Vec3::Y * 0.75);
            let glow = Material { emission: Vec3::splat(lamp_emission), ..matte(Vec3::splat(0.3)) };
            add(&mut scene, panel, glow, Affine3A::IDENTITY);
        }
        scene.integrator = Integrator::Path(direct);
        let reference = measure(&backend, &scene);
        assert_one_mean(name, &backend, &mut scene, reference, &others, 16, 3e-3);
    }
    assert_eq!(validation_messages(), 0);
}

/// Under discs at infinity that overlap, with lamps of all kinds and a sky of one colour, and a mirror: whether light sampling finds them, chance, or both, by power
/// or by the tree, the mean is the same. What chance never finds is left out.
#[test]
fn under_suns_every_estimator_has_one_mean() {
    if on_the_old_driver() {
        return;
    }
    let direct = Estimator { light_sampling: LightSampling::Direct, ..Estimator::default() };
    let others = [
        Estimator::default(),
        Estimator { light_choice: LightChoice::Power, ..Estimator::default() },
        Estimator { directions: Directions::Cosine, ..Estimator::default() },
        Estimator { extinction: Extinction::Surface, ..Estimator::default() },
        Estimator { light_choice: LightChoice::Power, ..direct },
        Estimator { light_sampling: LightSampling::None, ..direct },
    ];
    let Some(backend) = backends().into_iter().next() else { return };
    for lamps in [false, true] {
        let mut scene = crate::common::stage::stage(32, 32);
        scene.luminaires.retain(luminaire::scene::Luminaire::is_disc);
        // So wide that paths find as much of them as light sampling does.
        for luminaire in &mut scene.luminaires {
            if let luminaire::scene::Luminaire::Sun { angle, .. } = luminaire {
                *angle *= 3.0;
            }
        }
        if lamps {
            for x in [-1.5, 1.0] {
                let panel = quad(Vec3::new(x, -0.75, -1.75), Vec3::X * 0.5, Vec3::Y * 0.75);
                add(
                    &mut scene,
                    panel,
                    Material { emission: Vec3::splat(2.0), ..matte(Vec3::splat(0.3)) },
                    Affine3A::IDENTITY,
                );
            }
        }
        scene.integrator = Integrator::Path(direct);
        let reference = measure(&backend, &scene);
        let name = format!("lamps: {lamps}");
        assert_one_mean(&name, &backend, &mut scene, reference, &others, 12, 1e-2);
    }
    assert_eq!(validation_messages(), 0);
}

/// A tracer that takes another integrator is as one that was opened with it, also where the sky is sampled otherwise then, or no more: bit for bit,
/// on every backend and in the reference.
#[test]
fn another_integrator_samples_the_sky_otherwise() {
    for one_colour in [false, true] {
        let mut scene = open_air(16, 16);
        if one_colour {
            scene.environment.as_mut().expect("a sky").image = None;
        }
        let lamp_on_the_floor = quad(Vec3::new(-1.0, -0.75, -1.75), Vec3::X * 0.75, Vec3::Y * 0.75);
        add(&mut scene, lamp_on_the_floor, lamp(Vec3::ONE), Affine3A::IDENTITY);
        let choices = [LightSampling::Mis, LightSampling::Direct, LightSampling::None, LightSampling::Mis];
        let with = |light_sampling| Integrator::Path(Estimator { light_sampling, ..Estimator::default() });
        let scenes = choices.map(|choice| Scene { integrator: with(choice), ..scene.clone() });
        let check = |open: &dyn Fn(&Scene) -> Box<dyn luminaire::render::SceneTracer>, name: &str| {
            let mut changed = open(&scenes[0]);
            for scene in &scenes {
                changed.integrate(&scene.integrator).expect("it ends");
                let (found, expected) = (pixels(&mut *changed, scene, 4), pixels(&mut *open(scene), scene, 4));
                assert!(found == expected, "{name}, {:?}", scene.integrator);
            }
        };
        check(&|scene| Box::new(luminaire::reference::Reference::new(scene)), "reference");
        on_every_backend(|backend| check(&|scene| Box::new(backend.tracer(scene)), backend.name()));
    }
}

/// A closed shell of albedo `a` that emits 1. By chance alone (no light sampling) extinction without re-weighting gives `1 / (1 - a^2)`;
/// with direct light, whose first share is not lost, `1 + a / (1 - a^2)`; a threshold cuts the series `1 + a + a^2 + ...`, and so does a
/// depth.
#[test]
fn biased_estimators_are_off_by_what_they_should() {
    if on_the_old_driver() {
        return;
    }
    let a = 0.5f64;
    let series = |terms: i32| (0..terms).map(|k| a.powi(k)).sum::<f64>();
    let base = Estimator::preset("cosine").expect("a preset");
    let none = Estimator { light_sampling: LightSampling::None, ..base };
    let cases = [
        ("unbiased", base, 2.0),
        ("literal, no light sampling", Estimator { extinction: Extinction::Literal, ..none }, 1.0 / (1.0 - a * a)),
        ("literal", Estimator { extinction: Extinction::Literal, ..base }, 1.0 + a / (1.0 - a * a)),
        // 0.5, 0.25 are at least 0.2; 0.125 is not.
        ("threshold, no light sampling", Estimator { albedo_threshold: Some(0.2), ..none }, series(3)),
        ("threshold", Estimator { albedo_threshold: Some(0.2), ..base }, series(4)),
        ("2 bounces", Estimator { max_bounces: Some(2), ..base }, series(4)),
        ("2 bounces, no light sampling", Estimator { max_bounces: Some(2), ..none }, series(4)),
        ("2 bounces, both", Estimator { max_bounces: Some(2), ..Estimator::default() }, series(4)),
    ];
    let mut scene = empty(32, 32);
    scene.sensor = pinhole(Vec3::new(0.25, 0.125, 0.5), Vec3::new(0.5, -1.0, 0.25), Vec3::Y, 60.0);
    let glowing = Material { emission: Vec3::ONE, ..matte(Vec3::splat(a as f32)) };
    add(&mut scene, icosphere(3), glowing, Affine3A::IDENTITY);
    let Some(backend) = backends().into_iter().next() else { return };
    for (name, estimator, expected) in cases {
        scene.integrator = Integrator::Path(estimator);
        let found = measure(&backend, &scene);
        println!("{name}: {} +- {}, expected {expected}", found.mean, found.error);
        found.assert_is(expected, 3e-3);
    }
    assert_eq!(validation_messages(), 0);
}

/// Seen from inside a dielectric, through its flat surface at a right angle, white light from everywhere is brighter by `eta^2`: what is
/// transmitted has `(1 - F) eta^2`, and `F` of the white inside is reflected. Bodies that light leaves again cannot tell.
#[test]
fn radiance_is_higher_inside_a_dielectric() {
    if on_the_old_driver() {
        return;
    }
    for (eta, extinction) in [
        (1.5, Extinction::Throughput),
        (1.5, Extinction::Surface),
        (2.4, Extinction::Throughput),
        (0.8, Extinction::Throughput),
    ] {
        let mut scene = empty(32, 32);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        estimator(&mut scene).extinction = extinction;
        // The outward side is up, and the sensor is below.
        let surface = quad(Vec3::new(-9.0, 1.0, 9.0), Vec3::X * 18.0, Vec3::Z * -18.0);
        let glass = Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(eta), ..Material::default() };
        add(&mut scene, surface, glass, Affine3A::IDENTITY);
        scene.sensor = pinhole(Vec3::ZERO, Vec3::Y, Vec3::Z, 0.1);
        let eta = f64::from(eta);
        let reflected = ((eta - 1.0) / (eta + 1.0)).powi(2);
        let expected = (1.0 - reflected) * eta * eta + reflected;
        on_every_backend(|backend| measure(backend, &scene).assert_is(expected, 3e-3));
        let mut reference = luminaire::reference::Reference::new(&scene);
        total(&render(&mut reference, 32, 32, 512, 16)).assert_is(expected, 3e-3);
    }
}

/// White light from everywhere shows nothing of bodies that absorb nothing: glass of any index, the 60/40 mirror, a full mirror.
#[test]
fn what_absorbs_nothing_is_invisible_in_uniform_light() {
    if on_the_old_driver() {
        return;
    }
    let glass =
        |eta| Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(eta), ..Material::default() };
    let mirror = |reflection: f32, probability| Material {
        reflection: Vec3::splat(reflection),
        impulse_probability: probability,
        ..matte(Vec3::splat(1.0 - reflection))
    };
    let materials = [
        glass(1.5),
        glass(1.0 / 1.5),
        glass(2.4),
        mirror(0.6, Some(0.6)),
        mirror(0.6, Some(0.2)),
        mirror(0.6, None),
        mirror(1.0, None),
    ];
    for material in materials {
        let mut scene = empty(32, 32);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        scene.sensor.position = Vec3::Z * 2.0;
        add(&mut scene, icosphere(2), material.clone(), Affine3A::IDENTITY);
        on_every_backend(|backend| {
            let found = measure(backend, &scene);
            println!(
                "{:?} {:?}, {}: {} +- {}",
                material.eta,
                material.impulse_probability,
                backend.name(),
                found.mean,
                found.error
            );
            found.assert_is(1.0, 3e-3);
        });
    }
}
