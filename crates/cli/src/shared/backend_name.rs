//! What `--backend` and `--device` ask of the library.

use luminaire::backend::{Backend, Request};
use luminaire::{Error, Result};

/// `--backend`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum BackendName {
    /// The fastest on the best device; the CPU where there is no Vulkan.
    Auto,
    /// Vulkan ray queries over acceleration structures.
    RayQuery,
    /// A compute shader's own traversal of a BVH.
    ComputeBvh,
    /// The double-precision reference.
    Cpu,
}

impl BackendName {
    /// The backend that is asked for; none: `auto`.
    pub fn backend(self) -> Option<Backend> {
        match self {
            BackendName::Auto => None,
            BackendName::RayQuery => Some(Backend::RayQuery),
            BackendName::ComputeBvh => Some(Backend::ComputeBvh),
            BackendName::Cpu => Some(Backend::Cpu),
        }
    }
}

/// What `--backend` and `--device` ask for. A usage error if they do not go together.
pub fn request(backend: BackendName, device: Option<&str>) -> Result<Request> {
    if device.is_some() && backend == BackendName::Cpu {
        return Err(Error::Usage(
            "--device chooses a Vulkan device, but --backend cpu uses none: leave one of them out".into(),
        ));
    }
    Ok(Request { backend: backend.backend(), device: device.map(str::to_owned) })
}
