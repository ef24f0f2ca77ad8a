//! Where a ray met a triangle, and what the triangle has there.

use crate::scene::{Mesh, Triangle};
use glam::{DVec2, DVec3};

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// How far along the ray, in multiples of its direction.
    pub t: f64,
    /// Index into [`crate::scene::Scene::objects`].
    pub object: u32,
    /// Index into the mesh's triangles.
    pub triangle: u32,
    /// Weights of the triangle's second and third corner; the first has the rest of 1.
    pub barycentrics: [f64; 2],
}

/// The sum of `values`, weighted.
pub(super) fn interpolate(weights: [f64; 3], values: [DVec3; 3]) -> DVec3 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}

/// The colour of the vertices at a point of a triangle that has these weights; 1 where the mesh has none.
pub(super) fn vertex_colour(mesh: &Mesh, triangle: &Triangle, weights: [f64; 3]) -> DVec3 {
    if mesh.colours.is_empty() {
        return DVec3::ONE;
    }
    interpolate(weights, triangle.vertices.map(|v| mesh.colours[v as usize].as_dvec3()))
}

/// Texture coordinates at a point of a triangle that has these weights; 0 where the mesh has none.
pub(super) fn texture_coordinates(mesh: &Mesh, triangle: &Triangle, weights: [f64; 3]) -> DVec2 {
    if mesh.uvs.is_empty() {
        return DVec2::ZERO;
    }
    interpolate(weights, triangle.vertices.map(|v| mesh.uvs[v as usize].as_dvec2().extend(0.0))).truncate()
}
