//! `Mesh`, `Triangle`, and `Object`, which is where a mesh stands.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec2, Vec3, Vec4};

/// Triangles in object space.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// A name for messages: the file name.
    pub name: String,
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals: empty (no triangle has any), or one for each position; a zero vector means "none here", and a
    /// triangle with such a corner is shaded flat.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, v upwards: empty (no triangle has any), or one for each position.
    pub uvs: Vec<Vec2>,
    /// Colours of the vertices, linear, 0 to 1, which multiply the diffuse and the ambient albedo: empty (none), or one for each position.
    pub colours: Vec<Vec3>,
    /// Tangents of the corners, three for each triangle: the unit direction in which u grows, and in `w` the handedness, 1 or -1, by which the
    /// bitangent is `w normal x tangent`; one that is zero means "none here". Empty: nothing needs them ([`Scene::add_tangents`](crate::scene::Scene::add_tangents)),
    /// or nobody has made them.
    pub tangents: Vec<Vec4>,
    /// The triangles; all have a non-zero area.
    pub triangles: Vec<Triangle>,
}

impl Mesh {
    /// The corners of the triangles in object space, each vertex once; vertices that no triangle has are none.
    pub(crate) fn corners(&self) -> Vec<DVec3> {
        let mut shown = vec![false; self.positions.len()];
        self.triangles.iter().flat_map(|triangle| triangle.vertices).for_each(|vertex| shown[vertex as usize] = true);
        self.positions.iter().zip(shown).filter(|(_, shown)| *shown).map(|(position, _)| position.as_dvec3()).collect()
    }

    /// Object-space bounding box of the positions.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
    }
}

/// Three corners and a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Mesh::positions`] (and [`Mesh::normals`]).
    pub vertices: [u32; 3],
    /// Index into [`Scene::materials`](crate::scene::Scene::materials).
    pub material: u32,
}

/// An instance of a mesh.
#[derive(Debug, Clone)]
pub struct Object {
    /// A name for messages.
    pub name: String,
    /// Index into [`Scene::meshes`](crate::scene::Scene::meshes).
    pub mesh: u32,
    /// Object space to world space; invertible, may mirror and scale unevenly.
    pub object_to_world: Affine3A,
    /// Replaces the material of every triangle, if given.
    pub material: Option<u32>,
}

/// The box around a box, given by its least and greatest corner, that is mapped.
pub(crate) fn moved_box([low, high]: [DVec3; 2], map: &DAffine3) -> [DVec3; 2] {
    let mut moved = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for corner in 0..8 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let p = map.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
        moved = [moved[0].min(p), moved[1].max(p)];
    }
    moved
}

/// A vector along the outward normal, in object space: where the winding is counter-clockwise, unless the vertex normals know better.
/// One answer for a whole triangle, so that light is inside behind all of it or behind none.
pub(crate) fn outward(mesh: &Mesh, triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
    let winding = (b - a).cross(c - a);
    let normals = triangle.vertices.map(|v| mesh.normals.get(v as usize).map_or(DVec3::ZERO, |n| n.as_dvec3()));
    let known = normals.iter().all(|n| *n != DVec3::ZERO);
    if known && normals.iter().sum::<DVec3>().dot(winding) < 0.0 { -winding } else { winding }
}

/// An affine map in `f64`, from the `f32` numbers that both tracers share.
pub(crate) fn widen(map: glam::Affine3A) -> DAffine3 {
    let m = map.matrix3;
    DAffine3 {
        matrix3: DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3()),
        translation: map.translation.as_dvec3(),
    }
}
