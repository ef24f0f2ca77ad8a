//! Rays and triangles.
//!
//! Triangles are tested in world space, by brute force and through the trees alike: the trees only choose which triangles
//! are tested, so the two give the same hits to the last bit.
//!
//! Where a surface is partly transparent, chance decides whether a ray meets it. `salt` makes the decisions of one ray independent
//! of those of others ([`crate::sampling::ray_salt`]).

use super::hit::{Hit, texture_coordinates};
use super::prepared_scene::Reference;
use super::rounding::gamma;
use super::tree;
use crate::sampling::{coverage, uniform};
use glam::DVec3;

impl Reference {
    /// The hit with the smallest `t` in `(0, t_max)`; of several at the same `t`, the first in the scene's order.
    ///
    /// `direction` need not have unit length. A ray that is not finite, or has no direction, hits nothing.
    pub fn closest_hit(&self, origin: DVec3, direction: DVec3, t_max: f64, salt: u32) -> Option<Hit> {
        let mut closest: Option<Hit> = None;
        self.for_each_hit(origin, direction, t_max, &mut |hit| {
            if !self.is_met(&hit, salt) {
                return None;
            }
            if closest.is_none_or(|c| (hit.t, hit.object, hit.triangle) < (c.t, c.object, c.triangle)) {
                closest = Some(hit);
            }
            closest.map(|c| c.t)
        });
        closest
    }

    /// What a ray passes through holes before `t_max`, in the order in which it does.
    pub(super) fn passed(&self, origin: DVec3, direction: DVec3, t_max: f64, salt: u32) -> Vec<Hit> {
        let mut passed = vec![];
        self.for_each_hit(origin, direction, t_max, &mut |hit| {
            if !self.is_met(&hit, salt) {
                passed.push(hit);
            }
            None
        });
        passed.sort_by(|a, b| a.t.total_cmp(&b.t));
        passed
    }

    /// Whether anything is hit at a `t` in `(0, t_max)`.
    pub fn occluded(&self, origin: DVec3, direction: DVec3, t_max: f64, salt: u32) -> bool {
        let mut occluded = false;
        self.for_each_hit(origin, direction, t_max, &mut |hit| {
            let met = self.is_met(&hit, salt);
            occluded |= met;
            met.then_some(f64::NEG_INFINITY)
        });
        occluded
    }

    /// Calls `found` for hits in `(0, t_max)`, also of what the ray may pass. It returns the `t` beyond which it does not care for more, if it knows one; some more may come.
    fn for_each_hit(&self, origin: DVec3, direction: DVec3, t_max: f64, found: &mut impl FnMut(Hit) -> Option<f64>) {
        if !origin.is_finite() || !direction.is_finite() || direction == DVec3::ZERO {
            return;
        }
        let ray = Ray::new(origin, direction);
        let mut limit = t_max;
        let mut test = |object: u32, triangle: u32, limit: &mut f64| {
            if let Some((t, barycentrics)) = ray.intersect(self.corners(object, triangle))
                && t < t_max
            {
                let hit = Hit { t, object, triangle, barycentrics };
                if let Some(least) = found(hit) {
                    *limit = least;
                }
            }
        };
        if let Some(trees) = &self.trees {
            let walker = trees.world_walker(origin, direction);
            walker.walk(&trees.objects, &mut limit, &mut |object, limit| {
                let instance = &self.instances[object as usize];
                let mesh = &trees.meshes[self.scene.objects[object as usize].mesh as usize];
                let walker = tree::object_walker(mesh, instance, origin, direction);
                walker.walk(&mesh.bvh, limit, &mut |triangle, limit| test(object, triangle, limit));
            });
        } else {
            for (index, object) in self.scene.objects.iter().enumerate() {
                for triangle in 0..self.scene.meshes[object.mesh as usize].triangles.len() {
                    test(index as u32, triangle as u32, &mut limit);
                }
            }
        }
    }
}

impl Reference {
    /// Whether a ray meets the surface at a hit, or passes through: a surface of opacity 0.3 stops three rays of ten.
    fn is_met(&self, hit: &Hit, salt: u32) -> bool {
        let object = &self.scene.objects[hit.object as usize];
        let mesh = &self.scene.meshes[object.mesh as usize];
        let triangle = &mesh.triangles[hit.triangle as usize];
        let [b1, b2] = hit.barycentrics;
        let uv = texture_coordinates(mesh, triangle, [1.0 - b1 - b2, b1, b2]);
        let opacity = self.opacity(self.scene.material_of(object, triangle), uv);
        opacity >= 1.0 || uniform(coverage(salt, hit.object, hit.triangle)) < opacity
    }
}

/// A ray, with the shear that turns its direction into the z axis (after a permutation of the axes).
struct Ray {
    origin: DVec3,
    /// The axes to call x, y and z; z is the one along which the direction is longest.
    axes: [usize; 3],
    /// How much x, y change for one step along z.
    shear: [f64; 2],
    /// The direction's z.
    length: f64,
}

impl Ray {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let z = direction.abs().max_position();
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let shear = [direction[axes[0]] / direction[z], direction[axes[1]] / direction[z]];
        Ray { origin, axes, shear, length: direction[z] }
    }

    /// Distance and weights of the second and third corner where the ray hits a triangle, from either side.
    ///
    /// Watertight: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. A product is rounded
    /// monotonically, so an edge function has the right sign or is zero, and zero counts as inside. A hit that is not
    /// further away than the error of `t` may lie behind the origin and is no hit (Pharr, Jakob and Humphreys, "Physically
    /// Based Rendering", section 6.8.7).
    fn intersect(&self, corners: [DVec3; 3]) -> Option<(f64, [f64; 2])> {
        let [x, y, z] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let p = corner - self.origin;
            DVec3::new(p[x] - self.shear[0] * p[z], p[y] - self.shear[1] * p[z], p[z])
        });
        // Edge functions: twice the area, seen along the ray, of the triangle over the opposite edge.
        let u = c.x * b.y - c.y * b.x;
        let v = a.x * c.y - a.y * c.x;
        let w = b.x * a.y - b.y * a.x;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let sum = u + v + w;
        if sum == 0.0 {
            return None;
        }
        let scale = 1.0 / (sum * self.length);
        let t = (u * a.z + v * b.z + w * c.z) * scale;

        let far = a.abs().max(b.abs()).max(c.abs());
        let xy_error = gamma(5.0) * (far.truncate() + far.z);
        let z_error = gamma(3.0) * far.z;
        let edge_error = 2.0 * (gamma(2.0) * far.x * far.y + xy_error.y * far.x + xy_error.x * far.y);
        let edge = u.abs().max(v.abs()).max(w.abs());
        let t_error = 3.0 * (gamma(3.0) * edge * far.z + edge_error * far.z + z_error * edge) * scale.abs();
        (t > t_error).then_some((t, [v / sum, w / sum]))
    }
}
