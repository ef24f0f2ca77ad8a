//! The exposure that is found for a scene, against what the rule gives by hand.

use crate::common::scenes::*;
use glam::{Affine3A, Vec3};
use luminaire::backend::development;
use luminaire::picture::{Development, Tone};
use luminaire::reference::AutoExposure;
use luminaire::scene::{
    Environment, Estimator, Exposure, FilmSettings, Filter, Integrator, LightSampling, RenderSettings, Sampler, Scene,
};

fn found(scene: &Scene) -> AutoExposure {
    AutoExposure::of(scene, &scene.film)
}

/// The exposure of a scene for which there is one.
fn stops(scene: &Scene) -> f32 {
    let found = found(scene);
    assert_eq!(found.warning, None);
    found.stops
}

/// Stops of which a luminance becomes another one, as they are rounded.
fn from_to(luminance: f64, shown: f64) -> f32 {
    ((shown / luminance).log2() * 8.0).round() as f32 / 8.0
}

/// Walls side by side that fill the picture, of equal widths, each emitting so much; nothing else.
fn walls(emissions: &[f32]) -> Scene {
    let mut scene = empty(40, 40);
    scene.sensor = pinhole(Vec3::Z, Vec3::ZERO, Vec3::Y, 90.0);
    let width = 2.0 / emissions.len() as f32;
    for (i, emission) in emissions.iter().enumerate() {
        let corner = Vec3::new(-1.0 + i as f32 * width, -2.0, 0.0);
        add(&mut scene, quad(corner, Vec3::X * width, Vec3::Y * 4.0), lamp(Vec3::splat(*emission)), Affine3A::IDENTITY);
    }
    scene
}

/// A floor under a white sky: its radiance is its albedo.
fn floor_under_the_sky(looks_at: Vec3) -> Scene {
    let mut scene = empty(64, 48);
    let floor = quad(Vec3::new(-9e3, 0.0, 9e3), Vec3::X * 18e3, Vec3::Z * -18e3);
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::splat(4.0), image: None, rotation: 0.0 });
    scene.sensor = pinhole(Vec3::Y, Vec3::Y + looks_at, Vec3::Y, 60.0);
    scene
}

#[test]
fn one_radiance_becomes_a_light_grey() {
    for emission in [1e-4, 0.3, 1.0, 7e5] {
        assert_eq!(stops(&walls(&[emission])), from_to(emission.into(), 0.25), "{emission}");
    }
}

#[test]
fn the_bright_part_is_not_clipped_and_the_dark_part_not_black() {
    // An eighth is 8 times as bright as the rest, and becomes 0.8: the log-average is then 0.13.
    let mut emissions = [0.5; 8];
    emissions[3] = 4.0;
    assert_eq!(stops(&walls(&emissions)), from_to(4.0, 0.8));
    // A hundred times as bright: it would be 0.8 with an average of 0.014, which is too dark.
    emissions[3] = 50.0;
    let average = 0.5 * 100f64.powf(0.125);
    assert_eq!(stops(&walls(&emissions)), from_to(average, 0.09));
    // A lamp of a thirty-second of the picture counts in the average alone.
    let mut emissions = [0.5; 32];
    emissions[3] = 1e4;
    assert_eq!(stops(&walls(&emissions)), from_to(0.5 * 2e4f64.powf(1.0 / 32.0), 0.25));
    // What is black tells nothing of the light.
    assert_eq!(stops(&walls(&[0.0, 0.0, 0.0, 2.0])), from_to(2.0, 0.25));
}

#[test]
fn the_sky_counts_only_where_it_is_all() {
    let down = Vec3::new(0.0, -0.2, -1.0);
    let half = floor_under_the_sky(down);
    assert_eq!(stops(&half), from_to(0.5 * 4.0, 0.25), "as of the floor alone");
    assert_eq!(stops(&floor_under_the_sky(Vec3::new(0.0, 2.0, -1.0))), from_to(4.0, 0.25), "as of the sky");
}

#[test]
fn stronger_light_shifts_it_by_exactly_as_many_stops() {
    for scene in [cornell_like(64, 48), glass_room(48, 64), open_air(40, 40)] {
        let plain = stops(&scene);
        assert_ne!(plain, 0.0);
        for k in [-9, -1, 3, 12] {
            assert_eq!(stops(&brighter(&scene, 2f32.powi(k))), plain - k as f32, "{k}");
        }
    }
}

#[test]
fn it_depends_on_nothing_but_what_is_seen() {
    let scene = cornell_like(64, 48);
    let plain = found(&scene);
    let changed = |change: &dyn Fn(&mut Scene)| {
        let mut other = scene.clone();
        change(&mut other);
        found(&other)
    };
    assert_eq!(plain, changed(&|scene| scene.settings.seed = 77));
    assert_eq!(plain, changed(&|scene| scene.settings.sampler = Sampler::Independent));
    assert_eq!(plain, changed(&|scene| scene.settings.spp = 1));
    assert_eq!(plain, changed(&|scene| (scene.film.width, scene.film.height) = (4, 3)));
    assert_eq!(plain, changed(&|scene| (scene.film.width, scene.film.height) = (4000, 3000)));
    assert_eq!(plain, changed(&|scene| (scene.film.filter, scene.film.filter_radius) = (Filter::Gaussian, 3.0)));
    let wide = FilmSettings { width: 4000, height: 3, ..scene.film };
    assert!(AutoExposure::of(&scene, &wide).warning.is_none(), "even of a stripe");
}

#[test]
fn where_nothing_can_be_said_it_is_none_and_says_so() {
    let says = |scene: &Scene, part: &str| {
        let found = found(scene);
        let warning = found.warning.expect("a warning");
        assert!(found.stops == 0.0 && warning.contains(part) && warning.contains("0 stops"), "{warning}");
    };
    says(&walls(&[0.0]), "none of ");
    let mut scene = cornell_like(64, 48);
    scene.luminaires.clear();
    // A lamp so small that chance hardly ever meets it.
    for material in &mut scene.materials {
        material.emission = Vec3::ZERO;
    }
    add(&mut scene, quad(Vec3::splat(0.1), Vec3::X * 4e-4, Vec3::Z * 4e-4), lamp(Vec3::splat(1e6)), Affine3A::IDENTITY);
    let estimator = Estimator { light_sampling: LightSampling::None, ..Estimator::default() };
    scene.integrator = Integrator::Path(estimator);
    says(&scene, "paths found light");
}

#[test]
fn a_scene_says_how_it_is_developed() {
    let mut scene = walls(&[1.0]);
    assert_eq!(development(&scene), Development::default());
    scene.settings = RenderSettings::automatic();
    assert_eq!(scene.settings.exposure, Exposure::Auto);
    assert_eq!(development(&scene), Development { exposure: -2.0, tone: Tone::Neutral });
    scene.settings.exposure = Exposure::Stops(0.3);
    assert_eq!(development(&scene), Development { exposure: 0.3, tone: Tone::Neutral });
}
