//! A mesh from an OBJ file: one vertex of each triple of position, texture coordinate and normal.

mod faces;
mod statements;

use super::text_file::read_text;
use crate::scene::{Mesh, Triangle};
use crate::{Error, Result};
use glam::{DVec3, Vec2, Vec3};
use statements::ObjText;
use std::collections::HashMap;
use std::path::Path;

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
    // The text itself is given up here: what follows takes as much memory again.
    let mut text = statements::read(path, &read_text(path)?)?;
    let mut warnings = Vec::new();
    let has_normals = text.faces.corners.iter().any(|[_, _, normal]| *normal > 0);
    if smooth.is_some() && has_normals {
        let path = path.display();
        warnings.push(format!("{path}: `smooth` is ignored: the file has vertex normals of its own (vn)"));
    }
    let made = match smooth {
        Some(degrees) if !has_normals => text.faces.normals_by_angle(&text.positions, degrees),
        _ => text.faces.normals_by_group(&text.positions),
    };
    fill_gaps(&mut text, &made);
    drop(made);
    let (mut mesh, dropped) = build(&mut text);
    mesh.name = file_name(path);
    text.faults.warn(path, &mut warnings);
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
    let ObjText { materials, libraries, without_uv, .. } = text;
    Ok(Obj { mesh, materials, libraries, without_uv, warnings })
}

/// Gives corners that lack a texture coordinate or a normal one of their own, unless none has any: (0, 0), and what was made for
/// the corner, or zero.
fn fill_gaps(text: &mut ObjText, made: &[Vec3]) {
    if !text.uvs.is_empty() {
        text.uvs.push(Vec2::ZERO);
        let none = text.uvs.len() as u32;
        text.faces.corners.iter_mut().filter(|[_, uv, _]| *uv == 0).for_each(|[_, uv, _]| *uv = none);
    }
    if text.normals.is_empty() && made.iter().all(|normal| *normal == Vec3::ZERO) {
        return;
    }
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    for (corner, [_, _, index]) in text.faces.corners.iter_mut().enumerate().filter(|(_, [_, _, index])| *index == 0) {
        let normal = made.get(corner).copied().unwrap_or_default();
        *index = *known.entry(normal.to_array().map(f32::to_bits)).or_insert_with(|| {
            text.normals.push(normal);
            text.normals.len() as u32
        });
    }
}

/// The mesh of corners without gaps, and how many zero-area triangles are left out of it. Takes the faces out of `text`, and adds
/// to its faults.
fn build(text: &mut ObjText) -> (Mesh, usize) {
    let ObjText { positions, uvs, normals, faces, faults, .. } = text;
    let mut mesh = Mesh::default();
    let mut vertices = Vertices::of(positions);
    let (mut last, mut dropped) = (0, 0);
    let add = |material, corners: [[u32; 3]; 3]| {
        if material != last {
            vertices.end_sharing();
            last = material;
        }
        let [a, b, c] = corners.map(|[vertex, ..]| positions[vertex as usize - 1].as_dvec3());
        // Vertices of what is left out stay, and keep their numbers.
        let vertices = corners.map(|corner| vertices.number(corner));
        if (b - a).cross(c - a) == DVec3::ZERO {
            dropped += 1;
        } else {
            mesh.triangles.push(Triangle { vertices, material });
        }
    };
    std::mem::take(faces).cut(positions, add, |fault, line| faults.polygon(fault, line));
    mesh.positions = vertices.corners.iter().map(|[vertex, ..]| positions[*vertex as usize - 1]).collect();
    if !uvs.is_empty() {
        mesh.uvs = vertices.corners.iter().map(|[_, uv, _]| uvs[*uv as usize - 1]).collect();
    }
    if !normals.is_empty() {
        let normal = |index: u32| unit_or_zero(normals[index as usize - 1]);
        mesh.normals = vertices.corners.iter().map(|[_, _, index]| normal(*index)).collect();
    }
    if mesh.normals.iter().all(|normal| *normal == Vec3::ZERO) {
        mesh.normals = Vec::new();
    }
    (mesh, dropped)
}

/// The last part of a path.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Numbers for triples of position, texture coordinate and normal, in the order of their first use.
#[derive(Debug)]
struct Vertices {
    /// The triple of each vertex.
    corners: Vec<[u32; 3]>,
    /// For each position, 1 + the first vertex there; 0 for none.
    first: Vec<u32>,
    /// The other vertices. Most meshes have few, and are numbered without hashing.
    others: HashMap<[u32; 3], u32>,
    /// Vertices before this one are not used again.
    begin: u32,
}

impl Vertices {
    fn of(positions: &[Vec3]) -> Self {
        Vertices { corners: Vec::new(), first: vec![0; positions.len()], others: HashMap::new(), begin: 0 }
    }

    /// Equal triples before and after this call are different vertices.
    fn end_sharing(&mut self) {
        self.begin = self.corners.len() as u32;
    }

    fn number(&mut self, corner: [u32; 3]) -> u32 {
        let next = self.corners.len() as u32;
        let first = &mut self.first[corner[0] as usize - 1];
        let number = if *first <= self.begin {
            *first = next + 1;
            next
        } else if self.corners[*first as usize - 1] == corner {
            *first - 1
        } else {
            let other = self.others.entry(corner).or_insert(next);
            if *other < self.begin {
                *other = next;
            }
            *other
        };
        if number == next {
            self.corners.push(corner);
        }
        number
    }
}

/// In double precision, because the square of a short `f32` vector can vanish.
fn unit_or_zero(normal: Vec3) -> Vec3 {
    normal.as_dvec3().normalize_or_zero().as_vec3()
}
