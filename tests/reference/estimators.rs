//! Every estimator against every other, and the biased ones against what their bias comes to. Significance 1e-4 each.

use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::{furnace, means, preset};
use glam::{Affine3A, Vec3};
use luminaire::scene::*;

/// A glossy floor, a diffuse wall and a box under a sky with a bright spot, with a lamp close to the floor.
fn yard() -> Scene {
    let mut scene = empty(6, 6);
    scene.sensor = pinhole(Vec3::new(0.0, 1.5, 4.0), Vec3::new(0.0, 0.25, 0.0), Vec3::Y, 40.0);
    let floor = Material { glossy: Vec3::splat(0.4), exponent: 20.0, ..matte(Vec3::new(0.4, 0.3, 0.2)) };
    add(&mut scene, quad(Vec3::new(-3.0, 0.0, 3.0), Vec3::X * 6.0, Vec3::Z * -6.0), floor, Affine3A::IDENTITY);
    let wall = Material { reflection: Vec3::splat(0.2), ..matte(Vec3::splat(0.6)) };
    add(&mut scene, quad(Vec3::new(-3.0, 0.0, -1.0), Vec3::X * 6.0, Vec3::Y * 3.0), wall, Affine3A::IDENTITY);
    let place = Affine3A::from_translation(Vec3::new(1.0, 0.4, 0.5)) * Affine3A::from_scale(Vec3::splat(0.3));
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), place);
    let panel = quad(Vec3::new(-1.0, 0.6, -0.5), Vec3::X, Vec3::Z);
    add(&mut scene, panel, lamp(Vec3::new(2.0, 3.0, 4.0)), Affine3A::IDENTITY);
    let mut texels = vec![Vec3::splat(0.3); 32];
    texels[10] = Vec3::splat(2.0);
    let image = EnvironmentImage { name: "sky".into(), width: 8, height: 4, texels };
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: Some(image.into()), rotation: 20.0 });
    scene
}

/// The mean of the picture for an estimator, its seed apart from the others'.
fn mean(scene: &Scene, estimator: Estimator, seed: u32, samples: u32) -> Estimate {
    let mut scene = scene.clone();
    scene.integrator = Integrator::Path(estimator);
    scene.settings.seed = seed;
    means(&scene, samples)[1]
}

/// Whatever is sampled, however directions and points are chosen, whatever ends the paths: the same mean.
#[test]
fn every_unbiased_estimator_has_the_same_mean() {
    let scene = yard();
    let expected = mean(&scene, Estimator::default(), 1, 12_000);
    assert!(expected.error < 3e-3 * expected.mean, "{expected:?}");
    let mut variants = vec![];
    for light_sampling in [LightSampling::None, LightSampling::Direct, LightSampling::Mis] {
        for directions in [Directions::Uniform, Directions::Cosine, Directions::Bsdf] {
            variants.push(Estimator { light_sampling, directions, ..Estimator::default() });
        }
    }
    for area_sampling in [AreaSampling::Area, AreaSampling::SolidAngle] {
        for (light_sampling, extinction) in
            [(LightSampling::Direct, Extinction::Surface), (LightSampling::Mis, Extinction::Surface)]
        {
            variants.push(Estimator { area_sampling, light_sampling, extinction, ..Estimator::default() });
        }
    }
    // 0.9^30 of the light, at most, is cut off.
    variants.push(Estimator { extinction: Extinction::Off, max_bounces: Some(30), ..Estimator::default() });
    for (seed, estimator) in variants.into_iter().enumerate() {
        let found = mean(&scene, estimator, 2 + seed as u32, 4_000);
        assert!(found.error < 8e-3 * found.mean, "{estimator:?}: {found:?} is not sharp enough");
        let p = same_mean(found, expected);
        assert!(p >= SIGNIFICANCE, "{estimator:?}: {found:?} instead of {expected:?}, p = {p:.1e}");
    }
}

/// A limit of `k` bounces means the same to all: emission and direct light after `k` bounces.
#[test]
fn limits_mean_the_same_to_all() {
    let scene = yard();
    for max_bounces in [Some(0), Some(1)] {
        let expected = mean(&scene, Estimator { max_bounces, ..Estimator::default() }, 1, 6_000);
        for (seed, light_sampling) in [LightSampling::None, LightSampling::Direct].into_iter().enumerate() {
            for extinction in [Extinction::Off, Extinction::Surface, Extinction::Throughput] {
                let estimator = Estimator { light_sampling, extinction, max_bounces, ..Estimator::default() };
                let found = mean(&scene, estimator, 2 + seed as u32, 3_000);
                let p = same_mean(found, expected);
                assert!(p >= SIGNIFICANCE, "{estimator:?}: {found:?} instead of {expected:?}, p = {p:.1e}");
            }
        }
    }
}

/// In the furnace a limit of `k` leaves `1 + a + ... + a^(k + 1)`, by every estimator; the shell, which emits, does not light
/// itself from the edge.
#[test]
fn limited_furnaces() {
    let mut scene = furnace(Vec3::splat(0.7));
    let a = f64::from(0.7f32);
    let mut seed = 0;
    for light_sampling in [LightSampling::None, LightSampling::Direct, LightSampling::Mis] {
        for (extinction, directions) in [
            (Extinction::Off, Directions::Bsdf),
            (Extinction::Surface, Directions::Uniform),
            (Extinction::Throughput, Directions::Cosine),
        ] {
            for k in [0, 3] {
                seed += 1;
                scene.settings.seed = seed;
                let limits = Estimator { max_bounces: Some(k), ..Estimator::default() };
                scene.integrator = Integrator::Path(Estimator { light_sampling, extinction, directions, ..limits });
                means(&scene, 150)[0].assert_is((0..=k as i32 + 1).map(|k| a.powi(k)).sum(), 6e-3);
            }
        }
    }
}

/// Without a limit, `1 / (1 - a)`.
#[test]
fn unlimited_furnaces() {
    let mut scene = furnace(Vec3::splat(0.5));
    for (seed, light_sampling) in
        [LightSampling::None, LightSampling::Direct, LightSampling::Mis].into_iter().enumerate()
    {
        for extinction in [Extinction::Surface, Extinction::Throughput] {
            scene.settings.seed = seed as u32;
            scene.integrator = Integrator::Path(Estimator { light_sampling, extinction, ..Estimator::default() });
            means(&scene, 250)[0].assert_is(2.0, 5e-3);
        }
    }
}

/// The slide's extinction counts every loss twice: `1 / (1 - a^2)` where light is found by chance, and
/// `1 + a / (1 - a^2)` where direct light is sampled before chance decides.
#[test]
fn literal_extinction_counts_losses_twice() {
    for a in [0.5f32, 0.8] {
        let mut scene = furnace(Vec3::splat(a));
        scene.integrator = preset("literal-extinction");
        let a = f64::from(a);
        means(&scene, 250)[0].assert_is(1.0 + a / (1.0 - a * a), 5e-3);
        estimator(&mut scene).light_sampling = LightSampling::None;
        means(&scene, 250)[0].assert_is(1.0 / (1.0 - a * a), 5e-3);
    }
}

/// The threshold cuts all that comes after the last bounce at which the combined albedo `a^k` reaches it.
#[test]
fn albedo_threshold_cuts_the_tail() {
    for (a, threshold, last) in [(0.5f32, 0.1f32, 3), (0.7, 0.1, 6), (0.7, 0.8, 0)] {
        let mut scene = furnace(Vec3::splat(a));
        scene.integrator = preset("no-light-sampling");
        estimator(&mut scene).albedo_threshold = Some(threshold);
        let a = f64::from(a);
        assert!(a.powi(last) > f64::from(threshold) && a.powi(last + 1) < f64::from(threshold));
        let expected: f64 = (0..=last).map(|k| a.powi(k)).sum();
        means(&scene, 300)[0].assert_is(expected, 5e-3);
        // Direct light is found one bounce earlier.
        estimator(&mut scene).light_sampling = LightSampling::Direct;
        means(&scene, 300)[0].assert_is(expected + a.powi(last + 1), 5e-3);
    }
}

/// Every preset ends and is what its name says.
#[test]
fn presets_end() {
    for (name, estimator) in PRESETS {
        assert!(estimator.ends(), "{name}");
    }
    assert!(Estimator::default().ends() && !Estimator { extinction: Extinction::Off, ..Estimator::default() }.ends());
}
