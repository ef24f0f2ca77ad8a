//! The devices of this machine, and what each offers.

use super::instance::{API_VERSION, Instance};
use crate::{Error, Result};
use ash::{khr, vk};
use std::ffi::CStr;
use std::sync::Arc;

/// What every kernel binds and takes: as many or more of what the shaders have, none above what Vulkan guarantees. A test holds it against the
/// shaders.
pub const NEEDS: Needs = Needs {
    uniform_buffers: 1,
    storage_buffers: 2,
    texel_buffers: 16,
    resources: 32,
    push_constants: 32,
    uniform_bytes: 1 << 14,
    invocations: 64,
};

/// Numbers of resources in one shader, and sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// Uniform buffers.
    pub uniform_buffers: u32,
    /// Storage buffers.
    pub storage_buffers: u32,
    /// Uniform texel buffers, which count as sampled images.
    pub texel_buffers: u32,
    /// All of them together, with an acceleration structure.
    pub resources: u32,
    /// Bytes of push constants.
    pub push_constants: u32,
    /// Bytes of the uniform buffer.
    pub uniform_bytes: u32,
    /// Invocations of a workgroup, all in one row.
    pub invocations: u32,
}

impl Needs {
    /// What of this a device of these limits does not have, in words.
    pub(in crate::gpu) fn missing(&self, limits: &vk::PhysicalDeviceLimits) -> Option<String> {
        let row = limits.max_compute_work_group_invocations.min(limits.max_compute_work_group_size[0]);
        let needs = [
            ("uniform buffers in a shader", limits.max_per_stage_descriptor_uniform_buffers, self.uniform_buffers),
            ("storage buffers in a shader", limits.max_per_stage_descriptor_storage_buffers, self.storage_buffers),
            ("texel buffers in a shader", limits.max_per_stage_descriptor_sampled_images, self.texel_buffers),
            ("texel buffers in a descriptor set", limits.max_descriptor_set_sampled_images, self.texel_buffers),
            ("resources in a shader", limits.max_per_stage_resources, self.resources),
            ("bytes of push constants", limits.max_push_constants_size, self.push_constants),
            ("bytes in a uniform buffer", limits.max_uniform_buffer_range, self.uniform_bytes),
            ("invocations in a workgroup", row, self.invocations),
        ];
        let short = needs.into_iter().find(|(_, offered, needed)| offered < needed);
        short.map(|(what, offered, needed)| format!("{offered} {what} only; {needed} are needed"))
    }
}

/// A device that the loader knows, with what it offers.
pub struct PhysicalDevice {
    pub(in crate::gpu) instance: Arc<Instance>,
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
    pub(in crate::gpu) queue_family: Option<u32>,
    pub(in crate::gpu) timestamp_mask: u64,
    pub(in crate::gpu) limits: vk::PhysicalDeviceLimits,
    pub(in crate::gpu) scratch_alignment: u64,
    pub(in crate::gpu) max_instances: u64,
    pub(in crate::gpu) max_primitives: u64,
}

impl Instance {
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
        NEEDS.missing(&self.limits).map_or(Ok(()), Err)
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
    use super::{NEEDS, rank};
    use ash::vk;
    use ash::vk::PhysicalDeviceType as Type;

    /// The least that Vulkan guarantees is enough ("Required Limits" of the specification); less of anything is named.
    #[test]
    fn a_device_with_the_least_limits_is_usable() {
        let least = vk::PhysicalDeviceLimits {
            max_per_stage_descriptor_uniform_buffers: 12,
            max_per_stage_descriptor_storage_buffers: 4,
            max_per_stage_descriptor_sampled_images: 16,
            max_descriptor_set_sampled_images: 96,
            max_per_stage_resources: 128,
            max_push_constants_size: 128,
            max_uniform_buffer_range: 16384,
            max_compute_work_group_invocations: 128,
            max_compute_work_group_size: [128, 128, 64],
            ..vk::PhysicalDeviceLimits::default()
        };
        assert_eq!(NEEDS.missing(&least), None);
        let fewer = vk::PhysicalDeviceLimits { max_per_stage_descriptor_storage_buffers: 1, ..least };
        assert_eq!(NEEDS.missing(&fewer).as_deref(), Some("1 storage buffers in a shader only; 2 are needed"));
        let narrow = vk::PhysicalDeviceLimits { max_compute_work_group_size: [32, 32, 32], ..least };
        assert_eq!(NEEDS.missing(&narrow).as_deref(), Some("32 invocations in a workgroup only; 64 are needed"));
    }

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
