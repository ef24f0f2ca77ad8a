//! A mesh from an OBJ file, by `tobj`, which makes one vertex of each triple of position, texture coordinate and normal.

mod faces;
mod polygon;
mod text;

use super::text::read_text;
use crate::scene::{Mesh, Triangle};
use crate::{Error, Result};
use glam::{DVec3, Vec2, Vec3};
use std::io::Read;
use std::path::Path;
use text::ObjText;

/// A mesh and the names it refers to.
#[derive(Debug)]
pub(super) struct Obj {
    /// [`Triangle::material`] is 0 for none, else 1 + an index into `materials`.
    pub mesh: Mesh,
    /// Names of the materials, with the line of their first use.
    pub materials: Vec<(String, usize)>,
    /// What follows `mtllib`, with its line.
    pub libraries: Vec<(String, usize)>,
    /// Materials, numbered like [`Triangle::material`], of faces that lack a texture coordinate, with the line of the first.
    pub without_uv: Vec<(usize, usize)>,
    /// What was skipped or dropped.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file: all its groups in one mesh, polygons cut into triangles, zero-area triangles dropped. `smooth` makes vertex
/// normals where the file has none: faces share them that differ by less than so many degrees.
///
/// # Errors
/// If the file cannot be read, a line of it is wrong, or no triangle is left.
pub(super) fn read(path: &Path, smooth: Option<f32>) -> Result<Obj> {
    let ObjText { vertices, faces, materials, libraries, without_uv, mut warnings } =
        text::normalise(path, &read_text(path)?, smooth)?;
    let mut text = b"mtllib names\n".chain(vertices.as_bytes()).chain(faces.as_bytes());
    let names = |_: &Path| {
        let numbered = |index: usize| tobj::Material { name: index.to_string(), ..Default::default() };
        let map = (0..materials.len()).map(|index| (index.to_string(), index)).collect();
        Ok(((0..materials.len()).map(numbered).collect(), map))
    };
    let (models, _) = tobj::load_obj_buf(&mut text, &tobj::GPU_LOAD_OPTIONS, names)
        .map_err(|error| Error::scene(path, format!("the OBJ reader gave up: {error}")))?;
    let mut mesh = Mesh { name: file_name(path), ..Mesh::default() };
    let mut dropped = 0;
    for model in &models {
        dropped += append(&mut mesh, &model.mesh);
    }
    if mesh.triangles.is_empty() {
        let why = match dropped {
            0 => "it has no face with 3 or more corners".to_owned(),
            n => format!("all of its {n} triangles have zero area"),
        };
        // What was skipped may be why.
        let skipped: String = warnings.iter().map(|warning| format!("\n  {warning}")).collect();
        return Err(Error::scene(path, format!("nothing to trace: {why}{skipped}")));
    }
    if dropped > 0 {
        warnings.push(format!("{}: {dropped} zero-area triangle(s) dropped", path.display()));
    }
    if mesh.normals.iter().all(|normal| *normal == Vec3::ZERO) {
        mesh.normals = Vec::new();
    }
    Ok(Obj { mesh, materials, libraries, without_uv, warnings })
}

/// The last part of a path.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Adds a model to a mesh; returns how many zero-area triangles it left out.
fn append(mesh: &mut Mesh, model: &tobj::Mesh) -> usize {
    let base = mesh.positions.len() as u32;
    mesh.positions.extend(model.positions.chunks_exact(3).map(Vec3::from_slice));
    mesh.uvs.extend(model.texcoords.chunks_exact(2).map(Vec2::from_slice));
    mesh.normals.extend(model.normals.chunks_exact(3).map(|n| unit_or_zero(Vec3::from_slice(n))));
    let material = model.material_id.map_or(0, |index| index as u32 + 1);
    let mut dropped = 0;
    for corners in model.indices.chunks_exact(3) {
        let vertices = [corners[0], corners[1], corners[2]].map(|corner| base + corner);
        let [a, b, c] = vertices.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
        if (b - a).cross(c - a) == DVec3::ZERO {
            dropped += 1;
        } else {
            mesh.triangles.push(Triangle { vertices, material });
        }
    }
    dropped
}

/// In double precision, because the square of a short `f32` vector can vanish.
fn unit_or_zero(normal: Vec3) -> Vec3 {
    normal.as_dvec3().normalize_or_zero().as_vec3()
}
