//! A scene with everything else that a kernel is bound to.

use super::scene::GpuScene;
use super::vulkan::buffer::Buffer;
use super::vulkan::device::Device;
use super::vulkan::kernel::Kernel;
use super::vulkan::recorder::Recorder;
use super::vulkan::shader::Shader;
use super::vulkan::submission::submit;
use crate::Result;
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// A scene on a device, the two buffers that are the kernel's own, and the memory in which the host reads what it wrote.
pub(super) struct BoundScene {
    pub(super) scene: GpuScene,
    /// Binding 7: what the kernel writes.
    pub(super) results: Buffer,
    /// Binding 8: what else it reads or writes.
    pub(super) extra: Buffer,
    readback: Buffer,
    pub(super) device: Arc<Device>,
}

impl BoundScene {
    /// Makes `size` bytes of results, by this name, and reads back as many and `more` bytes.
    pub(super) fn new(
        device: &Arc<Device>,
        scene: GpuScene,
        (name, size): (&str, u64),
        extra: Buffer,
        more: u64,
    ) -> Result<Self> {
        let readback = format!("{name} readback");
        Ok(BoundScene {
            scene,
            results: Self::written(device, name, size)?,
            extra,
            readback: Buffer::new(
                device,
                &readback,
                size + more,
                vk::BufferUsageFlags::TRANSFER_DST,
                MemoryLocation::GpuToCpu,
            )?,
            device: device.clone(),
        })
    }

    /// A buffer that kernels write: it can be cleared and read back.
    pub(super) fn written(device: &Arc<Device>, name: &str, size: u64) -> Result<Buffer> {
        let transfer = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | transfer;
        Buffer::new(device, name, size, usage, MemoryLocation::GpuOnly)
    }

    /// A kernel for the scene's model, bound to all this, with push constants of the type `P`.
    pub(super) fn kernel<P: Pod>(&self, shader: &Shader) -> Result<Kernel> {
        let (constants, bindings) = (self.scene.model.constants(), self.scene.bindings(&self.results, &self.extra));
        Kernel::new(&self.device, shader, &constants, &bindings, size_of::<P>() as u32)
    }

    /// Records commands, submits them and waits; returns the seconds that the device worked by its own clock, if it has one.
    pub(super) fn run(&self, name: &str, record: impl FnOnce(&Recorder<'_>)) -> Result<Option<f64>> {
        submit(&self.device, name, |cmd| {
            record(&Recorder { device: &self.device, cmd, readback: &self.readback });
        })
    }

    /// The first `size` bytes of what was read back last.
    pub(super) fn read(&self, size: usize) -> Result<&[u8]> {
        Ok(&self.readback.mapped()?[..size])
    }
}
