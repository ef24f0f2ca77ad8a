//! Changes to single triangles of single objects, where other objects may share the mesh.

use crate::scene::{Mesh, Object, Scene, Triangle, widen};
use glam::{DVec3, Vec2, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// Changes to the triangles of objects.
#[derive(Debug, Default)]
pub(super) struct Edits {
    objects: BTreeMap<u32, ObjectEdits>,
}

/// Changes to the triangles of one object.
#[derive(Debug, Default, Clone)]
struct ObjectEdits {
    removed: BTreeSet<u32>,
    /// By triangle, the new material.
    materials: BTreeMap<u32, u32>,
    /// By triangle, by how much it moves in world space.
    moved: BTreeMap<u32, DVec3>,
    /// Corners in world space, and a material.
    added: Vec<([DVec3; 3], u32)>,
    /// Triangles of which a second one is made that faces the other way, with its material and by how much it moves in world space.
    turned: Vec<(u32, u32, DVec3)>,
}

impl Edits {
    pub(super) fn remove(&mut self, object: u32, triangle: u32) {
        self.objects.entry(object).or_default().removed.insert(triangle);
    }

    pub(super) fn give(&mut self, object: u32, triangle: u32, material: u32) {
        self.objects.entry(object).or_default().materials.insert(triangle, material);
    }

    pub(super) fn shift(&mut self, object: u32, triangle: u32, by: DVec3) {
        self.objects.entry(object).or_default().moved.insert(triangle, by);
    }

    /// A new triangle of this object, flat, counter-clockwise where it is outside.
    pub(super) fn add(&mut self, object: u32, corners: [DVec3; 3], material: u32) {
        self.objects.entry(object).or_default().added.push((corners, material));
    }

    /// A second triangle that faces the other way.
    pub(super) fn turn(&mut self, object: u32, triangle: u32, material: u32, by: DVec3) {
        self.objects.entry(object).or_default().turned.push((triangle, material, by));
    }

    /// How many triangles the meshes have that have to be made anew.
    pub(super) fn copies(&self, scene: &Scene) -> usize {
        let mesh = |object: &u32| scene.objects[*object as usize].mesh;
        let plain: BTreeSet<(u32, &BTreeSet<u32>)> =
            self.objects.iter().filter(|(_, e)| e.only_removes()).map(|(o, e)| (mesh(o), &e.removed)).collect();
        let others = self.objects.iter().filter(|(_, e)| !e.only_removes()).map(|(o, _)| mesh(o));
        let size = |mesh: u32| scene.meshes[mesh as usize].triangles.len();
        plain.iter().map(|(mesh, _)| size(*mesh)).chain(others.map(size)).sum()
    }

    /// Makes the changes. Objects that have no triangle left go, and meshes that no object shows any longer.
    pub(super) fn apply(self, scene: &mut Scene) {
        // Instances that lose the same triangles go on sharing a mesh.
        let mut known: HashMap<(u32, BTreeSet<u32>), u32> = HashMap::new();
        for (index, edits) in &self.objects {
            let object = &scene.objects[*index as usize];
            let key = (object.mesh, edits.removed.clone());
            let plain = edits.only_removes();
            if let Some(mesh) = known.get(&key).filter(|_| plain) {
                scene.objects[*index as usize].mesh = *mesh;
                continue;
            }
            let mesh = edited(&scene.meshes[object.mesh as usize], object, edits);
            let number = scene.meshes.len() as u32;
            scene.meshes.push(Arc::new(mesh));
            let object = &mut scene.objects[*index as usize];
            object.mesh = number;
            if edits.changes_materials() {
                object.material = None;
            }
            if plain {
                known.insert(key, number);
            }
        }
        scene.objects.retain(|object| !scene.meshes[object.mesh as usize].triangles.is_empty());
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
    fn only_removes(&self) -> bool {
        !self.changes_materials() && self.moved.is_empty()
    }

    /// Whether triangles of the object no longer have all the same material, if they had.
    fn changes_materials(&self) -> bool {
        !(self.materials.is_empty() && self.added.is_empty() && self.turned.is_empty())
    }
}

/// The mesh of an object after its changes.
fn edited(mesh: &Mesh, object: &Object, edits: &ObjectEdits) -> Mesh {
    let to_object = widen(object.object_to_world).inverse();
    let mut new = Mesh { triangles: Vec::with_capacity(mesh.triangles.len()), ..mesh.clone() };
    let own_materials = edits.changes_materials();
    for (index, triangle) in (0..).zip(&mesh.triangles) {
        if edits.removed.contains(&index) {
            continue;
        }
        let mut triangle = *triangle;
        if own_materials {
            let all = object.material.unwrap_or(triangle.material);
            triangle.material = edits.materials.get(&index).copied().unwrap_or(all);
        }
        if let Some(by) = edits.moved.get(&index) {
            triangle.vertices = triangle.vertices.map(|v| moved(&mut new, v, to_object.transform_vector3(*by), 1.0));
        }
        new.triangles.push(triangle);
    }
    for (index, material, by) in &edits.turned {
        let [a, b, c] = mesh.triangles[*index as usize].vertices;
        let vertices = [a, c, b].map(|v| moved(&mut new, v, to_object.transform_vector3(*by), -1.0));
        new.triangles.push(Triangle { vertices, material: *material });
    }
    for (corners, material) in &edits.added {
        let places = corners.map(|p| to_object.transform_point3(p).as_vec3());
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
        // An object that mirrors turns the winding of its triangles; outside stays outside.
        let mirrored = object.object_to_world.matrix3.determinant() < 0.0;
        let vertices = if mirrored { [first, first + 2, first + 1] } else { [first, first + 1, first + 2] };
        new.triangles.push(Triangle { vertices, material: *material });
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
