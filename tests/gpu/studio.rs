//! The ground under the studio sky.

use super::pictures::{differing, mean, pixels};
use super::*;
use glam::{DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::scene::{Projection, Sensor, load};

/// A scene of a triangle, with so much else.
fn scene(more: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("mesh.obj"), "v -1 0 0\nv 1 0 0\nv 0 2 0.1\nf 1 2 3\n").unwrap();
    std::fs::write(at("scene.toml"), format!("{more}\n[[object]]\nmesh = \"mesh.obj\"\n")).unwrap();
    let mut scene = load(&at("scene.toml")).unwrap();
    (scene.film.width, scene.film.height) = (24, 24);
    scene
}

/// Level ground of albedo 0.45 away from everything has the radiance of the sky at the horizon, 0.4, so that there is no line between them. One of albedo 0.9
/// is twice as bright. The model's shadow is darker.
#[test]
fn ground_far_from_the_model_cannot_be_told_from_the_sky() {
    let look = |scene: &mut Scene, from: Vec3, to: Vec3| {
        scene.sensor = Sensor {
            position: from,
            target: to,
            up: Vec3::Y,
            projection: Projection::Perspective { fov: 20.0 },
            lens: None,
            shift: glam::Vec2::ZERO,
        };
    };
    let mut ground = scene("[environment]\nsky = \"studio\"\n[ground]");
    look(&mut ground, Vec3::new(0.0, 3.0, 10.0), Vec3::new(0.0, 0.0, 18.0));
    let mut white = scene("[environment]\nsky = \"studio\"\n[ground]\ndiffuse = [0.9, 0.9, 0.9]");
    white.sensor = ground.sensor.clone();
    let mut shadow = ground.clone();
    look(&mut shadow, Vec3::new(0.2, 2.0, -4.0), Vec3::new(0.2, 0.0, -0.5));
    let mut above = ground.clone();
    look(&mut above, Vec3::new(0.0, 3.0, 10.0), Vec3::new(0.0, 3.0, 18.0));
    above.sensor.projection = Projection::Perspective { fov: 1.0 };
    // Not one number of the sky at the horizon is left to chance.
    let sky = |found: DVec3| (found - DVec3::splat(0.4)).abs().max_element() < 2e-3;
    let check = |name: &str, tracer: &mut dyn FnMut(&Scene) -> Vec<DVec3>| {
        let level = mean(&tracer(&ground));
        assert!((level.x - 0.4).abs() < 0.012, "{name}: {level}");
        let white = mean(&tracer(&white));
        assert!((white.x - 0.8).abs() < 0.024, "{name}: {white}");
        let shadow = mean(&tracer(&shadow));
        assert!(shadow.x < 0.37, "{name}: {shadow}");
        let horizon = tracer(&above);
        assert!(sky(mean(&horizon)), "{name}: {}", mean(&horizon));
    };
    check("reference", &mut |scene| pixels(&mut Reference::new(scene), scene, 64));
    let expected = pixels(&mut Reference::new(&ground), &ground, 16);
    on_every_backend(|backend| {
        check(backend.name(), &mut |scene| pixels(&mut backend.tracer(scene), scene, 64));
        let found = pixels(&mut backend.tracer(&ground), &ground, 16);
        let count = differing(&found, &expected, 1e-3);
        assert!(count <= found.len() / 50, "{}: {count} pixels differ", backend.name());
    });
}
