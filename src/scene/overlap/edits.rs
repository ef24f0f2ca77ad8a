//! Changes to single triangles of single objects, where other objects may share the mesh.

use super::pull::{Depth, Pulled, pull};
use crate::scene::{Mesh, Object, Scene, Triangle, outward, widen};
use glam::{DAffine3, DVec3, Vec2, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// Instances share what is added to them where it differs by less, for each unit of its coordinates.
const SAME_CORNER: f64 = 1e-6;

/// Triangles of meshes that are made anew: as many as the scene has, or if it has few, so many.
const MOST_COPIED: usize = 1 << 18;

/// Changes to the triangles of objects, in world space.
#[derive(Debug, Default)]
pub(super) struct Edits {
    objects: BTreeMap<u32, ObjectEdits>,
}

/// Changes to the triangles of one object. Distances are to the outward side.
#[derive(Debug, Default, Clone)]
struct ObjectEdits {
    removed: BTreeSet<u32>,
    /// By triangle, the new material.
    materials: BTreeMap<u32, u32>,
    /// By triangle, how far it moves.
    moved: BTreeMap<u32, f64>,
    /// By triangle of a body of glass, how far it is drawn in, to its inward side, with the corners that it shares.
    pulled: BTreeMap<u32, Depth>,
    /// Triangles of which a second one is made that faces the other way, and moves as far that way; with its material.
    turned: BTreeMap<u32, u32>,
    added: Vec<Added>,
}

/// A new triangle, counter-clockwise where it is outside.
#[derive(Debug, Clone)]
struct Added {
    corners: [DVec3; 3],
    material: u32,
    /// How far it moves.
    moved: f64,
}

/// What instances have to have in common, apart from distances, to share an edited mesh.
#[derive(PartialEq, Eq, Hash)]
struct Shape<'a> {
    mesh: u32,
    /// The object's own material, where the triangles get materials of their own.
    material: Option<u32>,
    removed: &'a BTreeSet<u32>,
    materials: &'a BTreeMap<u32, u32>,
    moved: Vec<u32>,
    pulled: Vec<u32>,
    turned: &'a BTreeMap<u32, u32>,
    added: Vec<u32>,
}

/// The meshes that are made anew.
#[derive(Debug)]
pub(super) struct Plan {
    meshes: Vec<Planned>,
}

/// A mesh that is made anew, and who shows it.
#[derive(Debug)]
struct Planned {
    objects: Vec<u32>,
    /// In object space; what moves does so as far as any of the objects asks.
    edits: ObjectEdits,
    /// What `edits.pulled` comes to.
    pulled: Pulled,
}

impl Edits {
    pub(super) fn remove(&mut self, object: u32, triangle: u32) {
        self.objects.entry(object).or_default().removed.insert(triangle);
    }

    pub(super) fn give(&mut self, object: u32, triangle: u32, material: u32) {
        self.objects.entry(object).or_default().materials.insert(triangle, material);
    }

    /// Moves a triangle to its outward side, or to the other one if the distance is negative.
    pub(super) fn shift(&mut self, object: u32, triangle: u32, by: f64) {
        let moved = self.objects.entry(object).or_default().moved.entry(triangle).or_default();
        *moved = further(*moved, by);
    }

    /// Draws a face of a body of glass in, so that the body stays closed.
    pub(super) fn pull(&mut self, object: u32, triangle: u32, depth: Depth) {
        self.objects.entry(object).or_default().pulled.insert(triangle, depth);
    }

    /// A new triangle of this object, flat, counter-clockwise where it is outside, and moved to there.
    pub(super) fn add(&mut self, object: u32, corners: [DVec3; 3], material: u32, moved: f64) {
        self.objects.entry(object).or_default().added.push(Added { corners, material, moved });
    }

    /// A second triangle that faces the other way, and moves as far that way as the first does its own.
    pub(super) fn turn(&mut self, object: u32, triangle: u32, material: u32) {
        self.objects.entry(object).or_default().turned.insert(triangle, material);
    }

    /// The meshes that the changes take: objects that show one mesh and are changed in the same way go on sharing one.
    pub(super) fn plan(&self, scene: &Scene) -> Plan {
        let mut meshes: Vec<Planned> = Vec::new();
        let mut known: HashMap<Shape, Vec<usize>> = HashMap::new();
        for (index, edits) in &self.objects {
            let object = &scene.objects[*index as usize];
            let own = edits.in_object_space(&scene.meshes[object.mesh as usize], object);
            let same_shape = known.entry(edits.shape(object)).or_default();
            match same_shape.iter().find(|known| meshes[**known].edits.adds_the_same(&own)) {
                Some(known) => {
                    meshes[*known].objects.push(*index);
                    meshes[*known].edits.move_as_far(&own);
                }
                None => {
                    same_shape.push(meshes.len());
                    meshes.push(Planned { objects: vec![*index], edits: own, pulled: Pulled::default() });
                }
            }
        }
        for planned in meshes.iter_mut().filter(|planned| !planned.edits.pulled.is_empty()) {
            let object = &scene.objects[planned.objects[0] as usize];
            let is_body = |material: u32| scene.materials[object.material.unwrap_or(material) as usize].is_body();
            planned.pulled = pull(&scene.meshes[object.mesh as usize], is_body, &planned.edits.pulled);
        }
        Plan { meshes }
    }
}

impl Plan {
    /// How many triangles the meshes have that would have to be made anew, if they are too many.
    pub(super) fn too_many(&self, scene: &Scene) -> Option<usize> {
        let mesh = |planned: &Planned| scene.objects[planned.objects[0] as usize].mesh as usize;
        let copies = self.meshes.iter().map(|planned| scene.meshes[mesh(planned)].triangles.len()).sum();
        let own: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        (copies > own.max(MOST_COPIED)).then_some(copies)
    }

    /// Objects and triangles of faces of glass that stay where they are, since their bodies are too thin to be drawn in.
    pub(super) fn stuck(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.meshes.iter().flat_map(|planned| {
            let objects = planned.objects.iter();
            objects.flat_map(|object| planned.pulled.stuck.iter().map(|triangle| (*object, *triangle)))
        })
    }

    /// Makes the changes. Objects that have no triangle left go, and meshes that no object shows any longer.
    pub(super) fn apply(self, scene: &mut Scene) {
        for Planned { objects, edits, pulled } in self.meshes {
            if edits.only_pulls() && pulled.corners.is_empty() {
                continue;
            }
            let first = &scene.objects[objects[0] as usize];
            let mesh = edited(&scene.meshes[first.mesh as usize], first, &edits, &pulled);
            let number = scene.meshes.len() as u32;
            scene.meshes.push(Arc::new(mesh));
            for index in objects {
                let object = &mut scene.objects[index as usize];
                object.mesh = number;
                if edits.changes_materials() {
                    object.material = None;
                }
            }
        }
        let stays = |object: &Object| !scene.meshes[object.mesh as usize].triangles.is_empty();
        // The ground keeps its triangles, but may have another number.
        let before = |ground: u32| scene.objects[..ground as usize].iter().filter(|object| stays(object)).count();
        scene.ground = scene.ground.map(|ground| before(ground) as u32);
        scene.objects.retain(stays);
        let mut number = vec![None; scene.meshes.len()];
        let mut kept = Vec::new();
        for object in &mut scene.objects {
            let place = &mut number[object.mesh as usize];
            object.mesh = *place.get_or_insert_with(|| {
                kept.push(scene.meshes[object.mesh as usize].clone());
                kept.len() as u32 - 1
            });
        }
        scene.meshes = kept;
    }
}

impl ObjectEdits {
    /// Whether triangles of the object no longer have all the same material, if they had.
    fn changes_materials(&self) -> bool {
        !(self.materials.is_empty() && self.added.is_empty() && self.turned.is_empty())
    }

    /// Whether nothing but bodies of glass is changed.
    fn only_pulls(&self) -> bool {
        !self.changes_materials() && self.removed.is_empty() && self.moved.is_empty()
    }

    fn shape(&self, object: &Object) -> Shape<'_> {
        Shape {
            mesh: object.mesh,
            // What is glass goes by it, too.
            material: object.material.filter(|_| self.changes_materials() || !self.pulled.is_empty()),
            removed: &self.removed,
            materials: &self.materials,
            moved: self.moved.keys().copied().collect(),
            pulled: self.pulled.keys().copied().collect(),
            turned: &self.turned,
            added: self.added.iter().map(|added| added.material).collect(),
        }
    }

    /// The same changes in the space of the object's mesh.
    fn in_object_space(&self, mesh: &Mesh, object: &Object) -> ObjectEdits {
        let to_world = widen(object.object_to_world);
        let to_object: DAffine3 = to_world.inverse();
        let normal_to_world = to_object.matrix3.transpose();
        // A transform takes distances across a triangle to such by one factor, the length that it gives to the normal.
        let distance = |normal: DVec3, by: f64| by * (normal_to_world * normal.normalize_or_zero()).length();
        // An object that mirrors turns the winding of its triangles; outside stays outside.
        let mirrored = to_world.matrix3.determinant() < 0.0;
        let factor = |triangle: u32| distance(outward(mesh, &mesh.triangles[triangle as usize]), 1.0);
        let added = self.added.iter().map(|added| {
            let [a, b, c] = added.corners.map(|p| to_object.transform_point3(p));
            let [a, b, c] = if mirrored { [a, c, b] } else { [a, b, c] };
            let moved = distance((b - a).cross(c - a), added.moved);
            Added { corners: [a, b, c], moved, ..*added }
        });
        ObjectEdits {
            moved: self.moved.iter().map(|(t, by)| (*t, factor(*t) * by)).collect(),
            pulled: self.pulled.iter().map(|(t, depth)| (*t, depth.times(factor(*t)))).collect(),
            added: added.collect(),
            ..self.clone()
        }
    }

    /// Whether what is added is in the same places, for changes of one shape.
    fn adds_the_same(&self, other: &ObjectEdits) -> bool {
        self.added.iter().zip(&other.added).all(|(a, b)| {
            let near = SAME_CORNER * a.corners.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
            a.corners.iter().zip(b.corners).all(|(p, q)| p.distance(q) <= near)
        })
    }

    /// Moves what moves at least as far as `other` does, for changes of one shape.
    fn move_as_far(&mut self, other: &ObjectEdits) {
        self.moved.values_mut().zip(other.moved.values()).for_each(|(own, by)| *own = further(*own, *by));
        self.pulled.values_mut().zip(other.pulled.values()).for_each(|(own, by)| *own = own.max(*by));
        self.added.iter_mut().zip(&other.added).for_each(|(own, by)| own.moved = own.moved.max(by.moved));
    }
}

/// The distance that is further, to either side.
fn further(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}

/// The mesh of an object after its changes, which are in object space.
fn edited(mesh: &Mesh, object: &Object, edits: &ObjectEdits, pulled: &Pulled) -> Mesh {
    // Tangents, which follow the triangles, are made afterwards.
    let triangles = Vec::with_capacity(mesh.triangles.len());
    let mut new = Mesh { triangles, tangents: Vec::new(), ..mesh.clone() };
    let own_materials = edits.changes_materials();
    let by = |index: u32| {
        let distance = edits.moved.get(&index).copied().unwrap_or(0.0);
        outward(mesh, &mesh.triangles[index as usize]).normalize_or_zero() * distance
    };
    // Corners of a body that move together stay one vertex.
    let mut known: HashMap<(u32, [u64; 3]), u32> = HashMap::new();
    for (index, triangle) in (0..).zip(&mesh.triangles) {
        if edits.removed.contains(&index) {
            continue;
        }
        let mut triangle = *triangle;
        if own_materials {
            let all = object.material.unwrap_or(triangle.material);
            triangle.material = edits.materials.get(&index).copied().unwrap_or(all);
        }
        if edits.moved.contains_key(&index) {
            triangle.vertices = triangle.vertices.map(|v| moved(&mut new, v, by(index), 1.0));
        }
        if let Some(by) = pulled.corners.get(&index) {
            for (vertex, by) in triangle.vertices.iter_mut().zip(by).filter(|(_, by)| **by != DVec3::ZERO) {
                let key = (*vertex, by.to_array().map(f64::to_bits));
                *vertex = *known.entry(key).or_insert_with(|| moved(&mut new, *vertex, *by, 1.0));
            }
        }
        new.triangles.push(triangle);
    }
    for (index, material) in &edits.turned {
        let [a, b, c] = mesh.triangles[*index as usize].vertices;
        let vertices = [a, c, b].map(|v| moved(&mut new, v, -by(*index), -1.0));
        new.triangles.push(Triangle { vertices, material: *material });
    }
    for added in &edits.added {
        let [a, b, c] = added.corners;
        let by = (b - a).cross(c - a).normalize_or_zero() * added.moved;
        let places = added.corners.map(|p| (p + by).as_vec3());
        let [a, b, c] = places.map(|p| p.as_dvec3());
        if (b - a).cross(c - a) == DVec3::ZERO {
            continue;
        }
        let first = new.positions.len() as u32;
        new.positions.extend(places);
        if !mesh.normals.is_empty() {
            new.normals.extend([Vec3::ZERO; 3]);
        }
        if !mesh.uvs.is_empty() {
            new.uvs.extend([Vec2::ZERO; 3]);
        }
        if !mesh.colours.is_empty() {
            new.colours.extend([Vec3::ONE; 3]);
        }
        new.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material: added.material });
    }
    new
}

/// A new vertex like an old one, moved, with its normal times `side`.
fn moved(mesh: &mut Mesh, vertex: u32, by: DVec3, side: f32) -> u32 {
    let old = vertex as usize;
    mesh.positions.push((mesh.positions[old].as_dvec3() + by).as_vec3());
    if !mesh.normals.is_empty() {
        mesh.normals.push(side * mesh.normals[old]);
    }
    if !mesh.uvs.is_empty() {
        mesh.uvs.push(mesh.uvs[old]);
    }
    if !mesh.colours.is_empty() {
        mesh.colours.push(mesh.colours[old]);
    }
    mesh.positions.len() as u32 - 1
}
