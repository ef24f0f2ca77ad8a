//! Which tracer runs, on which device, and why.

use crate::render::Tracer;
use crate::scene::Scene;
use crate::{Error, Result};

/// The three ways to trace rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backend {
    /// The kernel on Vulkan ray queries over bottom- and top-level acceleration structures.
    RayQuery,
    /// The kernel on our own traversal of a compressed wide BVH in plain buffers.
    ComputeBvh,
    /// The double-precision reference.
    Cpu,
}

impl std::fmt::Display for Backend {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Backend::RayQuery => "ray-query",
            Backend::ComputeBvh => "compute-bvh",
            Backend::Cpu => "cpu",
        })
    }
}

/// What the caller asked for.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// A backend; none: `auto`.
    pub backend: Option<Backend>,
    /// A device by index or part of its name; none: the best.
    pub device: Option<String>,
}

/// A tracer, ready to run.
pub struct Opened {
    /// The tracer with the scene loaded.
    pub tracer: Box<dyn Tracer>,
    /// What was chosen.
    pub backend: Backend,
    /// Name of the device, with its driver.
    pub device: String,
    /// One sentence: why this backend on this device.
    pub why: String,
    /// True where the choice deserves a notice (no Vulkan at all, and so on).
    pub notice: bool,
    /// Seconds spent on building the acceleration structures and uploading.
    pub build_seconds: f64,
}

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
    /// The backend that `auto` would run there, or why the device cannot be used.
    pub backend: std::result::Result<Backend, String>,
    /// Why that backend.
    pub why: String,
}

/// Opens the best tracer for a request.
///
/// # Errors
/// If the request names a device or backend that is not there, or the scene does not fit it.
pub fn open(_scene: &Scene, _request: &Request) -> Result<Opened> {
    Err(Error::NoDevice("not built yet".into()))
}

/// Every Vulkan device of this machine; empty with a reason where there is no Vulkan.
///
/// # Errors
/// [`Error::NoDevice`] if there is no Vulkan loader.
pub fn devices() -> Result<Vec<DeviceReport>> {
    Ok(Vec::new())
}

/// The device that `auto` takes: of the usable ones a discrete GPU before an integrated, a virtual and a software one; of
/// equals the first.
pub fn preferred(devices: &[DeviceReport]) -> Option<&DeviceReport> {
    let rank = |device: &DeviceReport| match device.kind {
        "discrete GPU" => 0,
        "integrated GPU" => 1,
        "virtual GPU" => 2,
        "software (CPU)" => 3,
        _ => 4,
    };
    devices.iter().filter(|device| device.backend.is_ok()).min_by_key(|device| rank(device))
}
