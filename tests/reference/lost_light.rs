//! Light that no estimator finds is said before it is missed: through glass, by mirrors, by paths that are too short, by chance alone.

use crate::common::scenes::*;
use glam::{Affine3A, Vec3};
use luminaire::film::{Batch, Tile};
use luminaire::reference::Reference;
use luminaire::reference::lost_light::lost_light;
use luminaire::render::Tracer;
use luminaire::scene::{Environment, Estimator, Integrator, LightSampling, Luminaire, Material, Scene};

fn glass() -> Material {
    Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::ZERO) }
}

fn mirror() -> Material {
    Material { reflection: Vec3::splat(0.9), ..matte(Vec3::ZERO) }
}

fn at(x: f32, y: f32, z: f32, scale: Vec3) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z)) * Affine3A::from_scale(scale)
}

/// A grey floor of 16 x 16 at y = -1, seen from above.
fn floor() -> Scene {
    let mut scene = empty(16, 12);
    scene.sensor = pinhole(Vec3::new(0.0, 5.0, 7.0), Vec3::new(0.0, -1.0, 0.0), Vec3::Y, 40.0);
    let floor = quad(Vec3::new(-8.0, -1.0, -8.0), Vec3::Z * 16.0, Vec3::X * 16.0);
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene
}

fn point(position: Vec3) -> Luminaire {
    Luminaire::Point { position, intensity: Vec3::splat(10.0) }
}

fn sun(direction: Vec3) -> Luminaire {
    Luminaire::Infinite { direction: direction.normalize(), irradiance: Vec3::splat(3.0) }
}

/// The floor with a body of this material around the origin.
fn with_ball(material: Material) -> Scene {
    let mut scene = floor();
    add(&mut scene, icosphere(2), material, at(0.0, 0.0, 0.0, Vec3::splat(0.5)));
    scene
}

/// Asserts that there is one sentence with all of these parts, in any unit of light.
fn says(scene: &Scene, parts: &[&str]) {
    for unit in [1.0, 1e-6, 1e6] {
        let found = lost_light(&brighter(scene, unit));
        assert_eq!(found.len(), 1, "in units of {unit}, looking for {parts:?}: {found:?}");
        assert!(parts.iter().all(|part| found[0].contains(part)), "{parts:?} are not in {found:?}");
    }
}

fn says_nothing(scene: &Scene) {
    assert_eq!(lost_light(scene), Vec::<String>::new());
}

/// Mean radiance of some samples of the reference.
fn mean(scene: &Scene) -> f64 {
    let tile = Tile { x: 0, y: 0, width: scene.film.width, height: scene.film.height };
    let traced = Reference::new(scene).trace(&Batch { tile, samples: 0..16, group: 4 }).unwrap();
    traced.sums.iter().map(|sum| sum.radiance[1]).sum::<f64>() / (16 * tile.pixels()) as f64
}

#[test]
fn a_lamp_without_an_area_in_glass() {
    let mut bulb = with_ball(glass());
    bulb.luminaires = vec![point(Vec3::ZERO)];
    says(
        &bulb,
        &["about 100 % of the light of [[luminaire]] 1 falls on glass or mirrors first", "a small mesh that emits"],
    );
    assert_eq!(mean(&bulb), 0.0, "what is said is so");
    // It is the first luminaire that emits, but the second of the scene; the third is no matter.
    let mut three = bulb.clone();
    three.luminaires.insert(0, Luminaire::Point { position: Vec3::X, intensity: Vec3::ZERO });
    three.luminaires.push(point(Vec3::new(5.0, 2.0, 0.0)));
    says(&three, &["[[luminaire]] 2"]);
    let mut open = floor();
    open.luminaires = bulb.luminaires.clone();
    says_nothing(&open);
    assert!(mean(&open) > 0.0);
    // Behind what is not transparent nothing is expected.
    let mut matt = with_ball(matte(Vec3::splat(0.5)));
    matt.luminaires = vec![point(Vec3::new(0.0, 3.0, 0.0))];
    says_nothing(&matt);
    // An area luminaire is found.
    let mut area = with_ball(glass());
    add(&mut area, icosphere(1), lamp(Vec3::splat(100.0)), at(0.0, 0.0, 0.0, Vec3::splat(0.1)));
    says_nothing(&area);
    assert!(mean(&area) > 0.0);
}

/// A closed room with a sensor in it; the upper half of the wall at x = 4 is a window with a pane.
fn room_with_a_window(pane: Material) -> Scene {
    let mut scene = empty(16, 12);
    scene.sensor = pinhole(Vec3::new(-3.0, 0.0, 3.0), Vec3::new(0.0, -1.0, 0.0), Vec3::Y, 60.0);
    let wall = |scene: &mut Scene, corner: [f32; 3], a: Vec3, b: Vec3| {
        add(scene, quad(corner.into(), a, b), matte(Vec3::splat(0.6)), Affine3A::IDENTITY);
    };
    let (x, y, z) = (Vec3::X * 8.0, Vec3::Y * 8.0, Vec3::Z * 8.0);
    wall(&mut scene, [-4.0; 3], z, x);
    wall(&mut scene, [-4.0, 4.0, -4.0], x, z);
    wall(&mut scene, [-4.0; 3], x, y);
    wall(&mut scene, [-4.0, -4.0, 4.0], y, x);
    wall(&mut scene, [-4.0; 3], y, z);
    wall(&mut scene, [4.0, -4.0, -4.0], z, y * 0.5);
    add(&mut scene, cube(), pane, at(4.0, 2.0, 0.0, Vec3::new(0.02, 2.0, 4.0)));
    scene
}

#[test]
fn the_sun_through_a_window_pane() {
    let mut room = room_with_a_window(glass());
    room.luminaires = vec![sun(Vec3::new(-1.0, -0.8, 0.1))];
    // Most of its light falls on roof and walls outside: only from within it is seen what is missing.
    says(
        &room,
        &[
            "about 100 % of the light of [[luminaire]] 1 on what the camera sees comes through glass",
            "a sun with an `angle`",
        ],
    );
    assert_eq!(mean(&room), 0.0);
    let mut shut = room_with_a_window(matte(Vec3::splat(0.2)));
    shut.luminaires = room.luminaires.clone();
    says_nothing(&shut);
    // A lamp in the room that outshines the sun by far.
    let mut lit = room.clone();
    add(&mut lit, icosphere(1), lamp(Vec3::splat(1e5)), at(0.0, 3.0, 0.0, Vec3::splat(0.3)));
    says_nothing(&lit);
    // Paths find the sky through the pane, if they may be long enough.
    let mut sky = room.clone();
    sky.luminaires.clear();
    sky.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    says_nothing(&sky);
    estimator(&mut sky).max_bounces = Some(1);
    says(&sky, &["lamps and environment", "max_bounces is 1", "allow more bounces"]);
    sky.integrator = Integrator::Simple { ambient: Vec3::ZERO };
    says(&sky, &["the simple ray tracer has no bounces"]);
}

#[test]
fn by_a_mirror() {
    let mut scene = floor();
    let wall = quad(Vec3::new(-8.0, -1.0, -1.0), Vec3::X * 16.0, Vec3::Y * 16.0);
    add(&mut scene, wall, mirror(), Affine3A::IDENTITY);
    scene.luminaires = vec![point(Vec3::new(0.0, 0.5, 0.0))];
    says(&scene, &["[[luminaire]] 1 falls on glass or mirrors first"]);
    // Half of the wall's light is scattered, and found; the other half is not.
    let half = Material { reflection: Vec3::splat(0.5), ..matte(Vec3::splat(0.5)) };
    *scene.materials.last_mut().unwrap() = half;
    says(&scene, &["falls on glass or mirrors first"]);
    *scene.materials.last_mut().unwrap() = matte(Vec3::splat(0.5));
    says_nothing(&scene);
}

#[test]
fn a_small_glass_is_not_worth_a_word() {
    let mut scene = floor();
    add(&mut scene, icosphere(2), glass(), at(1.0, -0.7, 1.0, Vec3::splat(0.25)));
    scene.luminaires = vec![sun(Vec3::new(0.2, -1.0, -0.3)), point(Vec3::new(-3.0, 4.0, 0.0))];
    says_nothing(&scene);
}

#[test]
fn lamps_in_glass_and_short_paths() {
    let mut scene = with_ball(glass());
    add(&mut scene, icosphere(1), lamp(Vec3::splat(100.0)), at(0.0, 0.0, 0.0, Vec3::splat(0.1)));
    let with = |integrator| Scene { integrator, ..scene.clone() };
    let path = |max_bounces, light_sampling| {
        Integrator::Path(Estimator { max_bounces, light_sampling, ..Estimator::default() })
    };
    // The ball is one surface on the way: the paths that find the lamp on the floor have one bounce.
    for light_sampling in [LightSampling::Mis, LightSampling::Direct] {
        says(&with(path(Some(0), light_sampling)), &["max_bounces is 0"]);
        says_nothing(&with(path(Some(1), light_sampling)));
        assert!(mean(&with(path(Some(1), light_sampling))) > 1.2 * mean(&with(path(Some(0), light_sampling))));
    }
    says(&with(Integrator::Simple { ambient: Vec3::ONE }), &["the simple ray tracer"]);
}

#[test]
fn by_chance_alone() {
    let mut scene = floor();
    add(&mut scene, icosphere(1), lamp(Vec3::ONE), at(0.0, 3.0, 0.0, Vec3::splat(0.3)));
    scene.luminaires = vec![point(Vec3::new(3.0, 2.0, 0.0)), sun(-Vec3::Y)];
    says_nothing(&scene);
    estimator(&mut scene).light_sampling = LightSampling::None;
    says(&scene, &["no path ever meets the 2 luminaires without an area"]);
    // Where there is nothing else, another warning says it.
    scene.objects.pop();
    says_nothing(&scene);
    assert!(scene.dark_because().is_some());
}

/// In a white room paths have ten thousand bounces, of which the search wants four.
#[test]
fn the_search_does_not_follow_paths_to_their_end() {
    let mut scene = empty(8, 8);
    add(&mut scene, icosphere(2), matte(Vec3::ONE), Affine3A::from_scale(Vec3::splat(3.0)));
    add(&mut scene, icosphere(1), mirror(), at(1.0, 0.0, -1.0, Vec3::splat(0.3)));
    scene.luminaires = vec![Luminaire::Point { position: Vec3::Y, intensity: Vec3::ONE }];
    let reference = Reference::new(&scene);
    assert!((0..64).all(|pixel| reference.first_vertices(pixel, 0, 4).len() <= 4));
    let start = std::time::Instant::now();
    lost_light(&scene);
    assert!(start.elapsed().as_secs_f64() < 5.0, "some milliseconds are enough");
}
