//! The Vulkan device that fills a window: any that can present, whichever one traces.

use super::surface::{ADVICE, Surface, with_advice};
use ash::{khr, vk};
use luminaire::gpu::{Instance, PhysicalDevice};
use luminaire::{Error, Result};
use std::sync::Arc;

/// Formats whose bytes are shown as they are, and whether blue comes first. A copy does not convert, so sRGB formats are among them.
const FORMATS: [(vk::Format, bool); 4] = [
    (vk::Format::B8G8R8A8_UNORM, true),
    (vk::Format::R8G8B8A8_UNORM, false),
    (vk::Format::B8G8R8A8_SRGB, true),
    (vk::Format::R8G8B8A8_SRGB, false),
];

/// A device with a queue that copies pictures into a window.
pub struct Device {
    pub(super) raw: ash::Device,
    pub(super) swapchains: khr::swapchain::Device,
    pub(super) queue: vk::Queue,
    /// The queue's family.
    pub(super) family: u32,
    /// The format of the swapchain's images.
    pub(super) format: vk::SurfaceFormatKHR,
    physical: vk::PhysicalDevice,
    memory: vk::PhysicalDeviceMemoryProperties,
    name: String,
    /// Kept here so that it outlives the device.
    instance: Arc<Instance>,
}

impl Device {
    /// Opens the best device that can present to a surface.
    ///
    /// # Errors
    /// If there is none, with the reason for each, or the driver fails.
    pub fn best_for(surface: &Surface) -> Result<Self> {
        let devices = surface.instance.devices().map_err(with_advice)?;
        let mut reasons = Vec::new();
        let mut found = Vec::new();
        for device in &devices {
            match way_to_present(surface, device) {
                Ok((family, format)) => found.push((device, family, format)),
                Err(reason) => reasons.push(format!("\n  {}: {reason}", device.name)),
            }
        }
        // The first of the best, in the loader's order.
        let Some((device, family, format)) = found.into_iter().rev().max_by_key(|(device, ..)| device.rank()) else {
            let none = if reasons.is_empty() { "\n  there is no device at all".into() } else { reasons.concat() };
            return Err(Error::NoDevice(format!("no Vulkan device can present to this window:{none}\n{ADVICE}")));
        };
        Self::open(&surface.instance, device, family, format)
    }

    /// `physical` is one of the instance's, and can present with this family and format ([`way_to_present`]).
    fn open(
        instance: &Arc<Instance>,
        physical: &PhysicalDevice,
        family: u32,
        format: vk::SurfaceFormatKHR,
    ) -> Result<Self> {
        let priorities = [1.0];
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&priorities)];
        let extensions = [khr::swapchain::NAME.as_ptr()];
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&extensions);
        let failed = |e: vk::Result| Error::Vulkan {
            call: "vkCreateDevice",
            device: physical.name.clone(),
            reason: e.to_string(),
        };
        // SAFETY: the device has this family and this extension (`way_to_present`), and `info` lives until the call returns.
        let raw = unsafe { instance.raw.create_device(physical.raw, &info, None) }.map_err(failed)?;
        Ok(Device {
            // SAFETY: the family was asked for one queue above.
            queue: unsafe { raw.get_device_queue(family, 0) },
            swapchains: khr::swapchain::Device::new(&instance.raw, &raw),
            raw,
            family,
            format,
            physical: physical.raw,
            // SAFETY: the physical device is one of this instance's.
            memory: unsafe { instance.raw.get_physical_device_memory_properties(physical.raw) },
            name: physical.name.clone(),
            instance: instance.clone(),
        })
    }

    /// Whether blue comes first in the bytes of a pixel.
    pub fn blue_first(&self) -> bool {
        FORMATS.iter().any(|(known, blue_first)| *known == self.format.format && *blue_first)
    }

    /// The index of a kind of memory among `allowed` that the host writes to without further calls; every device has one for buffers.
    pub fn host_memory(&self, allowed: u32) -> Option<u32> {
        let wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let kinds = self.memory.memory_types_as_slice();
        (0..).zip(kinds).find(|(i, kind)| allowed >> i & 1 == 1 && kind.property_flags.contains(wanted)).map(|(i, _)| i)
    }

    /// What a surface of the same instance allows now.
    pub fn capabilities(&self, surface: &Surface) -> ash::prelude::VkResult<vk::SurfaceCapabilitiesKHR> {
        assert!(Arc::ptr_eq(&self.instance, &surface.instance));
        // SAFETY: device and surface are alive and of one instance.
        unsafe { surface.calls.get_physical_device_surface_capabilities(self.physical, surface.raw) }
    }

    /// Asks whether it can present to a surface of the same instance: Vulkan wants this to be asked of every surface, and another screen may belong
    /// to another device.
    ///
    /// # Errors
    /// If it cannot, or the driver fails.
    pub fn check_presents_to(&self, surface: &Surface) -> Result<()> {
        assert!(Arc::ptr_eq(&self.instance, &surface.instance));
        // SAFETY: device and surface are alive and of one instance, and the device has the family.
        let presents =
            unsafe { surface.calls.get_physical_device_surface_support(self.physical, self.family, surface.raw) };
        match presents {
            Ok(true) => Ok(()),
            Ok(false) => {
                Err(Error::NoDevice(format!("{} cannot present to this window any more: open it again", self.name)))
            }
            Err(e) => Err(self.error("vkGetPhysicalDeviceSurfaceSupportKHR", e)),
        }
    }

    /// Waits until the device rests. One that is lost uses nothing any more, so there is nothing to fail.
    pub fn rest(&self) {
        // SAFETY: the device is alive, and its queue is used by the window's thread alone.
        let _ = unsafe { self.raw.device_wait_idle() };
    }

    /// An error that names the call and the device.
    pub fn error(&self, call: &'static str, result: vk::Result) -> Error {
        Error::Vulkan {
            call,
            device: self.name.clone(),
            reason: format!("{result}; `luminaire render` needs no window"),
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.rest();
        // SAFETY: whoever made something of the device has destroyed it before; the instance is still alive.
        unsafe { self.raw.destroy_device(None) };
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
