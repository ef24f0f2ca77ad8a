//! Tangents of meshes, by which maps know what is right and what is up on a surface.

use super::{Material, Mesh, Scene, Triangle};
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{DVec2, DVec3, Vec3, Vec4};
use std::borrow::Cow;
use std::sync::Arc;

impl Scene {
    /// The scene with the tangents that it needs: itself, if they are there already, as they are in one that was loaded.
    pub(crate) fn with_tangents(&self) -> Cow<'_, Scene> {
        // Most scenes need none: they are not copied to find that out.
        if !self.materials.iter().any(Material::needs_tangents) {
            return Cow::Borrowed(self);
        }
        let mut scene = self.clone();
        scene.add_tangents();
        let same = self.meshes.iter().zip(&scene.meshes).all(|(old, new)| Arc::ptr_eq(old, new));
        if same { Cow::Borrowed(self) } else { Cow::Owned(scene) }
    }

    /// Makes the tangents of every mesh that shows a material which needs them and has none yet, by the algorithm that programs which bake maps agree on
    /// (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008); gives a warning for each mesh in which some triangles can have none, because their texture
    /// coordinates have no area: maps bend no normal there.
    pub fn add_tangents(&mut self) -> Vec<String> {
        let needs: Vec<bool> = self.materials.iter().map(Material::needs_tangents).collect();
        // For each mesh, whether an object shows all of it with such a material, and whether one shows it with the triangles' own.
        let mut shown = vec![[false; 2]; self.meshes.len()];
        for object in &self.objects {
            let [whole, own] = &mut shown[object.mesh as usize];
            match object.material {
                Some(material) => *whole |= needs[material as usize],
                None => *own = true,
            }
        }
        let mut warnings = Vec::new();
        for (mesh, [whole, own]) in self.meshes.iter_mut().zip(shown) {
            let counts = |triangle: &Triangle| whole || own && needs[triangle.material as usize];
            // What has no coordinates at all is named with its material.
            if !mesh.tangents.is_empty() || mesh.uvs.is_empty() || !mesh.triangles.iter().any(counts) {
                continue;
            }
            let mesh = Arc::make_mut(mesh);
            mesh.tangents = tangents(mesh);
            let without = mesh.triangles.iter().zip(mesh.tangents.chunks(3));
            let without = without.filter(|(triangle, own)| own[0].w == 0.0 && counts(triangle)).count();
            if without > 0 {
                let (noun, have) = if without == 1 { ("triangle", "has") } else { ("triangles", "have") };
                warnings.push(format!(
                    "{}: {without} {noun} of {} {have} texture coordinates without an area: no normal map or brushing shows there",
                    mesh.name,
                    mesh.triangles.len()
                ));
            }
        }
        warnings
    }
}

/// The tangents of a mesh with texture coordinates.
fn tangents(mesh: &Mesh) -> Vec<Vec4> {
    let mut corners = Corners { mesh, tangents: vec![Vec4::ZERO; 3 * mesh.triangles.len()] };
    // The error has no value: nothing can fail.
    let _: Result<(), _> = generate_tangents(&mut corners);
    let mut tangents = corners.tangents;
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let own = &mut tangents[3 * index..3 * index + 3];
        let [a, b, c] = triangle.vertices.map(|v| mesh.uvs[v as usize].as_dvec2());
        let finite = own.iter().all(|tangent| tangent.is_finite() && tangent.truncate() != Vec3::ZERO);
        // What its neighbours lend to a triangle without coordinates of its own would show one texel all over it, turned as they are.
        if !finite || !has_area(b - a, c - a) {
            own.fill(Vec4::ZERO);
        }
    }
    tangents
}

/// Whether two edges in the texture span an area that is more than rounding.
fn has_area(a: DVec2, b: DVec2) -> bool {
    a.perp_dot(b).abs() > 1e-12 * a.length() * b.length()
}

/// The corners of a mesh, as the crate wants them, and what it finds.
struct Corners<'a> {
    mesh: &'a Mesh,
    tangents: Vec<Vec4>,
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    /// A triangle is flat unless all its corners have a normal.
    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let vertices = self.mesh.triangles[face].vertices;
        let normals = vertices.map(|v| self.mesh.normals.get(v as usize).copied().unwrap_or(Vec3::ZERO));
        if normals.iter().all(|normal| *normal != Vec3::ZERO) {
            return normals[corner].to_array();
        }
        let [a, b, c]: [DVec3; 3] = vertices.map(|v| self.mesh.positions[v as usize].as_dvec3());
        (b - a).cross(c - a).normalize_or_zero().as_vec3().to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.mesh.uvs[self.vertex(face, corner)].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[3 * face + corner] = space.map_or(Vec4::ZERO, |space| space.tangent_encoded().into());
    }
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face].vertices[corner] as usize
    }
}
