//! A scene as the kernels see it: buffers, converted from the plain data.

use super::budget::Budget;
use super::model::KernelModel;
use super::{Binding, Buffer, Device, TexelBuffer, layout};
use crate::Result;
use crate::gpu::accel::Geometry;
use crate::gpu::bvh::MeshBvh;
use crate::scene::{
    EmissiveTriangle, Environment, EnvironmentDistribution, FilmSettings, Integrator, Luminaire, LuminaireTable,
    Material, Projection, SampledLuminaire, Scene, Sensor, Texture, widen,
};
use ash::vk;
use bytemuck::Zeroable;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// Bindings 0 to 6 and 9 to 13.
pub(super) struct GpuScene {
    frame: Buffer,
    /// What `frame` holds.
    frame_data: layout::Frame,
    geometry: Geometry,
    materials: TexelBuffer,
    luminaires: TexelBuffer,
    textures: TexelBuffer,
    texels: TexelBuffer,
    environment_texels: TexelBuffer,
    environment_slots: TexelBuffer,
    pub(super) model: KernelModel,
}

impl GpuScene {
    /// Uploads a scene. `adjust` may change what the kernel models, to more than the scene needs.
    pub(super) fn new(
        device: &Arc<Device>,
        scene: &Scene,
        ray_query: bool,
        adjust: impl FnOnce(&mut KernelModel),
    ) -> Result<Self> {
        let table = LuminaireTable::new(scene);
        let mut model = KernelModel::with(scene, &table);
        adjust(&mut model);
        Budget::of(scene, ray_query, &model).check(device)?;
        let (geometry, places) = Geometry::build(device, scene, ray_query, &model)?;
        let materials: Vec<_> = (0..scene.materials.len()).map(|i| material(scene, &table, i)).collect();
        let luminaires = luminaires(scene, &table, &places);
        let texel = |name: &str, data: &[[u32; 4]]| TexelBuffer::new(device, name, data, vk::BufferUsageFlags::empty());
        let (textures, texels) = if model.features.textures || model.features.holes {
            pack_textures(&scene.textures)
        } else {
            Default::default()
        };
        let (environment_texels, environment_slots) = match (&scene.environment, &table.environment) {
            (Some(environment), Some(distribution)) => pack_environment(environment, distribution),
            _ => Default::default(),
        };
        let frame_data = frame(scene, &table);
        Ok(GpuScene {
            frame: Buffer::upload(device, "frame", &[frame_data], vk::BufferUsageFlags::UNIFORM_BUFFER)?,
            frame_data,
            geometry,
            materials: TexelBuffer::new(device, "materials", &materials, vk::BufferUsageFlags::empty())?,
            luminaires: TexelBuffer::new(device, "luminaires", &luminaires, vk::BufferUsageFlags::empty())?,
            textures: texel("textures", &textures)?,
            texels: texel("texels", &texels)?,
            environment_texels: texel("environment", &environment_texels)?,
            environment_slots: texel("environment choice", &environment_slots)?,
            model,
        })
    }

    /// Puts another camera and film in the place of the present ones. The kind of projection has to stay: it is a part of the kernel.
    pub(super) fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        aim(&mut self.frame_data, sensor, film);
        self.frame.write(&[self.frame_data])
    }

    /// Puts another integrator in the place of the present one; the kernel has to be made again, with the constants of `model`.
    pub(super) fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        self.model.integrator = *integrator;
        estimate(&mut self.frame_data, integrator);
        self.frame.write(&[self.frame_data])
    }

    /// Bindings 0 to 13, of which 7 and 8 are the caller's.
    pub(super) fn bindings<'a>(&'a self, seven: &'a Buffer, eight: &'a Buffer) -> Vec<Binding<'a>> {
        let [intersector, triangles, normals, objects, uvs] = self.geometry.bindings();
        vec![
            Binding::Uniform(&self.frame),
            intersector,
            triangles,
            normals,
            objects,
            Binding::Texel(&self.materials),
            Binding::Texel(&self.luminaires),
            Binding::Storage(seven),
            Binding::Storage(eight),
            uvs,
            Binding::Texel(&self.textures),
            Binding::Texel(&self.texels),
            Binding::Texel(&self.environment_texels),
            Binding::Texel(&self.environment_slots),
        ]
    }
}

/// `v` with a fourth component.
fn vec4(v: Vec3, w: f64) -> [f32; 4] {
    [v.x, v.y, v.z, w as f32]
}

fn frame(scene: &Scene, table: &LuminaireTable) -> layout::Frame {
    let (radiance, rotation) = scene.environment.as_ref().map_or((Vec3::ZERO, 0.0), |e| (e.radiance, e.rotation));
    let (environment_width, environment_height) = table.environment.as_ref().map_or((1, 1), |e| (e.width, e.height));
    let mut frame = layout::Frame {
        environment: vec4(radiance, table.environment_probability()),
        seed: scene.settings.seed,
        luminaire_count: table.entries.len() as u32,
        environment_width,
        environment_height,
        environment_rotation: (f64::from(rotation) / 360.0).rem_euclid(1.0) as f32,
        ..Zeroable::zeroed()
    };
    aim(&mut frame, &scene.sensor, &scene.film);
    estimate(&mut frame, &scene.integrator);
    frame
}

/// Puts the integrator's numbers into a frame.
fn estimate(frame: &mut layout::Frame, integrator: &Integrator) {
    let (ambient, max_bounces, albedo_threshold) = match *integrator {
        Integrator::Simple { ambient } => (ambient, 0, 0.0),
        Integrator::Path(estimator) => {
            (Vec3::ZERO, estimator.max_bounces.unwrap_or(u32::MAX), estimator.albedo_threshold.unwrap_or(0.0))
        }
    };
    frame.ambient = vec4(ambient, 0.0);
    (frame.max_bounces, frame.albedo_threshold) = (max_bounces, albedo_threshold);
}

/// Puts the camera and the film into a frame.
fn aim(frame: &mut layout::Frame, sensor: &Sensor, film: &FilmSettings) {
    let Sensor { position, target, up, projection, lens } = *sensor;
    // In f64 like the reference: these are rounded once.
    let forward = (target.as_dvec3() - position.as_dvec3()).normalize();
    let right = forward.cross(up.as_dvec3()).normalize();
    let true_up = right.cross(forward);
    let aspect = f64::from(film.width) / f64::from(film.height);
    let half = match projection {
        Projection::Perspective { fov } => (f64::from(fov).to_radians() / 2.0).tan(),
        Projection::Orthographic { height } => f64::from(height) / 2.0,
    };
    frame.position = vec4(position, 0.0);
    frame.forward = vec4(forward.as_vec3(), 0.0);
    frame.right = vec4((right * half * aspect).as_vec3(), 0.0);
    frame.up = vec4((true_up * half).as_vec3(), 0.0);
    frame.lens = lens.map_or([0.0, 1.0, 0.0, 0.0], |l| {
        [l.radius, l.focus_distance, l.blades as f32, (f64::from(l.rotation) / 360.0).rem_euclid(1.0) as f32]
    });
    (frame.width, frame.height) = (film.width, film.height);
    for (knot, offset) in film.filter.inverse_cdf(film.filter_radius).into_iter().enumerate() {
        frame.filter_table[knot / 4][knot % 4] = offset;
    }
}

fn material(scene: &Scene, table: &LuminaireTable, index: usize) -> layout::Material {
    let material: &Material = &scene.materials[index];
    let m = f64::from(material.exponent);
    let normalisation = (m + 2.0) * (m + 4.0) / (8.0 * PI * ((-m / 2.0).exp2() + m));
    let map = |map: Option<u32>| map.unwrap_or(u32::MAX);
    let maps = material.maps;
    let transmission = if material.eta.is_some() { material.transmission } else { Vec3::ZERO };
    layout::Material {
        ambient: vec4(material.ambient, normalisation),
        lambert: vec4(material.lambert, material.impulse_probability.map_or(-1.0, f64::from)),
        glossy: vec4(material.glossy, m),
        emission: vec4(material.emission, table.area_density[index]),
        reflection: vec4(material.reflection, material.eta.map_or(0.0, f64::from)),
        transmission: vec4(transmission, f64::from(material.opacity)),
        maps: [map(maps.ambient), map(maps.lambert), map(maps.glossy), map(maps.emission)],
        opacity_map: map(maps.opacity),
        one_sided: u32::from(material.one_sided),
        padding: [0; 2],
    }
}

/// The luminaire table; `places` says where the kernel has each mesh's triangles.
fn luminaires(scene: &Scene, table: &LuminaireTable, places: &[MeshBvh]) -> Vec<layout::Luminaire> {
    // For each mesh that emits, the place of each of its triangles.
    let mut place_of: Vec<Vec<u32>> = vec![Vec::new(); scene.meshes.len()];
    let mut luminaires = Vec::with_capacity(table.entries.len());
    for (index, entry) in table.entries.iter().enumerate() {
        let (threshold, alias_index) = table.choice.slots[index];
        let pdf = table.choice.pdf[index];
        let empty = layout::Luminaire { threshold, alias_index, ..Zeroable::zeroed() };
        luminaires.push(match entry {
            SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => {
                layout::Luminaire { a: vec4(*position, 0.0), radiance: vec4(*intensity, pdf), kind: 0, ..empty }
            }
            SampledLuminaire::Impulse(Luminaire::Infinite { direction, irradiance }) => {
                layout::Luminaire { a: vec4(-*direction, 0.0), radiance: vec4(*irradiance, pdf), kind: 1, ..empty }
            }
            SampledLuminaire::Area(triangle) => {
                let mesh = scene.objects[triangle.object as usize].mesh as usize;
                if place_of[mesh].is_empty() {
                    place_of[mesh] = inverse(&places[mesh]);
                }
                let [a, b, c] = triangle.vertices;
                let one_sided = scene.materials[triangle.material as usize].one_sided;
                let [a, b, c] = [a, b, c].map(|v| v.as_vec3());
                layout::Luminaire {
                    a: vec4(a, 0.0),
                    b: vec4(b, triangle.area()),
                    c: vec4(c, position_error(scene, triangle)),
                    normal: vec4(triangle.normal.as_vec3(), f64::from(u8::from(one_sided))),
                    radiance: vec4(scene.materials[triangle.material as usize].emission, pdf),
                    kind: 2,
                    triangle: place_of[mesh][triangle.triangle as usize],
                    material: triangle.material,
                    ..empty
                }
            }
            SampledLuminaire::Environment => layout::Luminaire { radiance: vec4(Vec3::ZERO, pdf), kind: 3, ..empty },
        });
    }
    luminaires
}

/// For each triangle of a mesh, its place among all triangles.
fn inverse(mesh: &MeshBvh) -> Vec<u32> {
    let mut places = vec![0; mesh.order.len()];
    for (place, triangle) in mesh.order.iter().enumerate() {
        places[*triangle as usize] = mesh.triangle_offset + place as u32;
    }
    places
}

/// A texel for each texture (first texel, width, height, clamped), and all their texels, two in one.
fn pack_textures(textures: &[Arc<Texture>]) -> (Vec<[u32; 4]>, Vec<[u32; 4]>) {
    let mut headers = Vec::with_capacity(textures.len());
    let mut halves: Vec<[u32; 2]> = Vec::with_capacity(textures.iter().map(|t| t.texels.len()).sum::<usize>() + 1);
    for texture in textures {
        headers.push([halves.len() as u32, texture.width, texture.height, u32::from(texture.clamp)]);
        halves.extend(texture.texels.iter().map(|texel| {
            let [r, g, b, a] = texel.map(|half| u32::from(half.to_bits()));
            [r | g << 16, b | a << 16]
        }));
    }
    (headers, pairs(halves))
}

/// The environment's texels with their densities, and its alias table.
fn pack_environment(
    environment: &Environment,
    distribution: &EnvironmentDistribution,
) -> (Vec<[u32; 4]>, Vec<[u32; 4]>) {
    let radiance = |texel: usize| environment.image.as_ref().map_or(Vec3::ONE, |image| image.texels[texel]);
    let texel = |(index, density): (usize, &f64)| {
        let Vec3 { x, y, z } = radiance(index);
        [x, y, z, *density as f32].map(f32::to_bits)
    };
    let texels = distribution.density.iter().enumerate().map(texel).collect();
    (texels, pairs(distribution.choice.slots.iter().map(|(threshold, alias)| [*threshold, *alias]).collect()))
}

/// Two in one, the last filled up with zeros.
fn pairs(mut halves: Vec<[u32; 2]>) -> Vec<[u32; 4]> {
    if halves.len() % 2 == 1 {
        halves.push([0; 2]);
    }
    halves.chunks_exact(2).map(|p| [p[0][0], p[0][1], p[1][0], p[1][1]]).collect()
}

/// How far a point that the kernel computes on an emissive triangle can lie from the surface that rays meet, in each
/// coordinate, so far as it lies across the surface: the bounds of `shaders/surfel.glsl`, taken over the whole triangle. They are the rounding of the point itself, of
/// the triangle test (by the triangle's size, and the more the narrower it is), and of the transforms.
fn position_error(scene: &Scene, triangle: &EmissiveTriangle) -> f64 {
    let gamma = |n: f64| n * f64::from(f32::EPSILON) * 0.5;
    let absolute = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let object = &scene.objects[triangle.object as usize];
    let mesh = &scene.meshes[object.mesh as usize];
    let corners = mesh.triangles[triangle.triangle as usize].vertices.map(|v| mesh.positions[v as usize].as_dvec3());
    let [a, b, c] = corners;
    let size = ((b - a).abs() + (c - a).abs()).max_element();
    let narrow = (size * size / (b - a).cross(c - a).abs().max_element()).min(256.0);
    let to_world = widen(object.object_to_world);
    let largest = |points: [DVec3; 3]| points.iter().fold(DVec3::ZERO, |m, v| m.max(v.abs()));
    let reach = largest(triangle.vertices);
    let mut in_object = gamma(7.0) * largest(corners) + gamma(4.0) * size * narrow;
    let mut in_world = gamma(4.0) * reach;
    if to_world != DAffine3::IDENTITY {
        let to_object = to_world.inverse();
        in_object += gamma(5.0) * (absolute(to_object.matrix3) * reach + to_object.translation.abs());
        in_world += gamma(4.0) * (absolute(to_world.matrix3) * largest(corners) + to_world.translation.abs());
    }
    // Only what is across the triangle matters, and a transform takes distances across it to such by one factor.
    let object_normal = (b - a).cross(c - a).normalize();
    let normal = to_world.matrix3.inverse().transpose() * object_normal;
    let unit = normal.normalize().abs();
    let across = object_normal.abs().dot(in_object) / normal.length() + unit.dot(in_world);
    // As the same number for each coordinate, of which the kernel takes the part across the triangle.
    across / unit.element_sum()
}
