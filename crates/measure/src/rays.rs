//! Rays to be shot at a scene, and what each method says that they meet.

use glam::Vec3;
use luminaire::Result;
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::Reference;
use luminaire::reference::hit::Hit;
use rayon::prelude::*;

/// A ray; its numbers are `f32`, so that every method gets the same ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes; any length but zero.
    pub direction: Vec3,
    /// How far, in multiples of the direction.
    pub t_max: f32,
}

impl Ray {
    /// A ray from one point to another and beyond; a unit direction.
    pub fn through(origin: Vec3, target: Vec3) -> Self {
        // In double precision: squares of short vectors vanish in single.
        let direction = (target.as_dvec3() - origin.as_dvec3()).normalize_or_zero().as_vec3();
        Ray { origin, direction, t_max: f32::INFINITY }
    }

    /// The arguments of [`Function::ClosestHit`], [`Function::Occluded`] and [`Function::Leave`].
    pub fn call(&self) -> Call {
        let [o, d] = [self.origin, self.direction].map(|v| v.to_array().map(f32::to_bits));
        [[o[0], o[1], o[2], self.t_max.to_bits()], [d[0], d[1], d[2], 0]]
    }
}

/// What the kernel's [`Function::ClosestHit`] or [`Function::Leave`] finds.
///
/// # Errors
/// If the driver fails.
pub fn probe_hits(probe: &Probe, function: Function, rays: &[Ray]) -> Result<Vec<Option<Hit>>> {
    let calls: Vec<Call> = rays.iter().map(Ray::call).collect();
    let float = |bits: u32| f64::from(f32::from_bits(bits));
    let hit = |r: &Call| Hit {
        t: float(r[0][0]),
        object: r[0][1],
        triangle: r[0][2],
        barycentrics: [float(r[1][0]), float(r[1][1])],
    };
    Ok(probe.call(function, &calls)?.iter().map(|r| (r[0][1] != u32::MAX).then(|| hit(r))).collect())
}

/// What the reference finds.
pub fn reference_hits(reference: &Reference, rays: &[Ray]) -> Vec<Option<Hit>> {
    rays.par_iter()
        .map(|r| reference.closest_hit(r.origin.as_dvec3(), r.direction.as_dvec3(), f64::from(r.t_max), 0))
        .collect()
}

/// [`Function::Leave`] by the reference: what a ray meets that is mirrored off the first surface.
pub fn reference_leaves(reference: &Reference, rays: &[Ray]) -> Vec<Option<Hit>> {
    let leave = |r: &Ray| {
        let direction = r.direction.as_dvec3().normalize();
        let first = reference.closest_hit(r.origin.as_dvec3(), direction, f64::INFINITY, 0)?;
        let surfel = reference.surfel(&first, -direction);
        let wi = direction - 2.0 * direction.dot(surfel.geometric_normal) * surfel.geometric_normal;
        reference.closest_hit(surfel.offset_ray_origin(wi), wi, f64::INFINITY, 0)
    };
    rays.par_iter().map(leave).collect()
}
