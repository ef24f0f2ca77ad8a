//! Single-precision tests of rays against triangles that the kernel does not use, or uses otherwise, to be put beside it.
//!
//! A model of what happens in a leaf of any tree of boxes: the ray is tested against the triangle's own box and, if it enters it,
//! against the triangle. The boxes above that leaf contain it, so that they lose no ray which the leaf's does not lose. Every triangle is tested. The arithmetic is
//! the kernel's: `f32`, rounded after every operation, in the order of `shaders/intersect_bvh.glsl`. Instances are placed by their corners, transformed and rounded.

use super::rays::Ray;
use glam::{Vec2, Vec3};
use luminaire::reference::hit::Hit;
use luminaire::scene::Scene;
use rayon::prelude::*;

/// A ray-triangle test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Test {
    /// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997. What two triangles say about a common
    /// edge is computed from different numbers.
    MoellerTrumbore {
        /// Determinants up to this one count as zero; the paper's program has 1e-6.
        epsilon: f32,
    },
    /// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: the kernel's.
    Watertight,
}

/// Triangles in world space, each in its box.
pub struct Triangles {
    test: Test,
    triangles: Vec<Triangle>,
    /// By which the box test's far side is multiplied.
    slack: f32,
}

struct Triangle {
    corners: [Vec3; 3],
    low: Vec3,
    high: Vec3,
    object: u32,
    index: u32,
}

impl Triangles {
    /// All triangles of a scene. `padded` boxes are larger by eight units in the last place of the largest coordinate and have the kernel's
    /// slack; the others are what the corners span.
    pub fn new(scene: &Scene, test: Test, padded: bool) -> Self {
        let mut triangles = Vec::new();
        for (object, placed) in scene.objects.iter().enumerate() {
            let mesh = &scene.meshes[placed.mesh as usize];
            for (index, triangle) in mesh.triangles.iter().enumerate() {
                let corners =
                    triangle.vertices.map(|v| placed.object_to_world.transform_point3(mesh.positions[v as usize]));
                let [a, b, c] = corners;
                let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                triangles.push(Triangle { corners, low, high, object: object as u32, index: index as u32 });
            }
        }
        if padded {
            let largest = triangles.iter().map(|t| t.low.abs().max(t.high.abs()).max_element()).fold(0.0, f32::max);
            let pad = Vec3::splat(largest * 4.0 * f32::EPSILON);
            for triangle in &mut triangles {
                triangle.low -= pad;
                triangle.high += pad;
            }
        }
        Triangles { test, triangles, slack: if padded { 1.0 + 4.0 * f32::EPSILON } else { 1.0 } }
    }

    /// The closest hit of each ray at a `t` above `t_min`.
    pub fn hits(&self, rays: &[Ray], t_min: f32) -> Vec<Option<Hit>> {
        rays.par_iter().map(|ray| self.closest_hit(ray, t_min)).collect()
    }

    /// What each ray meets after it was mirrored off the first surface, where a self-hit is kept off by a smallest distance `t_min` alone: the second ray
    /// starts at the rounded point `origin + t direction`. Directions have unit length.
    pub fn leaves(&self, rays: &[Ray], t_min: f32) -> Vec<Option<Hit>> {
        let leave = |ray: &Ray| {
            let first = self.closest_hit(ray, 0.0)?;
            let of = |t: &&Triangle| (t.object, t.index) == (first.object, first.triangle);
            let [a, b, c] = self.triangles.iter().find(of)?.corners;
            let normal = (b - a).cross(c - a);
            let normal = (normal / normal.abs().max_element()).normalize();
            let direction = ray.direction - 2.0 * ray.direction.dot(normal) * normal;
            let origin = ray.origin + first.t as f32 * ray.direction;
            self.closest_hit(&Ray { origin, direction, t_max: f32::INFINITY }, t_min)
        };
        rays.par_iter().map(leave).collect()
    }

    fn closest_hit(&self, ray: &Ray, t_min: f32) -> Option<Hit> {
        let sheared = Sheared::new(ray);
        // A component of zero would give infinity times zero; as in the kernel.
        let size = ray.direction.abs();
        let least = Vec3::splat(size.max_element() * 1e-18);
        let inverse = Vec3::select(size.cmplt(least), least, ray.direction).recip();
        let mut closest: Option<Hit> = None;
        let mut t_max = ray.t_max;
        for triangle in &self.triangles {
            let (t0, t1) = ((triangle.low - ray.origin) * inverse, (triangle.high - ray.origin) * inverse);
            let (near, far) = (t0.min(t1).max_element().max(0.0), t0.max(t1).min_element());
            if near > (far * self.slack).min(t_max) {
                continue;
            }
            let found = match self.test {
                Test::MoellerTrumbore { epsilon } => moeller_trumbore(ray, triangle.corners, epsilon),
                Test::Watertight => sheared.intersect(triangle.corners),
            };
            if let Some((t, [v, w])) = found
                && t > t_min
                && t < t_max
            {
                t_max = t;
                let barycentrics = [f64::from(v), f64::from(w)];
                closest = Some(Hit { t: t.into(), object: triangle.object, triangle: triangle.index, barycentrics });
            }
        }
        closest
    }
}

fn moeller_trumbore(ray: &Ray, [a, b, c]: [Vec3; 3], epsilon: f32) -> Option<(f32, [f32; 2])> {
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() <= epsilon {
        return None;
    }
    let inverse = 1.0 / determinant;
    let s = ray.origin - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(ab);
    let v = ray.direction.dot(q) * inverse;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| (ac.dot(q) * inverse, [u, v]))
}

/// A ray whose direction has become the z axis.
struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: Vec3,
}

impl Sheared {
    fn new(ray: &Ray) -> Self {
        let z = ray.direction.abs().max_position();
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let [x, y, z] = axes.map(|axis| ray.direction[axis]);
        Sheared { origin: ray.origin, axes, shear: Vec3::new(x / z, y / z, 1.0 / z) }
    }

    fn intersect(&self, corners: [Vec3; 3]) -> Option<(f32, [f32; 2])> {
        let permuted = corners.map(|corner| {
            let p = corner - self.origin;
            Vec3::from_array(self.axes.map(|axis| p[axis]))
        });
        let [a, b, c] = permuted.map(|p| Vec2::new(p.x - self.shear.x * p.z, p.y - self.shear.y * p.z));
        let u = c.x * b.y - c.y * b.x;
        let v = a.x * c.y - a.y * c.x;
        let w = b.x * a.y - b.y * a.x;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let determinant = u + v + w;
        if determinant == 0.0 {
            return None;
        }
        let reciprocal = 1.0 / determinant;
        let t = (u * permuted[0].z + v * permuted[1].z + w * permuted[2].z) * self.shear.z * reciprocal;
        Some((t, [v * reciprocal, w * reciprocal]))
    }
}
