//! Trees of boxes over the triangles of each mesh and over the objects, so that a ray tests few triangles.
//!
//! The boxes are `f32`; the walk widens them for each ray by a bound on every rounding error between the ray and the world-space
//! triangles, so that no triangle is missed that would have been hit.

use super::instance::Instance;
use super::rounding::gamma;
use crate::scene::{Mesh, Scene};
use glam::{DAffine3, DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

/// One tree for each mesh, in object space, and one over all objects, in world space.
pub(super) struct Trees {
    pub(super) meshes: Vec<MeshTree>,
    pub(super) objects: Bvh2,
    /// Largest absolute coordinate of the objects' boxes.
    reach: f64,
}

/// The tree of one mesh.
pub(super) struct MeshTree {
    pub(super) bvh: Bvh2,
    /// Largest absolute coordinate of the mesh.
    reach: f64,
}

impl Trees {
    pub(super) fn new(scene: &Scene, instances: &[Instance]) -> Self {
        let meshes: Vec<MeshTree> = scene.meshes.iter().map(|mesh| MeshTree::new(mesh)).collect();
        let boxes: Vec<Aabb> = scene
            .objects
            .iter()
            .zip(instances)
            .map(|(object, instance)| {
                let mesh = object.mesh as usize;
                world_box(scene.meshes[mesh].bounds().into(), meshes[mesh].reach, &instance.to_world)
            })
            .collect();
        let reach = boxes.iter().map(|b| b.min.abs().max(b.max.abs()).max_element()).fold(0.0, f32::max).into();
        Trees { meshes, objects: build(&boxes), reach }
    }

    /// A walker for a world-space ray over `objects`. The triangle test accepts rays that pass a triangle within its own
    /// rounding error, at most `gamma(16)` of the coordinates that went into it.
    pub(super) fn world_walker(&self, origin: DVec3, direction: DVec3) -> Walker {
        let pad = gamma(16.0) * (origin.abs().max_element() + self.reach);
        Walker { origin, inverse: direction.recip(), pad }
    }
}

impl MeshTree {
    fn new(mesh: &Mesh) -> Self {
        let corner = |v: u32| Vec3A::from(mesh.positions[v as usize]);
        let boxes: Vec<Aabb> = mesh.triangles.iter().map(|t| Aabb::from_points(&t.vertices.map(corner))).collect();
        let (low, high) = mesh.bounds();
        MeshTree { bvh: build(&boxes), reach: low.abs().max(high.abs()).max_element().into() }
    }
}

/// A walker over the tree of an instance's mesh, for a ray given in world space.
pub(super) fn object_walker(mesh: &MeshTree, instance: &Instance, origin: DVec3, direction: DVec3) -> Walker {
    let norm = |m: &DAffine3| m.matrix3.to_cols_array().iter().map(|e| e * e).sum::<f64>().sqrt();
    let (to_world, to_object) = (norm(&instance.to_world), norm(&instance.to_object));
    // The inverse is good to its condition number. Points reach from the ray's origin to the mesh, in world space.
    let condition = to_world * to_object;
    let translation = instance.to_world.translation.length();
    let pad = gamma(64.0) * condition * to_object * (origin.length() + translation + to_world * mesh.reach);
    let direction = instance.to_object.transform_vector3(direction);
    Walker { origin: instance.to_object.transform_point3(origin), inverse: direction.recip(), pad }
}

/// A ray on its way through a tree.
pub(super) struct Walker {
    origin: DVec3,
    /// One over the direction.
    inverse: DVec3,
    /// How far boxes are widened on all sides.
    pad: f64,
}

impl Walker {
    /// Calls `visit` for every primitive whose box the ray enters at a `t` in `[0, limit]`, nearer boxes first; `visit` may lower
    /// the limit.
    pub(super) fn walk(&self, bvh: &Bvh2, limit: &mut f64, visit: &mut impl FnMut(u32, &mut f64)) {
        if self.entry(bvh.nodes[0].aabb(), *limit).is_some() {
            self.walk_node(bvh, 0, limit, visit);
        }
    }

    fn walk_node(&self, bvh: &Bvh2, node: usize, limit: &mut f64, visit: &mut impl FnMut(u32, &mut f64)) {
        let node = &bvh.nodes[node];
        let first = node.first_index as usize;
        if node.is_leaf() {
            for &primitive in &bvh.primitive_indices[first..first + node.prim_count as usize] {
                visit(primitive, limit);
            }
            return;
        }
        let entries = [first, first + 1].map(|child| self.entry(bvh.nodes[child].aabb(), *limit));
        let swap = matches!(entries, [Some(left), Some(right)] if right < left);
        for child in if swap { [1, 0] } else { [0, 1] } {
            // The first child may have lowered the limit.
            if entries[child].is_some_and(|entry| entry <= *limit) {
                self.walk_node(bvh, first + child, limit, visit);
            }
        }
    }

    /// Where the ray enters a box, if it does in `[0, limit]`.
    fn entry(&self, aabb: &Aabb, limit: f64) -> Option<f64> {
        let (mut near, mut far) = (0.0f64, limit);
        for axis in 0..3 {
            let low = f64::from(aabb.min[axis]) - self.pad - self.origin[axis];
            let high = f64::from(aabb.max[axis]) + self.pad - self.origin[axis];
            let inverse = self.inverse[axis];
            if inverse.is_infinite() {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low * inverse, high * inverse);
            near = near.max(a.min(b));
            // Errs on the far side (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013).
            far = far.min(a.max(b) * (1.0 + 2.0 * gamma(3.0)));
        }
        (near <= far).then_some(near)
    }
}

fn build(boxes: &[Aabb]) -> Bvh2 {
    let indices = (0..boxes.len() as u32).collect();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    builder.build(PlocSearchDistance::Medium, boxes, indices, SortPrecision::U64, 0)
}

/// A box around an instance: around the corners of its mesh's box, with their rounding errors.
fn world_box(bounds: [glam::Vec3; 2], reach: f64, to_world: &DAffine3) -> Aabb {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in 0..8 {
        let pick = |axis: usize| f64::from(bounds[corner >> axis & 1][axis]);
        let p = to_world.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
        low = low.min(p);
        high = high.max(p);
    }
    let columns = to_world.matrix3;
    let sum = (columns.x_axis.abs() + columns.y_axis.abs() + columns.z_axis.abs()) * reach + to_world.translation.abs();
    let (low, high) = (low - gamma(8.0) * sum, high + gamma(8.0) * sum);
    Aabb::new(
        Vec3A::from(low.to_array().map(|v| (v as f32).next_down())),
        Vec3A::from(high.to_array().map(|v| (v as f32).next_up())),
    )
}
