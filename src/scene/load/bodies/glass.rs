//! The glass of a mesh: its triangles, the edges that are not closed, and the surfaces that these connect.

use super::split::between;
use crate::scene::sets::Sets;
use crate::scene::{Mesh, Object, Scene, outward};
use glam::{DVec3, Vec3};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Indices that multiply to this much of 1 around an edge are those of one body; files round them.
pub(super) const SAME_INDEX: f64 = 0.02;
/// Faces that leave an edge in directions that differ by less, in radian, lie on each other.
const SAME_ANGLE: f64 = 1e-5;

/// A triangle of a material that bends light.
pub(super) struct Face {
    /// Vertices by their places, counter-clockwise from outside.
    pub corners: [u32; 3],
    pub material: u32,
    /// Logarithm of the index of refraction.
    pub index: f64,
    /// The number of the surface that it is connected with, by edges.
    pub surface: u32,
}

/// The triangles of a mesh that bend light.
pub(super) struct Glass {
    /// Where the vertices are, in object space; each place once.
    pub places: Vec<Vec3>,
    pub faces: Vec<Face>,
    /// Edges around which the indices do not multiply to 1.
    pub loose: Vec<Loose>,
    /// Faces that lie on others, beside an edge that they share.
    pub doubled: usize,
    /// Faces that are wound against their vertex normals.
    pub against: usize,
    /// For each surface, whether it has a loose edge.
    pub is_loose: Vec<bool>,
}

/// An edge of the glass of a mesh around which the indices do not multiply to 1: other objects may close it.
pub(super) struct Loose {
    /// The places at its ends, the lesser number first.
    pub ends: [u32; 2],
    /// The logarithm of what the indices multiply to that are passed on the way around it.
    pub around: f64,
    /// How many faces of the glass have it.
    pub faces: usize,
    pub surface: u32,
    /// Whether a triangle of the same mesh has it that is no glass.
    pub covered: bool,
}

/// The objects that show the same triangles as glass of the same materials.
pub(super) struct Use {
    pub objects: Vec<usize>,
    pub glass: Glass,
}

/// An edge of a face: its ends in order, whether the face has them so, the number of the face.
type Edge = (u32, u32, bool, u32);

impl Glass {
    /// The glass of an object.
    pub fn of(scene: &Scene, object: &Object) -> Self {
        let mesh = &scene.meshes[object.mesh as usize];
        let material_of = |material: u32| object.material.unwrap_or(material);
        let bends: Vec<bool> = scene.materials.iter().map(|material| material.bends()).collect();
        let mut welded = Welded::default();
        let mut faces = Vec::new();
        let mut against = 0;
        for triangle in &mesh.triangles {
            let material = material_of(triangle.material);
            if !bends[material as usize] {
                continue;
            }
            let [a, b, c] = triangle.vertices.map(|v| welded.place(mesh.positions[v as usize]));
            let corners = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
            let winding = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let turned = outward(mesh, triangle).dot(winding) < 0.0;
            against += usize::from(turned);
            let corners = if turned { [a, c, b] } else { [a, b, c] };
            let index = scene.materials[material as usize].index_of_refraction().map_or(0.0, |eta| f64::from(eta).ln());
            faces.push(Face { corners, material, index, surface: 0 });
        }
        let mut glass =
            Glass { places: Vec::new(), faces, loose: Vec::new(), doubled: 0, against, is_loose: Vec::new() };
        glass.find_edges(mesh, &mut welded, |material| !bends[material_of(material) as usize]);
        glass.places = welded.places;
        glass
    }

    /// Fills in the edges and the surfaces. `other`: whether a material is none of the glass.
    fn find_edges(&mut self, mesh: &Mesh, welded: &mut Welded, other: impl Fn(u32) -> bool) {
        let mut edges: Vec<Edge> = Vec::with_capacity(3 * self.faces.len());
        for (number, face) in (0..).zip(&self.faces) {
            let [a, b, c] = face.corners;
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), a < b, number)));
        }
        edges.sort_unstable();
        self.split(&welded.places, &mut edges);
        let mut sets = Sets::new(self.faces.len());
        let mut faulty = Vec::new();
        let mut doubled = HashSet::new();
        for edge in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let around = self.around(edge);
            if around.abs() > SAME_INDEX {
                faulty.push(([edge[0].0, edge[0].1], around, edge.len(), edge[0].3));
            }
            doubled.extend(self.on_each_other(&welded.places, edge));
            for pair in edge.windows(2) {
                sets.join(pair[0].3 as usize, pair[1].3 as usize);
            }
        }
        self.doubled = doubled.len();
        let mut surfaces = 0;
        for number in 0..self.faces.len() {
            let first = sets.of(number);
            self.faces[number].surface = if first == number { surfaces } else { self.faces[first].surface };
            surfaces += u32::from(first == number);
        }
        self.is_loose = vec![false; surfaces as usize];
        if faulty.is_empty() {
            return;
        }
        // What is at an edge where glass ends at a wall or a lid cannot be known: the wall may close the body.
        let mut covered = HashSet::new();
        let ends: HashSet<(u32, u32)> = faulty.iter().map(|&([a, b], ..)| (a, b)).collect();
        for triangle in mesh.triangles.iter().filter(|triangle| other(triangle.material)) {
            let [a, b, c] = triangle.vertices.map(|v| welded.known(mesh.positions[v as usize]));
            for (a, b) in [(a, b), (b, c), (c, a)] {
                if let (Some(a), Some(b)) = (a, b)
                    && ends.contains(&(a.min(b), a.max(b)))
                {
                    covered.insert((a.min(b), a.max(b)));
                }
            }
        }
        for (ends, around, faces, face) in faulty {
            let surface = self.faces[face as usize].surface;
            self.is_loose[surface as usize] = true;
            let covered = covered.contains(&(ends[0], ends[1]));
            self.loose.push(Loose { ends, around, faces, surface, covered });
        }
    }

    /// Cuts edges where the corner of another face lies on them: a large face may border on several small ones, as CAD programs write them.
    fn split(&self, places: &[Vec3], edges: &mut Vec<Edge>) {
        let lonely =
            edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|edge| self.around(edge).abs() > SAME_INDEX);
        let lonely: HashSet<(u32, u32)> = lonely.map(|edge| (edge[0].0, edge[0].1)).collect();
        let place = |vertex: u32| places[vertex as usize].as_dvec3();
        // Where a corner was to lie on the edge, its coordinates were rounded.
        let near = |a: u32, b: u32| {
            let rounding = 4.0 * f64::from(f32::EPSILON) * place(a).abs().max(place(b).abs()).max_element();
            rounding + 1e-6 * place(a).distance(place(b))
        };
        let between = between(&lonely, place, near);
        if between.is_empty() {
            return;
        }
        let mut pieces = Vec::new();
        edges.retain(|&(a, b, ahead, face)| {
            let Some(between) = between.get(&(a, b)) else { return true };
            let mut from = a;
            for &to in between.iter().chain([&b]) {
                pieces.push((from.min(to), from.max(to), ahead == (from < to), face));
                from = to;
            }
            false
        });
        edges.extend(pieces);
        edges.sort_unstable();
    }

    /// The logarithm of what the indices that are passed on the way around an edge multiply to.
    fn around(&self, edge: &[Edge]) -> f64 {
        let index = |face: u32| self.faces[face as usize].index;
        edge.iter().map(|&(.., ahead, face)| if ahead { index(face) } else { -index(face) }).sum()
    }

    /// Those of the faces at an edge that lie on each other there: they leave it in one direction.
    fn on_each_other(&self, places: &[Vec3], edge: &[Edge]) -> Vec<u32> {
        let place = |vertex: u32| places[vertex as usize].as_dvec3();
        let (a, b) = (edge[0].0, edge[0].1);
        let along = (place(b) - place(a)).normalize_or_zero();
        let (x, y) = along.any_orthonormal_pair();
        let mut angles: Vec<(f64, u32)> = Vec::with_capacity(edge.len());
        for &(.., face) in edge {
            // The corner that is farthest from the edge, which may be a part of the face's own.
            let off = |corner: &u32| along.cross(place(*corner) - place(a)).length_squared();
            let corners = self.faces[face as usize].corners;
            let opposite = corners.into_iter().max_by(|p, q| off(p).total_cmp(&off(q))).expect("three corners");
            let away = place(opposite) - place(a);
            angles.push((y.dot(away).atan2(x.dot(away)), face));
        }
        angles.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut found = Vec::new();
        for (i, (angle, face)) in angles.iter().enumerate() {
            let (next, other) = angles[(i + 1) % angles.len()];
            let turn = (next - angle).rem_euclid(TAU);
            if face != &other && turn.min(TAU - turn) < SAME_ANGLE {
                found.extend([*face, other]);
            }
        }
        found
    }

    /// For each surface all of whose faces lie in one plane, a point of that and its normal.
    pub fn planes(&self) -> Vec<Option<(DVec3, DVec3)>> {
        let mut planes: Vec<Option<(DVec3, DVec3)>> = vec![None; self.is_loose.len()];
        let mut flat = vec![true; self.is_loose.len()];
        for face in &self.faces {
            let surface = face.surface as usize;
            let [a, b, c] = self.corners(face);
            let (at, normal) = *planes[surface].get_or_insert((a, (b - a).cross(c - a).normalize_or_zero()));
            let size = a.distance(at).max(b.distance(at)).max(c.distance(at));
            flat[surface] &= [a, b, c].iter().all(|p| (*p - at).dot(normal).abs() <= 1e-4 * size);
        }
        planes.into_iter().zip(flat).map(|(plane, flat)| plane.filter(|_| flat)).collect()
    }

    /// Closed surfaces of one index above 1 whose faces point inwards.
    pub fn inside_out(&self) -> Vec<u32> {
        let mut volumes = vec![0.0; self.is_loose.len()];
        let mut origins: Vec<Option<DVec3>> = vec![None; self.is_loose.len()];
        let mut usual: Vec<bool> = self.is_loose.iter().map(|loose| !loose).collect();
        for face in &self.faces {
            let [a, b, c] = self.corners(face);
            let surface = face.surface as usize;
            let origin = *origins[surface].get_or_insert(a);
            volumes[surface] += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
            usual[surface] &= face.index > 0.0;
        }
        // Doubled faces cancel but for rounding.
        if self.doubled > 0 {
            return Vec::new();
        }
        let planes = self.planes();
        (0..volumes.len())
            .filter(|s| usual[*s] && volumes[*s] < 0.0 && planes[*s].is_none())
            .map(|s| s as u32)
            .collect()
    }

    pub fn corners(&self, face: &Face) -> [DVec3; 3] {
        face.corners.map(|place| self.places[place as usize].as_dvec3())
    }

    /// The materials of these faces, each once.
    pub fn materials(&self, faces: impl Iterator<Item = usize>) -> Vec<u32> {
        let mut said = HashSet::new();
        faces.map(|face| self.faces[face].material).filter(|material| said.insert(*material)).collect()
    }
}

/// Vertices by their places: those that differ in a normal or a texture coordinate alone are one.
#[derive(Default)]
struct Welded {
    numbers: HashMap<[u32; 3], u32>,
    places: Vec<Vec3>,
}

impl Welded {
    /// The number of a place.
    fn place(&mut self, position: Vec3) -> u32 {
        let next = self.places.len() as u32;
        let number = *self.numbers.entry(bits(position)).or_insert(next);
        if number == next {
            self.places.push(position);
        }
        number
    }

    /// The number of a place that has one.
    fn known(&self, position: Vec3) -> Option<u32> {
        self.numbers.get(&bits(position)).copied()
    }
}

/// The bits of a position; zero has one sign.
fn bits(position: Vec3) -> [u32; 3] {
    position.to_array().map(|x| (x + 0.0).to_bits())
}
