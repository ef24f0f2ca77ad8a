//! The shaders: SPIR-V that is shipped, or GLSL compiled at run time with the `shaderc` feature.

use crate::Result;
use std::borrow::Cow;

/// A compute shader in one of its two variants.
#[derive(Debug, Clone, Copy)]
pub struct Shader {
    /// File name of the SPIR-V under `shaders/spirv`, without its ending; also the name in debuggers.
    pub name: &'static str,
    /// The shipped SPIR-V.
    pub spirv: &'static [u8],
}

macro_rules! shader {
    ($name:literal) => {
        Shader { name: $name, spirv: include_bytes!(concat!("../../../shaders/spirv/", $name, ".spv")) }
    };
}

/// The path tracer on the compute BVH and on ray queries, then the probe on both, then what only traces rays on both, then
/// the first hits.
pub const SHADERS: [Shader; 8] = [
    shader!("path_trace_bvh"),
    shader!("path_trace_ray_query"),
    shader!("probe_bvh"),
    shader!("probe_ray_query"),
    shader!("trace_rays_bvh"),
    shader!("trace_rays_ray_query"),
    shader!("aov_bvh"),
    shader!("aov_ray_query"),
];

impl Shader {
    /// The path tracer.
    pub(in crate::gpu) fn path_trace(ray_query: bool) -> &'static Shader {
        &SHADERS[usize::from(ray_query)]
    }

    /// The probe.
    pub(in crate::gpu) fn probe(ray_query: bool) -> &'static Shader {
        &SHADERS[2 + usize::from(ray_query)]
    }

    /// What only traces rays.
    pub(in crate::gpu) fn trace_rays(ray_query: bool) -> &'static Shader {
        &SHADERS[4 + usize::from(ray_query)]
    }

    /// The first hits of camera rays.
    pub(in crate::gpu) fn aov(ray_query: bool) -> &'static Shader {
        &SHADERS[6 + usize::from(ray_query)]
    }

    /// The shipped SPIR-V words.
    #[cfg(not(feature = "shaderc"))]
    pub(in crate::gpu) fn code(&self) -> Result<Cow<'static, [u32]>> {
        Ok(Cow::Owned(bytemuck::pod_collect_to_vec(self.spirv)))
    }

    /// The SPIR-V words of the GLSL as it stands on disk now.
    #[cfg(feature = "shaderc")]
    pub(in crate::gpu) fn code(&self) -> Result<Cow<'static, [u32]>> {
        super::compile::compile(self.name).map(Cow::Owned)
    }
}
