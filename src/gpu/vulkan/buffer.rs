//! Buffers with their memory.

use super::device::Device;
use crate::{Error, Result};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::Arc;

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
            // A failure to free can only be a bug of the allocator; a drop has no way to report it.
            let _ = self.device.allocator().free(allocation);
        }
    }
}
