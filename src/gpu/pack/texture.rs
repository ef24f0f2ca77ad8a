//! Textures, as the kernel has them.

use crate::gpu::layout;
use crate::scene::Texture;
use bytemuck::Zeroable;
use glam::Affine2;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// What the kernel knows of each texture, and all their texels, two in one; those that several textures share only once.
pub(in crate::gpu) fn textures(textures: &[Arc<Texture>]) -> (Vec<layout::Texture>, Vec<[u32; 4]>) {
    let mut headers = Vec::with_capacity(textures.len());
    let mut halves: Vec<[u32; 2]> = Vec::with_capacity(texel_count(textures) as usize + 1);
    let mut first_texels = HashMap::new();
    for texture in textures {
        let first_texel = *first_texels.entry(Arc::as_ptr(&texture.texels)).or_insert(halves.len() as u32);
        let Affine2 { matrix2, translation } = texture.transform;
        headers.push(layout::Texture {
            first_texel,
            width: texture.width,
            height: texture.height,
            clamped: u32::from(texture.clamp),
            u: matrix2.row(0).extend(translation.x).to_array(),
            v: matrix2.row(1).extend(translation.y).to_array(),
            ..Zeroable::zeroed()
        });
        if (first_texel as usize) < halves.len() {
            continue;
        }
        halves.extend(texture.texels.iter().map(|texel| {
            let [r, g, b, a] = texel.map(|half| u32::from(half.to_bits()));
            [r | g << 16, b | a << 16]
        }));
    }
    (headers, pairs(halves))
}

/// Texels of all textures, those that are shared only once.
pub(in crate::gpu) fn texel_count(textures: &[Arc<Texture>]) -> u64 {
    let mut seen = HashSet::new();
    let own = textures.iter().filter(|texture| seen.insert(Arc::as_ptr(&texture.texels)));
    own.map(|texture| texture.texels.len() as u64).sum()
}

/// Two in one, the last filled up with zeros.
fn pairs(mut halves: Vec<[u32; 2]>) -> Vec<[u32; 4]> {
    if halves.len() % 2 == 1 {
        halves.push([0; 2]);
    }
    halves.chunks_exact(2).map(|p| [p[0][0], p[0][1], p[1][0], p[1][1]]).collect()
}
