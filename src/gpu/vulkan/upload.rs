//! Filling device-local buffers.

use super::buffer::Buffer;
use super::device::Device;
use super::submission::{barrier, submit};
use crate::Result;
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// Bytes that one upload moves at most; a larger buffer is filled in pieces.
const STAGING: u64 = 64 << 20;

impl Buffer {
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
            submit(device, "upload", |cmd| {
                // SAFETY: both buffers are alive, and the ranges lie inside them.
                unsafe { device.raw.cmd_copy_buffer(cmd, staging.raw, self.raw, &copy) };
                // To whatever reads it in later submissions: shaders, uniform fetches, builds of acceleration structures.
                let written = (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
                let any = (vk::PipelineStageFlags::ALL_COMMANDS, vk::AccessFlags::MEMORY_READ);
                barrier(device, cmd, written, any);
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
}
