//! Every Vulkan handle lives here: device, buffers, commands, pipelines, and the GPU tracer.
//!
//! Each object holds an `Arc<Device>`; the device owns the instance, the allocator and the queue and drops them in order.
//! A raw handle is wrapped the moment it exists, so an early return cannot leak it.

pub mod accel;
mod bound_scene;
pub mod bvh;
pub mod layout;
mod memory_check;
pub mod pack;
pub mod probe;
mod scene;
pub mod specialization;
mod trace_rays;
mod tracer;
mod vulkan;

pub use trace_rays::RayTracer;
pub use tracer::GpuTracer;
pub use vulkan::binding::Binding;
pub use vulkan::buffer::Buffer;
pub use vulkan::device::Device;
pub use vulkan::instance::Instance;
pub use vulkan::kernel::Kernel;
pub use vulkan::physical_device::{NEEDS, Needs, PhysicalDevice};
pub use vulkan::shader::{SHADERS, Shader};
pub use vulkan::texel_buffer::TexelBuffer;
pub use vulkan::validation::validation_messages;

#[cfg(feature = "shaderc")]
pub use vulkan::compile::folder as shader_folder;
