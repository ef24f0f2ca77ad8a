//! How far two faces of glass are from each other where the one covers the other, for those that lie in one plane only about as well as files round.

use super::face::Face;
use crate::scene::Scene;
use crate::scene::sets::Sets;
use glam::DVec3;
use std::collections::HashMap;

/// Files with six digits round a coordinate by 5e-6 of it, so that two faces of one plane are up to 1.8e-5 of their coordinates apart.
const ROUNDED: f64 = 2e-5;
/// But never more than this part of the smaller triangle.
const MOST_ROUNDED: f64 = 1e-3;
/// Nobody is told of bodies that reach less far into each other, for each unit of their size: that much is taken out here.
const UNNOTICED: f64 = 1e-4;
/// A gap counts as wide enough for rays if it has this part of the smaller triangle, whatever the bound on rounding says.
const WIDE: f64 = 5e-5;

/// How far another face lies from one, where it covers it: the range of the distance along the outward normal of the one. What is positive is a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Separation {
    pub least: f64,
    pub most: f64,
}

impl Separation {
    pub(super) const NONE: Separation = Separation { least: 0.0, most: 0.0 };

    /// The same, seen from the other face.
    pub(super) fn of_the_other(self, same_way: bool) -> Self {
        if same_way { Separation { least: -self.most, most: -self.least } } else { self }
    }

    /// How far the one has to be drawn in for the overlap alone.
    pub(super) fn overlap(self) -> f64 {
        (-self.least).max(0.0)
    }

    /// Whether a part of the one is nearer than so far to the other, or they cross.
    pub(super) fn is_within(self, near: f64) -> bool {
        self.least < near && self.most > -near
    }
}

/// How far faces may be off one plane to be compared by their distance.
fn most_off(face: &Face, other: &Face) -> f64 {
    let size = face.size().min(other.size());
    (ROUNDED * face.reach().max(other.reach())).min(MOST_ROUNDED * size).max(UNNOTICED * size)
}

/// How far around a face others are that may be compared with it.
pub(super) fn margin(face: &Face) -> f64 {
    MOST_ROUNDED * face.size()
}

/// A gap that is smaller is not seen by rays as one.
pub(super) fn told_apart(scene: &Scene, face: &Face, other: &Face) -> f64 {
    let tolerance = face.tolerance(other);
    let rounding = face.needed(scene, other) - tolerance;
    tolerance.max(rounding.min(WIDE * face.size().min(other.size())))
}

/// How far another face lies from one over what they have in common, if that is an area and they are everywhere there about as near as files round.
pub(super) fn separation(face: &Face, other: &Face) -> Option<Separation> {
    // Neighbours in the surface of a body, which are the most of what is near.
    let meet = || face.corners.iter().any(|p| other.corners.contains(p));
    if face.object == other.object && face.normal.dot(other.normal) > 0.0 && meet() {
        return None;
    }
    let most = most_off(face, other);
    let (large, small, sign) = if face.size() >= other.size() { (face, other, 1.0) } else { (other, face, -1.0) };
    let corners = large.corners;
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).try_normalize()?;
    let normal = if normal.dot(face.normal) < 0.0 { -normal } else { normal };
    let height = |p: &DVec3| sign * (*p - a).dot(normal);
    // What lies wholly to one side need not be cut.
    if small.corners.iter().all(|p| height(p) > most) || small.corners.iter().all(|p| height(p) < -most) {
        return None;
    }
    if beside(large, small, normal, 2.0 * most) || beside(small, large, normal, 2.0 * most) {
        return None;
    }
    let mut common = small.corners.to_vec();
    for k in 0..3 {
        let [p, q, r] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
        let inward = normal.cross(q - p);
        let inward = if inward.dot(r - p) < 0.0 { -inward } else { inward };
        common = cut(&common, |point| (*point - p).dot(inward));
    }
    let heights = common.iter().map(height);
    let least = heights.clone().fold(f64::INFINITY, f64::min);
    let found = Separation { least, most: heights.fold(f64::NEG_INFINITY, f64::max) };
    (common.len() >= 3 && found.least >= -most && found.most <= most).then_some(found)
}

/// Whether a side of one triangle has the other on its outer side, but for a margin.
fn beside(of: &Face, from: &Face, normal: DVec3, margin: f64) -> bool {
    (0..3).any(|k| {
        let [p, q, r] = [0, 1, 2].map(|i| of.corners[(k + i) % 3]);
        let Some(inward) = normal.cross(q - p).try_normalize() else { return true };
        let inward = if inward.dot(r - p) < 0.0 { -inward } else { inward };
        from.corners.iter().all(|corner| (*corner - p).dot(inward) <= margin)
    })
}

/// The part of a convex polygon where `inside` is not negative, for a function that is linear in space.
fn cut(polygon: &[DVec3], inside: impl Fn(&DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (at_p, at_q) = (inside(p), inside(&q));
        if at_p >= 0.0 {
            kept.push(*p);
        }
        if (at_p < 0.0) != (at_q < 0.0) {
            kept.push(p.lerp(q, at_p / (at_p - at_q)));
        }
    }
    kept
}

/// The connected surfaces of faces: what shares edges in one object.
#[derive(Debug)]
pub(super) struct Surfaces {
    /// By face.
    of: Vec<usize>,
    /// By surface: the middle of its box.
    middles: HashMap<usize, DVec3>,
}

impl Surfaces {
    pub(super) fn new(faces: &[Face]) -> Self {
        let mut sets = Sets::new(faces.len());
        let mut known = HashMap::new();
        for (index, face) in faces.iter().enumerate() {
            let [a, b, c] = face.corners.map(|p| (p + DVec3::ZERO).to_array().map(f64::to_bits));
            for (a, b) in [(a, b), (b, c), (c, a)] {
                let first = *known.entry((face.object, a.min(b), a.max(b))).or_insert(index);
                sets.join(first, index);
            }
        }
        let of: Vec<usize> = (0..faces.len()).map(|index| sets.of(index)).collect();
        let mut boxes: HashMap<usize, (DVec3, DVec3)> = HashMap::new();
        for (face, surface) in faces.iter().zip(&of) {
            let (low, high) = boxes.entry(*surface).or_insert((DVec3::INFINITY, DVec3::NEG_INFINITY));
            face.corners.iter().for_each(|p| (*low, *high) = (low.min(*p), high.max(*p)));
        }
        Surfaces { of, middles: boxes.into_iter().map(|(key, (low, high))| (key, 0.5 * (low + high))).collect() }
    }

    /// Whether two faces that face each other, and overlap, are of bodies on either side of them, and not the two sides of a thin one, or of a thin wall.
    pub(super) fn are_side_by_side(&self, faces: &[Face], a: usize, b: usize) -> bool {
        let outside = |own: usize, other: usize| {
            let face = &faces[own];
            (self.middles[&self.of[other]] - face.centre()).dot(face.normal) > 0.0
        };
        self.of[a] != self.of[b] && outside(a, b) && outside(b, a)
    }
}
