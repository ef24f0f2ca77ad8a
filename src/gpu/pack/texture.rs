//! Textures and the environment, as the kernel has them.

use crate::gpu::layout;
use crate::scene::{Environment, EnvironmentDistribution, Texture};
use glam::Vec3;
use std::sync::Arc;

/// What the kernel knows of each texture, and all their texels, two in one.
pub(in crate::gpu) fn textures(textures: &[Arc<Texture>]) -> (Vec<layout::Texture>, Vec<[u32; 4]>) {
    let mut headers = Vec::with_capacity(textures.len());
    let mut halves: Vec<[u32; 2]> = Vec::with_capacity(textures.iter().map(|t| t.texels.len()).sum::<usize>() + 1);
    for texture in textures {
        headers.push(layout::Texture {
            first_texel: halves.len() as u32,
            width: texture.width,
            height: texture.height,
            clamped: u32::from(texture.clamp),
        });
        halves.extend(texture.texels.iter().map(|texel| {
            let [r, g, b, a] = texel.map(|half| u32::from(half.to_bits()));
            [r | g << 16, b | a << 16]
        }));
    }
    (headers, pairs(halves))
}

/// The environment's texels with their densities, and its alias table, two slots in one texel.
pub(in crate::gpu) fn environment(
    environment: &Environment,
    distribution: &EnvironmentDistribution,
) -> (Vec<layout::EnvironmentTexel>, Vec<[u32; 4]>) {
    let radiance = |texel: usize| environment.image.as_ref().map_or(Vec3::ONE, |image| image.texels[texel]);
    let texel = |(index, density): (usize, &f64)| layout::EnvironmentTexel {
        radiance: radiance(index).to_array(),
        density: *density as f32,
    };
    let texels = distribution.density.iter().enumerate().map(texel).collect();
    (texels, pairs(distribution.choice.slots.iter().map(|(threshold, alias)| [*threshold, *alias]).collect()))
}

/// Two in one, the last filled up with zeros.
fn pairs(mut halves: Vec<[u32; 2]>) -> Vec<[u32; 4]> {
    if halves.len() % 2 == 1 {
        halves.push([0; 2]);
    }
    halves.chunks_exact(2).map(|p| [p[0][0], p[0][1], p[1][0], p[1][1]]).collect()
}
