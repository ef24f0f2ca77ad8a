//! The software BVH, built by the `obvhs` crate: an eight-wide compressed BVH a mesh, and one over the instances.
//!
//! The box test of the kernel rounds, so every leaf box is padded by eight units in the last place of the largest coordinate:
//! with that, no ray aimed at a shared edge or vertex was ever seen to slip through (`tests/gpu/intersection.rs`).

mod order;

pub use order::spatial_order;

use crate::scene::{Mesh, Scene, widen};
use glam::{DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
pub use obvhs::cwbvh::node::CwBvhNode;
use std::time::Duration;

/// The kernel's traversal stack holds this many entries (`STACK_SIZE` in `shaders/intersect_bvh.glsl`).
pub const STACK_SIZE: usize = 32;

/// A two-level BVH over a scene, laid out for the kernel.
pub struct TwoLevelBvh {
    /// All nodes; indices in them are absolute. The top level starts at 0; where the scene needs no instances there is no
    /// top level, and the only mesh starts at 0.
    pub nodes: Vec<CwBvhNode>,
    /// For each mesh: its root node, its first triangle, and which of its triangles lies in which place.
    pub meshes: Vec<MeshBvh>,
    /// Which of the scene's objects lies in which place of the top level.
    pub object_order: Vec<u32>,
    /// Entries of the traversal stack that the deepest ray can need.
    pub stack_depth: usize,
}

/// Where a mesh lies in a [`TwoLevelBvh`].
pub struct MeshBvh {
    /// Index of the root node.
    pub root: u32,
    /// Index of the first triangle.
    pub triangle_offset: u32,
    /// `order[i]` is the index in [`Mesh::triangles`] of the triangle in place `i`.
    pub order: Vec<u32>,
}

impl TwoLevelBvh {
    /// Builds the BVHs of all meshes, and the top level if `instances`.
    pub fn build(scene: &Scene, instances: bool) -> Self {
        let mut built: Vec<CwBvh> = scene.meshes.iter().map(|mesh| build_mesh(mesh)).collect();
        let (mut top, object_order) = if instances {
            // A leaf of several instances would have rays enter those that they miss.
            let mut top = build(&instance_boxes(scene), 1);
            let order = std::mem::take(&mut top.primitive_indices);
            (top.nodes, order)
        } else {
            (Vec::new(), vec![0])
        };
        let mesh_depth = built.iter().map(|b| depth(&b.nodes)).max().unwrap_or(0);
        // One entry a level, and the rest of the leaf whose instance is entered.
        let stack_depth = mesh_depth + if instances { depth(&top) + 1 } else { 0 };
        let mut meshes = Vec::with_capacity(built.len());
        let mut triangle_offset = 0u32;
        for bvh in &mut built {
            let root = top.len() as u32;
            for node in &mut bvh.nodes {
                node.child_base_idx += root;
                node.primitive_base_idx += triangle_offset;
            }
            top.append(&mut bvh.nodes);
            let order = std::mem::take(&mut bvh.primitive_indices);
            let count = order.len() as u32;
            meshes.push(MeshBvh { root, triangle_offset, order });
            triangle_offset += count;
        }
        TwoLevelBvh { nodes: top, meshes, object_order, stack_depth }
    }
}

/// How far a box must be padded so that rounding cannot lose what lies in it: 8 * 2^-24 of the largest coordinate.
fn padding(low: DVec3, high: DVec3) -> f64 {
    low.abs().max(high.abs()).max_element() * 8.0 * f64::from(f32::EPSILON) * 0.5
}

fn build_mesh(mesh: &Mesh) -> CwBvh {
    let (low, high) = mesh.bounds();
    let pad = Vec3A::splat(padding(low.as_dvec3(), high.as_dvec3()) as f32);
    let boxes: Vec<Aabb> = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.vertices.map(|v| Vec3A::from(mesh.positions[v as usize]));
            Aabb::new(a.min(b).min(c) - pad, a.max(b).max(c) + pad)
        })
        .collect();
    build(&boxes, 3)
}

/// World-space boxes of the instances, padded for the rounding of their transforms.
fn instance_boxes(scene: &Scene) -> Vec<Aabb> {
    let (low, high) = scene.world_bounds();
    let pad = padding(low, high);
    let mesh_boxes: Vec<_> = scene.meshes.iter().map(|mesh| mesh.bounds()).collect();
    scene
        .objects
        .iter()
        .map(|object| {
            let to_world = widen(object.object_to_world);
            let (low, high) = mesh_boxes[object.mesh as usize];
            let (low, high) = (low.as_dvec3(), high.as_dvec3());
            // The mesh's own leaves are padded too.
            let mesh_pad = DVec3::splat(padding(low, high));
            let (low, high) = (low - mesh_pad, high + mesh_pad);
            let centre = to_world.transform_point3(0.5 * (low + high));
            let half = 0.5 * (high - low);
            let m = to_world.matrix3;
            let reach = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z + DVec3::splat(pad);
            Aabb::new(round_to(centre - reach, f32::next_down), round_to(centre + reach, f32::next_up))
        })
        .collect()
}

fn round_to(v: DVec3, outward: impl Fn(f32) -> f32) -> Vec3A {
    Vec3A::from(Vec3::from_array(v.to_array().map(|x| outward(x as f32))))
}

/// Meshes of up to so many triangles get the better BVH. It takes three times as long to build: 3.3 s in place of 1.0 s for a million.
const WORTH_OPTIMIZING: usize = 1 << 17;

/// With at most `most_in_leaf` boxes in a leaf, if that is fewer than three.
fn build(boxes: &[Aabb], most_in_leaf: u32) -> CwBvh {
    let quality = match boxes.len() {
        ..=WORTH_OPTIMIZING => BvhBuildParams::very_slow_build(),
        _ => BvhBuildParams::medium_build(),
    };
    build_cwbvh(boxes, BvhBuildParams { max_prims_per_leaf: most_in_leaf, ..quality }, &mut Duration::default())
}

/// Levels of a BVH.
fn depth(nodes: &[CwBvhNode]) -> usize {
    // A child always comes after its parent.
    let mut level = vec![1usize; nodes.len()];
    let mut deepest = 0;
    for (index, node) in nodes.iter().enumerate() {
        deepest = deepest.max(level[index]);
        for child in 0..8 {
            if !node.is_leaf(child) {
                let child = node.child_node_index(child) as usize;
                level[child] = level[index] + 1;
            }
        }
    }
    deepest
}
