//! What every device of this machine offers, and what would run there.

use super::choice::{Backend, Request, choose, preferred};
use crate::Result;
use crate::gpu::Instance;

/// What one Vulkan device offers.
#[derive(Debug, Clone)]
pub struct DeviceReport {
    /// Index, as `--device` takes it.
    pub index: usize,
    /// Name of the device.
    pub name: String,
    /// Driver name and version, Vulkan version.
    pub driver: String,
    /// "discrete GPU", "integrated GPU", "virtual GPU", "software (CPU)" or "other".
    pub kind: &'static str,
    /// What it offers and lacks, a line each: feature and yes / no / value.
    pub features: Vec<(String, String)>,
    /// Whether it offers ray queries.
    pub ray_query: bool,
    /// The backend that `auto` would run there, or why the device cannot be used.
    pub backend: std::result::Result<Backend, String>,
    /// Why that backend.
    pub why: String,
    /// True for the device that is used unless another is asked for.
    pub preferred: bool,
}

/// Every Vulkan device of this machine.
///
/// # Errors
/// If there is no Vulkan loader or no driver, with what to install.
pub fn devices() -> Result<Vec<DeviceReport>> {
    let devices = Instance::new()?.devices()?;
    let best = choose(&devices, &Request::default()).ok().map(|(device, ..)| device.index);
    Ok(devices
        .iter()
        .map(|d| {
            let (backend, why) = preferred(d.ray_query, d.is_software());
            DeviceReport {
                index: d.index,
                name: d.name.clone(),
                driver: d.driver.clone(),
                kind: d.kind(),
                features: d.features(),
                ray_query: d.ray_query,
                backend: d.usable().map(|()| backend),
                why: why.into(),
                preferred: best == Some(d.index),
            }
        })
        .collect())
}
