//! Every Vulkan handle lives here: device, buffers, commands, pipelines, and the GPU tracer.
//!
//! Each object holds an `Arc<Device>`; the device owns the instance, the allocator and the queue and drops them in order.
//! A raw handle is wrapped the moment it exists, so an early return cannot leak it.

pub mod accel;
mod binding;
mod bound_scene;
mod budget;
mod buffer;
pub mod bvh;
#[cfg(feature = "shaderc")]
mod compile;
mod device;
mod instance;
mod kernel;
pub mod layout;
pub mod model;
pub mod pack;
mod physical_device;
pub mod probe;
mod ray_tracer;
mod recorder;
mod scene;
mod shader;
mod submission;
mod texel_buffer;
mod tracer;
mod upload;
mod validation;

pub use binding::Binding;
pub use buffer::Buffer;
pub use device::Device;
pub use instance::Instance;
pub use kernel::Kernel;
pub use physical_device::PhysicalDevice;
pub use ray_tracer::RayTracer;
pub use shader::{SHADERS, Shader};
pub use texel_buffer::TexelBuffer;
pub use tracer::GpuTracer;
pub use validation::validation_messages;

#[cfg(feature = "shaderc")]
pub use compile::folder as shader_folder;
