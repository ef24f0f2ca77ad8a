//! Recording and submitting work, one batch at a time.

use super::device::Device;
use crate::Result;
use ash::vk;
use std::sync::Arc;

/// After this long without an answer a device is taken to hang.
const TIMEOUT_NANOSECONDS: u64 = 600_000_000_000;

/// Handles of one submission, freed together.
struct Submission<'a> {
    device: &'a Device,
    pool: vk::CommandPool,
    fence: vk::Fence,
    queries: vk::QueryPool,
}

impl Drop for Submission<'_> {
    fn drop(&mut self) {
        if self.device.is_hung() {
            return;
        }
        // SAFETY: the handles are null or from this device, and the fence said that the work is done (or none was submitted).
        unsafe {
            self.device.raw.destroy_query_pool(self.queries, None);
            self.device.raw.destroy_fence(self.fence, None);
            self.device.raw.destroy_command_pool(self.pool, None);
        }
    }
}

/// Records commands, submits them and waits; returns the seconds that the device worked by its own clock, if it has one.
pub(crate) fn submit(device: &Arc<Device>, name: &str, record: impl FnOnce(vk::CommandBuffer)) -> Result<Option<f64>> {
    let raw = &device.raw;
    let mut submission =
        Submission { device, pool: vk::CommandPool::null(), fence: vk::Fence::null(), queries: vk::QueryPool::null() };
    let pool_info = vk::CommandPoolCreateInfo::default()
        .queue_family_index(device.queue_family)
        .flags(vk::CommandPoolCreateFlags::TRANSIENT);
    // SAFETY: every handle is from this device and alive; the structures live until their call returns; the
    // command buffer is recorded once, submitted once, and the fence is waited for before anything is freed.
    unsafe {
        submission.pool =
            raw.create_command_pool(&pool_info, None).map_err(|e| device.error("vkCreateCommandPool", e))?;
        device.set_name(submission.pool, name);
        submission.fence = raw.create_fence(&Default::default(), None).map_err(|e| device.error("vkCreateFence", e))?;
        device.set_name(submission.fence, name);
        if device.timestamp_mask != 0 {
            let query_info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
            submission.queries =
                raw.create_query_pool(&query_info, None).map_err(|e| device.error("vkCreateQueryPool", e))?;
            device.set_name(submission.queries, name);
        }
        let buffer_info = vk::CommandBufferAllocateInfo::default()
            .command_pool(submission.pool)
            .level(vk::CommandBufferLevel::PRIMARY)
            .command_buffer_count(1);
        let cmd =
            raw.allocate_command_buffers(&buffer_info).map_err(|e| device.error("vkAllocateCommandBuffers", e))?[0];
        device.set_name(cmd, name);
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        raw.begin_command_buffer(cmd, &begin).map_err(|e| device.error("vkBeginCommandBuffer", e))?;
        if device.timestamp_mask != 0 {
            raw.cmd_reset_query_pool(cmd, submission.queries, 0, 2);
            raw.cmd_write_timestamp(cmd, vk::PipelineStageFlags::TOP_OF_PIPE, submission.queries, 0);
        }
        record(cmd);
        if device.timestamp_mask != 0 {
            raw.cmd_write_timestamp(cmd, vk::PipelineStageFlags::BOTTOM_OF_PIPE, submission.queries, 1);
        }
        raw.end_command_buffer(cmd).map_err(|e| device.error("vkEndCommandBuffer", e))?;
        let buffers = [cmd];
        let info = [vk::SubmitInfo::default().command_buffers(&buffers)];
        {
            let queue = device.queue();
            raw.queue_submit(*queue, &info, submission.fence).map_err(|e| device.error("vkQueueSubmit", e))?;
        }
        if let Err(e) = raw.wait_for_fences(&[submission.fence], true, TIMEOUT_NANOSECONDS) {
            // A lost device uses nothing any more, and everything may be freed; after a timeout nothing may.
            if e != vk::Result::ERROR_DEVICE_LOST {
                device.set_hung();
            }
            return Err(device.error("vkWaitForFences", e));
        }
        if device.timestamp_mask == 0 {
            return Ok(None);
        }
        let mut ticks = [0u64; 2];
        raw.get_query_pool_results(
            submission.queries,
            0,
            &mut ticks,
            vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT,
        )
        .map_err(|e| device.error("vkGetQueryPoolResults", e))?;
        let period = f64::from(device.limits.timestamp_period);
        let elapsed = ticks[1].wrapping_sub(ticks[0]) & device.timestamp_mask;
        Ok(Some(elapsed as f64 * period * 1e-9))
    }
}

/// What came before in `from` is done and visible to what comes after in `to`.
pub(crate) fn barrier(
    device: &Device,
    cmd: vk::CommandBuffer,
    from: (vk::PipelineStageFlags, vk::AccessFlags),
    to: (vk::PipelineStageFlags, vk::AccessFlags),
) {
    let memory = [vk::MemoryBarrier::default().src_access_mask(from.1).dst_access_mask(to.1)];
    // SAFETY: called while `cmd` is being recorded, by the closures given to `submit`.
    unsafe { device.raw.cmd_pipeline_barrier(cmd, from.0, to.0, vk::DependencyFlags::empty(), &memory, &[], &[]) };
}
