//! A swapchain, and the memory from which pictures are copied to its images.

use super::device::Device;
use super::surface::Surface;
use ash::vk;

/// The images of a window of one size.
pub struct Chain {
    pub(super) raw: vk::SwapchainKHR,
    pub(super) extent: vk::Extent2D,
    images: Vec<vk::Image>,
    /// For each image, signalled when the copy to it has ended.
    done: Vec<vk::Semaphore>,
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    /// Where all of the memory is mapped, until it is freed.
    mapped: *mut u8,
}

impl Chain {
    /// A swapchain with `extent`, which the surface allows and is not empty.
    pub(super) fn new(
        device: &Device,
        surface: &Surface,
        can: &vk::SurfaceCapabilitiesKHR,
        extent: vk::Extent2D,
    ) -> ash::prelude::VkResult<Self> {
        let most = if can.max_image_count == 0 { u32::MAX } else { can.max_image_count };
        // The window is opaque wherever the surface allows it.
        let alpha = if can.supported_composite_alpha.contains(vk::CompositeAlphaFlagsKHR::OPAQUE) {
            vk::CompositeAlphaFlagsKHR::OPAQUE
        } else {
            // The first that it allows instead.
            vk::CompositeAlphaFlagsKHR::from_raw(1 << can.supported_composite_alpha.as_raw().trailing_zeros())
        };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count((can.min_image_count + 1).min(most))
            .image_format(device.format.format)
            .image_color_space(device.format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::TRANSFER_DST)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(can.current_transform)
            .composite_alpha(alpha)
            // The only mode that every device has.
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true);
        let mut chain = Chain {
            raw: vk::SwapchainKHR::null(),
            extent,
            images: vec![],
            done: vec![],
            buffer: vk::Buffer::null(),
            memory: vk::DeviceMemory::null(),
            mapped: std::ptr::null_mut(),
        };
        match chain.fill(device, &info) {
            Ok(()) => Ok(chain),
            Err(e) => {
                // SAFETY: nothing of it was used yet.
                unsafe { chain.destroy(device) };
                Err(e)
            }
        }
    }

    /// Makes the handles.
    fn fill(&mut self, device: &Device, info: &vk::SwapchainCreateInfoKHR<'_>) -> ash::prelude::VkResult<()> {
        let buffer = vk::BufferCreateInfo::default().size(self.bytes()).usage(vk::BufferUsageFlags::TRANSFER_SRC);
        // SAFETY: the device is alive and `info` within what its surface allows; the structures live until their call returns. The memory fits
        // the buffer's requirements, is visible to the host, and stays mapped until it is freed.
        unsafe {
            self.raw = device.swapchains.create_swapchain(info, None)?;
            self.images = device.swapchains.get_swapchain_images(self.raw)?;
            for _ in &self.images {
                self.done.push(device.raw.create_semaphore(&Default::default(), None)?);
            }
            self.buffer = device.raw.create_buffer(&buffer, None)?;
            let needs = device.raw.get_buffer_memory_requirements(self.buffer);
            let kind = device.host_memory(needs.memory_type_bits).ok_or(vk::Result::ERROR_OUT_OF_HOST_MEMORY)?;
            let memory = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            self.memory = device.raw.allocate_memory(&memory, None)?;
            device.raw.bind_buffer_memory(self.buffer, self.memory, 0)?;
            self.mapped = device.raw.map_memory(self.memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?.cast();
        }
        Ok(())
    }

    /// Bytes of a picture.
    fn bytes(&self) -> u64 {
        4 * u64::from(self.extent.width) * u64::from(self.extent.height)
    }

    /// The memory from which [`Chain::record`] copies.
    pub(super) fn staging(&mut self) -> &mut [u8] {
        // SAFETY: so many bytes are mapped there as long as `self` lives (zeros or what was written: any byte is a `u8`), and only this
        // slice refers to them. The memory is coherent; the presenter calls this only when the last copy has ended.
        unsafe { std::slice::from_raw_parts_mut(self.mapped, self.bytes() as usize) }
    }

    /// Signalled when the copy to an image has ended.
    pub(super) fn done(&self, image: usize) -> vk::Semaphore {
        self.done[image]
    }

    /// Records the copy of the staging memory to an image.
    ///
    /// # Safety
    /// `commands` of the device that this was made with is being recorded, and its submission waits at the stage of transfers until the image was acquired.
    pub(super) unsafe fn record(&self, device: &Device, commands: vk::CommandBuffer, image: usize) {
        let colour = vk::ImageAspectFlags::COLOR;
        let range = vk::ImageSubresourceRange::default().aspect_mask(colour).level_count(1).layer_count(1);
        let barrier = vk::ImageMemoryBarrier::default()
            .image(self.images[image])
            .subresource_range(range)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED);
        let (to_write, to_show) = (vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::ImageLayout::PRESENT_SRC_KHR);
        let before = [barrier.dst_access_mask(vk::AccessFlags::TRANSFER_WRITE).new_layout(to_write)];
        let after = [barrier.src_access_mask(vk::AccessFlags::TRANSFER_WRITE).old_layout(to_write).new_layout(to_show)];
        let whole = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers::default().aspect_mask(colour).layer_count(1))
            .image_extent(self.extent.into())];
        let (transfer, end) = (vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::BOTTOM_OF_PIPE);
        let none = vk::DependencyFlags::empty();
        // SAFETY: the caller's promise; the handles are alive, the copy lies inside the buffer and the image. The first barrier begins at
        // the stage that waits for the image; the host's writes were done before the submission.
        unsafe {
            device.raw.cmd_pipeline_barrier(commands, transfer, transfer, none, &[], &[], &before);
            device.raw.cmd_copy_buffer_to_image(commands, self.buffer, self.images[image], to_write, &whole);
            device.raw.cmd_pipeline_barrier(commands, transfer, end, none, &[], &[], &after);
        }
    }

    /// Frees everything.
    ///
    /// # Safety
    /// It was made with this device, which has come to rest.
    pub(super) unsafe fn destroy(self, device: &Device) {
        // SAFETY: the handles are null or of this device, which uses none of them any more; freeing unmaps.
        unsafe {
            device.raw.destroy_buffer(self.buffer, None);
            device.raw.free_memory(self.memory, None);
            self.done.iter().for_each(|semaphore| device.raw.destroy_semaphore(*semaphore, None));
            device.swapchains.destroy_swapchain(self.raw, None);
        }
    }
}
