//! Every Vulkan handle lives here: device, buffers, commands, pipelines, and the GPU tracer.
//!
//! Each object holds an `Arc<Device>`; the device owns the instance, the allocator and the queue and drops them in order.
//! A raw handle is wrapped the moment it exists, so an early return cannot leak it.

pub mod accel;
mod budget;
mod buffer;
pub mod bvh;
mod commands;
#[cfg(feature = "shaderc")]
mod compile;
mod device;
mod instance;
mod kernel;
pub mod layout;
pub mod model;
pub mod probe;
mod ray_tracer;
mod scene;
mod shader;
mod tracer;

pub use buffer::{Buffer, TexelBuffer};
pub use device::Device;
pub use instance::{Instance, PhysicalDevice, validation_messages};
pub use kernel::{Binding, Kernel};
pub use ray_tracer::RayTracer;
pub use shader::{SHADERS, Shader};
pub use tracer::GpuTracer;

pub(crate) use commands::{barrier, submit};
#[cfg(feature = "shaderc")]
pub use compile::folder as shader_folder;
