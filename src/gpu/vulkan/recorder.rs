//! Recording a run of a kernel.

use super::buffer::Buffer;
use super::device::Device;
use super::kernel::Kernel;
use super::submission::barrier;
use ash::vk;
use bytemuck::Pod;

/// Records the three parts of every kernel run, with the barriers between them.
pub(in crate::gpu) struct Recorder<'a> {
    pub(in crate::gpu) device: &'a Device,
    pub(in crate::gpu) cmd: vk::CommandBuffer,
    /// Where [`Recorder::read_back`] copies to.
    pub(in crate::gpu) readback: &'a Buffer,
}

impl Recorder<'_> {
    /// Fills a buffer with zeros, before the kernel.
    pub(in crate::gpu) fn clear(&self, buffer: &Buffer) {
        // SAFETY: called while the commands are being recorded; the buffer is alive until the submission has ended.
        unsafe { self.device.raw.cmd_fill_buffer(self.cmd, buffer.raw, 0, vk::WHOLE_SIZE, 0) };
    }

    /// Runs the kernel on what was cleared.
    pub(in crate::gpu) fn dispatch(&self, kernel: &Kernel, push: &impl Pod, groups: [u32; 3]) {
        let shader_access = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
        let written = (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
        barrier(self.device, self.cmd, written, (vk::PipelineStageFlags::COMPUTE_SHADER, shader_access));
        kernel.dispatch(self.cmd, bytemuck::bytes_of(push), groups);
        let results = (vk::PipelineStageFlags::COMPUTE_SHADER, vk::AccessFlags::SHADER_WRITE);
        let copies = (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_READ);
        barrier(self.device, self.cmd, results, copies);
    }

    /// Copies the first `size` bytes of a buffer to an offset in the memory that the host reads after the submission.
    pub(in crate::gpu) fn read_back(&self, from: &Buffer, size: u64, offset: u64) {
        let copy = [vk::BufferCopy { src_offset: 0, dst_offset: offset, size }];
        // SAFETY: called while the commands are being recorded; both buffers are alive until the submission has ended, and
        // the callers' ranges lie inside them.
        unsafe { self.device.raw.cmd_copy_buffer(self.cmd, from.raw, self.readback.raw, &copy) };
        let written = (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
        barrier(self.device, self.cmd, written, (vk::PipelineStageFlags::HOST, vk::AccessFlags::HOST_READ));
    }
}
