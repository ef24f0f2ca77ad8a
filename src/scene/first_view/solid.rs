//! The triangles of a scene as the search for a view sees them: in a unit of their own, few enough to be looked at quickly, in a tree.

use super::lattice::{Facet, Mix, simplified};
use super::visit::for_triangles;
use crate::scene::Scene;
use glam::{DVec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use std::cell::Cell;
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

/// Scenes of at most so many triangles are looked at as they are.
const EXACT: u64 = 150_000;

/// Triangles that are kept of those with one box.
const MOST_ALIKE: u32 = 16;
/// Tests of a triangle in all: ordinary scenes need a tenth.
const MOST_TESTED: u32 = 40_000_000;

/// What a ray meets.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// Along the ray, in units of its direction.
    pub distance: f32,
    /// Whether the outward side is met.
    pub front: bool,
    /// Unit normal on the outward side.
    pub normal: Vec3A,
    /// Whether light passes.
    clear: bool,
}

/// The shape of a scene, mapped so that its bounds are within -1 to 1, and the largest extent is from -1 to 1. Strays are beyond that.
pub(super) struct Solid {
    /// What the middle of the bounds is in the scene.
    pub middle: DVec3,
    /// A unit here is so long in the scene.
    pub unit: f64,
    /// Half the extents of the bounds, without strays.
    pub half: Vec3A,
    triangles: Vec<RtTriangle>,
    /// By triangle: light passes it.
    clear: Vec<bool>,
    tree: Bvh2,
    /// Triangles that rays have been tested against so far.
    tested: Cell<u32>,
}

impl Solid {
    /// What lies within bounds, and all else, too; none if nothing has any extent.
    pub(super) fn new(scene: &Scene, (low, high): (DVec3, DVec3)) -> Option<Self> {
        let (middle, unit) = (0.5 * (low + high), 0.5 * (high - low).max_element());
        if !(unit > 0.0 && unit.is_finite()) {
            return None;
        }
        let mut kept: Vec<Facet> = Vec::new();
        let to_here = |p: DVec3| Vec3A::from(((p - middle) / unit).as_vec3());
        if scene.triangle_count() <= EXACT {
            for_triangles(scene, unit, &mut |corners, clear| kept.push((corners.map(to_here), clear)));
        } else {
            kept = simplified(scene, unit, to_here);
        }
        // Of triangles with one box a few stand for all: a tree over thousands of them takes minutes.
        let mut boxes: HashMap<[[u32; 3]; 2], u32, BuildHasherDefault<Mix>> = HashMap::default();
        kept.retain(|([a, b, c], _)| {
            let corners = [a.min(*b).min(*c), a.max(*b).max(*c)];
            let alike = boxes.entry(corners.map(|p| p.to_array().map(f32::to_bits))).or_default();
            *alike += 1;
            *alike <= MOST_ALIKE && (*b - *a).cross(*c - *a) != Vec3A::ZERO
        });
        let triangles: Vec<RtTriangle> = kept.iter().map(|([a, b, c], _)| RtTriangle::new(*a, *b, *c)).collect();
        let clear = kept.iter().map(|(_, clear)| *clear).collect();
        if triangles.is_empty() {
            return None;
        }
        let indices = (0..triangles.len() as u32).collect();
        let mut builder = PlocBuilder::with_capacity(triangles.len());
        let tree = builder.build(PlocSearchDistance::Minimum, &triangles, indices, SortPrecision::U64, 0);
        let half = Vec3A::from((0.5 * (high - low) / unit).as_vec3());
        Some(Solid { middle, unit, half, triangles, clear, tree, tested: Cell::new(0) })
    }

    /// The first thing that a ray meets. Of two in one place the one that turns its outward side to the ray.
    pub(super) fn meet(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        if self.is_exhausted() {
            return None;
        }
        let mut tested = 0;
        let [origin, direction] = [origin, direction].map(|v| Vec3A::from(v.as_vec3()));
        let (mut nearest, mut found, mut front) = (f32::INFINITY, 0, false);
        let mut hit = RayHit::none();
        self.tree.ray_traverse(Ray::new(origin, direction, 1e-5, f32::INFINITY), &mut hit, |ray, place| {
            tested += 1;
            let index = self.tree.primitive_indices[place];
            let triangle = &self.triangles[index as usize];
            let distance = triangle.intersect(ray);
            if distance <= nearest && distance < f32::INFINITY {
                let towards = triangle.ng.dot(direction) > 0.0;
                if distance < nearest || (towards, index) > (front, found) {
                    (nearest, found, front) = (distance, index, towards);
                }
            }
            distance
        });
        self.tested.set(self.tested.get() + tested);
        (nearest < f32::INFINITY).then(|| Hit {
            distance: nearest,
            front,
            normal: self.triangles[found as usize].compute_normal(),
            clear: self.clear[found as usize],
        })
    }

    /// The first thing that a ray meets and cannot pass: panes are looked through.
    pub(super) fn meet_opaque(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        const MOST_PANES: u32 = 16;
        let mut passed = 0.0;
        for _ in 0..MOST_PANES {
            let mut hit = self.meet(origin + passed * direction, direction)?;
            if !hit.clear {
                hit.distance += passed as f32;
                return Some(hit);
            }
            passed += f64::from(hit.distance) + 1e-5;
        }
        None
    }

    /// Whether rays had to be tested against so many triangles that no more of them are followed: many triangles lie in one place.
    pub(super) fn is_exhausted(&self) -> bool {
        self.tested.get() > MOST_TESTED
    }

    /// How many triangles there are.
    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The corners of each triangle.
    pub(super) fn corners(&self) -> impl ExactSizeIterator<Item = [Vec3A; 3]> {
        self.triangles.iter().map(|t| [t.v0, t.v0 - t.e1, t.v0 + t.e2])
    }
}
