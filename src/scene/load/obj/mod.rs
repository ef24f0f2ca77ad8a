//! A mesh from an OBJ file: one vertex of each triple of position, texture coordinate and normal.

mod colours;
mod contents;
mod faces;
mod positions;
mod statements;

use super::far::FilePlace;
use super::model::Reading;
use super::text_file::read_text;
use crate::scene::{Mesh, Triangle};
use crate::{Error, Result};
use glam::{DVec3, Vec2, Vec3};
use positions::Positions;
use statements::ObjText;
use std::collections::HashMap;
use std::path::Path;

/// A mesh and the names it refers to.
#[derive(Debug)]
pub(super) struct Obj {
    /// [`Triangle::material`] is 0 for none, else 1 + an index into `materials`.
    pub mesh: Mesh,
    /// Where the mesh lies in the file's coordinates.
    pub place: FilePlace,
    /// Names of the materials, with the line of their first use.
    pub materials: Vec<(String, usize)>,
    /// What follows `mtllib`, with its line.
    pub libraries: Vec<(String, usize)>,
    /// Materials, numbered like [`Triangle::material`], of faces that lack a texture coordinate, with the line of the first.
    pub without_uv: Vec<(usize, usize)>,
    /// By [`Reading::smooth`] faces share normals that would not share them otherwise.
    pub smoothed: bool,
    /// What was skipped or dropped.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file: all its groups in one mesh, polygons cut into triangles, zero-area triangles dropped.
///
/// # Errors
/// If the file cannot be read, a line of it is wrong, or no triangle is left.
pub(super) fn read(path: &Path, how: Reading) -> Result<Obj> {
    // The text itself is given up here: what follows takes as much memory again.
    let mut warnings = Vec::new();
    let mut text = statements::read(path, &read_text(path, &mut warnings)?)?;
    let smooth = how.smooth.map(f32::from_bits);
    let has_normals = text.faces.corners.iter().any(|[_, _, normal]| *normal > 0);
    let smooth = smooth.filter(|_| !how.smooth_if_unsaid || !has_normals && !text.says_smoothing);
    if smooth.is_some() && has_normals {
        let path = path.display();
        warnings.push(format!("{path}: `smooth` is ignored: the file has vertex normals of its own (vn)"));
    }
    let (made, smoothed) = match smooth {
        Some(degrees) if !has_normals => {
            let (made, smoothed) = text.faces.normals_by_angle(&text.positions, degrees);
            // Normals that nobody asked for and that change nothing cost memory and time.
            if smoothed || !how.smooth_if_unsaid { (made, smoothed) } else { (Vec::new(), false) }
        }
        _ => (text.faces.normals_by_group(&text.positions), false),
    };
    fill_gaps(&mut text, &made);
    drop(made);
    let vertices = text.positions.len();
    let colours = std::mem::take(&mut text.colours).resolve(vertices, path, &mut warnings);
    let colours = if how.without_colours { Vec::new() } else { colours };
    let (mut mesh, place, lost) = build(&mut text, &colours);
    mesh.name = file_name(path);
    text.faults.warn(path, &mut warnings);
    text.contents.warn(path, &mut warnings);
    if mesh.triangles.is_empty() {
        let why = match lost.no_area + lost.flattened {
            0 => format!("it has no face with 3 or more corners (there are {} in it)", text.contents.instead(vertices)),
            n if lost.flattened > 0 => format!(
                "all of its {n} triangles have zero area, {} of them because they are too small for single precision so far \
                 from the middle of the file",
                lost.flattened
            ),
            n => format!("all of its {n} triangles have zero area"),
        };
        // What was skipped may be why.
        let skipped: String = warnings.iter().map(|warning| format!("\n  {warning}")).collect();
        return Err(Error::scene(path, format!("nothing to trace: {why}{skipped}")));
    }
    lost.warn(path, &mesh, &mut warnings);
    let ObjText { materials, libraries, without_uv, .. } = text;
    Ok(Obj { mesh, place, materials, libraries, without_uv, smoothed, warnings })
}

/// Triangles that are not what the file says.
#[derive(Debug, Default)]
struct Lost {
    /// Zero-area triangles, which are left out.
    no_area: usize,
    /// Triangles that single precision makes zero-area ones, which are left out.
    flattened: usize,
    /// Triangles of which it knows an edge to no better than a part in 64.
    blurred: usize,
}

impl Lost {
    /// An edge of fewer steps of single precision is blurred.
    const STEPS: f64 = 64.0;
    /// So many blurred triangles in a hundred are worth a warning: slivers are everywhere.
    const PERCENT: usize = 1;

    fn warn(&self, path: &Path, mesh: &Mesh, warnings: &mut Vec<String>) {
        let path = path.display();
        if self.no_area > 0 {
            warnings.push(format!("{path}: {} zero-area triangle(s) dropped", self.no_area));
        }
        let (low, high) = mesh.bounds();
        let reach = low.abs().max(high.abs()).max_element();
        let step = reach * f32::EPSILON;
        let cause = format!(
            "the mesh reaches {reach:.3e} from its middle or origin, where single precision has steps of {step:.1e}; \
             split it, or leave out what lies far off"
        );
        if self.flattened > 0 {
            warnings.push(format!("{path}: {} triangle(s) are dropped that are too small: {cause}", self.flattened));
        }
        if 100 * self.blurred > Self::PERCENT * mesh.triangles.len() {
            warnings.push(format!("{path}: details are lost, in {} triangle(s): {cause}", self.blurred));
        }
    }
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

/// The mesh of corners without gaps, where it lies, and what is left out of it. Takes the faces out of `text`, and adds to its faults.
/// `colours` are those of the file's vertices, if it has any.
fn build(text: &mut ObjText, colours: &[Vec3]) -> (Mesh, FilePlace, Lost) {
    let ObjText { positions, uvs, normals, faces, faults, .. } = text;
    let mut mesh = Mesh::default();
    let mut vertices = Vertices::of(positions.len());
    let (mut last, mut lost) = (0, Lost::default());
    let add = |material, corners: [[u32; 3]; 3]| {
        if material != last {
            vertices.end_sharing();
            last = material;
        }
        let places = corners.map(|[vertex, ..]| vertex as usize - 1);
        let [a, b, c] = places.map(|vertex| positions.at(vertex));
        // Vertices of what is left out stay, and keep their numbers.
        let vertices = corners.map(|corner| vertices.number(corner));
        if (b - a).cross(c - a) == DVec3::ZERO {
            let [a, b, c] = places.map(|vertex| positions.exact[vertex]);
            match (b - a).cross(c - a) == DVec3::ZERO {
                true => lost.no_area += 1,
                false => lost.flattened += 1,
            }
            return;
        }
        let least =
            [b - a, c - b, a - c].map(|edge| edge.abs().max_element()).into_iter().fold(f64::INFINITY, f64::min);
        let reach = a.abs().max(b.abs()).max(c.abs()).max_element();
        lost.blurred += usize::from(least < Lost::STEPS * f64::from(f32::EPSILON) * reach);
        mesh.triangles.push(Triangle { vertices, material });
    };
    std::mem::take(faces).cut(positions, add, |fault, line| faults.polygon(fault, line));
    mesh.positions = vertices.corners.iter().map(|[vertex, ..]| positions.rounded(*vertex as usize - 1)).collect();
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
    if !colours.is_empty() {
        mesh.colours = vertices.corners.iter().map(|[vertex, ..]| colours[*vertex as usize - 1]).collect();
    }
    (mesh, place(positions, &vertices), lost)
}

/// Where the mesh of these vertices lies.
fn place(positions: &Positions, vertices: &Vertices) -> FilePlace {
    let origin = positions.origin;
    let exact = match origin == DVec3::ZERO {
        true => Vec::new(),
        false => vertices.corners.iter().map(|[vertex, ..]| positions.exact[*vertex as usize - 1]).collect(),
    };
    FilePlace { origin, exact }
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
    fn of(positions: usize) -> Self {
        Vertices { corners: Vec::new(), first: vec![0; positions], others: HashMap::new(), begin: 0 }
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
