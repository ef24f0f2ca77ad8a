//! The GPU tracer: a scene on a device, and the kernel that traces batches of it.

use super::bound_scene::BoundScene;
use super::layout::{self, TILE_WORKGROUP};
use super::scene::GpuScene;
use super::specialization::KernelModel;
use super::vulkan::device::Device;
use super::vulkan::kernel::Kernel;
use super::vulkan::shader::Shader;
use crate::Result;
use crate::film::{AovSum, Batch, GROUPS_IN_TURN, PixelSum, Rays, SampleId, Tile};
use crate::render::{SceneTracer, Traced, Tracer};
use crate::scene::{FilmSettings, Integrator, Scene, Sensor};
use std::ops::Range;
use std::sync::Arc;

/// The most sums of one batch: 24 MiB of results.
const MAX_SUMS: usize = 1 << 20;
const DROPPED_SIZE: usize = size_of::<layout::Dropped>();

/// Traces batches on a Vulkan device.
pub struct GpuTracer {
    // Dropped before what they are bound to.
    kernel: Kernel,
    /// For the first hits; made when it is first wanted.
    aov_kernel: Option<Kernel>,
    /// With the sums, and the samples that were not finite.
    bound: BoundScene,
    ray_query: bool,
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
        let dropped = BoundScene::written(device, "dropped", DROPPED_SIZE as u64)?;
        // The samples that were not finite come back behind the sums.
        let bound = BoundScene::new(device, gpu_scene, ("sums", size), dropped, DROPPED_SIZE as u64)?;
        let kernel = bound.kernel::<layout::Batch>(Shader::path_trace(ray_query))?;
        Ok(GpuTracer { kernel, aov_kernel: None, bound, ray_query })
    }
}

impl SceneTracer for GpuTracer {
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        self.bound.scene.look(sensor, film)
    }

    fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        integrator.check_ends()?;
        self.bound.scene.integrate(&self.bound.device, integrator)?;
        // Kernels are bound to buffers that may be gone.
        self.aov_kernel = None;
        self.kernel = self.bound.kernel::<layout::Batch>(Shader::path_trace(self.ray_query))?;
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
        let push = push(tile, batch.samples.clone(), batch.group);
        let size = (count * size_of::<layout::PixelSum>()) as u64;
        let workgroups = [
            tile.width.div_ceil(TILE_WORKGROUP),
            tile.height.div_ceil(TILE_WORKGROUP),
            groups.div_ceil(GROUPS_IN_TURN),
        ];
        let bound = &self.bound;
        let device_seconds = bound.run("path trace", |recorder| {
            recorder.clear(&bound.extra);
            recorder.dispatch(&self.kernel, &push, workgroups);
            recorder.read_back(&bound.results, size, 0);
            recorder.read_back(&bound.extra, DROPPED_SIZE as u64, size);
        })?;
        // Above the bits that count samples.
        let alpha = bound.scene.model.transparent;
        assert!(!alpha || batch.group < layout::MISSED, "groups of less than {} samples", layout::MISSED);
        let missed = |dropped: u32| if alpha { dropped / layout::MISSED } else { 0 };
        let (sums, dropped) = bound.read(size as usize + DROPPED_SIZE)?.split_at(size as usize);
        let sums = bytemuck::cast_slice::<u8, layout::PixelSum>(sums)
            .iter()
            .map(|s| PixelSum {
                radiance: s.radiance.map(f64::from),
                rays: Rays { all: s.rays, shadow: s.shadow_rays },
                dropped: s.dropped - missed(s.dropped) * layout::MISSED,
                missed: missed(s.dropped),
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
            None => self.bound.kernel::<layout::Batch>(Shader::aov(self.ray_query))?,
        };
        let kernel = self.aov_kernel.insert(kernel);
        let push = push(tile, samples, 0);
        let workgroups = [tile.width.div_ceil(TILE_WORKGROUP), tile.height.div_ceil(TILE_WORKGROUP), 1];
        let bound = &self.bound;
        bound.run("first hits", |recorder| {
            recorder.dispatch(kernel, &push, workgroups);
            recorder.read_back(&bound.results, size, 0);
        })?;
        let sums = bytemuck::cast_slice::<u8, layout::AovSum>(bound.read(size as usize)?);
        let sum = |s: &layout::AovSum| AovSum { albedo: s.albedo, depth: s.depth, normal: s.normal, hits: s.hits };
        Ok(sums.iter().map(sum).collect())
    }

    fn max_sums(&self) -> usize {
        MAX_SUMS
    }

    fn batch_seconds(&self) -> f64 {
        // A GPU also draws the desktop, and its driver kills what runs for seconds.
        if self.bound.device.software { 0.25 } else { 0.05 }
    }
}

/// The push constants for samples of a tile.
fn push(tile: Tile, samples: Range<u32>, group: u32) -> layout::Batch {
    layout::Batch {
        tile_x: tile.x,
        tile_y: tile.y,
        tile_width: tile.width,
        tile_height: tile.height,
        first_sample: samples.start,
        end_sample: samples.end,
        group,
    }
}
