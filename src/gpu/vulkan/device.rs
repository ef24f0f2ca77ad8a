//! A logical device with one compute queue and a memory allocator.

use super::instance::Instance;
use super::physical_device::PhysicalDevice;
use crate::{Error, Result};
use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::ffi::CString;
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// An open device. Everything made from it holds an `Arc` of it.
pub struct Device {
    pub(crate) raw: ash::Device,
    // Freed by hand in `drop`: before the device, after every buffer.
    allocator: ManuallyDrop<Mutex<Allocator>>,
    queue: Mutex<vk::Queue>,
    pub(in crate::gpu) queue_family: u32,
    acceleration_structure: Option<khr::acceleration_structure::Device>,
    debug_utils: Option<ext::debug_utils::Device>,
    /// Which bits of a timestamp count; none without timestamps.
    pub(in crate::gpu) timestamp_mask: u64,
    hung: AtomicBool,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    pub(crate) scratch_alignment: u64,
    pub(crate) max_instances: u64,
    pub(crate) max_primitives: u64,
    /// Bytes of its largest device-local heap.
    pub(in crate::gpu) memory: u64,
    /// Name of the device.
    pub name: String,
    /// True for a driver that runs on the CPU.
    pub software: bool,
    // Last: the instance outlives the device.
    _instance: Arc<Instance>,
}

impl Device {
    /// Opens a device; with `ray_query` also what ray queries need.
    ///
    /// # Errors
    /// If the device is not usable, or the driver fails.
    pub fn open(physical: &PhysicalDevice, ray_query: bool) -> Result<Arc<Self>> {
        let name = physical.name.clone();
        physical.usable().map_err(|reason| Error::NoDevice(format!("{name} cannot be used: {reason}")))?;
        if ray_query && !physical.ray_query {
            return Err(Error::NoDevice(format!(
                "{name} has no ray query (VK_KHR_ray_query): use --backend compute-bvh, which needs none, or another device"
            )));
        }
        let failed = |call, result: vk::Result| Error::Vulkan { call, device: name.clone(), reason: explain(result) };
        let queue_family = physical.queue_family.expect("usable() saw it");

        let priorities = [1.0];
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&priorities)];
        let mut features_12 = vk::PhysicalDeviceVulkan12Features::default().buffer_device_address(ray_query);
        let mut features_structure =
            vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default().acceleration_structure(true);
        let mut features_query = vk::PhysicalDeviceRayQueryFeaturesKHR::default().ray_query(true);
        let extensions = [
            khr::acceleration_structure::NAME.as_ptr(),
            khr::deferred_host_operations::NAME.as_ptr(),
            khr::ray_query::NAME.as_ptr(),
        ];
        let mut info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).push_next(&mut features_12);
        if ray_query {
            info = info
                .enabled_extension_names(&extensions)
                .push_next(&mut features_structure)
                .push_next(&mut features_query);
        }
        let instance = &physical.instance;
        // SAFETY: `info` lives until the call returns; the physical device reported every extension and feature asked for.
        let raw = unsafe { instance.raw.create_device(physical.raw, &info, None) }
            .map_err(|e| failed("vkCreateDevice", e))?;
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: raw.clone(),
            physical_device: physical.raw,
            debug_settings: Default::default(),
            buffer_device_address: ray_query,
            allocation_sizes: Default::default(),
        });
        let allocator = match allocator {
            Ok(allocator) => allocator,
            Err(e) => {
                // SAFETY: nothing was made from the device yet.
                unsafe { raw.destroy_device(None) };
                return Err(Error::Vulkan { call: "creating the allocator", device: name, reason: e.to_string() });
            }
        };
        // SAFETY: the family was asked for one queue above.
        let queue = unsafe { raw.get_device_queue(queue_family, 0) };
        Ok(Arc::new(Device {
            acceleration_structure: ray_query.then(|| khr::acceleration_structure::Device::new(&instance.raw, &raw)),
            debug_utils: instance.debug_utils.then(|| ext::debug_utils::Device::new(&instance.raw, &raw)),
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            queue: Mutex::new(queue),
            queue_family,
            timestamp_mask: physical.timestamp_mask,
            hung: AtomicBool::new(false),
            limits: physical.limits,
            scratch_alignment: physical.scratch_alignment,
            max_instances: physical.max_instances,
            max_primitives: physical.max_primitives,
            memory: physical.memory,
            software: physical.is_software(),
            name,
            _instance: instance.clone(),
            raw,
        }))
    }

    /// The acceleration-structure calls.
    ///
    /// # Panics
    /// If the device was opened without ray query.
    pub(crate) fn acceleration_structure(&self) -> &khr::acceleration_structure::Device {
        self.acceleration_structure.as_ref().expect("the device was opened with ray query")
    }

    /// Bytes of device memory that everything alive on this device holds.
    pub fn allocated_bytes(&self) -> u64 {
        self.allocator().generate_report().total_allocated_bytes
    }

    pub(in crate::gpu) fn allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(in crate::gpu) fn queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records that a submission never ended: from now on nothing may be freed, because the device may still use it.
    pub(in crate::gpu) fn set_hung(&self) {
        self.hung.store(true, Ordering::SeqCst);
    }

    /// True if objects of this device must be leaked instead of freed.
    pub(crate) fn is_hung(&self) -> bool {
        self.hung.load(Ordering::SeqCst)
    }

    /// An error that names the call and this device.
    pub(crate) fn error(&self, call: &'static str, result: vk::Result) -> Error {
        Error::Vulkan { call, device: self.name.clone(), reason: explain(result) }
    }

    /// Refuses what is beyond a limit of the device; `unit` is the unit and the limit's Vulkan name.
    pub(crate) fn check_limit(&self, what: &str, needed: u64, limit: u64, unit: &str, advice: &str) -> Result<()> {
        if needed <= limit {
            return Ok(());
        }
        Err(Error::Limit {
            what: what.into(),
            needed: needed.to_string(),
            device: self.name.clone(),
            limit: format!("{limit} {unit}"),
            advice: advice.into(),
        })
    }

    /// Gives an object a name for debuggers and validation messages.
    pub(crate) fn set_name(&self, handle: impl vk::Handle, name: &str) {
        let Some(debug) = &self.debug_utils else { return };
        let Ok(name) = CString::new(name) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle was just made from this device; a failure costs only the name.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if self.is_hung() {
            // The instance must not go before its devices either.
            std::mem::forget(self._instance.clone());
            return;
        }
        // SAFETY: every buffer, kernel and structure holds an `Arc` of this device, so none is left, and each waited for its
        // own work; the allocator is dropped once, here, before the device that its memory belongs to.
        unsafe {
            let _ = self.raw.device_wait_idle();
            ManuallyDrop::drop(&mut self.allocator);
            self.raw.destroy_device(None);
        }
    }
}

/// A result code in words, with advice where there is any.
fn explain(result: vk::Result) -> String {
    match result {
        vk::Result::ERROR_DEVICE_LOST => {
            "the device was lost (driver crash, watchdog, or unplugged): run again, on another device or with --backend cpu \
             if it stays"
                .into()
        }
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
            "out of device memory: a smaller scene or picture, another device, or --backend cpu".into()
        }
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => "out of memory".into(),
        vk::Result::TIMEOUT => "the device did not answer in time: it may hang".into(),
        other => other.to_string(),
    }
}
