//! What bodies absorb along a ray: Beer's law, from one crossing of a boundary to the next.
//!
//! A ray knows what it goes through by the surfaces at its ends: the one that it comes to, if that is the inner side of a body, or else the one that it leaves. Where
//! it passes a body's boundary through a hole, that is a crossing as well, and the distance counts from there.

use super::hit::Hit;
use super::prepared_scene::Reference;
use glam::DVec3;

/// What is not absorbed over a length inside.
pub fn absorbed(absorption: DVec3, length: f64) -> DVec3 {
    // Nothing of no absorption, however long the way is.
    let lost = DVec3::select(absorption.cmpgt(DVec3::ZERO), absorption * length, DVec3::ZERO);
    (-lost).exp()
}

impl Reference {
    /// What is absorbed in a unit of length behind the surfaces of a material: of a body that absorbs.
    pub(super) fn body_absorption(&self, material: u32) -> DVec3 {
        self.surfaces[material as usize].map_or(DVec3::ZERO, |surface| surface.inner_absorption())
    }

    /// What is left of light along a ray up to `t_max`, where nothing stops it before; `size` is the length of its direction. `from` is absorbed behind the surface that it
    /// leaves, `to` in front of the one that it comes to; one of the two may say nothing.
    pub(super) fn passed_bodies(
        &self,
        ray: (DVec3, DVec3),
        size: f64,
        t_max: f64,
        salt: u32,
        [from, to]: [DVec3; 2],
    ) -> DVec3 {
        let (left, from, t) = match self.pierced_bodies {
            true => self.through_holes(ray, size, t_max, salt, from),
            false => (DVec3::ONE, from, 0.0),
        };
        left * absorbed(if to == DVec3::ZERO { from } else { to }, size * (t_max - t))
    }

    /// The same behind the last hole that the ray passes; what is absorbed from there on, if the surface that it comes to says nothing; and where that is.
    fn through_holes(
        &self,
        (origin, direction): (DVec3, DVec3),
        size: f64,
        t_max: f64,
        salt: u32,
        mut from: DVec3,
    ) -> (DVec3, DVec3, f64) {
        let (mut left, mut t) = (DVec3::ONE, 0.0);
        for hit in self.passed(origin, direction, t_max, salt) {
            let inside = self.body_absorption(self.material_index(hit.object, hit.triangle));
            if inside == DVec3::ZERO {
                continue;
            }
            let front = self.is_front(&hit, direction);
            left *= absorbed(if front { from } else { inside }, size * (hit.t - t));
            from = if front { inside } else { DVec3::ZERO };
            t = hit.t;
        }
        (left, from, t)
    }

    /// Whether a ray comes to the outward side of what it hits.
    fn is_front(&self, hit: &Hit, direction: DVec3) -> bool {
        self.outward(hit).dot(direction) <= 0.0
    }
}
