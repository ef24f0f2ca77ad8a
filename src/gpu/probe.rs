//! Runs single shader functions over arrays, so that tests can hold each against its twin.

use super::bound_scene::BoundScene;
use super::layout::{self, ROW_WORKGROUP};
use super::scene::GpuScene;
use super::vulkan::buffer::Buffer;
use super::vulkan::device::Device;
use super::vulkan::kernel::Kernel;
use super::vulkan::shader::Shader;
use crate::Result;
use crate::scene::Scene;
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::cell::RefCell;
use std::sync::Arc;

/// A function of `shaders/probe.comp`. Arguments and results are two `uvec4` a call, floats by their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Function {
    /// pixel, sample, block, seed to four numbers.
    Random4 = 0,
    /// (origin, t_max), (direction) to (t, object, triangle), (barycentrics); a miss has t = infinity.
    ClosestHit = 1,
    /// The same to 0 or 1.
    Occluded = 2,
    /// (u, v) to a direction about +z.
    CosineHemisphere = 3,
    /// (u, v) to barycentric coordinates.
    UniformTriangle = 4,
    /// Random bits to an index into the luminaire table.
    ChooseLuminaire = 5,
    /// (wo, material), (wi) to (f without impulses, pdf) on a surface whose normal is +z.
    Bsdf = 6,
    /// A ray to its first hit, and mirrored off it to the second, which comes back as from `ClosestHit`.
    Leave = 7,
    /// (u, v) to a direction about +z.
    UniformHemisphere = 8,
    /// (u, v, m) to a half vector about +z.
    GlossyHalfVector = 9,
    /// (wo, material), random numbers to (wi, pdf, or -1 for an impulse), (weight, eta^2) on a surface seen from outside whose normal is +z.
    Scatter = 10,
    /// (point, index into the luminaire table), (u, v) to (direction, solid angle); 0 where the triangle is sampled by area.
    SphericalTriangle = 11,
    /// random bits, u, v to (direction, density).
    SampleEnvironment = 12,
    /// A direction to (radiance, density).
    EnvironmentAt = 13,
    /// Texture, u, v to colour and alpha.
    TextureAt = 14,
    /// (wo, eta) to (direction, reflectance), the normal being +z.
    Refract = 15,
    /// Pixel x, y, index, sample to (origin), (direction).
    SensorRay = 16,
    /// pixel, sample, block, seed to the sampler's four numbers.
    Numbers = 17,
    /// pixel, sample, ray, seed and object, triangle to salt and number.
    Coverage = 18,
    /// (turns), (y, x) to sine, cosine, angle.
    SinCos = 19,
    /// (point, random bits), (normal, further bits) to an index into the luminaire table, or `NONE`, and its probability.
    ChooseByTree = 20,
    /// (point, place among the light tree's paths), (normal) to the probability of what is there.
    TreeProbability = 21,
    /// (u, v, index into the luminaire table) to (direction to a disc at infinity, density).
    SampleSun = 22,
    /// (direction, index into the luminaire table) to what the intensity of a spot or a photometric luminaire is multiplied by.
    Intensity = 23,
}

/// The bit of a material in the arguments of [`Function::Bsdf`] and [`Function::Scatter`] that says that the surface is seen from inside.
pub const INSIDE: u32 = 1 << 31;

/// Arguments or results of one call.
pub type Call = [[u32; 4]; 2];

/// Calls that run at once; more are run in pieces.
const PIECE: usize = 1 << 18;

/// The probe with a scene, compiled once for all functions.
pub struct Probe {
    // Dropped before what it is bound to.
    kernel: Kernel,
    /// With the arguments.
    bound: RefCell<BoundScene>,
}

impl Probe {
    /// Uploads a scene.
    ///
    /// # Errors
    /// As for [`super::GpuTracer::new`].
    pub fn new(device: &Arc<Device>, scene: &Scene, ray_query: bool) -> Result<Self> {
        let gpu_scene = GpuScene::new(device, scene, ray_query, |_| {})?;
        let size = (PIECE * size_of::<Call>()) as u64;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let arguments = Buffer::new(device, "probe in", size, usage, MemoryLocation::CpuToGpu)?;
        let bound = BoundScene::new(device, gpu_scene, ("probe out", size), arguments, 0)?;
        let kernel = bound.kernel::<layout::Call>(Shader::probe(ray_query))?;
        Ok(Probe { kernel, bound: RefCell::new(bound) })
    }

    /// Calls `function` once for each of `arguments`.
    ///
    /// # Errors
    /// If the driver fails.
    pub fn call(&self, function: Function, arguments: &[Call]) -> Result<Vec<Call>> {
        let mut bound = self.bound.borrow_mut();
        let mut results = Vec::with_capacity(arguments.len());
        for piece in arguments.chunks(PIECE) {
            let bytes: &[u8] = bytemuck::cast_slice(piece);
            bound.extra.mapped_mut()?[..bytes.len()].copy_from_slice(bytes);
            let push = layout::Call { function: function as u32, count: piece.len() as u32 };
            bound.run("probe", |recorder| {
                recorder.clear(&bound.results);
                recorder.dispatch(&self.kernel, &push, [push.count.div_ceil(ROW_WORKGROUP), 1, 1]);
                recorder.read_back(&bound.results, bytes.len() as u64, 0);
            })?;
            results.extend(bytemuck::pod_collect_to_vec::<u8, Call>(bound.read(bytes.len())?));
        }
        Ok(results)
    }
}
