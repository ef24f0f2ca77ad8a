//! Scenes of any number of lamps, instances or bounces.

use crate::stability::rooms::{furnace, without_roulette};
use glam::{Affine3A, Vec2, Vec3};
use luminaire::scene::build::{add, empty, icosphere, lamp, matte, quad};
use luminaire::scene::{
    Environment, Estimator, FilmSettings, Integrator, LightChoice, LightSampling, Mesh, Projection, Scene, Sensor,
    Triangle,
};

/// Pixels of the pictures of lamps and instances.
pub(super) const SIZE: (u32, u32) = (16, 16);

/// A street without end: a floor of `n` squares with a small lamp one unit above the middle of each, of which the picture shows one.
/// Direct light only.
pub(super) fn city(n: u32, light_sampling: LightSampling, light_choice: LightChoice) -> Scene {
    let mut scene = empty(SIZE.0, SIZE.1);
    let side = f64::from(n).sqrt().ceil() as u32;
    let middle = (side / 2) as f32 + 0.5;
    scene.sensor = Sensor {
        position: Vec3::new(middle, 0.9, middle),
        target: Vec3::new(middle, 0.0, middle),
        up: Vec3::Z,
        projection: Projection::Orthographic { height: 1.0 },
        lens: None,
        shift: Vec2::ZERO,
    };
    let floor = quad(Vec3::new(0.0, 0.0, side as f32), Vec3::X * side as f32, Vec3::Z * -(side as f32));
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let mut lamps = Mesh { name: "lamps".into(), ..Mesh::default() };
    // The square that is seen has the first lamp, the others follow in rows.
    let places = (0..side * side).map(|i| (i + (side / 2) * (side + 1)) % (side * side)).take(n as usize);
    for place in places {
        let corner = Vec3::new((place % side) as f32 + 0.45, 1.0, (place / side) as f32 + 0.45);
        let first = lamps.positions.len() as u32;
        lamps.positions.extend([Vec3::ZERO, Vec3::X, Vec3::Z].map(|v| corner + 0.1 * v));
        lamps.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material: 0 });
    }
    add(&mut scene, lamps, lamp(Vec3::splat(100.0)), Affine3A::IDENTITY);
    scene.integrator =
        Integrator::Path(Estimator { light_sampling, light_choice, max_bounces: Some(0), ..Estimator::default() });
    scene
}

/// `n` spheres of 80 triangles that fill the picture, in white light.
pub(super) fn crowd(n: u32) -> Scene {
    let mut scene = empty(SIZE.0, SIZE.1);
    let side = f64::from(n).sqrt().ceil() as u32;
    scene.sensor.position = Vec3::new(0.0, 0.0, 1.5);
    let radius = 0.5 / side as f32;
    for i in 0..n {
        let place = |i: u32| (2 * i + 1) as f32 * radius - 0.5;
        let map = Affine3A::from_translation(Vec3::new(place(i % side), place(i / side), 0.0))
            * Affine3A::from_scale(Vec3::splat(radius));
        if i == 0 {
            add(&mut scene, icosphere(1), matte(Vec3::splat(0.5)), map);
        } else {
            let mut object = scene.objects[0].clone();
            object.object_to_world = map;
            scene.objects.push(object);
        }
    }
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    scene.integrator =
        Integrator::Path(Estimator { light_sampling: LightSampling::None, max_bounces: Some(2), ..without_roulette() });
    scene
}

/// A closed room whose paths have `n` bounces, by an albedo at which the last one still has more than a third of the light.
pub(super) fn long_paths(n: u32) -> (Scene, f64) {
    let albedo = (1.0 - 1.0 / f64::from(n + 1)) as f32;
    let scene = furnace((8, 1), albedo, Estimator { max_bounces: Some(n), ..without_roulette() });
    let a = f64::from(albedo);
    (scene, (1.0 - a.powf(f64::from(n) + 2.0)) / (1.0 - a))
}

/// Pixels of a scene's picture.
pub(super) fn film(scene: &Scene) -> (u32, u32) {
    let FilmSettings { width, height, .. } = scene.film;
    (width, height)
}
