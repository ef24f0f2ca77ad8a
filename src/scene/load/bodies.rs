//! Bodies of glass: light that enters one must leave it, so its surface has to be closed, with all faces outwards.
//!
//! Around an edge a closed surface crosses in and out as often: the indices of refraction that are passed on the way around multiply to 1. That
//! holds for one body, for several that share an edge, and where glass, water and air meet in faces that each have their own index.

use super::loader::listed;
use crate::scene::{Mesh, Object, Scene, outward, widen};
use glam::{DAffine3, DVec3, Vec3};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

/// Indices that multiply to this much of 1 around an edge are those of one body; files round them.
const SAME_INDEX: f64 = 0.02;
/// Faces that leave an edge in directions that differ by less, in radian, lie on each other.
const SAME_ANGLE: f64 = 1e-5;
/// Edges without a partner of which it is found out whether corners of other faces lie on them: each is held against the ends of all.
const MOST_SPLIT: usize = 4096;
/// Bodies that are inside out of which it is found out whether they are hollows in another: one at a time costs all triangles.
const MOST_HOLLOWS: usize = 16;

/// A warning for each mesh whose glass is not made of closed bodies with all faces outwards, and for bodies that stand twice in one place.
pub(super) fn warnings(scene: &Scene) -> Vec<String> {
    let mut warnings = Vec::new();
    let mut objects_of: HashMap<(u32, Option<u32>), Vec<usize>> = HashMap::new();
    let mut places: HashMap<(u32, [u32; 12]), &str> = HashMap::new();
    let mut uses = Vec::new();
    for (index, object) in scene.objects.iter().enumerate() {
        // Where the object has a material of its own, it alone decides.
        if object.material.is_some_and(|material| !scene.materials[material as usize].bends()) {
            continue;
        }
        let objects = objects_of.entry((object.mesh, object.material)).or_insert_with(|| {
            uses.push((object.mesh, object.material));
            Vec::new()
        });
        objects.push(index);
    }
    let mut glasses = Vec::new();
    for key in uses {
        let objects = &objects_of[&key];
        let glass = Glass::of(scene, &scene.objects[objects[0]]);
        if glass.faces.is_empty() {
            continue;
        }
        for object in objects.iter().map(|index| &scene.objects[*index]) {
            let place = object.object_to_world.to_cols_array().map(|x| (x + 0.0).to_bits());
            if let Some(other) = places.insert((object.mesh, place), &object.name) {
                warnings.push(format!(
                    "objects `{other}` and `{}` are the same body of glass in the same place; light would enter it twice: remove one",
                    object.name
                ));
            }
        }
        glasses.push((objects, glass));
    }
    for (objects, glass) in &glasses {
        let object = &scene.objects[objects[0]];
        let file = &scene.meshes[object.mesh as usize].name;
        let more = objects.len() - 1;
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let who = format!("object `{}`{more} ({file})", object.name);
        warnings.extend(glass.faults(scene, &who));
        if (1..glass.faces.len()).contains(&glass.against) {
            warnings.push(format!(
                "{who}: {} of {} faces of glass ({}) are wound against their vertex normals, which are taken to say which side is outside",
                glass.against,
                glass.faces.len(),
                glass.materials(scene, 0..glass.faces.len())
            ));
        }
        let hollows: Vec<_> = glass.inside_out().take(MOST_HOLLOWS).collect();
        let lost: Vec<_> = hollows.iter().filter(|body| !is_hollow(scene, &glasses, glass, object, body)).collect();
        if let Some(body) = lost.first() {
            let materials = glass.materials(scene, body.faces.iter().copied());
            warnings.push(format!(
                "{who}: {} of glass ({materials}) {} inside out: the faces point inwards, so that what is around it would be the glass; \
                 turn them around",
                if lost.len() == 1 { "a body".into() } else { format!("{} bodies", lost.len()) },
                if lost.len() == 1 { "is" } else { "are" },
            ));
        }
    }
    warnings
}

/// A triangle of a material that bends light.
struct Face {
    /// Vertices by their places, counter-clockwise from outside.
    corners: [u32; 3],
    material: u32,
    /// Logarithm of the index of refraction.
    index: f64,
    /// The number of the surface that it is connected with, by edges.
    surface: u32,
}

/// The triangles of a mesh that bend light.
struct Glass {
    /// Where the vertices are, in object space; each place once.
    places: Vec<Vec3>,
    faces: Vec<Face>,
    /// Edges that one face has alone, and those around which the indices do not multiply to 1 though several have them, with a place on each. Edges that
    /// other materials share are in neither.
    open: Vec<(u32, u32)>,
    wrong: Vec<(u32, u32)>,
    /// Faces that lie on others, beside an edge that they share.
    doubled: usize,
    /// Faces that are wound against their vertex normals.
    against: usize,
    /// For each surface, whether a fault or another material is at one of its edges.
    unsure: Vec<bool>,
}

/// An edge of a face: its ends in order, whether the face has them so, the number of the face.
type Edge = (u32, u32, bool, u32);

/// A surface that is closed.
struct Body {
    faces: Vec<usize>,
}

impl Glass {
    /// The glass of an object.
    fn of(scene: &Scene, object: &Object) -> Self {
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
            let index = scene.materials[material as usize].eta.map_or(0.0, |eta| f64::from(eta).ln());
            faces.push(Face { corners, material, index, surface: 0 });
        }
        let mut glass = Glass {
            places: Vec::new(),
            faces,
            open: Vec::new(),
            wrong: Vec::new(),
            doubled: 0,
            against,
            unsure: Vec::new(),
        };
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
        let mut parents: Vec<u32> = (0..self.faces.len() as u32).collect();
        let mut faulty = Vec::new();
        let mut doubled = HashSet::new();
        for edge in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let around = self.around(edge);
            if around.abs() > SAME_INDEX {
                faulty.push((edge[0].0, edge[0].1, edge.len(), edge[0].3));
            }
            doubled.extend(self.on_each_other(&welded.places, edge));
            for pair in edge.windows(2) {
                let (a, b) = (root(&mut parents, pair[0].3), root(&mut parents, pair[1].3));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
        self.doubled = doubled.len();
        let mut surfaces = 0;
        for number in 0..self.faces.len() {
            let parent = root(&mut parents, number as u32) as usize;
            self.faces[number].surface = if parent == number { surfaces } else { self.faces[parent].surface };
            surfaces += u32::from(parent == number);
        }
        self.unsure = vec![false; surfaces as usize];
        if faulty.is_empty() {
            return;
        }
        // What is at an edge where glass ends at a wall or a lid cannot be known: the wall may close the body.
        let mut covered = HashSet::new();
        let ends: HashSet<(u32, u32)> = faulty.iter().map(|&(a, b, ..)| (a, b)).collect();
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
        for (a, b, faces, face) in faulty {
            let surface = self.faces[face as usize].surface;
            self.unsure[surface as usize] = true;
            if !covered.contains(&(a, b)) {
                if faces == 1 { self.open.push((a, surface)) } else { self.wrong.push((a, surface)) }
            }
        }
    }

    /// Cuts edges where the corner of another face lies on them: a large face may border on several small ones, as CAD programs write them.
    fn split(&self, places: &[Vec3], edges: &mut Vec<Edge>) {
        let lonely =
            edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|edge| self.around(edge).abs() > SAME_INDEX);
        let lonely: HashSet<(u32, u32)> = lonely.map(|edge| (edge[0].0, edge[0].1)).collect();
        if lonely.is_empty() || lonely.len() > MOST_SPLIT {
            return;
        }
        let place = |vertex: u32| places[vertex as usize].as_dvec3();
        let ends: HashSet<u32> = lonely.iter().flat_map(|&(a, b)| [a, b]).collect();
        let mut between: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
        for &(a, b) in &lonely {
            let (start, along) = (place(a), place(b) - place(a));
            let length = along.length();
            // Where a corner was to lie on the edge, its coordinates were rounded.
            let rounding = 4.0 * f64::from(f32::EPSILON) * place(a).abs().max(place(b).abs()).max_element();
            let near = rounding + 1e-6 * length;
            let mut on: Vec<(f64, u32)> = Vec::new();
            for &vertex in &ends {
                let at = (place(vertex) - start).dot(along) / length;
                let off = (start + at / length * along).distance(place(vertex));
                if at > near && at < length - near && off <= near {
                    on.push((at, vertex));
                }
            }
            if !on.is_empty() {
                on.sort_by(|a, b| a.0.total_cmp(&b.0));
                between.insert((a, b), on.into_iter().map(|(_, vertex)| vertex).collect());
            }
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

    /// What is wrong with the edges and faces, as a warning.
    fn faults(&self, scene: &Scene, who: &str) -> Option<String> {
        let mut sheets = self.sheets();
        let mut parts = Vec::new();
        let mut count = |number: usize, one: &str, many: &str| match number {
            0 => {}
            1 => parts.push(format!("1 {one}")),
            _ => parts.push(format!("{number} {many}")),
        };
        count(self.open.len(), "open edge", "open edges");
        count(
            self.wrong.len(),
            "edge between faces that are wound, or have vertex normals, against each other",
            "edges between faces that are wound, or have vertex normals, against each other",
        );
        count(self.doubled, "face that lies on another", "faces that lie on each other");
        let faulty: HashSet<u32> = self.open.iter().chain(&self.wrong).map(|(_, surface)| *surface).collect();
        if parts.is_empty() && sheets.is_empty() {
            return None;
        }
        if parts.is_empty() {
            parts.push("a flat sheet whose edges other materials share".into());
        }
        let all = faulty.is_empty() && sheets.is_empty();
        let in_question = |surface: u32| all || faulty.contains(&surface) || sheets.contains(&surface);
        let faces = (0..self.faces.len()).filter(|face| in_question(self.faces[*face].surface));
        let materials = self.materials(scene, faces);
        let place = self.open.iter().chain(&self.wrong).next().map(|(place, _)| self.places[*place as usize]);
        let place = place.map_or(String::new(), |p| format!(", the first at {} {} {}", p.x, p.y, p.z));
        let flat = !sheets.is_empty();
        sheets.retain(|surface| faulty.contains(surface));
        let only_sheets = flat && faulty.len() == sheets.len() && self.doubled == 0;
        let advice = match (flat, only_sheets) {
            (true, true) => "if it is a pane, state `thin = true` in its [[material]]; else close it",
            (true, false) => {
                "close it and turn all faces outwards, once each; flat panes want `thin = true` in their [[material]]"
            }
            (false, _) => {
                "close it and turn all faces outwards, once each (thin sheets want `thin = true` in their [[material]])"
            }
        };
        Some(format!(
            "{who}: the glass of material {materials} is not a closed body ({}{place}): unless walls close it, light that passes is too \
             bright or too dark by the square of its index of refraction; {advice}",
            parts.join(", ")
        ))
    }

    /// Surfaces all of whose faces lie in one plane.
    fn sheets(&self) -> HashSet<u32> {
        let mut planes: Vec<Option<(DVec3, DVec3)>> = vec![None; self.unsure.len()];
        let mut flat = vec![true; self.unsure.len()];
        for face in &self.faces {
            let surface = face.surface as usize;
            let [a, b, c] = self.corners(face);
            let (at, normal) = *planes[surface].get_or_insert((a, (b - a).cross(c - a).normalize_or_zero()));
            let size = a.distance(at).max(b.distance(at)).max(c.distance(at));
            flat[surface] &= [a, b, c].iter().all(|p| (*p - at).dot(normal).abs() <= 1e-4 * size);
        }
        (0..self.unsure.len() as u32).filter(|surface| flat[*surface as usize]).collect()
    }

    /// Closed surfaces of one index above 1 whose faces point inwards.
    fn inside_out(&self) -> impl Iterator<Item = Body> {
        let mut volumes = vec![0.0; self.unsure.len()];
        let mut origins: Vec<Option<DVec3>> = vec![None; self.unsure.len()];
        let mut usual: Vec<bool> = self.unsure.iter().map(|unsure| !unsure).collect();
        for face in &self.faces {
            let [a, b, c] = self.corners(face);
            let surface = face.surface as usize;
            let origin = *origins[surface].get_or_insert(a);
            volumes[surface] += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
            usual[surface] &= face.index > 0.0;
        }
        // Doubled faces cancel but for rounding.
        let sheets = self.sheets();
        let doubled = self.doubled > 0;
        (0..volumes.len() as u32)
            .filter(move |surface| {
                let surface = *surface as usize;
                !doubled && usual[surface] && volumes[surface] < 0.0 && !sheets.contains(&(surface as u32))
            })
            .take(MOST_HOLLOWS)
            .map(|surface| Body {
                faces: (0..self.faces.len()).filter(|face| self.faces[*face].surface == surface).collect(),
            })
    }

    fn corners(&self, face: &Face) -> [DVec3; 3] {
        face.corners.map(|place| self.places[place as usize].as_dvec3())
    }

    /// The names of the materials of these faces.
    fn materials(&self, scene: &Scene, faces: impl Iterator<Item = usize>) -> String {
        let mut said = HashSet::new();
        let numbers = faces.map(|face| self.faces[face].material).filter(|material| said.insert(*material));
        let names: Vec<_> = numbers.map(|material| scene.materials[material as usize].name.as_str()).collect();
        listed(names.into_iter())
    }

    /// How often glass is around a point of object space, without the faces that `counts` leaves out: the solid angle of all others, over that of a sphere (van
    /// Oosterom and Strackee 1983).
    fn winding(&self, point: DVec3, counts: impl Fn(usize) -> bool) -> f64 {
        let angle = |face: &Face| {
            let [a, b, c] = self.corners(face).map(|p| (p - point).normalize_or_zero());
            let angle = 2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
            if face.index < 0.0 { -angle } else { angle }
        };
        let faces = self.faces.iter().enumerate().filter(|(number, _)| counts(*number));
        faces.map(|(_, face)| angle(face)).sum::<f64>() / (4.0 * PI)
    }
}

/// Whether a body that is inside out is a hollow in glass, of its own mesh or of another object.
fn is_hollow(scene: &Scene, glasses: &[(&Vec<usize>, Glass)], glass: &Glass, object: &Object, body: &Body) -> bool {
    let own: HashSet<usize> = body.faces.iter().copied().collect();
    // Some points of it: it may reach into another body.
    let step = body.faces.len().div_ceil(4);
    body.faces.iter().step_by(step).all(|face| {
        let [a, b, c] = glass.corners(&glass.faces[*face]);
        let point = (a + b + c) / 3.0;
        let mut around = glass.winding(point, |face| !own.contains(&face));
        if around > 0.5 {
            return true;
        }
        let in_world = widen(object.object_to_world).transform_point3(point);
        for (objects, other) in glasses {
            let others =
                objects.iter().map(|index| &scene.objects[*index]).filter(|other| !std::ptr::eq(*other, object));
            let (low, high) = scene.meshes[scene.objects[objects[0]].mesh as usize].bounds();
            for place in others {
                let to_object: DAffine3 = widen(place.object_to_world).inverse();
                let point = to_object.transform_point3(in_world);
                if point.cmpge(low.as_dvec3()).all() && point.cmple(high.as_dvec3()).all() {
                    around += other.winding(point, |_| true);
                }
            }
        }
        around > 0.5
    })
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

/// The least member of a set of a forest of sets.
fn root(parents: &mut [u32], mut node: u32) -> u32 {
    while parents[node as usize] != node {
        let parent = parents[node as usize];
        parents[node as usize] = parents[parent as usize];
        node = parent;
    }
    node
}
