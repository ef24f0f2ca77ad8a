//! The light tree, as the kernel has it.

use crate::gpu::layout::{self, LIGHT_TREE_HEADER};
use crate::scene::light_tree::LightNode;
use crate::scene::{LightTree, LuminaireTable};

/// Texels of the tree: a header, what is chosen beside it, nodes, paths.
pub(in crate::gpu) fn light_tree(tree: &LightTree, table: &LuminaireTable) -> Vec<[u32; 4]> {
    let slots = &tree.outer_choice.slots;
    let nodes_at = LIGHT_TREE_HEADER + slots.len();
    let paths_at = nodes_at + tree.nodes.len() * size_of::<layout::LightNode>() / 16;
    let mut texels = Vec::with_capacity(paths_at + tree.paths.len().div_ceil(2));
    let probability = (tree.probability as f32).to_bits();
    texels.push([slots.len() as u32, nodes_at as u32, paths_at as u32, probability]);
    // They stand in a row, before the environment.
    let first_sun = tree.outer.iter().position(|outer| *outer == table.suns().next().map(|(entry, _)| entry as u32));
    texels.push([(tree.environment_probability as f32).to_bits(), first_sun.unwrap_or(0) as u32, 0, 0]);
    for ((entry, (threshold, alias)), pdf) in tree.outer.iter().zip(slots).zip(&tree.outer_choice.pdf) {
        texels.push([*threshold, entry.unwrap_or(layout::NONE), *alias, (*pdf as f32).to_bits()]);
    }
    for &LightNode { x, y, z, radius, strength, axis_xy, axis_z_spread, link } in &tree.nodes {
        let node = layout::LightNode { x, y, z, radius, strength, axis_xy, axis_z_spread, link };
        texels.extend(bytemuck::cast::<layout::LightNode, [[u32; 4]; 8]>(node));
    }
    let halves = |path: u64| [path as u32, (path >> 32) as u32];
    texels.extend(tree.paths.chunks(2).map(|pair| {
        let ([a, b], [c, d]) = (halves(pair[0]), halves(*pair.last().expect("one at least")));
        [a, b, c, d]
    }));
    texels
}
