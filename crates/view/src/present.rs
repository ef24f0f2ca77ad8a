//! Pictures from host memory into a window: any Vulkan device that can present does, whatever traces.
//!
//! A picture is written to a buffer and copied to an image of the swapchain; one is on its way at a time. The swapchain is made again when the window's size
//! changes, the surface when it is lost.

use super::chain::Chain;
use ash::{khr, vk};
use luminaire::gpu::{Instance, PhysicalDevice};
use luminaire::{Error, Result};
use std::ffi::CStr;
use std::sync::Arc;
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

/// How long to wait for an image or for the last copy before the window is served again, and before the device is taken to hang.
const PATIENCE: u64 = 100_000_000;
const HANGS: u64 = 10_000_000_000;

/// Formats whose bytes are shown as they are, and whether blue comes first. A copy does not convert, so an sRGB format does as well.
const FORMATS: [(vk::Format, bool); 4] = [
    (vk::Format::B8G8R8A8_UNORM, true),
    (vk::Format::R8G8B8A8_UNORM, false),
    (vk::Format::B8G8R8A8_SRGB, true),
    (vk::Format::R8G8B8A8_SRGB, false),
];

/// Writes a picture of a size into rows of four bytes a pixel, blue first if it is told so.
pub type Fill<'a> = dyn FnMut(&mut [u8], (u32, u32), bool) + 'a;

/// A window and the device that fills it.
pub struct Presenter {
    /// None before the first picture, and after anything has changed.
    chain: Option<Chain>,
    pub(super) device: ash::Device,
    pub(super) swapchains: khr::swapchain::Device,
    queue: vk::Queue,
    family: u32,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    /// Signalled when the last copy is done.
    copied: vk::Fence,
    /// Signalled when the image that was acquired may be written.
    acquired: vk::Semaphore,
    surface: Surface,
    pub(super) physical: vk::PhysicalDevice,
    pub(super) format: vk::SurfaceFormatKHR,
    reversed: bool,
    /// Name of the device.
    pub(super) name: String,
}

/// A window's surface.
struct Surface {
    raw: vk::SurfaceKHR,
    calls: khr::surface::Instance,
    instance: Arc<Instance>,
    // After the surface, which refers to it.
    window: Arc<Window>,
}

impl Surface {
    fn new(instance: &Arc<Instance>, window: &Arc<Window>) -> Result<Self> {
        let failed = |reason: String| Error::NoDevice(format!("the window cannot be drawn into ({reason}): {ADVICE}"));
        let display = window.display_handle().map_err(|e| failed(e.to_string()))?.as_raw();
        let handle = window.window_handle().map_err(|e| failed(e.to_string()))?.as_raw();
        // SAFETY: the instance was made with the extensions of this display, and the window outlives the surface.
        let raw = unsafe { ash_window::create_surface(&instance.entry, &instance.raw, display, handle, None) }
            .map_err(|e| failed(e.to_string()))?;
        let calls = khr::surface::Instance::new(&instance.entry, &instance.raw);
        Ok(Surface { raw, calls, instance: instance.clone(), window: window.clone() })
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: every swapchain of it is gone: `Presenter` drops its chain first.
        unsafe { self.calls.destroy_surface(self.raw, None) };
    }
}

/// What helps where a window cannot be filled.
const ADVICE: &str = "install a Vulkan driver that can present (Debian and Ubuntu: mesa-vulkan-drivers), or use `luminaire render`, which needs no window";

impl Presenter {
    /// Opens the best device that can present to a window.
    ///
    /// # Errors
    /// If there is none, with the reason for each, or the driver fails.
    pub fn new(window: &Arc<Window>) -> Result<Self> {
        let display =
            window.display_handle().map_err(|e| Error::NoDevice(format!("the window has no display: {e}")))?;
        let extensions = ash_window::enumerate_required_extensions(display.as_raw())
            .map_err(|e| Error::NoDevice(format!("Vulkan knows no such windows ({e}): {ADVICE}")))?;
        // SAFETY: ash-window gives the names of extensions, which are constants and NUL-terminated.
        let extensions: Vec<&'static CStr> = extensions.iter().map(|name| unsafe { CStr::from_ptr(*name) }).collect();
        let instance = Instance::with_extensions(&extensions).map_err(with_advice)?;
        let surface = Surface::new(&instance, window)?;
        let devices = instance.devices().map_err(with_advice)?;
        let mut reasons = Vec::new();
        let mut found = Vec::new();
        for device in &devices {
            match way_to_present(&surface, device) {
                Ok((family, format)) => found.push((device, family, format)),
                Err(reason) => reasons.push(format!("\n  {}: {reason}", device.name)),
            }
        }
        // The first of the best, in the loader's order.
        let Some((device, family, format)) = found.into_iter().rev().max_by_key(|(device, ..)| device.rank()) else {
            let none = if reasons.is_empty() { "\n  there is no device at all".into() } else { reasons.concat() };
            return Err(Error::NoDevice(format!("no Vulkan device can present to this window:{none}\n{ADVICE}")));
        };
        let physical = device.raw;
        Self::open(surface, physical, device.name.clone(), family, format)
    }

    fn open(
        surface: Surface,
        physical: vk::PhysicalDevice,
        name: String,
        family: u32,
        format: vk::SurfaceFormatKHR,
    ) -> Result<Self> {
        let failed =
            |call, result: vk::Result| Error::Vulkan { call, device: name.clone(), reason: result.to_string() };
        let instance = &surface.instance.raw;
        let priorities = [1.0];
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&priorities)];
        let extensions = [khr::swapchain::NAME.as_ptr()];
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&extensions);
        // SAFETY: the device has this family and this extension (`way_to_present`), and `info` lives until the call returns.
        let device =
            unsafe { instance.create_device(physical, &info, None) }.map_err(|e| failed("vkCreateDevice", e))?;
        // SAFETY: the family was asked for one queue above.
        let queue = unsafe { device.get_device_queue(family, 0) };
        let swapchains = khr::swapchain::Device::new(instance, &device);
        let reversed = FORMATS.iter().any(|(known, reversed)| *known == format.format && *reversed);
        let mut presenter = Presenter {
            chain: None,
            device,
            swapchains,
            queue,
            family,
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            copied: vk::Fence::null(),
            acquired: vk::Semaphore::null(),
            surface,
            physical,
            format,
            reversed,
            name,
        };
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let done = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        // SAFETY: the device is alive; the structures live until their call returns. What is made is destroyed by `drop`, also
        // if a later call fails.
        unsafe {
            let raw = presenter.device.clone();
            presenter.pool =
                raw.create_command_pool(&pool, None).map_err(|e| presenter.error("vkCreateCommandPool", e))?;
            let buffers = vk::CommandBufferAllocateInfo::default().command_pool(presenter.pool).command_buffer_count(1);
            presenter.commands =
                raw.allocate_command_buffers(&buffers).map_err(|e| presenter.error("vkAllocateCommandBuffers", e))?[0];
            presenter.copied = raw.create_fence(&done, None).map_err(|e| presenter.error("vkCreateFence", e))?;
            presenter.acquired =
                raw.create_semaphore(&Default::default(), None).map_err(|e| presenter.error("vkCreateSemaphore", e))?;
        }
        Ok(presenter)
    }

    /// The index of a kind of memory among `allowed` that the host writes to without further calls; every device has one for buffers.
    pub(super) fn host_memory(&self, allowed: u32) -> Option<u32> {
        let wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: the physical device is one of this instance's.
        let memory = unsafe { self.surface.instance.raw.get_physical_device_memory_properties(self.physical) };
        let kinds = memory.memory_types_as_slice();
        (0..).zip(kinds).find(|(i, kind)| allowed >> i & 1 == 1 && kind.property_flags.contains(wanted)).map(|(i, _)| i)
    }

    /// An error that names the call and the device.
    pub(super) fn error(&self, call: &'static str, result: vk::Result) -> Error {
        Error::Vulkan {
            call,
            device: self.name.clone(),
            reason: format!("{result}; `luminaire render` needs no window"),
        }
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
                    Err(e) => return Err(self.error("vkCreateSwapchainKHR", e)),
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
                Err(e) => return Err(self.error("presenting", e)),
            }
        }
        Ok(false)
    }

    /// Forgets the swapchain, because the window has another size.
    pub fn drop_chain(&mut self) {
        if let Some(chain) = self.chain.take() {
            // SAFETY: the queue is used by this thread alone. A device that is lost uses nothing any more.
            let _ = unsafe { self.device.device_wait_idle() };
            chain.destroy(self);
        }
    }

    fn new_surface(&mut self) -> Result<()> {
        self.drop_chain();
        let (instance, window) = (self.surface.instance.clone(), self.surface.window.clone());
        // Windows have one surface at a time: the old one goes first, and a null handle may be destroyed by `drop` again.
        // SAFETY: its swapchain is gone.
        unsafe { self.surface.calls.destroy_surface(self.surface.raw, None) };
        self.surface.raw = vk::SurfaceKHR::null();
        self.surface = Surface::new(&instance, &window)?;
        // Vulkan wants this to be asked of every surface, and another screen may belong to another device.
        // SAFETY: device and surface are alive and of one instance, and the device has the family.
        let presents = unsafe {
            self.surface.calls.get_physical_device_surface_support(self.physical, self.family, self.surface.raw)
        };
        match presents {
            Ok(true) => Ok(()),
            Ok(false) => {
                Err(Error::NoDevice(format!("{} cannot present to this window any more: open it again", self.name)))
            }
            Err(e) => Err(self.error("vkGetPhysicalDeviceSurfaceSupportKHR", e)),
        }
    }

    /// A swapchain of the window's size; none while it has no size.
    fn new_chain(&self) -> ash::prelude::VkResult<Option<Chain>> {
        let (calls, surface) = (&self.surface.calls, self.surface.raw);
        // SAFETY: device and surface are alive and of one instance.
        let can = unsafe { calls.get_physical_device_surface_capabilities(self.physical, surface) }?;
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
        Chain::new(self, surface, &can, extent).map(Some)
    }

    /// Fills an image and queues it for the window; true if the swapchain does not fit the window any more.
    fn present(&mut self, fill: &mut Fill<'_>) -> ash::prelude::VkResult<bool> {
        let chain = self.chain.as_mut().expect("show() has made it");
        let (device, commands) = (&self.device, self.commands);
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
                self.swapchains.acquire_next_image(chain.raw, PATIENCE, self.acquired, vk::Fence::null())?;
            let extent = (chain.extent.width, chain.extent.height);
            fill(chain.staging(), extent, self.reversed);
            device.reset_fences(&fences)?;
            device.begin_command_buffer(
                commands,
                &vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT),
            )?;
            chain.record(device, commands, index as usize);
            device.end_command_buffer(commands)?;
            let (acquired, done, stages) =
                ([self.acquired], [chain.done(index as usize)], [vk::PipelineStageFlags::TRANSFER]);
            let buffers = [commands];
            let submit = [vk::SubmitInfo::default()
                .wait_semaphores(&acquired)
                .wait_dst_stage_mask(&stages)
                .command_buffers(&buffers)
                .signal_semaphores(&done)];
            device.queue_submit(self.queue, &submit, self.copied)?;
            self.surface.window.pre_present_notify();
            let (swapchains, indices) = ([chain.raw], [index]);
            let info =
                vk::PresentInfoKHR::default().wait_semaphores(&done).swapchains(&swapchains).image_indices(&indices);
            suboptimal |= self.swapchains.queue_present(self.queue, &info)?;
            Ok(suboptimal)
        }
    }
}

impl Drop for Presenter {
    fn drop(&mut self) {
        self.drop_chain();
        // SAFETY: the handles are null or of this device, which has come to rest and is destroyed last, before its surface.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_semaphore(self.acquired, None);
            self.device.destroy_fence(self.copied, None);
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
        }
    }
}

fn with_advice(error: Error) -> Error {
    match error {
        Error::NoDevice(reason) => Error::NoDevice(format!("a window needs Vulkan: {reason}; or: {ADVICE}")),
        other => other,
    }
}

/// The queue family and the format with which a device presents to a surface, or why it cannot.
fn way_to_present(
    surface: &Surface,
    device: &PhysicalDevice,
) -> std::result::Result<(u32, vk::SurfaceFormatKHR), String> {
    let instance = &surface.instance.raw;
    let failed = |e: vk::Result| e.to_string();
    // SAFETY: device and surface are alive and of one instance (here and below).
    let extensions = unsafe { instance.enumerate_device_extension_properties(device.raw) }.map_err(failed)?;
    if !extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(khr::swapchain::NAME)) {
        return Err("it has no VK_KHR_swapchain".into());
    }
    // SAFETY: as above.
    let families = unsafe { instance.get_physical_device_queue_family_properties(device.raw) };
    let copies = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE | vk::QueueFlags::TRANSFER;
    let presents = |family: u32| {
        // SAFETY: as above, and the family is one of the device's.
        unsafe { surface.calls.get_physical_device_surface_support(device.raw, family, surface.raw) }.unwrap_or(false)
    };
    let family = (0..)
        .zip(&families)
        .find(|(index, family)| family.queue_flags.intersects(copies) && presents(*index))
        .map(|(index, _)| index)
        .ok_or("none of its queues presents to it")?;
    // SAFETY: as above.
    let can =
        unsafe { surface.calls.get_physical_device_surface_capabilities(device.raw, surface.raw) }.map_err(failed)?;
    if !can.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_DST) {
        return Err("its swapchains cannot be copied to".into());
    }
    // SAFETY: as above.
    let formats =
        unsafe { surface.calls.get_physical_device_surface_formats(device.raw, surface.raw) }.map_err(failed)?;
    let fits = |wanted: vk::Format| {
        formats.iter().find(|f| f.format == wanted && f.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR).copied()
    };
    let format =
        FORMATS.iter().find_map(|(wanted, _)| fits(*wanted)).ok_or("it offers no sRGB picture of 8 bits a channel")?;
    Ok((family, format))
}
