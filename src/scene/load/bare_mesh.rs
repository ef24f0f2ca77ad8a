//! What an OBJ file needs to become a picture, and does not say: a camera, and a light if next to nothing in it emits.

use super::loader::Loader;
use super::obj;
use crate::Result;
use crate::scene::{
    Estimator, FilmSettings, Filter, Integrator, Luminaire, Object, Projection, RenderSettings, Scene, Sensor, widen,
};
use glam::{Affine3A, DAffine3, DVec3, Vec2, Vec3};
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
/// A scene whose emitting triangles have less than this share of its area is not meant to be lit by them alone: they glow, as
/// lava in a landscape does. The lamp of a Cornell box has seven times as much.
const LEAST_EMITTING: f64 = 1e-3;

/// Size and filter of the picture where nothing is said.
pub(super) const FILM: FilmSettings = FilmSettings { width: 512, height: 512, filter: Filter::Box, filter_radius: 0.5 };

/// Loads a bare OBJ.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let mut loader = Loader::new(Vec::new());
    let mesh = loader.mesh(path, obj::Reading::default())?;
    let object = Object { name: obj::file_name(path), mesh, object_to_world: Affine3A::IDENTITY, material: None };
    let mut objects = vec![object];
    let origin = loader.settle(&mut objects, &[DAffine3::IDENTITY]);
    let (materials, textures) = loader.finish_materials(&objects);
    let mut scene = Scene {
        path: path.to_owned(),
        origin,
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
            shift: Vec2::ZERO,
        },
        cameras: Vec::new(),
        film: FILM,
        integrator: Integrator::Path(Estimator::default()),
        settings: RenderSettings::default(),
        files: loader.files,
        warnings: loader.warnings,
    };
    scene.sensor = framing_sensor(&scene);
    let emitting = emitting_share(&scene);
    if emitting < LEAST_EMITTING {
        scene.luminaires.push(Luminaire::Infinite {
            direction: KEY_DIRECTION.normalize().as_vec3(),
            irradiance: Vec3::splat(KEY_IRRADIANCE),
        });
        scene.integrator = Integrator::Simple { ambient: Vec3::splat(AMBIENT) };
        let why = if scene.triangles_emit() {
            format!("only {} of its area emits light, too little to see the rest by", percent(emitting))
        } else {
            "nothing in it emits light".into()
        };
        scene.warnings.push(format!(
            "{}: {why}, so it gets a key light at infinity and an ambient term (the simple ray tracer); \
             write a scene file for anything better",
            path.display()
        ));
    }
    Ok(scene)
}

/// The emitting triangles' share of the area of all triangles, from 0 to 1.
fn emitting_share(scene: &Scene) -> f64 {
    let (mut emitting, mut all) = (0.0, 0.0);
    for object in &scene.objects {
        let to_world = widen(object.object_to_world);
        let mesh = &scene.meshes[object.mesh as usize];
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
            let area = 0.5 * (b - a).cross(c - a).length();
            all += area;
            if scene.material_of(object, triangle).emission != Vec3::ZERO {
                emitting += area;
            }
        }
    }
    if emitting > 0.0 { emitting / all } else { 0.0 }
}

/// A small share in words.
fn percent(share: f64) -> String {
    if share < 1e-6 { "less than 0.0001 %".into() } else { format!("{:.4} %", 100.0 * share) }
}

/// A camera in front of the scene, a little from above and from the right, that has all of it in the picture.
pub(super) fn framing_sensor(scene: &Scene) -> Sensor {
    let (low, high) = scene.world_bounds();
    let center = 0.5 * (low + high);
    let mut radius: f64 = 0.0;
    for object in &scene.objects {
        let to_world = widen(object.object_to_world);
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
        shift: Vec2::ZERO,
    }
}
