//! A triangle in world space, and how two of them lie.

use crate::scene::rounding::across;
use crate::scene::{Mesh, Scene, Triangle, outward};
use glam::{DAffine3, DVec3, Vec3A};
use obvhs::aabb::Aabb;

/// What is nearer than this, for each unit of the coordinates, is in the same place: single precision knows numbers to 6e-8, a point that a ray
/// finds to about ten times that, and shadow rays start and end by as much before what they are about (up to 3.5e-6 of lamps behind lamps leaked).
const SAME_PLACE: f64 = 5e-6;
/// But never more than this part of the smaller triangle, so that what is tiny keeps its shape.
const LEAST_SHAPE: f64 = 1e-4;
/// How far a triangle is moved off another one, for each unit of its coordinates and its size, unless that is too little or too much.
const USUAL_LIFT: f64 = 1.5e-5;
/// And at most, for each unit of its width: what is moved further is seen to have moved.
const MOST_LIFT: f64 = 0.01;

/// A triangle of an object, in world space.
#[derive(Debug, Clone)]
pub(super) struct Face {
    /// Index into [`Scene::objects`](crate::scene::Scene::objects).
    pub object: u32,
    /// Index into the mesh's triangles.
    pub triangle: u32,
    /// Index into [`Scene::materials`](crate::scene::Scene::materials).
    pub material: u32,
    pub corners: [DVec3; 3],
    /// Unit normal on the outward side; zero if it has no area.
    pub normal: DVec3,
    /// Its longest edge.
    size: f64,
    /// Its largest coordinate.
    reach: f64,
}

/// How two triangles lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Relation {
    /// They have no area in common.
    Apart,
    /// The three corners of the one are those of the other.
    Same,
    /// They lie in a plane, and a part of the one lies on the other.
    Overlapping,
}

impl Face {
    pub(super) fn new(object: u32, triangle: u32, mesh: &Mesh, to_world: &DAffine3, material: u32) -> Self {
        let of: &Triangle = &mesh.triangles[triangle as usize];
        let corners = of.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
        let normal = to_world.matrix3.inverse().transpose() * outward(mesh, of);
        let [a, b, c] = corners;
        Face {
            object,
            triangle,
            material,
            corners,
            normal: normal.normalize_or_zero(),
            size: a.distance(b).max(b.distance(c)).max(c.distance(a)),
            reach: corners.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max),
        }
    }

    /// The corners' bits in an order of their own: equal where the places are equal.
    pub(super) fn key(&self) -> [[u64; 3]; 3] {
        // Adding 0 makes -0 the same as 0.
        let mut key = self.corners.map(|p| (p + DVec3::ZERO).to_array().map(f64::to_bits));
        key.sort_unstable();
        key
    }

    /// A box around it, and around what may be in the same place, or nearer than `margin`.
    pub(super) fn bounds(&self, margin: f64) -> Aabb {
        let [a, b, c] = self.corners;
        let pad = DVec3::splat(margin.max(2.0 * SAME_PLACE * self.reach));
        let (low, high) = (a.min(b).min(c) - pad, a.max(b).max(c) + pad);
        Aabb::new(Vec3A::from(low.as_vec3()), Vec3A::from(high.as_vec3()))
    }

    pub(super) fn centre(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / 3.0
    }

    /// Object, material and place, for people.
    pub(super) fn describe(&self, scene: &Scene) -> String {
        let object = &scene.objects[self.object as usize].name;
        let material = &scene.materials[self.material as usize].name;
        let DVec3 { x, y, z } = self.centre() + scene.origin;
        format!("object `{object}`, material `{material}`, at ({x:.6} {y:.6} {z:.6})")
    }

    /// How far it has to be off another one in whose plane it lies, so that rays tell them apart: the bounds on the rounding of both.
    pub(super) fn needed(&self, scene: &Scene, other: &Face) -> f64 {
        let rounding = |face: &Face| across(scene, face.object, face.triangle, face.corners).0;
        rounding(self) + rounding(other) + self.tolerance(other)
    }

    /// How far it is usually moved off another triangle: further than rays usually round by, but so little that nobody sees it.
    pub(super) fn usual_lift(&self) -> f64 {
        (USUAL_LIFT * self.reach.max(self.size)).min(self.most_lift())
    }

    /// Its longest edge.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Its largest coordinate.
    pub(super) fn reach(&self) -> f64 {
        self.reach
    }

    fn most_lift(&self) -> f64 {
        let [a, b, c] = self.corners;
        // The side of the square of which it would be half.
        MOST_LIFT * (b - a).cross(c - a).length().sqrt()
    }

    /// How far it is moved off another triangle that it lies on, if that takes at least `needed`. None if that would be seen.
    pub(super) fn lift(&self, needed: f64) -> Option<f64> {
        (needed <= self.most_lift()).then(|| needed.max(self.usual_lift()))
    }

    /// How far another one may lie off its plane, and still be taken to lie in it.
    pub(super) fn tolerance(&self, other: &Face) -> f64 {
        (SAME_PLACE * self.reach.max(other.reach)).min(LEAST_SHAPE * self.size.min(other.size))
    }

    /// How `other` lies to this one.
    pub(super) fn relation(&self, other: &Face) -> Relation {
        let near = self.tolerance(other);
        let (large, small) = if self.size >= other.size { (self, other) } else { (other, self) };
        let [a, b, c] = large.corners;
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { return Relation::Apart };
        if small.corners.iter().any(|p| (*p - a).dot(normal).abs() > near) {
            return Relation::Apart;
        }
        let has = |face: &Face, p: &DVec3| face.corners.iter().any(|q| q.distance(*p) <= near);
        if self.corners.iter().all(|p| has(other, p)) && other.corners.iter().all(|p| has(self, p)) {
            return Relation::Same;
        }
        // Two triangles of a plane are apart if a side of one of them has the other on its outer side (separating axes).
        let apart = |of: &Face, from: &Face| {
            (0..3).any(|k| {
                let [p, q, r] = [0, 1, 2].map(|i| of.corners[(k + i) % 3]);
                let Some(inward) = normal.cross(q - p).try_normalize() else { return true };
                let inward = if inward.dot(r - p) < 0.0 { -inward } else { inward };
                from.corners.iter().all(|corner| (*corner - p).dot(inward) <= 2.0 * near)
            })
        };
        if apart(self, other) || apart(other, self) { Relation::Apart } else { Relation::Overlapping }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::build::mesh;
    use glam::Vec3;

    fn face(corners: [[f32; 3]; 3]) -> Face {
        let mesh = mesh(corners.map(Vec3::from).to_vec(), &[[0, 1, 2]]);
        Face::new(0, 0, &mesh, &DAffine3::IDENTITY, 0)
    }

    #[test]
    fn triangles_that_lie_on_each_other_are_told_from_neighbours() {
        let a = face([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]);
        let cases = [
            ([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]], Relation::Same),
            ([[0.0, 1.0, 1.000_000_5], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]], Relation::Same),
            ([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]], Relation::Apart),
            ([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]], Relation::Overlapping),
            ([[0.2, 0.2, 1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]], Relation::Overlapping),
            ([[0.0, 0.0, 1.001], [1.0, 0.0, 1.001], [0.0, 1.0, 1.001]], Relation::Apart),
            // Across each other in space, not in a plane.
            ([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 2.0]], Relation::Apart),
        ];
        for (corners, expected) in cases {
            let b = face(corners);
            assert_eq!((a.relation(&b), b.relation(&a)), (expected, expected), "{corners:?}");
        }
    }
}
