//! Which tracer runs, on which device, and why.

mod choice;
mod development;
mod devices;
mod renderer;

pub use crate::memory::{check_driver, fit_threads};
pub use choice::{Backend, Request};
pub use development::development;
pub use devices::{DeviceReport, devices};
pub use renderer::{Renderer, open};
