//! The device and the backend for a request.

use crate::gpu::PhysicalDevice;
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

/// The backend that is the faster one on a device, and why.
pub(super) fn preferred(ray_query: bool, software: bool) -> (Backend, &'static str) {
    match (ray_query, software) {
        (true, false) => (Backend::RayQuery, "the GPU offers ray queries"),
        (true, true) => {
            (Backend::ComputeBvh, "a software device, on which our BVH is faster than the driver's ray queries")
        }
        (false, _) => (Backend::ComputeBvh, "the device offers no ray queries"),
    }
}

/// The device and backend for a request.
pub(super) fn choose<'a>(
    devices: &'a [PhysicalDevice],
    request: &Request,
) -> Result<(&'a PhysicalDevice, Backend, String)> {
    let wants_ray_query = request.backend == Some(Backend::RayQuery);
    let device = match &request.device {
        Some(wanted) => {
            let names: Vec<&str> = devices.iter().map(|d| d.name.as_str()).collect();
            &devices[find(&names, wanted)?]
        }
        None => devices
            .iter()
            .filter(|d| d.usable().is_ok() && (d.ray_query || !wants_ray_query))
            // The first of the best, in the loader's order.
            .rev()
            .max_by_key(|d| d.rank())
            .ok_or_else(|| {
                let found: Vec<String> = devices.iter().map(|d| d.name.clone()).collect();
                let found = if found.is_empty() { "there is no device at all".into() } else { found.join(", ") };
                Error::NoDevice(if wants_ray_query {
                    format!("no device offers ray queries ({found}): use --backend compute-bvh, which needs none")
                } else {
                    format!("no Vulkan device is usable ({found}): see `luminaire devices`, or use --backend cpu")
                })
            })?,
    };
    device.usable().map_err(|reason| Error::NoDevice(format!("{} cannot be used: {reason}", device.name)))?;
    if wants_ray_query && !device.ray_query {
        let advice =
            if device.ray_tracing_pipeline { " (it has ray-tracing pipelines, but those are not used)" } else { "" };
        return Err(Error::NoDevice(format!(
            "{} offers no ray queries{advice}: use --backend compute-bvh, which needs none, or another --device",
            device.name
        )));
    }
    Ok(match request.backend {
        Some(backend) => (device, backend, "as asked".into()),
        None => {
            let (backend, why) = preferred(device.ray_query, device.is_software());
            (device, backend, why.into())
        }
    })
}

/// Which of the devices has this index, or a name that contains this text (without regard to case).
fn find(names: &[&str], wanted: &str) -> Result<usize> {
    if let Ok(index) = wanted.parse::<usize>()
        && index < names.len()
    {
        return Ok(index);
    }
    let lower = wanted.to_lowercase();
    let mut found = names.iter().enumerate().filter(|(_, name)| name.to_lowercase().contains(&lower));
    let problem = match (found.next(), found.next()) {
        (Some((index, _)), None) => return Ok(index),
        (Some(_), Some(_)) => format!("several devices are called like `{wanted}`: give an index"),
        _ => format!("no device has the index or a name like `{wanted}`; there are"),
    };
    let list: String = names.iter().enumerate().map(|(index, name)| format!("\n  {index}: {name}")).collect();
    Err(Error::NoDevice(problem + &list))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ray_query_where_a_gpu_offers_it_and_the_bvh_elsewhere() {
        assert_eq!(preferred(true, false).0, Backend::RayQuery);
        assert_eq!(preferred(false, false).0, Backend::ComputeBvh);
        assert_eq!(preferred(true, true).0, Backend::ComputeBvh);
        assert_eq!(preferred(false, true).0, Backend::ComputeBvh);
    }

    #[test]
    fn devices_are_found_by_index_and_by_name() {
        let names = ["NVIDIA GeForce RTX 4090", "llvmpipe (LLVM 15)", "NVIDIA GeForce RTX 4070"];
        assert_eq!(find(&names, "1").unwrap(), 1);
        assert_eq!(find(&names, "LLVM").unwrap(), 1);
        // No such index, but a part of a name.
        assert_eq!(find(&names, "4090").unwrap(), 0);
        assert!(find(&names, "nvidia").unwrap_err().to_string().contains("give an index\n  0: NVIDIA"));
        assert_eq!(find(&names, "407").unwrap(), 2);
        assert!(find(&names, "9").is_ok() && find(&names, "8").unwrap_err().to_string().contains("  1: llvmpipe"));
    }
}
