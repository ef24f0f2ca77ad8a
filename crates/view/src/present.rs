//! Shows pictures from host memory in a window.
//!
//! A picture is written to a buffer and copied from there to an image of the swapchain; no second one is written before the copy has ended. The
//! swapchain is made again when the window's size changes, the surface when it is lost.

use super::chain::Chain;
use super::device::Device;
use super::surface::Surface;
use ash::vk;
use luminaire::Result;
use std::sync::Arc;
use winit::window::Window;

/// The most nanoseconds to wait for an image; then the window's events come first, and the picture is tried again.
const PATIENCE: u64 = 100_000_000;
/// The most nanoseconds to wait for the last copy; then the device counts as hanging.
const HANGS: u64 = 10_000_000_000;

/// Writes a picture of a size into rows of four bytes a pixel, with blue first if the last argument says so.
pub type Fill<'a> = dyn FnMut(&mut [u8], (u32, u32), bool) + 'a;

/// A window and the device that fills it.
pub struct Presenter {
    /// None before the first picture, and after anything has changed.
    chain: Option<Chain>,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    /// Signalled when the last copy is done.
    copied: vk::Fence,
    /// Signalled when the image that was acquired may be written.
    acquired: vk::Semaphore,
    // Declared after everything that was made from it, and so dropped after it.
    device: Device,
    // Declared after the device, which must be destroyed first.
    surface: Surface,
}

impl Presenter {
    /// Opens the best device that can present to a window.
    ///
    /// # Errors
    /// If there is none, with the reason for each, or the driver fails.
    pub fn new(window: &Arc<Window>) -> Result<Self> {
        let surface = Surface::of(window)?;
        let device = Device::best_for(&surface)?;
        let mut presenter = Presenter {
            chain: None,
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            copied: vk::Fence::null(),
            acquired: vk::Semaphore::null(),
            device,
            surface,
        };
        presenter.prepare()?;
        Ok(presenter)
    }

    /// Makes the handles.
    fn prepare(&mut self) -> Result<()> {
        let device = &self.device;
        let raw = &device.raw;
        let failed = |call| move |e| device.error(call, e);
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(device.family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let done = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        // SAFETY: the device is alive; the structures live until their call returns. What is made is destroyed by `drop`, also
        // if a later call fails.
        unsafe {
            self.pool = raw.create_command_pool(&pool, None).map_err(failed("vkCreateCommandPool"))?;
            let buffers = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
            self.commands = raw.allocate_command_buffers(&buffers).map_err(failed("vkAllocateCommandBuffers"))?[0];
            self.copied = raw.create_fence(&done, None).map_err(failed("vkCreateFence"))?;
            self.acquired = raw.create_semaphore(&Default::default(), None).map_err(failed("vkCreateSemaphore"))?;
        }
        Ok(())
    }

    /// Shows what `fill` writes. False if nothing can be shown now: the window has no size, or no image is free.
    ///
    /// # Errors
    /// If the driver fails with anything but a change of the window.
    pub fn show(&mut self, fill: &mut Fill<'_>) -> Result<bool> {
        // A window may change again while all is made anew, but not forever.
        for _ in 0..8 {
            if self.chain.is_none() {
                match self.new_chain() {
                    Ok(chain) => self.chain = chain,
                    Err(vk::Result::ERROR_SURFACE_LOST_KHR) => {
                        self.new_surface()?;
                        continue;
                    }
                    Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => continue,
                    Err(e) => return Err(self.device.error("vkCreateSwapchainKHR", e)),
                }
            }
            if self.chain.is_none() {
                return Ok(false);
            }
            match self.present(fill) {
                Ok(suboptimal) => {
                    if suboptimal {
                        self.drop_chain();
                    }
                    return Ok(true);
                }
                Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => return Ok(false),
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.drop_chain(),
                Err(vk::Result::ERROR_SURFACE_LOST_KHR) => self.new_surface()?,
                Err(e) => return Err(self.device.error("presenting", e)),
            }
        }
        Ok(false)
    }

    /// Forgets the swapchain, because the window has another size.
    pub fn drop_chain(&mut self) {
        if let Some(chain) = self.chain.take() {
            self.device.rest();
            // SAFETY: every chain here is made with this device, which rests.
            unsafe { chain.destroy(&self.device) };
        }
    }

    fn new_surface(&mut self) -> Result<()> {
        self.drop_chain();
        // SAFETY: the swapchain was dropped.
        unsafe { self.surface.renew() }?;
        self.device.check_presents_to(&self.surface)
    }

    /// A swapchain of the window's size; none while it has no size.
    fn new_chain(&self) -> ash::prelude::VkResult<Option<Chain>> {
        let can = self.device.capabilities(&self.surface)?;
        let size = self.surface.window.inner_size();
        let extent = match can.current_extent {
            // On Wayland the swapchain determines the size.
            vk::Extent2D { width: u32::MAX, .. } => vk::Extent2D {
                width: size.width.clamp(can.min_image_extent.width, can.max_image_extent.width),
                height: size.height.clamp(can.min_image_extent.height, can.max_image_extent.height),
            },
            extent => extent,
        };
        if extent.width == 0 || extent.height == 0 || size.width == 0 || size.height == 0 {
            return Ok(None);
        }
        Chain::new(&self.device, &self.surface, &can, extent).map(Some)
    }

    /// Fills an image and queues it for the window; true if the swapchain does not fit the window any more.
    fn present(&mut self, fill: &mut Fill<'_>) -> ash::prelude::VkResult<bool> {
        let chain = self.chain.as_mut().expect("show() has made it");
        let Device { raw: device, swapchains, queue, .. } = &self.device;
        let commands = self.commands;
        let fences = [self.copied];
        // SAFETY: all handles are alive and of this device, and used by this thread alone. The fence says that the last copy has ended, so
        // its command buffer, its staging memory and the semaphore it waited for are free; an image is written only after `acquired`,
        // for which the copy waits, and presented after `done`, which the copy signals.
        unsafe {
            device.wait_for_fences(&fences, true, HANGS).map_err(|e| match e {
                vk::Result::TIMEOUT => vk::Result::ERROR_DEVICE_LOST,
                other => other,
            })?;
            let (index, mut suboptimal) =
                swapchains.acquire_next_image(chain.raw, PATIENCE, self.acquired, vk::Fence::null())?;
            let extent = (chain.extent.width, chain.extent.height);
            fill(chain.staging(), extent, self.device.blue_first());
            device.reset_fences(&fences)?;
            device.begin_command_buffer(
                commands,
                &vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT),
            )?;
            chain.record(&self.device, commands, index as usize);
            device.end_command_buffer(commands)?;
            let (acquired, done, stages) =
                ([self.acquired], [chain.done(index as usize)], [vk::PipelineStageFlags::TRANSFER]);
            let buffers = [commands];
            let submit = [vk::SubmitInfo::default()
                .wait_semaphores(&acquired)
                .wait_dst_stage_mask(&stages)
                .command_buffers(&buffers)
                .signal_semaphores(&done)];
            device.queue_submit(*queue, &submit, self.copied)?;
            self.surface.window.pre_present_notify();
            let (chains, indices) = ([chain.raw], [index]);
            let info = vk::PresentInfoKHR::default().wait_semaphores(&done).swapchains(&chains).image_indices(&indices);
            suboptimal |= swapchains.queue_present(*queue, &info)?;
            Ok(suboptimal)
        }
    }
}

impl Drop for Presenter {
    fn drop(&mut self) {
        self.drop_chain();
        self.device.rest();
        let raw = &self.device.raw;
        // SAFETY: the handles are null or of this device, which has come to rest and is destroyed after them.
        unsafe {
            raw.destroy_semaphore(self.acquired, None);
            raw.destroy_fence(self.copied, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}
