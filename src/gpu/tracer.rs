//! The GPU tracer: a scene on a device, and the kernel that traces batches of it.

use super::commands::{self, Recorder};
use super::model::KernelModel;
use super::shader::Shader;
use super::{Binding, Buffer, Device, Kernel, layout};
use crate::Result;
use crate::accel::Geometry;
use crate::film::{Batch, PixelSum};
use crate::render::{Traced, Tracer};
use crate::scene::{
    EmissiveTriangle, Integrator, Luminaire, LuminaireTable, Material, SampledLuminaire, Scene, Sensor, widen,
};
use ash::vk;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// The most sums of one batch: 16 MiB of results.
const MAX_SUMS: usize = 1 << 20;
/// Workgroups are 8 x 8 pixels (`shaders/path_trace.comp`).
const WORKGROUP: u32 = 8;
/// A path whose surfaces absorb nothing must still end.
const MAX_SURVIVAL: f64 = 0.9999;

/// A scene as the kernels see it: bindings 0 and 1 to 6.
pub(super) struct GpuScene {
    frame: Buffer,
    geometry: Geometry,
    materials: Buffer,
    luminaires: Buffer,
    pub(super) model: KernelModel,
}

impl GpuScene {
    pub(super) fn new(device: &Arc<Device>, scene: &Scene, ray_query: bool) -> Result<Self> {
        let table = LuminaireTable::new(scene);
        let model = KernelModel::with(scene, &table);
        let geometry = Geometry::build(device, scene, ray_query, &model)?;
        let materials: Vec<_> = scene.materials.iter().map(material).collect();
        let luminaires: Vec<_> = (0..table.entries.len()).map(|i| luminaire(scene, &table, i)).collect();
        let frame = [frame(scene, table.entries.len() as u32)];
        Ok(GpuScene {
            frame: Buffer::upload(device, "frame", &frame, vk::BufferUsageFlags::UNIFORM_BUFFER)?,
            geometry,
            materials: Buffer::storage(device, "materials", &materials)?,
            luminaires: Buffer::storage(device, "luminaires", &luminaires)?,
            model,
        })
    }

    /// Bindings 0 to 6.
    pub(super) fn bindings(&self) -> Vec<Binding<'_>> {
        let mut bindings = vec![Binding::Uniform(&self.frame)];
        bindings.extend(self.geometry.bindings());
        bindings.extend([Binding::Storage(&self.materials), Binding::Storage(&self.luminaires)]);
        bindings
    }
}

/// Traces batches on a Vulkan device.
pub struct GpuTracer {
    // Dropped before what it is bound to.
    kernel: Kernel,
    _scene: GpuScene,
    sums: Buffer,
    counters: Buffer,
    readback: Buffer,
    device: Arc<Device>,
}

impl GpuTracer {
    /// Uploads a scene, builds its acceleration structure, and the kernel that it needs.
    ///
    /// # Errors
    /// If the scene is beyond a limit of the device, or the driver fails.
    pub fn new(device: &Arc<Device>, scene: &Scene, ray_query: bool) -> Result<Self> {
        let gpu_scene = GpuScene::new(device, scene, ray_query)?;
        let size = (MAX_SUMS * size_of::<layout::PixelSum>()) as u64;
        let result = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        let sums = Buffer::new(device, "sums", size, result, MemoryLocation::GpuOnly)?;
        let counters =
            Buffer::new(device, "counters", 16, result | vk::BufferUsageFlags::TRANSFER_DST, MemoryLocation::GpuOnly)?;
        // The counters come back behind the sums.
        let readback =
            Buffer::new(device, "readback", size + 16, vk::BufferUsageFlags::TRANSFER_DST, MemoryLocation::GpuToCpu)?;
        let mut bindings = gpu_scene.bindings();
        bindings.extend([Binding::Storage(&sums), Binding::Storage(&counters)]);
        let kernel = Kernel::new(
            device,
            Shader::path_trace(ray_query),
            &gpu_scene.model.constants(),
            &bindings,
            size_of::<layout::Batch>() as u32,
        )?;
        Ok(GpuTracer { kernel, _scene: gpu_scene, sums, counters, readback, device: device.clone() })
    }
}

impl Tracer for GpuTracer {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        let tile = batch.tile;
        let groups = batch.groups();
        let count = tile.pixels() * groups as usize;
        assert!(count <= MAX_SUMS, "a batch of {count} sums is more than max_sums()");
        if count == 0 {
            return Ok(Traced::default());
        }
        let push = layout::Batch {
            tile_x: tile.x,
            tile_y: tile.y,
            tile_width: tile.width,
            tile_height: tile.height,
            first_sample: batch.samples.start,
            end_sample: batch.samples.end,
            group: batch.group,
        };
        let size = (count * size_of::<layout::PixelSum>()) as u64;
        let workgroups = [tile.width.div_ceil(WORKGROUP), tile.height.div_ceil(WORKGROUP), groups];
        let device_seconds = commands::submit(&self.device, "path trace", |cmd| {
            let recorder = Recorder { device: &self.device, cmd };
            recorder.clear(&self.counters);
            recorder.dispatch(&self.kernel, bytemuck::bytes_of(&push), workgroups);
            recorder.read_back(&self.sums, size, &self.readback, 0);
            recorder.read_back(&self.counters, 16, &self.readback, size);
        })?;
        let bytes = &self.readback.mapped()?[..size as usize + 16];
        let (sums, counters) = bytes.split_at(size as usize);
        let sums = bytemuck::cast_slice::<u8, layout::PixelSum>(sums)
            .iter()
            .map(|s| PixelSum { radiance: s.radiance.map(f64::from), rays: s.rays })
            .collect();
        let non_finite = bytemuck::cast_slice::<u8, u32>(counters)[0];
        Ok(Traced { sums, non_finite, device_seconds })
    }

    fn max_sums(&self) -> usize {
        MAX_SUMS
    }

    fn batch_seconds(&self) -> f64 {
        // A GPU also draws the desktop, and its driver kills what runs for seconds.
        if self.device.software { 0.25 } else { 0.05 }
    }
}

/// `v` with a fourth component.
fn vec4(v: Vec3, w: f64) -> [f32; 4] {
    [v.x, v.y, v.z, w as f32]
}

fn frame(scene: &Scene, luminaire_count: u32) -> layout::Frame {
    let Sensor { position, target, up, projection, .. } = scene.sensor;
    let crate::scene::Projection::Perspective { fov } = projection else { unreachable!() };
    // In f64 like the reference: these are rounded once.
    let half = (f64::from(fov).to_radians() / 2.0).tan();
    let forward = (target.as_dvec3() - position.as_dvec3()).normalize();
    let right = forward.cross(up.as_dvec3()).normalize();
    let true_up = right.cross(forward);
    let aspect = f64::from(scene.film.width) / f64::from(scene.film.height);
    let (ambient, max_bounces) = match scene.integrator {
        Integrator::Simple { ambient } => (ambient, 0),
        Integrator::Path(e) => (Vec3::ZERO, e.max_bounces.unwrap_or(u32::MAX)),
    };
    layout::Frame {
        position: vec4(position, 0.0),
        forward: vec4(forward.as_vec3(), 0.0),
        right: vec4((right * half * aspect).as_vec3(), 0.0),
        up: vec4((true_up * half).as_vec3(), 0.0),
        ambient: vec4(ambient, 0.0),
        width: scene.film.width,
        height: scene.film.height,
        seed: scene.settings.seed,
        luminaire_count,
        max_bounces,
        padding: [0; 3],
    }
}

fn material(material: &Material) -> layout::Material {
    let m = f64::from(material.exponent);
    let normalisation = (m + 2.0) * (m + 4.0) / (8.0 * std::f64::consts::PI * ((-m / 2.0).exp2() + m));
    let albedo = material.lambert.as_dvec3() + material.glossy.as_dvec3();
    layout::Material {
        ambient: vec4(material.ambient, normalisation),
        lambert: vec4(material.lambert, albedo.max_element().min(MAX_SURVIVAL)),
        glossy: vec4(material.glossy, m),
        emission: vec4(material.emission, 0.0),
    }
}

fn luminaire(scene: &Scene, table: &LuminaireTable, index: usize) -> layout::Luminaire {
    let (threshold, alias_index) = table.choice.slots[index];
    let pdf = table.choice.pdf[index];
    let entry = layout::Luminaire { threshold, alias_index, ..Default::default() };
    match &table.entries[index] {
        SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => {
            layout::Luminaire { a: vec4(*position, 0.0), radiance: vec4(*intensity, pdf), kind: 0, ..entry }
        }
        SampledLuminaire::Impulse(Luminaire::Infinite { direction, irradiance }) => {
            layout::Luminaire { a: vec4(-*direction, 0.0), radiance: vec4(*irradiance, pdf), kind: 1, ..entry }
        }
        SampledLuminaire::Environment => entry,
        SampledLuminaire::Area(triangle) => {
            let [a, b, c] = triangle.vertices;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let [a, b, c] = [a, b, c].map(|v| v.as_vec3());
            layout::Luminaire {
                a: vec4(a, 0.0),
                b: vec4(b, triangle.area()),
                c: vec4(c, position_error(scene, triangle)),
                normal: vec4(normal.as_vec3(), 0.0),
                radiance: vec4(scene.materials[triangle.material as usize].emission, pdf),
                kind: 2,
                ..entry
            }
        }
    }
}

/// How far a point that the kernel computes on an emissive triangle can lie from the surface that rays meet, in each
/// coordinate: the bounds of `shaders/surfel.glsl`, taken over the whole triangle. They are the rounding of the point itself, of
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
    let mut error = gamma(4.0) * largest(triangle.vertices);
    error += absolute(to_world.matrix3) * (gamma(7.0) * largest(corners) + gamma(4.0) * size * narrow);
    if to_world != DAffine3::IDENTITY {
        let to_object = to_world.inverse();
        let back = absolute(to_object.matrix3) * largest(triangle.vertices) + to_object.translation.abs();
        error += gamma(8.0) * (absolute(to_world.matrix3) * back + to_world.translation.abs());
    }
    error.max_element()
}
