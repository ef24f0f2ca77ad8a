//! How far a kernel's single precision can put a point of a triangle off the surface that rays meet.

use super::{Scene, widen};
use glam::{DAffine3, DMat3, DVec3};

/// Half a unit in the last place of 1: the relative error of one rounding. This and the next ones are twins of `shaders/surfel.glsl`.
pub const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 * 0.5;
/// Roundings of a point from its weights and the corners.
pub const POINT_ROUNDINGS: f64 = 7.0;
/// Roundings of a point's distance to the triangle's plane in the intersection tests.
pub const PLANE_ROUNDINGS: f64 = 4.0;
/// By how much the latter grow at most for a narrow triangle.
pub const MOST_NARROW: f64 = 256.0;
/// Roundings of the transform of a ray's origin into the object's space.
pub const TO_OBJECT_ROUNDINGS: f64 = 5.0;
/// Roundings of the transform of a point into world space.
pub const TO_WORLD_ROUNDINGS: f64 = 4.0;

/// How far a point that a kernel computes on a triangle can lie from the surface that rays meet, across it, and the triangle's unit normal, in
/// world space: the bounds of `shaders/surfel.glsl`, taken over the whole triangle. They are the rounding of the point itself, of the
/// triangle test (by the triangle's size, and the more the narrower it is), and of the transforms. `vertices` are its corners in world space.
pub(crate) fn across(scene: &Scene, object: u32, triangle: u32, vertices: [DVec3; 3]) -> (f64, DVec3) {
    let gamma = |roundings: f64| roundings * UNIT_ROUNDOFF;
    let absolute = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let object = &scene.objects[object as usize];
    let mesh = &scene.meshes[object.mesh as usize];
    let corners = mesh.triangles[triangle as usize].vertices.map(|v| mesh.positions[v as usize].as_dvec3());
    let [a, b, c] = corners;
    let size = ((b - a).abs() + (c - a).abs()).max_element();
    let narrow = (size * size / (b - a).cross(c - a).abs().max_element()).min(MOST_NARROW);
    let to_world = widen(object.object_to_world);
    let largest = |points: [DVec3; 3]| points.iter().fold(DVec3::ZERO, |m, v| m.max(v.abs()));
    let reach = largest(vertices);
    let mut in_object = gamma(POINT_ROUNDINGS) * largest(corners) + gamma(PLANE_ROUNDINGS) * size * narrow;
    let mut in_world = gamma(TO_WORLD_ROUNDINGS) * reach;
    if to_world != DAffine3::IDENTITY {
        let to_object = to_world.inverse();
        in_object += gamma(TO_OBJECT_ROUNDINGS) * (absolute(to_object.matrix3) * reach + to_object.translation.abs());
        in_world +=
            gamma(TO_WORLD_ROUNDINGS) * (absolute(to_world.matrix3) * largest(corners) + to_world.translation.abs());
    }
    // Only what is across the triangle matters, and a transform takes distances across it to such by one factor.
    let object_normal = (b - a).cross(c - a).normalize();
    let normal = to_world.matrix3.inverse().transpose() * object_normal;
    let unit = normal.normalize();
    let distance = object_normal.abs().dot(in_object) / normal.length() + unit.abs().dot(in_world);
    (distance, unit)
}
