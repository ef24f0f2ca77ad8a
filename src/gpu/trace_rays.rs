//! An intersector by itself: rays in, distances out, timed by the device.

use super::bound_scene::BoundScene;
use super::layout::{self, ROW_WORKGROUP};
use super::probe::Call;
use super::scene::GpuScene;
use super::vulkan::buffer::Buffer;
use super::vulkan::device::Device;
use super::vulkan::kernel::Kernel;
use super::vulkan::shader::Shader;
use crate::Result;
use crate::scene::Scene;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// A scene on a device with the rays to trace in it.
pub struct RayTracer {
    // Dropped before what it is bound to.
    kernel: Kernel,
    /// With the rays.
    bound: BoundScene,
    count: usize,
    /// Seconds that it took to build what rays are traced against and to upload the scene, without the kernel and the rays.
    pub build_seconds: f64,
    /// Bytes of device memory that the scene holds, without the rays.
    pub scene_bytes: u64,
}

impl RayTracer {
    /// Uploads a scene and rays, which are [`Call`]s as for [`super::probe::Function::ClosestHit`].
    ///
    /// # Errors
    /// If the scene or the rays are beyond a limit of the device, or the driver fails.
    pub fn new(device: &Arc<Device>, scene: &Scene, ray_query: bool, rays: &[Call]) -> Result<Self> {
        let before = device.allocated_bytes();
        let start = Instant::now();
        let gpu_scene = GpuScene::new(device, scene, ray_query, |_| {})?;
        let build_seconds = start.elapsed().as_secs_f64();
        let scene_bytes = device.allocated_bytes().saturating_sub(before);
        let ray_buffer = Buffer::storage(device, "rays", rays)?;
        let size = (rays.len() * size_of::<f32>()) as u64;
        let bound = BoundScene::new(device, gpu_scene, ("hits", size), ray_buffer, 0)?;
        let kernel = bound.kernel::<layout::Shots>(Shader::trace_rays(ray_query))?;
        Ok(RayTracer { kernel, bound, count: rays.len(), build_seconds, scene_bytes })
    }

    /// The most repetitions that one [`RayTracer::trace`] can do.
    pub fn most_repeats(&self) -> u32 {
        self.bound.device.limits.max_compute_work_group_count[1]
    }

    /// Traces the rays of a range `repeats` times in one go: to the closest hit, or to `any_hit`. Returns the seconds that it took by the device's
    /// clock, or by the host's where the device has none. More repeats than [`RayTracer::most_repeats`] are that many.
    ///
    /// # Errors
    /// If there are more rays in the range than the device starts workgroups for, or the driver fails.
    ///
    /// # Panics
    /// If there are no such rays.
    pub fn trace(&self, range: Range<usize>, any_hit: bool, repeats: u32) -> Result<f64> {
        assert!(range.start <= range.end && range.end <= self.count, "rays {range:?} of {}", self.count);
        let push = layout::Shots {
            first: range.start as u32,
            count: range.len() as u32,
            any_hit: any_hit.into(),
            never: -1.0,
        };
        let groups = [push.count.div_ceil(ROW_WORKGROUP), repeats.clamp(1, self.most_repeats()), 1];
        let device = &self.bound.device;
        device.check_limit(
            "rays",
            groups[0].into(),
            device.limits.max_compute_work_group_count[0].into(),
            "workgroups (maxComputeWorkGroupCount)",
            "trace fewer rays at once",
        )?;
        let start = Instant::now();
        let by_device = self.bound.run("trace rays", |recorder| recorder.dispatch(&self.kernel, &push, groups))?;
        Ok(by_device.unwrap_or_else(|| start.elapsed().as_secs_f64()))
    }

    /// The first `count` results of the last [`RayTracer::trace`], which had at least so many rays: distances, infinite for a miss; for any hit
    /// 1 where something is in the way, else 0.
    ///
    /// # Errors
    /// If the driver fails.
    ///
    /// # Panics
    /// If there is no room for so many.
    pub fn results(&self, count: usize) -> Result<Vec<f32>> {
        assert!(count <= self.count, "{count} results of {} rays", self.count);
        let size = count * size_of::<f32>();
        if size == 0 {
            return Ok(Vec::new());
        }
        self.bound.run("read hits", |recorder| recorder.read_back(&self.bound.results, size as u64, 0))?;
        Ok(bytemuck::pod_collect_to_vec(self.bound.read(size)?))
    }
}
