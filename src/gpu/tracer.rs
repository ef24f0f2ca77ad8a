//! The GPU tracer: a scene on a device, and the kernel that traces batches of it.

use super::commands::{self, Recorder};
use super::model::KernelModel;
use super::scene::GpuScene;
use super::shader::Shader;
use super::{Buffer, Device, Kernel, layout};
use crate::Result;
use crate::film::{AovSum, Batch, PixelSum, Rays, SampleId, Tile};
use crate::render::{SceneTracer, Traced, Tracer};
use crate::sampling::PARTS;
use crate::scene::{FilmSettings, Integrator, Scene, Sensor};
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::ops::Range;
use std::sync::Arc;

/// The most sums of one batch: 24 MiB of results.
const MAX_SUMS: usize = 1 << 20;
/// Workgroups are 8 x 8 pixels (`shaders/path_trace.comp`).
const WORKGROUP: u32 = 8;
const DROPPED_SIZE: usize = size_of::<layout::Dropped>();

/// Traces batches on a Vulkan device.
pub struct GpuTracer {
    // Dropped before what they are bound to.
    kernel: Kernel,
    /// For the first hits; made when it is first wanted.
    aov_kernel: Option<Kernel>,
    scene: GpuScene,
    ray_query: bool,
    sums: Buffer,
    dropped: Buffer,
    readback: Buffer,
    device: Arc<Device>,
}

impl GpuTracer {
    /// Uploads a scene, builds its acceleration structure, and the kernel that it needs. The caller sees to it that the estimator ends
    /// ([`crate::scene::Estimator::ends`]); [`crate::backend::open`] refuses the others.
    ///
    /// # Errors
    /// If the scene is beyond a limit of the device, or the driver fails.
    pub fn new(device: &Arc<Device>, scene: &Scene, ray_query: bool) -> Result<Self> {
        Self::with_model(device, scene, ray_query, |_| {})
    }

    /// The same with a kernel that models what `adjust` says, which has to be no less than the scene needs: the picture is the same,
    /// and slower. For tests and measurements.
    ///
    /// # Errors
    /// As for [`GpuTracer::new`].
    pub fn with_model(
        device: &Arc<Device>,
        scene: &Scene,
        ray_query: bool,
        adjust: impl FnOnce(&mut KernelModel),
    ) -> Result<Self> {
        let gpu_scene = GpuScene::new(device, scene, ray_query, adjust)?;
        let size = (MAX_SUMS * size_of::<layout::PixelSum>()) as u64;
        let result = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        let sums = Buffer::new(device, "sums", size, result, MemoryLocation::GpuOnly)?;
        let dropped_usage = result | vk::BufferUsageFlags::TRANSFER_DST;
        let dropped = Buffer::new(device, "dropped", DROPPED_SIZE as u64, dropped_usage, MemoryLocation::GpuOnly)?;
        // The samples that were not finite come back behind the sums.
        let readback_size = size + DROPPED_SIZE as u64;
        let readback = Buffer::new(
            device,
            "readback",
            readback_size,
            vk::BufferUsageFlags::TRANSFER_DST,
            MemoryLocation::GpuToCpu,
        )?;
        let kernel = kernel(device, &gpu_scene, ray_query, &sums, &dropped)?;
        Ok(GpuTracer {
            kernel,
            aov_kernel: None,
            scene: gpu_scene,
            ray_query,
            sums,
            dropped,
            readback,
            device: device.clone(),
        })
    }
}

/// The kernel for a scene's model, bound to its buffers.
fn kernel(device: &Arc<Device>, scene: &GpuScene, ray_query: bool, sums: &Buffer, dropped: &Buffer) -> Result<Kernel> {
    let (constants, bindings) = (scene.model.constants(), scene.bindings(sums, dropped));
    Kernel::new(device, Shader::path_trace(ray_query), &constants, &bindings, size_of::<layout::Batch>() as u32)
}

impl SceneTracer for GpuTracer {
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        self.scene.look(sensor, film)
    }

    fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        integrator.check_ends()?;
        self.scene.integrate(integrator)?;
        self.kernel = kernel(&self.device, &self.scene, self.ray_query, &self.sums, &self.dropped)?;
        Ok(())
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
        let workgroups = [tile.width.div_ceil(WORKGROUP), tile.height.div_ceil(WORKGROUP), groups.div_ceil(PARTS)];
        let device_seconds = commands::submit(&self.device, "path trace", |cmd| {
            let recorder = Recorder { device: &self.device, cmd };
            recorder.clear(&self.dropped);
            recorder.dispatch(&self.kernel, bytemuck::bytes_of(&push), workgroups);
            recorder.read_back(&self.sums, size, &self.readback, 0);
            recorder.read_back(&self.dropped, DROPPED_SIZE as u64, &self.readback, size);
        })?;
        let bytes = &self.readback.mapped()?[..size as usize + DROPPED_SIZE];
        let (sums, dropped) = bytes.split_at(size as usize);
        let sums = bytemuck::cast_slice::<u8, layout::PixelSum>(sums)
            .iter()
            .map(|s| PixelSum {
                radiance: s.radiance.map(f64::from),
                rays: Rays { all: s.rays, shadow: s.shadow_rays },
                dropped: s.dropped,
            })
            .collect();
        let dropped: &layout::Dropped = bytemuck::from_bytes(dropped);
        let named = dropped.samples.iter().take(dropped.count as usize);
        let mut dropped: Vec<_> = named.map(|&[pixel, sample]| SampleId { pixel, sample }).collect();
        dropped.sort();
        Ok(Traced { sums, dropped, device_seconds })
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        let size = (tile.pixels() * size_of::<layout::AovSum>()) as u64;
        assert!(tile.pixels() <= MAX_SUMS / 2, "{} pixels are more than max_sums() / 2", tile.pixels());
        if size == 0 {
            return Ok(vec![]);
        }
        let kernel = match self.aov_kernel.take() {
            Some(kernel) => kernel,
            None => Kernel::new(
                &self.device,
                Shader::aov(self.ray_query),
                &self.scene.model.constants(),
                &self.scene.bindings(&self.sums, &self.dropped),
                size_of::<layout::Batch>() as u32,
            )?,
        };
        let kernel = self.aov_kernel.insert(kernel);
        let push = layout::Batch {
            tile_x: tile.x,
            tile_y: tile.y,
            tile_width: tile.width,
            tile_height: tile.height,
            first_sample: samples.start,
            end_sample: samples.end,
            group: 0,
        };
        let workgroups = [tile.width.div_ceil(WORKGROUP), tile.height.div_ceil(WORKGROUP), 1];
        commands::submit(&self.device, "first hits", |cmd| {
            let recorder = Recorder { device: &self.device, cmd };
            recorder.dispatch(kernel, bytemuck::bytes_of(&push), workgroups);
            recorder.read_back(&self.sums, size, &self.readback, 0);
        })?;
        let sums = bytemuck::cast_slice::<u8, layout::AovSum>(&self.readback.mapped()?[..size as usize]);
        let sum = |s: &layout::AovSum| AovSum { albedo: s.albedo, depth: s.depth, normal: s.normal, hits: s.hits };
        Ok(sums.iter().map(sum).collect())
    }

    fn max_sums(&self) -> usize {
        MAX_SUMS
    }

    fn batch_seconds(&self) -> f64 {
        // A GPU also draws the desktop, and its driver kills what runs for seconds.
        if self.device.software { 0.25 } else { 0.05 }
    }
}
