//! Vulkan itself, which knows nothing of scenes: instance and devices, buffers, shaders and kernels, commands.

pub(super) mod binding;
pub(super) mod buffer;
#[cfg(feature = "shaderc")]
pub(super) mod compile;
pub(super) mod device;
pub(super) mod instance;
pub(super) mod kernel;
pub(super) mod physical_device;
pub(super) mod recorder;
pub(super) mod shader;
pub(super) mod submission;
pub(super) mod texel_buffer;
pub(super) mod upload;
pub(super) mod validation;
