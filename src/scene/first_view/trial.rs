//! Small pictures on trial: what a camera would see.

use super::fit::Eye;
use super::solid::{Hit, Solid};
use super::surroundings::Bounds;
use glam::DVec3;

/// Rays along each side of a trial picture.
const SIDE: usize = 32;
/// Neighbours are of one surface if the cosine between their normals is no less, and one is no further from the other's plane, as a part of their
/// distance.
const SAME_COSINE: f32 = 0.9;
const SAME_PLANE: f64 = 0.03;

/// A small picture: for each of its rays what it meets, and where.
pub(super) struct Trial {
    hits: Vec<Option<Hit>>,
    points: Vec<DVec3>,
    /// Along the line of sight, the middle of what is to be seen.
    depth: f64,
}

impl Trial {
    pub(super) fn new(solid: &Solid, eye: &Eye) -> Self {
        let (mut hits, mut points) = (Vec::with_capacity(SIDE * SIDE), Vec::with_capacity(SIDE * SIDE));
        for ray in 0..SIDE * SIDE {
            let direction = eye.direction(at(ray % SIDE), at(ray / SIDE));
            let hit = solid.meet(eye.position, direction);
            points.push(eye.position + hit.map_or(0.0, |hit| f64::from(hit.distance)) * direction);
            hits.push(hit);
        }
        Trial { hits, points, depth: eye.depth }
    }

    /// The area of what is seen, as if it were at the depth of the middle; in some unit.
    pub(super) fn area(&self) -> f64 {
        self.depth * self.depth * self.hits.iter().flatten().count() as f64 / self.hits.len() as f64
    }

    /// The part of what is seen that turns its outward side to the camera.
    pub(super) fn front(&self) -> f64 {
        let front = self.hits.iter().flatten().filter(|hit| hit.front).count();
        front as f64 / self.hits.iter().flatten().count().max(1) as f64
    }

    /// The part of the picture that shows what is within a box.
    pub(super) fn shows(&self, bounds: &Bounds) -> f64 {
        let shown = self.hits.iter().zip(&self.points).filter(|(hit, point)| hit.is_some() && bounds.contains(**point));
        shown.count() as f64 / self.hits.len() as f64
    }

    /// How much there is to see: the part of what is seen that differs from its neighbours, in the middle of the picture more than at its edges.
    pub(super) fn content(&self) -> f64 {
        // Neighbours on one plane do not differ, however far one is behind the other.
        let differ = |a: usize, b: usize| match (&self.hits[a], &self.hits[b]) {
            (Some(met), Some(other)) => {
                let off = met.normal.as_dvec3().dot(self.points[b] - self.points[a]).abs();
                met.normal.dot(other.normal).abs() < SAME_COSINE || off > SAME_PLANE * f64::from(met.distance)
            }
            _ => false,
        };
        let (mut sum, mut weights) = (0.0, 0.0);
        for ray in (0..SIDE * SIDE).filter(|ray| self.hits[*ray].is_some()) {
            let (x, y) = (ray % SIDE, ray / SIDE);
            let weight = 1.1 - at(x).abs().max(at(y).abs());
            let is_edge = x > 0 && differ(ray, ray - 1) || y > 0 && differ(ray, ray - SIDE);
            sum += weight * f64::from(u8::from(is_edge));
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    }
}

/// A little off the middle of a pixel, where models have edges.
fn at(pixel: usize) -> f64 {
    (pixel as f64 + 0.513) / SIDE as f64 * 2.0 - 1.0
}
