//! The Vulkan loader, opened.

use super::validation;
use crate::{Error, Result};
use ash::{ext, vk};
use std::ffi::CStr;
use std::sync::Arc;

/// Our minimum: buffer device address and SPIR-V 1.5 are part of it.
pub(crate) const API_VERSION: u32 = vk::API_VERSION_1_2;
/// A Vulkan instance.
pub struct Instance {
    /// For those who call Vulkan themselves, as the window does.
    pub raw: ash::Instance,
    pub(in crate::gpu) debug_utils: bool,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// The loader. Last, so that the library stays loaded until everything else is gone.
    pub entry: ash::Entry,
}

impl Instance {
    /// Loads Vulkan. With `LUMINAIRE_VALIDATION=1` in the environment the Khronos validation layer watches every call,
    /// synchronization included.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if there is no loader or no driver, with what to install; or if a limit of the process leaves a driver too little address space.
    pub fn new() -> Result<Arc<Self>> {
        Self::with_extensions(&[])
    }

    /// The same with extensions that the loader has to know.
    ///
    /// # Errors
    /// As for [`Instance::new`], and if it does not know one of them.
    pub fn with_extensions(wanted: &[&'static CStr]) -> Result<Arc<Self>> {
        crate::memory::check_driver()?;
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

        let validated = std::env::var_os("LUMINAIRE_VALIDATION").is_some_and(|v| v == "1");
        if validated && !layers.iter().any(|l| l.layer_name_as_c_str() == Ok(validation::LAYER)) {
            return Err(Error::NoDevice(
                "LUMINAIRE_VALIDATION=1, but the Khronos validation layer is not installed (Debian and Ubuntu: \
                 vulkan-validationlayers)"
                    .into(),
            ));
        }
        let debug_utils =
            validated || extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ext::debug_utils::NAME));

        let known = |name: &&CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(*name));
        if let Some(missing) = wanted.iter().find(|name| !known(name)) {
            let missing = missing.to_string_lossy();
            return Err(Error::NoDevice(format!("no Vulkan driver here has {missing}: update or install one")));
        }

        let application = vk::ApplicationInfo::default().application_name(c"luminaire").api_version(API_VERSION);
        let layer_names: Vec<_> = validated.then_some(validation::LAYER.as_ptr()).into_iter().collect();
        let extension_names: Vec<_> =
            debug_utils.then_some(ext::debug_utils::NAME).iter().chain(wanted).map(|name| name.as_ptr()).collect();
        let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
        let mut messenger_info = validation::messenger_info();
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_layer_names(&layer_names)
            .enabled_extension_names(&extension_names);
        if validated {
            info = info.push_next(&mut features).push_next(&mut messenger_info);
        }
        // SAFETY: `info` and what it points to live until the call returns; the names are layers and extensions listed above.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|e| failed("vkCreateInstance", e))?;
        let mut instance = Instance { raw, debug_utils, messenger: None, entry };
        if validated {
            let loader = ext::debug_utils::Instance::new(&instance.entry, &instance.raw);
            // SAFETY: the extension is enabled; the callback is a static function without user data.
            let messenger = unsafe { loader.create_debug_utils_messenger(&validation::messenger_info(), None) }
                .map_err(|e| failed("vkCreateDebugUtilsMessengerEXT", e))?;
            instance.messenger = Some((loader, messenger));
        }
        Ok(Arc::new(instance))
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
