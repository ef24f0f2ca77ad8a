//! An intersector by itself: rays in, distances out, timed by the device.

use super::commands::{self, Recorder};
use super::probe::Call;
use super::scene::GpuScene;
use super::shader::Shader;
use super::{Buffer, Device, Kernel, layout};
use crate::Result;
use crate::scene::Scene;
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// Invocations of a workgroup (`shaders/trace_rays.comp`).
const WORKGROUP: u32 = 64;

/// A scene on a device with the rays to trace in it.
pub struct RayTracer {
    // Dropped before what it is bound to.
    kernel: Kernel,
    _scene: GpuScene,
    _rays: Buffer,
    count: usize,
    results: Buffer,
    readback: Buffer,
    device: Arc<Device>,
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
        let (source, target) = (vk::BufferUsageFlags::TRANSFER_SRC, vk::BufferUsageFlags::TRANSFER_DST);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | source;
        let results = Buffer::new(device, "hits", size, usage, MemoryLocation::GpuOnly)?;
        let readback = Buffer::new(device, "hits readback", size, target, MemoryLocation::GpuToCpu)?;
        let kernel = Kernel::new(
            device,
            Shader::trace_rays(ray_query),
            &gpu_scene.model.constants(),
            &gpu_scene.bindings(&results, &ray_buffer),
            size_of::<layout::Shots>() as u32,
        )?;
        Ok(RayTracer {
            kernel,
            _scene: gpu_scene,
            _rays: ray_buffer,
            count: rays.len(),
            results,
            readback,
            device: device.clone(),
            build_seconds,
            scene_bytes,
        })
    }

    /// The most repetitions that one [`RayTracer::trace`] can do.
    pub fn most_repeats(&self) -> u32 {
        self.device.limits.max_compute_work_group_count[1]
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
        let groups = [push.count.div_ceil(WORKGROUP), repeats.clamp(1, self.most_repeats()), 1];
        self.device.check_limit(
            "rays",
            groups[0].into(),
            self.device.limits.max_compute_work_group_count[0].into(),
            "workgroups (maxComputeWorkGroupCount)",
            "trace fewer rays at once",
        )?;
        let start = Instant::now();
        let by_device = commands::submit(&self.device, "trace rays", |cmd| {
            let recorder = Recorder { device: &self.device, cmd };
            recorder.dispatch(&self.kernel, bytemuck::bytes_of(&push), groups);
        })?;
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
        commands::submit(&self.device, "read hits", |cmd| {
            Recorder { device: &self.device, cmd }.read_back(&self.results, size as u64, &self.readback, 0);
        })?;
        Ok(bytemuck::pod_collect_to_vec(&self.readback.mapped()?[..size]))
    }
}
