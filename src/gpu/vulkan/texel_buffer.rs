//! Buffers that shaders read through texel fetches.

use super::buffer::Buffer;
use super::device::Device;
use crate::Result;
use ash::vk;
use bytemuck::Pod;
use std::sync::Arc;

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
