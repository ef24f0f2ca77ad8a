//! Triangles of a scene by what they are made of, and which of others are near to them.

use super::face::Face;
use crate::scene::{Material, Mesh, Scene, moved_box, widen};
use glam::DAffine3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

/// Pairs of triangles that are compared, for each triangle: neighbours have about a dozen.
const PAIRS: usize = 64;
/// Other triangles that are compared with those of a tree.
const MOST_OTHERS: usize = 50_000_000;

/// The triangles whose material is of a kind; none if there are more than `most`.
pub(super) fn select(scene: &Scene, kind: impl Fn(&Material) -> bool, most: usize) -> Option<Vec<Face>> {
    let chosen: Vec<bool> = scene.materials.iter().map(kind).collect();
    let mut faces = Vec::new();
    if !chosen.contains(&true) {
        return Some(faces);
    }
    // Instances of a mesh choose the same triangles.
    let mut of_mesh: Vec<Option<Vec<u32>>> = vec![None; scene.meshes.len()];
    for (index, object) in (0..).zip(&scene.objects) {
        let mesh = &scene.meshes[object.mesh as usize];
        let to_world = widen(object.object_to_world);
        let mut face = |triangle: u32| {
            let material = object.material.unwrap_or(mesh.triangles[triangle as usize].material);
            faces.push(Face::new(index, triangle, mesh, &to_world, material));
        };
        match object.material {
            Some(material) if chosen[material as usize] => (0..mesh.triangles.len() as u32).for_each(&mut face),
            Some(_) => {}
            None => of_mesh[object.mesh as usize]
                .get_or_insert_with(|| {
                    let all = (0..).zip(&mesh.triangles);
                    all.filter(|(_, t)| chosen[t.material as usize]).map(|(index, _)| index).collect()
                })
                .iter()
                .copied()
                .for_each(&mut face),
        }
        if faces.len() > most {
            return None;
        }
    }
    Some(faces)
}

/// A tree of the boxes around faces, and by leaf the number of the face.
pub(super) struct Near {
    bvh: Bvh2,
    numbers: Vec<usize>,
    boxes: Vec<Aabb>,
}

impl Near {
    /// The tree of these ones of the faces, each with a margin around it.
    pub(super) fn new(faces: &[Face], numbers: Vec<usize>, margin: impl Fn(&Face) -> f64) -> Self {
        let boxes: Vec<Aabb> =
            numbers.iter().map(|index| &faces[*index]).map(|face| face.bounds(margin(face))).collect();
        let indices = (0..boxes.len() as u32).collect();
        let mut builder = PlocBuilder::with_capacity(boxes.len());
        let bvh = builder.build(PlocSearchDistance::Minimum, &boxes, indices, SortPrecision::U64, 0);
        Near { bvh, numbers, boxes }
    }

    /// Calls `found` with the number of each face of the tree, in order, and those behind it in order that are near to it. False if there are too many.
    pub(super) fn each_pair(&self, mut found: impl FnMut(usize, usize)) -> bool {
        let mut pairs = PAIRS * self.numbers.len() + 1_000_000;
        let mut near: Vec<usize> = Vec::new();
        for (place, &index) in self.numbers.iter().enumerate() {
            near.clear();
            self.visit(self.boxes[place], |other| {
                near.extend((other > index).then_some(other));
                pairs = pairs.saturating_sub(1);
                pairs > 0
            });
            near.iter().for_each(|other| found(index, *other));
        }
        pairs > 0
    }

    /// Calls `found` with each triangle of the scene whose material is one of the `chosen` and that is near to faces of the tree for which `counts`, and
    /// with the numbers of these. False if there are too many to look at all.
    pub(super) fn each_other(
        &self,
        scene: &Scene,
        chosen: &[bool],
        counts: impl Fn(usize) -> bool,
        mut found: impl FnMut(Face, &[usize]),
    ) -> bool {
        let counted = (0..self.numbers.len()).filter(|place| counts(self.numbers[*place]));
        let bounds = counted.map(|place| self.boxes[place]).reduce(|a, b| a.union(&b));
        let Some(bounds) = bounds else { return true };
        let (mut budget, mut pairs) = (MOST_OTHERS, MOST_OTHERS);
        let mut near = Vec::new();
        for (object_index, object) in (0..).zip(&scene.objects) {
            let mesh: &Mesh = &scene.meshes[object.mesh as usize];
            if object.material.is_some_and(|material| !chosen[material as usize]) {
                continue;
            }
            let to_world: DAffine3 = widen(object.object_to_world);
            if scene.objects.len() > 1 {
                let (low, high) = mesh.bounds();
                let moved = moved_box([low, high].map(|corner| corner.as_dvec3()), &to_world);
                if !Aabb::from_points(&moved.map(|corner| corner.as_vec3a())).intersect_aabb(&bounds) {
                    continue;
                }
            }
            for (triangle_index, triangle) in (0..).zip(&mesh.triangles) {
                let material = object.material.unwrap_or(triangle.material);
                budget = budget.saturating_sub(1);
                if budget == 0 || !chosen[material as usize] {
                    continue;
                }
                let corners = triangle
                    .vertices
                    .map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()).as_vec3a());
                let around = Aabb::from_points(&corners);
                if !around.intersect_aabb(&bounds) {
                    continue;
                }
                near.clear();
                self.visit(around, |number| {
                    near.extend(counts(number).then_some(number));
                    pairs = pairs.saturating_sub(1);
                    pairs > 0
                });
                if !near.is_empty() {
                    found(Face::new(object_index, triangle_index, mesh, &to_world, material), &near);
                }
            }
        }
        budget > 0 && pairs > 0
    }

    /// Calls `found` with the number of each face whose box is near to this one, until it returns false.
    fn visit(&self, around: Aabb, mut found: impl FnMut(usize) -> bool) {
        self.bvh.aabb_traverse(around, |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let first = node.first_index as usize;
            let leaves = &bvh.primitive_indices[first..first + node.prim_count as usize];
            leaves.iter().all(|leaf| found(self.numbers[*leaf as usize]))
        });
    }
}
