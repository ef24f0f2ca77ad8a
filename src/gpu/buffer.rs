//! Buffers, and texel views of them.

use super::{Device, commands};
use crate::{Error, Result};
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::Arc;

/// Bytes that one upload moves at most; a larger buffer is filled in pieces.
const STAGING: u64 = 64 << 20;

/// A buffer with its memory.
pub struct Buffer {
    pub(crate) raw: vk::Buffer,
    allocation: Option<Allocation>,
    pub(crate) device: Arc<Device>,
}

impl Buffer {
    /// A buffer of at least 16 bytes (an empty one may not exist).
    pub(crate) fn new(
        device: &Arc<Device>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self> {
        let size = size.max(16);
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the device is alive; `info` has no pointers.
        let raw = unsafe { device.raw.create_buffer(&info, None) }.map_err(|e| device.error("vkCreateBuffer", e))?;
        let mut buffer = Buffer { raw, allocation: None, device: device.clone() };
        device.set_name(raw, name);
        // SAFETY: the buffer was made from this device.
        let requirements = unsafe { device.raw.get_buffer_memory_requirements(raw) };
        let allocation = device
            .allocator()
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear: true,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|e| Error::Vulkan {
                call: "allocating memory",
                device: device.name.clone(),
                reason: format!(
                    "{e} ({:.1} MiB for {name}): a smaller scene or picture, or another device",
                    size as f64 / f64::from(1 << 20)
                ),
            })?;
        // SAFETY: the memory is fresh, fits the requirements, and stays until `drop`.
        let bound = unsafe { device.raw.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) };
        buffer.allocation = Some(allocation);
        bound.map_err(|e| device.error("vkBindBufferMemory", e))?;
        Ok(buffer)
    }

    /// A device-local buffer that holds `data`.
    pub(crate) fn upload<T: Pod>(
        device: &Arc<Device>,
        name: &str,
        data: &[T],
        usage: vk::BufferUsageFlags,
    ) -> Result<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Self::new(device, name, bytes.len() as u64, usage, MemoryLocation::GpuOnly)?;
        buffer.write(data)?;
        Ok(buffer)
    }

    /// Puts `data` at the start of a device-local buffer that was made by [`Buffer::upload`] with at least as much.
    pub(crate) fn write<T: Pod>(&self, data: &[T]) -> Result<()> {
        let (device, bytes) = (&self.device, bytemuck::cast_slice::<T, u8>(data));
        let size = (bytes.len() as u64).min(STAGING);
        let mut staging =
            Self::new(device, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, MemoryLocation::CpuToGpu)?;
        for (index, piece) in bytes.chunks(STAGING as usize).enumerate() {
            staging.mapped_mut()?[..piece.len()].copy_from_slice(piece);
            let copy = [vk::BufferCopy { src_offset: 0, dst_offset: index as u64 * STAGING, size: piece.len() as u64 }];
            commands::submit(device, "upload", |cmd| {
                // SAFETY: both buffers are alive, and the ranges lie inside them.
                unsafe { device.raw.cmd_copy_buffer(cmd, staging.raw, self.raw, &copy) };
                // To whatever reads it in later submissions: shaders, uniform fetches, builds of acceleration structures.
                let written = (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
                let any = (vk::PipelineStageFlags::ALL_COMMANDS, vk::AccessFlags::MEMORY_READ);
                commands::barrier(device, cmd, written, any);
            })?;
        }
        Ok(())
    }

    /// A buffer that shaders read by structure; refused if it is beyond what the device can address in one piece
    /// (some drivers drop what lies beyond without a word).
    pub(crate) fn storage<T: Pod>(device: &Arc<Device>, name: &str, data: &[T]) -> Result<Self> {
        let (needed, limit) = (size_of_val(data) as u64, u64::from(device.limits.max_storage_buffer_range));
        let advice = "use less at once, another device, or --backend cpu";
        device.check_limit(name, needed, limit, "bytes (maxStorageBufferRange)", advice)?;
        Self::upload(device, name, data, vk::BufferUsageFlags::STORAGE_BUFFER)
    }

    /// The bytes of a host-visible buffer.
    pub(crate) fn mapped(&self) -> Result<&[u8]> {
        let slice = self.allocation.as_ref().and_then(Allocation::mapped_slice);
        slice.ok_or_else(|| self.device.error("vkMapMemory", vk::Result::ERROR_MEMORY_MAP_FAILED))
    }

    /// The same, to write to.
    pub(crate) fn mapped_mut(&mut self) -> Result<&mut [u8]> {
        let error = self.device.error("vkMapMemory", vk::Result::ERROR_MEMORY_MAP_FAILED);
        self.allocation.as_mut().and_then(Allocation::mapped_slice_mut).ok_or(error)
    }

    /// The device address; the buffer must have been made with `SHADER_DEVICE_ADDRESS`.
    pub(crate) fn address(&self) -> vk::DeviceAddress {
        let info = vk::BufferDeviceAddressInfo::default().buffer(self.raw);
        // SAFETY: the buffer is alive; devices opened with ray query enable the feature, and only those ask.
        unsafe { self.device.raw.get_buffer_device_address(&info) }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        if self.device.is_hung() {
            return;
        }
        // SAFETY: every submission waits for its end before it returns, so the device no longer uses the buffer.
        unsafe { self.device.raw.destroy_buffer(self.raw, None) };
        if let Some(allocation) = self.allocation.take() {
            // A failure to free can only be a bug of the allocator; there is nobody to tell in a drop.
            let _ = self.device.allocator().free(allocation);
        }
    }
}

/// A buffer that shaders read as `uvec4` texels: on lavapipe a texel fetch costs a third of a storage-buffer load (`docs/performance.md`).
pub struct TexelBuffer {
    pub(crate) view: vk::BufferView,
    pub(crate) buffer: Buffer,
}

impl TexelBuffer {
    /// Uploads `data`, whose size is a multiple of 16 bytes; refused if it has more texels than the device can address.
    pub(crate) fn new<T: Pod>(
        device: &Arc<Device>,
        name: &str,
        data: &[T],
        usage: vk::BufferUsageFlags,
    ) -> Result<Self> {
        let (needed, limit) = (size_of_val(data) as u64 / 16, u64::from(device.limits.max_texel_buffer_elements));
        let advice = "use fewer of them (meshes: as instances; images: smaller), another device, or --backend cpu";
        device.check_limit(name, needed, limit, "texels (maxTexelBufferElements)", advice)?;
        let buffer = Buffer::upload(device, name, data, usage | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER)?;
        let info = vk::BufferViewCreateInfo::default()
            .buffer(buffer.raw)
            .format(vk::Format::R32G32B32A32_UINT)
            .range(vk::WHOLE_SIZE);
        // SAFETY: the buffer is alive and allows texel views; every device supports the format for them.
        let view =
            unsafe { device.raw.create_buffer_view(&info, None) }.map_err(|e| device.error("vkCreateBufferView", e))?;
        device.set_name(view, name);
        Ok(TexelBuffer { view, buffer })
    }
}

impl Drop for TexelBuffer {
    fn drop(&mut self) {
        if self.buffer.device.is_hung() {
            return;
        }
        // SAFETY: as for the buffer, which outlives its view: fields are dropped after this.
        unsafe { self.buffer.device.raw.destroy_buffer_view(self.view, None) };
    }
}
