//! Faces of a closed body that are drawn into it by a hair, with the vertices that they share, so that it stays closed.

use crate::scene::sets::Sets;
use crate::scene::{Mesh, Triangle, outward};
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::f64::consts::TAU;

/// A corner moves at most so many times as far as its faces do: where these meet at an acute angle it has to move further than they.
const MOST_STRETCHED: f64 = 16.0;
/// How often the faces of a corner take turns to move it.
const ROUNDS: usize = 64;
/// And for each unit of the size of what moves together at most so far: what moves further is seen to have moved.
const MOST_SEEN: f64 = 0.02;
/// Faces that leave an edge in directions that differ by less, in radian, lie on each other.
const SAME_ANGLE: f64 = 1e-4;

/// How far a face is drawn in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Depth {
    /// Well beyond what rays round by.
    pub usual: f64,
    /// Just enough, for bodies that are thin.
    pub least: f64,
}

impl Depth {
    /// The larger one of both numbers.
    pub(super) fn max(self, other: Depth) -> Depth {
        Depth { usual: self.usual.max(other.usual), least: self.least.max(other.least) }
    }

    /// Both numbers times a factor.
    pub(super) fn times(self, factor: f64) -> Depth {
        Depth { usual: self.usual * factor, least: self.least * factor }
    }
}

/// Where corners of triangles move to, and which faces stay where they are since their body is too thin.
#[derive(Debug, Default)]
pub(super) struct Pulled {
    /// By triangle, by how much each corner moves.
    pub corners: BTreeMap<u32, [DVec3; 3]>,
    pub stuck: BTreeSet<u32>,
}

/// Draws faces of a mesh in, all in its own space. `is_glass`: whether a material is that of bodies, whose corners go with the faces.
pub(super) fn pull(mesh: &Mesh, is_glass: impl Fn(u32) -> bool, depths: &BTreeMap<u32, Depth>) -> Pulled {
    let around = Around::new(mesh, is_glass, depths);
    let usual = around.solve(|triangle| depths.get(&triangle).map(|depth| depth.usual));
    if usual.stuck.is_empty() {
        return usual;
    }
    around.solve(|triangle| {
        depths.get(&triangle).map(|depth| if usual.stuck.contains(&triangle) { depth.least } else { depth.usual })
    })
}

/// The triangles of the bodies around corners that move.
struct Around<'a> {
    mesh: &'a Mesh,
    /// Those that have a corner in a place that moves.
    triangles: Vec<u32>,
    /// Along the outward normals, of unit length.
    normals: Vec<DVec3>,
    /// Triangles, by their place in the list above, that go around a corner of one body, and the number of the corner in each.
    fans: Vec<Vec<(usize, usize)>>,
}

impl<'a> Around<'a> {
    fn new(mesh: &'a Mesh, is_glass: impl Fn(u32) -> bool, depths: &BTreeMap<u32, Depth>) -> Self {
        let mut numbers: HashMap<[u32; 3], usize> = HashMap::new();
        for triangle in depths.keys() {
            for vertex in mesh.triangles[*triangle as usize].vertices {
                let next = numbers.len();
                numbers.entry(bits(mesh.positions[vertex as usize])).or_insert(next);
            }
        }
        let place_of: Vec<Option<usize>> = mesh.positions.iter().map(|p| numbers.get(&bits(*p)).copied()).collect();
        let mut around = Around { mesh, triangles: Vec::new(), normals: Vec::new(), fans: Vec::new() };
        let mut at_place: Vec<Vec<(usize, usize)>> = vec![Vec::new(); numbers.len()];
        for (index, triangle) in (0..).zip(&mesh.triangles) {
            let places = triangle.vertices.map(|v| place_of[v as usize]);
            if places == [None; 3] || !is_glass(triangle.material) {
                continue;
            }
            let number = around.triangles.len();
            around.triangles.push(index);
            around.normals.push(outward(mesh, triangle).normalize_or_zero());
            for (corner, place) in places.iter().enumerate() {
                if let Some(place) = place {
                    at_place[*place].push((number, corner));
                }
            }
        }
        for place in at_place {
            around.add_fans(&place);
        }
        around
    }

    fn triangle(&self, number: usize) -> &Triangle {
        &self.mesh.triangles[self.triangles[number] as usize]
    }

    fn corner(&self, number: usize, corner: usize) -> Vec3 {
        self.mesh.positions[self.triangle(number).vertices[corner] as usize]
    }

    /// Parts the triangles of a place by the bodies that they belong to, and adds these.
    fn add_fans(&mut self, place: &[(usize, usize)]) {
        let mut sets = Sets::new(place.len());
        // By the other end of an edge: where in `place`, and the third corner.
        let mut edges: BTreeMap<[u32; 3], Vec<(usize, usize)>> = BTreeMap::new();
        for (at, &(number, corner)) in place.iter().enumerate() {
            for (end, third) in [((corner + 1) % 3, (corner + 2) % 3), ((corner + 2) % 3, (corner + 1) % 3)] {
                edges.entry(bits(self.corner(number, end))).or_default().push((at, third));
            }
        }
        let (number, corner) = place[0];
        let start = self.corner(number, corner);
        for (end, faces) in edges {
            let end = Vec3::from_array(end.map(f32::from_bits));
            for (a, b) in self.partners(place, start, end, &faces) {
                sets.join(a, b);
            }
        }
        let mut fans: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (at, face) in place.iter().enumerate() {
            fans.entry(sets.of(at)).or_default().push(*face);
        }
        self.fans.extend(fans.into_values());
    }

    /// Which faces at an edge are neighbours in the surface of a body. Of two there is no doubt; where two bodies touch at an edge, those are that have the
    /// inside between them.
    fn partners(
        &self,
        place: &[(usize, usize)],
        start: Vec3,
        end: Vec3,
        faces: &[(usize, usize)],
    ) -> Vec<(usize, usize)> {
        if faces.len() < 4 || faces.len() % 2 == 1 {
            return faces.windows(2).map(|pair| (pair[0].0, pair[1].0)).collect();
        }
        // The same whichever end is asked from.
        let (low, high) = if bits(start) < bits(end) { (start, end) } else { (end, start) };
        let axis = (high.as_dvec3() - low.as_dvec3()).normalize_or_zero();
        let x = axis.any_orthonormal_vector();
        let y = axis.cross(x);
        let mut first = None;
        let mut around: Vec<(f64, bool, usize)> = faces
            .iter()
            .map(|&(at, third)| {
                let (number, _) = place[at];
                let away = self.corner(number, third).as_dvec3() - low.as_dvec3();
                let angle = y.dot(away).atan2(x.dot(away));
                let mut turn = (angle - *first.get_or_insert(angle)).rem_euclid(TAU);
                if TAU - turn < SAME_ANGLE {
                    turn = 0.0;
                }
                // Whether the inside begins here for who goes around.
                let begins = self.normals[number].dot(axis.cross(away)) < 0.0;
                (turn, begins, at)
            })
            .collect();
        around.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut from = 0;
        for k in 1..=around.len() {
            if k == around.len() || around[k].0 - around[k - 1].0 >= SAME_ANGLE {
                // Of what lies on each other one body ends before the other begins.
                around[from..k].sort_by_key(|(_, begins, at)| (*begins, *at));
                from = k;
            }
        }
        let mut open: Vec<usize> = Vec::new();
        let mut found = Vec::new();
        for (_, begins, at) in around.iter().chain(&around) {
            if *begins {
                open.push(*at);
            } else if let Some(other) = open.pop() {
                found.push((other, *at));
            }
        }
        found
    }

    /// Moves all corners as far as their faces ask. Faces whose bodies are too thin for it are stuck.
    fn solve(&self, depth: impl Fn(u32) -> Option<f64>) -> Pulled {
        let depths: Vec<Option<f64>> = self.triangles.iter().map(|triangle| depth(*triangle)).collect();
        let mut moves = vec![[DVec3::ZERO; 3]; self.triangles.len()];
        let mut sets = Sets::new(self.triangles.len());
        let mut bad = vec![false; self.triangles.len()];
        for fan in &self.fans {
            let asked: Vec<(DVec3, f64)> = fan
                .iter()
                .filter_map(|(number, _)| depths[*number].map(|depth| (self.normals[*number], depth)))
                .collect();
            if asked.is_empty() {
                continue;
            }
            let by = moved(&asked);
            for &(number, corner) in fan {
                sets.join(fan[0].0, number);
                match by {
                    Some(by) => moves[number][corner] = by,
                    None => bad[number] = true,
                }
            }
        }
        for (number, by) in moves.iter().enumerate() {
            bad[number] |= *by != [DVec3::ZERO; 3] && !self.keeps_its_shape(number, by);
        }
        let mut extents: HashMap<usize, (Vec3, Vec3)> = HashMap::new();
        for number in 0..moves.len() {
            let extent = extents.entry(sets.of(number)).or_insert((Vec3::INFINITY, Vec3::NEG_INFINITY));
            for p in [0, 1, 2].map(|k| self.corner(number, k)) {
                *extent = (extent.0.min(p), extent.1.max(p));
            }
        }
        let mut bad_bodies = BTreeSet::new();
        for (number, depth) in depths.iter().enumerate() {
            let body = sets.of(number);
            let (low, high) = extents[&body];
            if bad[number] || depth.is_some_and(|depth| depth > MOST_SEEN * f64::from(low.distance(high))) {
                bad_bodies.insert(body);
            }
        }
        let mut pulled = Pulled::default();
        for (number, by) in moves.into_iter().enumerate() {
            if bad_bodies.contains(&sets.of(number)) {
                pulled.stuck.extend(depths[number].map(|_| self.triangles[number]));
            } else if by != [DVec3::ZERO; 3] {
                pulled.corners.insert(self.triangles[number], by);
            }
        }
        pulled
    }

    /// Whether a triangle whose corners move so still faces the same way, and has at least half of its area.
    fn keeps_its_shape(&self, number: usize, by: &[DVec3; 3]) -> bool {
        let old = [0, 1, 2].map(|k| self.corner(number, k).as_dvec3());
        let new = [0, 1, 2].map(|k| (old[k] + by[k]).as_vec3().as_dvec3());
        let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
        let (old, new) = (area(old), area(new));
        old.dot(new) >= 0.5 * old.length() * old.length().max(new.length())
    }
}

/// By how much a corner moves so that each of its faces, given by their outward normals, is drawn in at least so far. None if it cannot be, or would
/// have to move much further than they do.
fn moved(asked: &[(DVec3, f64)]) -> Option<DVec3> {
    let mut by = DVec3::ZERO;
    for _ in 0..ROUNDS {
        // By turns each moves it to where it would have it: that comes to a place where all would, if there is one.
        for (normal, depth) in asked {
            by -= *normal * (normal.dot(by) + depth).max(0.0);
        }
        if asked.iter().all(|(normal, depth)| normal.dot(by) + depth <= 1e-3 * depth) {
            break;
        }
    }
    let largest = asked.iter().map(|(_, depth)| *depth).fold(0.0, f64::max);
    let reached = asked.iter().all(|(normal, depth)| normal.dot(by) + depth <= 0.1 * depth);
    (reached && by.length() <= MOST_STRETCHED * largest).then_some(by)
}

/// The bits of a place; zero has one sign.
fn bits(position: Vec3) -> [u32; 3] {
    position.to_array().map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::build::mesh;

    const HAIR: Depth = Depth { usual: 1e-3, least: 1e-5 };

    /// A box between two corners, with its outward faces' triangles in pairs: bottom, top, front, back, left, right.
    fn add_box(positions: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>, low: Vec3, high: Vec3) {
        let first = positions.len() as u32;
        let pick = |i: u32, axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        positions.extend((0..8).map(|i| Vec3::new(pick(i, 0), pick(i, 1), pick(i, 2))));
        let faces = [[0, 1, 5, 4], [2, 6, 7, 3], [4, 5, 7, 6], [0, 2, 3, 1], [0, 4, 6, 2], [1, 3, 7, 5]];
        triangles.extend(faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|v| v + first)));
    }

    fn depths(faces: &[u32]) -> BTreeMap<u32, Depth> {
        faces.iter().flat_map(|face| [2 * face, 2 * face + 1]).map(|triangle| (triangle, HAIR)).collect()
    }

    #[test]
    fn corners_go_with_all_their_faces() {
        let (mut positions, mut triangles) = (vec![], vec![]);
        add_box(&mut positions, &mut triangles, Vec3::ZERO, Vec3::ONE);
        let mesh = mesh(positions, &triangles);
        let pulled = pull(&mesh, |_| true, &depths(&[0, 4]));
        assert!(pulled.stuck.is_empty());
        for (triangle, by) in &pulled.corners {
            for (vertex, by) in mesh.triangles[*triangle as usize].vertices.iter().zip(by) {
                let p = mesh.positions[*vertex as usize];
                let at = |zero: bool| if zero { 1e-3 } else { 0.0 };
                let expected = DVec3::new(at(p.x == 0.0), at(p.y == 0.0), 0.0);
                assert!(by.distance(expected) < 1e-5, "{p}: {by}");
            }
        }
    }

    /// Two boxes whose common corners are the same vertices: only the one moves.
    #[test]
    fn bodies_that_share_vertices_are_parted() {
        let (mut positions, mut triangles) = (vec![], vec![]);
        add_box(&mut positions, &mut triangles, Vec3::ZERO, Vec3::ONE);
        add_box(&mut positions, &mut triangles, Vec3::X, Vec3::new(2.0, 1.0, 1.0));
        let same = |v: u32| positions.iter().position(|p| *p == positions[v as usize]).expect("itself") as u32;
        let triangles: Vec<_> = triangles.iter().map(|t| t.map(same)).collect();
        let mesh = mesh(positions, &triangles);
        let pulled = pull(&mesh, |_| true, &depths(&[10]));
        assert!(pulled.stuck.is_empty());
        assert!(pulled.corners.keys().all(|triangle| *triangle >= 12), "{:?}", pulled.corners.keys());
        for (triangle, by) in &pulled.corners {
            for (vertex, by) in mesh.triangles[*triangle as usize].vertices.iter().zip(by) {
                let expected = if mesh.positions[*vertex as usize].x == 1.0 { 1e-3 } else { 0.0 };
                assert!(by.distance(expected * DVec3::X) < 1e-9);
            }
        }
    }

    #[test]
    fn thin_bodies_move_by_less_or_stay() {
        for (thickness, moves) in [(1e-2, Some(1e-3)), (1e-4, Some(1e-5)), (1e-6, None)] {
            let (mut positions, mut triangles) = (vec![], vec![]);
            add_box(&mut positions, &mut triangles, Vec3::ZERO, Vec3::new(1.0, thickness, 1.0));
            let mesh = mesh(positions, &triangles);
            let pulled = pull(&mesh, |_| true, &depths(&[0]));
            assert_eq!(pulled.stuck.is_empty(), moves.is_some(), "{thickness}");
            let by = pulled.corners.get(&0).map(|by| by[0].y);
            assert_eq!(by.map(|by| (by * 1e7).round()), moves.map(|by: f64| (by * 1e7).round()), "{thickness}");
        }
    }
}
