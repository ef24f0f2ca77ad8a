//! Compiling the GLSL at run time, for those who change it (feature `shaderc`).

use crate::{Error, Result};
use std::path::PathBuf;

/// Where the sources are: `LUMINAIRE_SHADERS`, or the folder that the program was built from.
pub fn folder() -> PathBuf {
    std::env::var_os("LUMINAIRE_SHADERS")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders")), PathBuf::from)
}

/// SPIR-V of the shader that is shipped as `name`.
pub(in crate::gpu) fn compile(name: &str) -> Result<Vec<u32>> {
    let folder = folder();
    let (stem, ray_query) = match name.strip_suffix("_ray_query") {
        Some(stem) => (stem, true),
        None => (name.trim_end_matches("_bvh"), false),
    };
    let path = folder.join(format!("{stem}.comp"));
    let source = std::fs::read_to_string(&path).map_err(|e| Error::read(&path, e))?;
    let failed = |log: String| Error::Shader { name: path.display().to_string(), log };
    let compiler = shaderc::Compiler::new().map_err(|e| failed(e.to_string()))?;
    let mut options = shaderc::CompileOptions::new().map_err(|e| failed(e.to_string()))?;
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_2 as u32);
    // As scripts/build-shaders.sh does.
    options.set_optimization_level(shaderc::OptimizationLevel::Performance);
    if ray_query {
        options.add_macro_definition("RAY_QUERY", None);
    }
    options.set_include_callback(|file, _, _, _| {
        let path = folder.join(file);
        let content = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(shaderc::ResolvedInclude { resolved_name: path.display().to_string(), content })
    });
    let kind = shaderc::ShaderKind::Compute;
    let artifact = compiler
        .compile_into_spirv(&source, kind, &path.display().to_string(), "main", Some(&options))
        .map_err(|e| failed(e.to_string()))?;
    Ok(artifact.as_binary().to_vec())
}
