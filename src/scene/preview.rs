//! What an OBJ file needs to become a picture, and does not say: a camera, and a light if nothing in it emits.

use super::load::Loader;
use super::{
    Estimator, FilmSettings, Filter, Integrator, Luminaire, Object, Projection, RenderSettings, Scene, Sensor, obj,
};
use crate::Result;
use glam::{Affine3A, DVec3, Vec3};
use std::path::Path;

/// Vertical field of view of the framing camera, in degrees.
const FOV: f32 = 40.0;
/// From the scene to the camera: in front (+z), a little to the right and above.
const VIEW: DVec3 = DVec3::new(0.5, 0.35, 1.0);
/// The direction in which the key light travels: from the upper left, behind the camera.
const KEY_DIRECTION: DVec3 = DVec3::new(0.3, -0.8, -0.7);
/// Irradiance of the key light: a white surface that faces it has a radiance of 0.7, and with the ambient term 0.9: not yet clipped.
const KEY_IRRADIANCE: f32 = 2.2;
/// Ambient radiance beside the key light.
const AMBIENT: f32 = 0.2;

/// Size and filter of the picture where nothing is said.
pub(super) const FILM: FilmSettings = FilmSettings { width: 512, height: 512, filter: Filter::Box, filter_radius: 0.5 };

/// Loads a bare OBJ.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let mut loader = Loader::new(Vec::new());
    let mesh = loader.mesh(path, None)?;
    let object = Object { name: obj::file_name(path), mesh, object_to_world: Affine3A::IDENTITY, material: None };
    let objects = vec![object];
    let (materials, textures) = loader.finish_materials(&objects);
    let mut scene = Scene {
        path: path.to_owned(),
        meshes: loader.meshes,
        objects,
        materials,
        textures,
        luminaires: Vec::new(),
        environment: None,
        sensor: Sensor {
            position: Vec3::Z,
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Perspective { fov: FOV },
            lens: None,
        },
        film: FILM,
        integrator: Integrator::Path(Estimator::default()),
        settings: RenderSettings::default(),
        warnings: loader.warnings,
    };
    scene.sensor = framing_sensor(&scene);
    if !scene.triangles_emit() {
        scene.luminaires.push(Luminaire::Infinite {
            direction: KEY_DIRECTION.normalize().as_vec3(),
            irradiance: Vec3::splat(KEY_IRRADIANCE),
        });
        scene.integrator = Integrator::Simple { ambient: Vec3::splat(AMBIENT) };
        scene.warnings.push(format!(
            "{}: nothing in it emits light, so it gets a key light at infinity and an ambient term (the simple ray tracer); \
             write a scene file for anything better",
            path.display()
        ));
    }
    Ok(scene)
}

/// A camera in front of the scene, a little from above and from the right, that has all of it in the picture.
pub(super) fn framing_sensor(scene: &Scene) -> Sensor {
    let (low, high) = scene.world_bounds();
    let center = 0.5 * (low + high);
    let mut radius: f64 = 0.0;
    for object in &scene.objects {
        let to_world = super::luminaire::widen(object.object_to_world);
        for position in &scene.meshes[object.mesh as usize].positions {
            radius = radius.max(to_world.transform_point3(position.as_dvec3()).distance(center));
        }
    }
    // A small thing far from the origin: keep the camera distinct from its target in single precision.
    radius = radius.max(1e-5 * center.abs().max_element());
    let half_height = f64::from(FOV).to_radians() / 2.0;
    let aspect = f64::from(scene.film.width) / f64::from(scene.film.height);
    let half_width = (half_height.tan() * aspect).atan();
    let distance = radius / half_height.min(half_width).sin();
    let position = (center + distance * VIEW.normalize()).as_vec3();
    Sensor {
        position,
        target: center.as_vec3(),
        up: Vec3::Y,
        projection: Projection::Perspective { fov: FOV },
        lens: None,
    }
}
