//! Rays as a path tracer traces them, kind by kind, and what the reference says that they meet.

use crate::bench::meshes::Room;
use crate::rays::Ray;
use glam::DVec3;
use luminaire::reference::Reference;
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::cosine_hemisphere;
use luminaire::sampling::{random4, uniform};
use rayon::prelude::*;

/// What a ray is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// From the eye: neighbours go the same way.
    Camera,
    /// From where those hit, cosine-distributed.
    Bounce,
    /// From where those hit.
    SecondBounce,
    /// To a point on the lamp, from the first of these hits that faces it: any hit.
    Shadow,
}

impl Kind {
    /// Every kind, in the order of [`RaySet`].
    pub const ALL: [Kind; 4] = [Kind::Camera, Kind::Bounce, Kind::SecondBounce, Kind::Shadow];

    /// Part of a figure's name.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Camera => "camera",
            Kind::Bounce => "bounce",
            Kind::SecondBounce => "second-bounce",
            Kind::Shadow => "shadow",
        }
    }

    /// As sentences have it.
    pub fn words(self) -> &'static str {
        match self {
            Kind::SecondBounce => "second bounce",
            other => other.name(),
        }
    }

    /// Whether any hit will do.
    pub fn any_hit(self) -> bool {
        self == Kind::Shadow
    }
}

/// As many rays of each kind as there are pixels, pixel by pixel in squares of 8 by 8 as the path tracer's workgroups have them.
pub struct RaySet {
    /// By the order of [`Kind::ALL`].
    pub rays: [Vec<Ray>; 4],
    /// What the reference finds: the distance, infinite for a miss; for shadow rays 1 where something is in the way, else 0.
    pub expected: [Vec<f64>; 4],
}

/// What the reference finds of one ray.
pub fn reference_result(reference: &Reference, kind: Kind, ray: &Ray) -> f64 {
    let (origin, direction, t_max) = (ray.origin.as_dvec3(), ray.direction.as_dvec3(), f64::from(ray.t_max));
    if kind.any_hit() {
        return f64::from(u8::from(reference.occluded(origin, direction, t_max, 0)));
    }
    reference.closest_hit(origin, direction, t_max, 0).map_or(f64::INFINITY, |hit| hit.t)
}

/// Rays leave a surface from this far off it: far more than a coordinate's rounding in `f32`, and less than any bump. The rooms are about 2 wide.
const OFF: f64 = 1e-5;

impl RaySet {
    /// The rays of a picture of `side` by `side` pixels (a multiple of 8); `reference` has the room's scene, of which the film is that large.
    pub fn new(room: &Room, reference: &Reference, side: u32) -> Self {
        let paths: Vec<[(Ray, f64); 4]> =
            (0..side * side).into_par_iter().map(|index| path(room, reference, pixel(index, side))).collect();
        let column = |kind: usize| paths.iter().map(|path| path[kind]).unzip();
        let [a, b, c, d]: [(Vec<Ray>, Vec<f64>); 4] = [0, 1, 2, 3].map(column);
        RaySet { rays: [a.0, b.0, c.0, d.0], expected: [a.1, b.1, c.1, d.1] }
    }

    /// Rays of each kind.
    pub fn len(&self) -> usize {
        self.rays[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The pixel at a place in the order of 8 by 8 squares.
fn pixel(index: u32, side: u32) -> u32 {
    let (square, within) = (index / 64, index % 64);
    let squares = side / 8;
    let (x, y) = (square % squares * 8 + within % 8, square / squares * 8 + within / 8);
    y * side + x
}

fn path(room: &Room, reference: &Reference, pixel: u32) -> [(Ray, f64); 4] {
    let random = |vertex: u32| random4(pixel, vertex, 0, 7).map(uniform);
    let (eye, line) = reference.sensor_ray(pixel, 0);
    let mut ray = unlimited(eye, line);
    let mut from = None;
    let mut traced = [0; 3].map(|_| (ray, f64::INFINITY));
    for (vertex, traced) in traced.iter_mut().enumerate() {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let hit = reference.closest_hit(origin, direction, f64::INFINITY, 0);
        *traced = (ray, hit.map_or(f64::INFINITY, |hit| hit.t));
        // A ray that gets out of the closed room through its rounding is traced again in place of the next.
        let Some(hit) = hit else { continue };
        let surfel = reference.surfel(&hit, -direction.normalize());
        let [u, v, s, t] = random(vertex as u32);
        from = from.or_else(|| to_lamp(room, &surfel, s, t));
        let n = surfel.geometric_normal;
        ray = unlimited(surfel.position + OFF * n, cosine_hemisphere(n, u, v));
    }
    // Nothing on this path faces the lamp: from the eye.
    let shadow = from.unwrap_or_else(|| {
        let [_, _, s, t] = random(3);
        segment(eye, lamp_point(room, s, t))
    });
    let [a, b, c] = traced;
    [a, b, c, (shadow, reference_result(reference, Kind::Shadow, &shadow))]
}

fn unlimited(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin: origin.as_vec3(), direction: direction.as_vec3(), t_max: f32::INFINITY }
}

/// A ray that ends at a point.
fn segment(from: DVec3, to: DVec3) -> Ray {
    Ray { origin: from.as_vec3(), direction: (to - from).as_vec3(), t_max: 1.0 }
}

/// A point a little below the lamp, so that the lamp itself is not in the way.
fn lamp_point(room: &Room, s: f64, t: f64) -> DVec3 {
    let [corner, a, b] = room.lamp.map(|v| v.as_dvec3());
    corner + s * a + t * b - 1e-3 * DVec3::Y
}

fn to_lamp(room: &Room, surfel: &Surfel, s: f64, t: f64) -> Option<Ray> {
    let target = lamp_point(room, s, t);
    let n = surfel.geometric_normal;
    let towards = target - surfel.position;
    (n.dot(towards) > 0.0 && towards.y > 0.0).then(|| segment(surfel.position + OFF * n, target))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_pixel_once_and_neighbours_together() {
        let pixels: Vec<u32> = (0..24 * 24).map(|index| pixel(index, 24)).collect();
        assert_eq!(pixels.iter().collect::<HashSet<_>>().len(), 24 * 24);
        assert!(pixels.iter().all(|p| *p < 24 * 24));
        let first: HashSet<[u32; 2]> = pixels[..64].iter().map(|p| [p % 24 / 8, p / 24 / 8]).collect();
        assert_eq!(first, HashSet::from([[0, 0]]));
    }
}
