//! The Vulkan loader, its devices, and the validation messages.

use crate::{Error, Result};
use ash::{ext, khr, vk};
use std::ffi::{CStr, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Our minimum: buffer device address and SPIR-V 1.5 are part of it.
pub(crate) const API_VERSION: u32 = vk::API_VERSION_1_2;
/// Storage buffers that the kernel binds.
const STORAGE_BUFFERS: u32 = 5;
const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

static VALIDATION_MESSAGES: AtomicUsize = AtomicUsize::new(0);

/// Warnings and errors that the validation layer has given in this process so far. Zero without the layer, which
/// `LUMINAIRE_VALIDATION=1` switches on.
pub fn validation_messages() -> usize {
    VALIDATION_MESSAGES.load(Ordering::SeqCst)
}

/// A Vulkan instance.
pub struct Instance {
    /// For those who call Vulkan themselves, as the window does.
    pub raw: ash::Instance,
    pub(super) debug_utils: bool,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// The loader. Last, so that the library stays loaded until everything else is gone.
    pub entry: ash::Entry,
}

/// A device that the loader knows, with what it offers.
pub struct PhysicalDevice {
    pub(super) instance: Arc<Instance>,
    /// For those who call Vulkan themselves, as the window does.
    pub raw: vk::PhysicalDevice,
    /// Index in the loader's order, as `--device` takes it.
    pub index: usize,
    /// Name of the device.
    pub name: String,
    /// Driver name and version.
    pub driver: String,
    /// Vulkan version of the device.
    pub api_version: (u32, u32, u32),
    /// GPU of some kind, or software.
    pub device_type: vk::PhysicalDeviceType,
    /// Acceleration structures, ray queries and what they need.
    pub ray_query: bool,
    /// Ray-tracing pipelines, which luminaire does not use; some GPUs have these alone.
    pub ray_tracing_pipeline: bool,
    /// Bytes of the largest device-local heap.
    pub memory: u64,
    pub(super) queue_family: Option<u32>,
    pub(super) timestamp_mask: u64,
    pub(super) limits: vk::PhysicalDeviceLimits,
    pub(super) scratch_alignment: u64,
    pub(super) max_instances: u64,
    pub(super) max_primitives: u64,
}

impl Instance {
    /// Loads Vulkan. With `LUMINAIRE_VALIDATION=1` in the environment the Khronos validation layer watches every call,
    /// synchronization included.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if there is no loader or no driver, with what to install.
    pub fn new() -> Result<Arc<Self>> {
        Self::with_extensions(&[])
    }

    /// The same with extensions that the loader has to know.
    ///
    /// # Errors
    /// As for [`Instance::new`], and if it does not know one of them.
    pub fn with_extensions(wanted: &[&'static CStr]) -> Result<Arc<Self>> {
        // SAFETY: the loader found by the system's rules is trusted to be a Vulkan loader.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| {
            Error::NoDevice(format!(
                "no Vulkan loader ({e}): install one (Debian and Ubuntu: libvulkan1 and mesa-vulkan-drivers, or the GPU \
                 maker's driver), or run with --backend cpu"
            ))
        })?;
        let failed = |call, result: vk::Result| Error::Vulkan {
            call,
            device: "the Vulkan loader".into(),
            reason: match result {
                vk::Result::ERROR_INCOMPATIBLE_DRIVER => {
                    "no driver is installed (or VK_DRIVER_FILES names none)".into()
                }
                other => other.to_string(),
            },
        };
        // SAFETY: the entry points were just loaded; no pointer is passed (here and in the next two calls).
        let version =
            unsafe { entry.try_enumerate_instance_version() }.map_err(|e| failed("vkEnumerateInstanceVersion", e))?;
        if version.unwrap_or(vk::API_VERSION_1_0) < API_VERSION {
            return Err(Error::NoDevice("the Vulkan loader is older than Vulkan 1.2: update it".into()));
        }
        // SAFETY: as above.
        let extensions = unsafe { entry.enumerate_instance_extension_properties(None) }
            .map_err(|e| failed("vkEnumerateInstanceExtensionProperties", e))?;
        // SAFETY: as above.
        let layers = unsafe { entry.enumerate_instance_layer_properties() }
            .map_err(|e| failed("vkEnumerateInstanceLayerProperties", e))?;

        let validation = std::env::var_os("LUMINAIRE_VALIDATION").is_some_and(|v| v == "1");
        if validation && !layers.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
            return Err(Error::NoDevice(
                "LUMINAIRE_VALIDATION=1, but the Khronos validation layer is not installed (Debian and Ubuntu: \
                 vulkan-validationlayers)"
                    .into(),
            ));
        }
        let debug_utils =
            validation || extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ext::debug_utils::NAME));

        let known = |name: &&CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(*name));
        if let Some(missing) = wanted.iter().find(|name| !known(name)) {
            let missing = missing.to_string_lossy();
            return Err(Error::NoDevice(format!("no Vulkan driver here has {missing}: update or install one")));
        }

        let application = vk::ApplicationInfo::default().application_name(c"luminaire").api_version(API_VERSION);
        let layer_names: Vec<_> = validation.then_some(VALIDATION_LAYER.as_ptr()).into_iter().collect();
        let extension_names: Vec<_> =
            debug_utils.then_some(ext::debug_utils::NAME).iter().chain(wanted).map(|name| name.as_ptr()).collect();
        let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
        let mut messenger_info = messenger_info();
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_layer_names(&layer_names)
            .enabled_extension_names(&extension_names);
        if validation {
            info = info.push_next(&mut features).push_next(&mut messenger_info);
        }
        // SAFETY: `info` and what it points to live until the call returns; the names are layers and extensions listed above.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|e| failed("vkCreateInstance", e))?;
        let mut instance = Instance { raw, debug_utils, messenger: None, entry };
        if validation {
            let loader = ext::debug_utils::Instance::new(&instance.entry, &instance.raw);
            // SAFETY: the extension is enabled; the callback is a static function without user data.
            let messenger = unsafe { loader.create_debug_utils_messenger(&self::messenger_info(), None) }
                .map_err(|e| failed("vkCreateDebugUtilsMessengerEXT", e))?;
            instance.messenger = Some((loader, messenger));
        }
        Ok(Arc::new(instance))
    }

    /// Every device, in the loader's order.
    ///
    /// # Errors
    /// If the loader fails, or knows no device.
    pub fn devices(self: &Arc<Self>) -> Result<Vec<PhysicalDevice>> {
        let failed = |result: vk::Result| Error::Vulkan {
            call: "vkEnumeratePhysicalDevices",
            device: "the Vulkan loader".into(),
            reason: result.to_string(),
        };
        // SAFETY: the instance is alive.
        let raw = unsafe { self.raw.enumerate_physical_devices() }.map_err(failed)?;
        // A device that does not even answer must not hide the others.
        let found = raw.into_iter().filter_map(|raw| self.inspect(raw).ok());
        Ok(found.enumerate().map(|(index, device)| PhysicalDevice { index, ..device }).collect())
    }

    fn inspect(self: &Arc<Self>, raw: vk::PhysicalDevice) -> ash::prelude::VkResult<PhysicalDevice> {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut structures = vk::PhysicalDeviceAccelerationStructurePropertiesKHR::default();
        // SAFETY: `raw` comes from this instance, here and below.
        let plain = unsafe { self.raw.get_physical_device_properties(raw) };
        // SAFETY: as above.
        let extensions = unsafe { self.raw.enumerate_device_extension_properties(raw) }?;
        let has = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
        let modern = plain.api_version >= API_VERSION;
        let structure_extension = modern
            && has(khr::acceleration_structure::NAME)
            && has(khr::deferred_host_operations::NAME)
            && has(khr::ray_query::NAME);

        let mut properties = vk::PhysicalDeviceProperties2::default();
        let mut has_structure = vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default();
        let mut has_query = vk::PhysicalDeviceRayQueryFeaturesKHR::default();
        let mut has_12 = vk::PhysicalDeviceVulkan12Features::default();
        let mut features = vk::PhysicalDeviceFeatures2::default();
        if modern {
            properties = properties.push_next(&mut driver);
            features = features.push_next(&mut has_12);
        }
        if structure_extension {
            properties = properties.push_next(&mut structures);
            features = features.push_next(&mut has_structure).push_next(&mut has_query);
        }
        // SAFETY: every structure is alive, and chained only where the device says that it knows it (also in the next call).
        unsafe { self.raw.get_physical_device_properties2(raw, &mut properties) };
        let limits = properties.properties.limits;
        // SAFETY: as above.
        unsafe { self.raw.get_physical_device_features2(raw, &mut features) };
        // SAFETY: as above.
        let families = unsafe { self.raw.get_physical_device_queue_family_properties(raw) };
        // SAFETY: as above.
        let memory = unsafe { self.raw.get_physical_device_memory_properties(raw) };

        let queue_family = families.iter().position(|f| f.queue_flags.contains(vk::QueueFlags::COMPUTE));
        let timestamp_bits = queue_family
            .map(|f| families[f].timestamp_valid_bits)
            .filter(|bits| *bits > 0 && limits.timestamp_period > 0.0);
        let text = |s: &[std::ffi::c_char]| {
            // SAFETY: Vulkan gives NUL-terminated strings in fixed arrays.
            unsafe { CStr::from_ptr(s.as_ptr()) }.to_string_lossy().into_owned()
        };
        let version = plain.api_version;
        Ok(PhysicalDevice {
            instance: self.clone(),
            raw,
            index: 0,
            name: text(&plain.device_name),
            driver: if modern {
                let (name, info) = (text(&driver.driver_name), text(&driver.driver_info));
                // Not twice.
                let known = text(&plain.device_name).contains(&name) || info.contains(&name);
                if known && !info.is_empty() { info } else { format!("{name} {info}").trim().to_owned() }
            } else {
                format!("driver version {:#x}", plain.driver_version)
            },
            api_version: (
                vk::api_version_major(version),
                vk::api_version_minor(version),
                vk::api_version_patch(version),
            ),
            device_type: plain.device_type,
            ray_query: structure_extension
                && has_structure.acceleration_structure == vk::TRUE
                && has_query.ray_query == vk::TRUE
                && has_12.buffer_device_address == vk::TRUE,
            ray_tracing_pipeline: has(khr::ray_tracing_pipeline::NAME),
            memory: memory
                .memory_heaps_as_slice()
                .iter()
                .filter(|h| h.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
                .map(|h| h.size)
                .max()
                .unwrap_or(0),
            queue_family: queue_family.map(|f| f as u32),
            timestamp_mask: timestamp_bits.map_or(0, |bits| u64::MAX >> (64 - bits)),
            limits,
            scratch_alignment: u64::from(structures.min_acceleration_structure_scratch_offset_alignment).max(1),
            max_instances: structures.max_instance_count,
            max_primitives: structures.max_primitive_count,
        })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: devices hold an `Arc` of this instance, so none is left; the messenger is its child and goes first.
        unsafe {
            if let Some((loader, messenger)) = self.messenger.take() {
                loader.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

impl PhysicalDevice {
    /// True for a driver that runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.device_type == vk::PhysicalDeviceType::CPU
    }

    /// How much we would like to run on it: GPUs before software, discrete before integrated, ray queries first.
    pub fn rank(&self) -> (u8, bool) {
        rank(self.device_type, self.ray_query)
    }

    /// What kind of device it is, in words.
    pub fn kind(&self) -> &'static str {
        match self.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete GPU",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated GPU",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual GPU",
            vk::PhysicalDeviceType::CPU => "software (CPU)",
            _ => "other",
        }
    }

    /// `Err` with the reason if luminaire cannot run there at all.
    pub fn usable(&self) -> std::result::Result<(), String> {
        if self.api_version < (1, 2, 0) {
            return Err(format!("Vulkan {}.{} only; 1.2 is needed", self.api_version.0, self.api_version.1));
        }
        if self.queue_family.is_none() {
            return Err("no queue that runs compute shaders".into());
        }
        let storage_buffers = self.limits.max_per_stage_descriptor_storage_buffers;
        if storage_buffers < STORAGE_BUFFERS {
            return Err(format!("{storage_buffers} storage buffers in a shader only; {STORAGE_BUFFERS} are needed"));
        }
        Ok(())
    }

    /// The limits and features that matter, for `luminaire devices`.
    pub fn features(&self) -> Vec<(String, String)> {
        let yes = |b: bool| String::from(if b { "yes" } else { "no" });
        let (major, minor, patch) = self.api_version;
        vec![
            ("Vulkan".into(), format!("{major}.{minor}.{patch}")),
            ("ray query".into(), yes(self.ray_query)),
            ("ray-tracing pipelines (not used)".into(), yes(self.ray_tracing_pipeline)),
            ("device memory".into(), format!("{:.1} GiB", self.memory as f64 / f64::from(1 << 30))),
            ("largest storage buffer".into(), format!("{} MiB", self.limits.max_storage_buffer_range >> 20)),
            ("largest texel buffer".into(), format!("{} texels", self.limits.max_texel_buffer_elements)),
            ("timestamps".into(), yes(self.timestamp_mask != 0)),
        ]
    }
}

fn messenger_info() -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE)
        .pfn_user_callback(Some(on_message))
}

/// Prints and counts a validation message.
///
/// # Safety
/// Called by Vulkan with a valid callback structure.
unsafe extern "system" fn on_message(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    _user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes a valid structure whose strings are null or NUL-terminated.
    let message = unsafe { (*data).message_as_c_str() }.unwrap_or(c"?");
    eprintln!("Vulkan validation ({severity:?}): {}", message.to_string_lossy());
    VALIDATION_MESSAGES.fetch_add(1, Ordering::SeqCst);
    vk::FALSE
}

fn rank(device_type: vk::PhysicalDeviceType, ray_query: bool) -> (u8, bool) {
    use vk::PhysicalDeviceType as Type;
    let kind = match device_type {
        Type::DISCRETE_GPU => 4,
        Type::INTEGRATED_GPU => 3,
        Type::VIRTUAL_GPU => 2,
        Type::CPU => 0,
        _ => 1,
    };
    (kind, ray_query)
}

#[cfg(test)]
mod tests {
    use super::rank;
    use ash::vk::PhysicalDeviceType as Type;

    #[test]
    fn gpus_come_before_software_and_ray_queries_first() {
        let order = [
            rank(Type::CPU, false),
            rank(Type::CPU, true),
            rank(Type::VIRTUAL_GPU, true),
            rank(Type::INTEGRATED_GPU, true),
            rank(Type::DISCRETE_GPU, false),
            rank(Type::DISCRETE_GPU, true),
        ];
        assert!(order.is_sorted());
    }
}
