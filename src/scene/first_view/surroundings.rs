//! Grounds and backdrops, which are much larger than what is meant to be seen.

use super::lattice::Mix;
use super::solid::Solid;
use crate::scene::sets::Sets;
use glam::{DVec3, Vec3A};
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

/// What reaches over so much of the scene, and across this so much, is ground, backdrop or wall, if it is no body,
const SURROUNDINGS: [f32; 2] = [0.6, 0.35];
/// if what is left is not larger than this part of it,
const SMALL: f32 = 0.4;
/// and has at least so many of the triangles.
const DETAIL: f64 = 0.5;

/// A body bulges: between its middle and its triangles there is more than this part of the box around it. A slab is flatter than that box.
const BULGE: f32 = 0.05;
const SLAB: f32 = 0.1;
/// How far from a plane corners may be that lie in it.
const FLAT: f32 = 1e-4;

/// A box around points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub low: Vec3A,
    pub high: Vec3A,
}

impl Bounds {
    const EMPTY: Self = Bounds { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn middle(&self) -> Vec3A {
        0.5 * (self.low + self.high)
    }

    /// The largest extent.
    pub(super) fn extent(&self) -> f32 {
        (self.high - self.low).max_element()
    }

    /// Whether a point lies within, or hardly outside.
    pub(super) fn contains(&self, p: DVec3) -> bool {
        let p = Vec3A::from(p.as_vec3());
        p.cmpge(self.low - 1e-3).all() && p.cmple(self.high + 1e-3).all()
    }
}

/// Triangles that hang together by their edges.
struct Piece {
    bounds: Bounds,
    triangles: usize,
    /// The plane that all of them lie in, by a normal and a point, as far as is known.
    plane: Option<(Vec3A, Vec3A)>,
    /// Six times the volume between the triangles and the middle of the bounds, negative where they turn their outward sides to it.
    bulge: f32,
}

impl Piece {
    /// Whether this is ground, backdrop or the walls of a room in a scene of an extent.
    fn surrounds(&self, scene: f32) -> bool {
        let mut extents = (self.bounds.high - self.bounds.low).to_array();
        extents.sort_by(f32::total_cmp);
        let [thin, wide, long] = extents;
        let is_body = thin > SLAB * wide && self.bulge > 6.0 * BULGE * thin * wide * long;
        long > SURROUNDINGS[0] * scene && wide > SURROUNDINGS[1] * scene && !is_body
    }
}

/// The box around what stands on a ground or before a backdrop; none if all of the scene is meant.
pub(super) fn within(solid: &Solid) -> Option<Bounds> {
    let pieces = pieces(solid);
    // The largest extent is from -1 to 1; beyond it are strays.
    const EXTENT: f32 = 2.0;
    let whole = Bounds { low: -solid.half, high: solid.half };
    let things: Vec<&Piece> = pieces
        .iter()
        .filter(|piece| whole.contains(piece.bounds.middle().as_dvec3()) && !piece.surrounds(EXTENT))
        .collect();
    if things.iter().all(|piece| piece.plane.is_some()) {
        return None;
    }
    // What is flat may be a part of the surroundings, too: a floor of many tiles, a lamp high above.
    [false, true].into_iter().find_map(|without_flat| {
        let things = things.iter().filter(|piece| !(without_flat && piece.plane.is_some()));
        let (bounds, count) =
            things.fold((Bounds::EMPTY, 0), |(all, count), piece| (all.with(piece.bounds), count + piece.triangles));
        let is_detail = count as f64 >= DETAIL * solid.len() as f64 && bounds.extent() < SMALL * EXTENT;
        is_detail.then_some(bounds)
    })
}

/// The pieces of a scene, in the order of their first triangles.
fn pieces(solid: &Solid) -> Vec<Piece> {
    let mut sets = Sets::new(solid.len());
    let mut edges: HashMap<[u32; 6], u32, BuildHasherDefault<Mix>> = HashMap::default();
    edges.reserve(solid.len() * 3 / 2);
    for (index, corners) in solid.corners().enumerate() {
        // Adding zero makes one zero of both.
        let corners = corners.map(|corner| (corner + 0.0).to_array().map(f32::to_bits));
        for side in 0..3 {
            let (mut a, mut b) = (corners[side], corners[(side + 1) % 3]);
            if b < a {
                std::mem::swap(&mut a, &mut b);
            }
            let first = *edges.entry([a[0], a[1], a[2], b[0], b[1], b[2]]).or_insert(index as u32);
            sets.join(first as usize, index);
        }
    }
    let mut piece_of = vec![u32::MAX; solid.len()];
    let mut piece_of_triangle = Vec::with_capacity(solid.len());
    let mut pieces: Vec<Piece> = Vec::new();
    for (index, [a, b, c]) in solid.corners().enumerate() {
        let root = sets.of(index);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        // The root is the first of its piece.
        if root == index {
            piece_of[root] = pieces.len() as u32;
            pieces.push(Piece { bounds: Bounds::EMPTY, triangles: 0, plane: Some((normal, a)), bulge: 0.0 });
        }
        piece_of_triangle.push(piece_of[root]);
        let piece = &mut pieces[piece_of[root] as usize];
        piece.bounds = piece.bounds.with(Bounds { low: a.min(b).min(c), high: a.max(b).max(c) });
        piece.triangles += 1;
        piece.plane = piece.plane.filter(|(n, p)| [a, b, c].iter().all(|corner| n.dot(*corner - *p).abs() < FLAT));
    }
    for (root, [a, b, c]) in piece_of_triangle.into_iter().zip(solid.corners()) {
        let piece = &mut pieces[root as usize];
        let [a, b, c] = [a, b, c].map(|corner| corner - piece.bounds.middle());
        piece.bulge += a.dot(b.cross(c));
    }
    pieces
}
