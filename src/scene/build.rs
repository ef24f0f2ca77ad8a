//! Scenes built in code: for tests, measurements and programs that have no scene file.

use super::{
    Estimator, FilmSettings, Filter, Integrator, Luminaire, Material, Mesh, Object, Projection, RenderSettings,
    Sampler, Scene, Sensor, Triangle,
};
use glam::{Affine3A, DVec3, Mat3, Vec2, Vec3};
use std::collections::HashMap;

/// A scene without objects, to be filled by [`add`]: the sensor is at the origin and looks along -z, 60 degrees high; unlimited paths. The
/// random numbers are independent: statistics want independent samples.
pub fn empty(width: u32, height: u32) -> Scene {
    Scene {
        path: "test".into(),
        origin: DVec3::ZERO,
        meshes: vec![],
        objects: vec![],
        materials: vec![],
        luminaires: vec![],
        textures: vec![],
        environment: None,
        sensor: pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, 60.0),
        cameras: vec![],
        film: FilmSettings { width, height, filter: Filter::Box, filter_radius: 0.5 },
        integrator: Integrator::Path(Estimator::default()),
        settings: RenderSettings { sampler: Sampler::Independent, ..RenderSettings::default() },
        warnings: vec![],
        notes: vec![],
        ground: None,
        files: vec![],
    }
}

/// A pinhole camera; `fov` in degrees.
pub fn pinhole(position: Vec3, target: Vec3, up: Vec3, fov: f32) -> Sensor {
    Sensor { position, target, up, projection: Projection::Perspective { fov }, lens: None, shift: Vec2::ZERO }
}

/// The path estimator of a scene, to be changed.
pub fn estimator(scene: &mut Scene) -> &mut Estimator {
    match &mut scene.integrator {
        Integrator::Path(estimator) => estimator,
        Integrator::Simple { .. } => panic!("the simple ray tracer has no estimator"),
    }
}

/// Adds a mesh, its material, and one instance of it; gives the mesh's index.
pub fn add(scene: &mut Scene, mesh: Mesh, material: Material, object_to_world: Affine3A) -> u32 {
    scene.meshes.push(mesh.into());
    let mesh = scene.meshes.len() as u32 - 1;
    add_instance(scene, mesh, material, object_to_world);
    mesh
}

/// Adds another instance of a mesh, with its own material.
pub fn add_instance(scene: &mut Scene, mesh: u32, material: Material, object_to_world: Affine3A) {
    scene.materials.push(material);
    let name = format!("object {}", scene.objects.len());
    scene.objects.push(Object { name, mesh, object_to_world, material: Some(scene.materials.len() as u32 - 1) });
}

/// A diffuse material that does not emit.
pub fn matte(albedo: impl Into<Vec3>) -> Material {
    Material { name: "matte".into(), lambert: albedo.into(), ..Material::default() }
}

/// A black material that emits.
pub fn lamp(emission: impl Into<Vec3>) -> Material {
    Material { name: "lamp".into(), emission: emission.into(), ..matte(Vec3::ZERO) }
}

/// A mesh without vertex normals; its triangles' own material is the scene's first.
pub fn mesh(positions: Vec<Vec3>, triangles: &[[u32; 3]]) -> Mesh {
    let triangles = triangles.iter().map(|&vertices| Triangle { vertices, material: 0 }).collect();
    Mesh { name: "mesh".into(), positions, triangles, ..Mesh::default() }
}

/// The parallelogram with a corner and two edges.
pub fn quad(corner: Vec3, a: Vec3, b: Vec3) -> Mesh {
    mesh(vec![corner, corner + a, corner + a + b, corner + b], &[[0, 1, 2], [0, 2, 3]])
}

/// The cube from -1 to 1.
pub fn cube() -> Mesh {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32) * 2.0 - 1.0;
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh((0..8).map(corner).collect(), &triangles)
}

/// A sphere of radius 1: an icosahedron whose `20 * 4^subdivisions` faces have all their corners on the sphere. Closed, convex;
/// without vertex normals (`mesh.normals = mesh.positions.clone()` gives it smooth ones).
pub fn icosphere(subdivisions: u32) -> Mesh {
    let g = (1.0 + 5f32.sqrt()) / 2.0;
    let mut positions: Vec<Vec3> = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        positions.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)].map(Vec3::normalize));
    }
    // The faces are the triples of neighbours; seen from outside, counter-clockwise.
    let near = |a: usize, b: usize| (positions[a] - positions[b]).length() < 1.1;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let out = Mat3::from_cols(positions[a], positions[b], positions[c]).determinant() > 0.0;
                    triangles.push(if out { [a, b, c] } else { [a, c, b] }.map(|v| v as u32));
                }
            }
        }
    }
    for _ in 0..subdivisions {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    mesh(positions, &triangles)
}

/// Makes everything that emits `factor` times as bright: the same picture in another unit of light.
pub fn brighter(scene: &Scene, factor: f32) -> Scene {
    let mut scene = scene.clone();
    scene.materials.iter_mut().for_each(|material| material.emission *= factor);
    for luminaire in &mut scene.luminaires {
        match luminaire {
            Luminaire::Point { intensity, .. }
            | Luminaire::Spot { intensity, .. }
            | Luminaire::Photometric { intensity, .. } => *intensity *= factor,
            Luminaire::Infinite { irradiance, .. } | Luminaire::Sun { irradiance, .. } => *irradiance *= factor,
        }
    }
    scene.environment.iter_mut().for_each(|environment| environment.radiance *= factor);
    if let Integrator::Simple { ambient } = &mut scene.integrator {
        *ambient *= factor;
    }
    scene
}

/// Moves and scales everything: radiance stays as it is, sample by sample, but for rounding.
pub fn transformed(scene: &Scene, scale: f32, shift: Vec3) -> Scene {
    let mut scene = scene.clone();
    let map = Affine3A::from_translation(shift) * Affine3A::from_scale(Vec3::splat(scale));
    for object in &mut scene.objects {
        object.object_to_world = map * object.object_to_world;
    }
    for luminaire in &mut scene.luminaires {
        if let Luminaire::Point { position, intensity }
        | Luminaire::Spot { position, intensity, .. }
        | Luminaire::Photometric { position, intensity, .. } = luminaire
        {
            *position = map.transform_point3(*position);
            *intensity *= scale * scale;
        }
    }
    scene.sensor.position = map.transform_point3(scene.sensor.position);
    scene.sensor.target = map.transform_point3(scene.sensor.target);
    scene
}
