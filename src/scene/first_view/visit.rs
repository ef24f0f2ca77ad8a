//! Vertices and triangles of all instances, in the scene; of instances that are too many, something like them.

use crate::scene::{Mesh, Object, Scene, Triangle, moved_box, outward, widen};
use glam::{BVec3, DAffine3, DVec3, Vec3};

/// Triangles that are visited before instances are taken for their boxes, and beyond that, before some are left out.
pub(super) const VISITED: u64 = 20_000_000;
/// An instance below this part of the scene is taken for its box, where there are too many triangles.
const SMALL: f64 = 0.02;
/// A box seen from outside, by the numbers of its corners.
const BOX: [[usize; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// Visits the vertices of all instances; of instances that are too many, the corners of their boxes.
pub(super) fn for_points(scene: &Scene, visit: &mut impl FnMut(DVec3)) {
    for_some_points(scene, 1, visit);
}

/// Visits each so manieth of the points.
pub(super) fn for_some_points(scene: &Scene, step: usize, visit: &mut impl FnMut(DVec3)) {
    let in_boxes = vertices(scene) > VISITED;
    let boxes: Vec<_> = scene.meshes.iter().map(|mesh| mesh.bounds()).collect();
    let mut skip = 0;
    for object in &scene.objects {
        let (mesh, to_world) = (&scene.meshes[object.mesh as usize], widen(object.object_to_world));
        if in_boxes {
            let (low, high) = boxes[object.mesh as usize];
            every(step, &mut skip, &box_corners(low, high, &to_world), |p| visit(*p));
        } else {
            every(step, &mut skip, &mesh.positions, |p| visit(to_world.transform_point3(p.as_dvec3())));
        }
    }
}

/// Visits each so manieth item, beginning with the one after `skip`, which afterwards says the same of the next items.
fn every<T>(step: usize, skip: &mut usize, items: &[T], visit: impl FnMut(&T)) {
    items.iter().skip(*skip).step_by(step).for_each(visit);
    let rest = items.len().saturating_sub(*skip);
    *skip = if rest > 0 { (step - rest % step) % step } else { *skip - items.len() };
}

/// How many points [`for_points`] visits.
pub(super) fn points(scene: &Scene) -> usize {
    let vertices = vertices(scene);
    if vertices > VISITED { 8 * scene.objects.len() } else { vertices as usize }
}

fn vertices(scene: &Scene) -> u64 {
    scene.objects.iter().map(|o| scene.meshes[o.mesh as usize].positions.len() as u64).sum()
}

/// Visits the corners of triangles, in the scene, counter-clockwise as seen from the outward side: of all triangles, if they are not too many.
pub(super) fn for_triangles(scene: &Scene, unit: f64, visit: &mut impl FnMut([DVec3; 3], bool)) {
    let all = scene.triangle_count();
    let boxes: Vec<_> = scene.meshes.iter().map(|mesh| mesh.bounds()).collect();
    let is_small = |object: &Object, to_world: &DAffine3| {
        let (low, high) = boxes[object.mesh as usize];
        let [low, high] = moved_box([low.as_dvec3(), high.as_dvec3()], to_world);
        all > VISITED && (high - low).max_element() < SMALL * unit
    };
    let whole: u64 = scene
        .objects
        .iter()
        .filter(|object| !is_small(object, &widen(object.object_to_world)))
        .map(|object| scene.meshes[object.mesh as usize].triangles.len() as u64)
        .sum();
    let step = whole.div_ceil(VISITED).max(1) as usize;
    for object in &scene.objects {
        let (mesh, to_world) = (&scene.meshes[object.mesh as usize], widen(object.object_to_world));
        let mirrored = to_world.matrix3.determinant() < 0.0;
        if is_small(object, &to_world) {
            let (low, high) = boxes[object.mesh as usize];
            let corners = box_corners(low, high, &to_world);
            for [a, b, c, d] in BOX {
                for [a, b, c] in [[a, b, c], [a, c, d]] {
                    visit(if mirrored { [a, c, b] } else { [a, b, c] }.map(|i| corners[i]), false);
                }
            }
            continue;
        }
        for triangle in mesh.triangles.iter().step_by(step) {
            let [a, b, c] = triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
            let material = scene.material_of(object, triangle);
            let clear = material.transmits() || material.opacity < 0.5;
            visit(if mirrored != is_wound_inward(mesh, triangle) { [a, c, b] } else { [a, b, c] }, clear);
        }
    }
}

/// Whether the vertex normals say that the winding is clockwise as seen from outside.
fn is_wound_inward(mesh: &Mesh, triangle: &Triangle) -> bool {
    if mesh.normals.is_empty() {
        return false;
    }
    let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
    outward(mesh, triangle).dot((b - a).cross(c - a)) < 0.0
}

fn box_corners(low: Vec3, high: Vec3, to_world: &DAffine3) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let corner = Vec3::select(BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), high, low);
        to_world.transform_point3(corner.as_dvec3())
    })
}
