//! The faces of an OBJ file, and the vertex normals that are made from them.

use super::polygon::{self, Cut, Fault};
use crate::scene::load::text::Tally;
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

/// More faces than this at one point get no normal there by angle: each is compared with each.
const MOST_FACES_AT_A_POINT: usize = 16_384;

/// Faces with at least 3 corners.
#[derive(Debug, Default)]
pub(super) struct Faces {
    /// Indices of vertex, texture coordinate and normal, from 1; 0 for none.
    pub corners: Vec<[u32; 3]>,
    faces: Vec<Face>,
}

#[derive(Debug)]
struct Face {
    /// One past the last of its corners.
    end: u32,
    /// 0 for none, else 1 + an index.
    material: u32,
    /// 0 for none.
    smoothing_group: u32,
    /// In the file, for warnings.
    line: u32,
}

/// Polygons that are not what they should be.
#[derive(Debug, Default)]
pub(super) struct Faults {
    /// [`Fault::Tangled`].
    pub tangled: Tally,
    /// [`Fault::NotFlat`].
    pub not_flat: Tally,
    /// [`Fault::TooLarge`].
    pub too_large: Tally,
}

/// A corner, seen from the point at which it lies.
#[derive(Debug)]
struct Incident {
    corner: usize,
    smoothing_group: u32,
    /// Unit normal of the face; zero if it has no area.
    normal: DVec3,
    /// The angle of the face there: a sum with these weights does not depend on how a surface is cut into faces (Thürmer and
    /// Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998).
    angle: f64,
}

impl Faces {
    /// The corners that were added since the last face are the next one.
    pub(super) fn end_face(&mut self, material: u32, smoothing_group: u32, line: usize) {
        self.faces.push(Face { end: self.corners.len() as u32, material, smoothing_group, line: line as u32 });
    }

    /// A normal for each corner of a face that has a smoothing group and no normals of its own: the mean over the faces of the
    /// group at that point. Empty if there is no such face.
    pub(super) fn normals_by_group(&self, positions: &[Vec3]) -> Vec<Option<Vec3>> {
        let wants = |corners: &[[u32; 3]], face: &Face| {
            face.smoothing_group > 0 && corners.iter().all(|[_, _, normal]| *normal == 0)
        };
        if !self.iter().any(|(corners, face)| wants(corners, face)) {
            return Vec::new();
        }
        let mut normals = vec![None; self.corners.len()];
        for incidents in self.points(positions) {
            let mut sums: BTreeMap<u32, DVec3> = BTreeMap::new();
            for at in incidents.iter().filter(|at| at.smoothing_group > 0) {
                let part = at.angle * at.normal;
                sums.entry(at.smoothing_group).and_modify(|sum| *sum += part).or_insert(part);
            }
            for at in &incidents {
                let sum = sums.get(&at.smoothing_group);
                normals[at.corner] = sum.and_then(|sum| sum.try_normalize()).map(DVec3::as_vec3);
            }
        }
        let mut first = 0;
        for (corners, face) in self.iter() {
            if !wants(corners, face) {
                normals[first..first + corners.len()].fill(None);
            }
            first += corners.len();
        }
        normals
    }

    /// A normal for each corner: the mean over the faces at that point whose normals differ from this face's by less than so many
    /// degrees. Empty for 0.
    pub(super) fn normals_by_angle(&self, positions: &[Vec3], degrees: f32) -> Vec<Option<Vec3>> {
        if degrees <= 0.0 {
            return Vec::new();
        }
        let least_cosine = f64::from(degrees).to_radians().cos();
        let mut normals = vec![None; self.corners.len()];
        for incidents in self.points(positions).filter(|incidents| incidents.len() <= MOST_FACES_AT_A_POINT) {
            for this in &incidents {
                let near =
                    |other: &&Incident| other.corner == this.corner || other.normal.dot(this.normal) > least_cosine;
                let sum: DVec3 = incidents.iter().filter(near).map(|other| other.angle * other.normal).sum();
                normals[this.corner] = sum.try_normalize().map(DVec3::as_vec3);
            }
        }
        normals
    }

    /// `usemtl` and `f` lines; only polygons that a fan covers have more than three corners. `made` are further normals,
    /// appended to `vertices`; `totals` says how many vertices, texture coordinates and normals that text has. One past the last
    /// texture coordinate stands for none.
    pub(super) fn text(
        &self,
        positions: &[Vec3],
        totals: [usize; 3],
        made: &[Option<Vec3>],
        vertices: &mut String,
        faults: &mut Faults,
    ) -> String {
        const WRITES: &str = "writing to a string";
        let mut text = String::new();
        let has_normals = totals[2] > 0 || made.iter().any(Option::is_some);
        let mut known: HashMap<[u32; 3], usize> = HashMap::new();
        let mut index_of = |normal: Vec3| {
            let next = totals[2] + 1 + known.len();
            *known.entry(normal.to_array().map(f32::to_bits)).or_insert_with(|| {
                writeln!(vertices, "vn {} {} {}", normal.x, normal.y, normal.z).expect(WRITES);
                next
            })
        };
        let mut write = |text: &mut String, corner: usize| {
            let [vertex, uv, normal] = self.corners[corner];
            write!(text, " {vertex}").expect(WRITES);
            if totals[1] > 0 {
                let uv = if uv == 0 { totals[1] + 1 } else { uv as usize };
                write!(text, "/{uv}").expect(WRITES);
            }
            if has_normals {
                let normal = match (normal, made.get(corner).copied().flatten()) {
                    (0, normal) => index_of(normal.unwrap_or(Vec3::ZERO)),
                    (normal, _) => normal as usize,
                };
                write!(text, "{}/{normal}", if totals[1] > 0 { "" } else { "/" }).expect(WRITES);
            }
        };
        let (mut first, mut material) = (0, 0);
        let mut outline: Vec<DVec3> = Vec::new();
        for (corners, face) in self.iter() {
            if face.material != material {
                material = face.material;
                writeln!(text, "usemtl {}", material - 1).expect(WRITES);
            }
            let mut triangles = None;
            if corners.len() > 3 {
                outline.clear();
                outline.extend(corners.iter().map(|[vertex, ..]| positions[*vertex as usize - 1].as_dvec3()));
                let Cut { triangles: cut, fault } = polygon::cut(&outline);
                triangles = cut;
                match fault {
                    None => {}
                    Some(Fault::Tangled) => faults.tangled.add(face.line as usize),
                    Some(Fault::NotFlat) => faults.not_flat.add(face.line as usize),
                    Some(Fault::TooLarge) => faults.too_large.add(face.line as usize),
                }
            }
            match triangles {
                None => {
                    text.push('f');
                    (first..first + corners.len()).for_each(|corner| write(&mut text, corner));
                    text.push('\n');
                }
                Some(triangles) => {
                    for triangle in triangles {
                        text.push('f');
                        triangle.iter().for_each(|corner| write(&mut text, first + *corner as usize));
                        text.push('\n');
                    }
                }
            }
            first += corners.len();
        }
        text
    }

    /// Corners and all else of each face.
    fn iter(&self) -> impl Iterator<Item = (&[[u32; 3]], &Face)> {
        let mut first = 0;
        self.faces.iter().map(move |face| {
            let corners = &self.corners[first..face.end as usize];
            first = face.end as usize;
            (corners, face)
        })
    }

    /// The corners at each point. Vertices at the same place are one point, however often the file lists it.
    fn points(&self, positions: &[Vec3]) -> impl Iterator<Item = Vec<Incident>> {
        let mut index: HashMap<[u32; 3], usize> = HashMap::new();
        let mut points: Vec<Vec<Incident>> = Vec::new();
        let mut first = 0;
        for (corners, face) in self.iter() {
            let at = |corner: usize| positions[corners[corner % corners.len()][0] as usize - 1];
            let point = |corner: usize| at(corner).as_dvec3();
            // Newell's method: the area vector of any polygon.
            let edge = |corner: usize| (point(corner) - point(0)).cross(point(corner + 1) - point(0));
            let normal = (1..corners.len() - 1).map(edge).sum::<DVec3>().normalize_or_zero();
            let count = corners.len();
            let steps = steps_to_others(count, |a, b| point(a) == point(b));
            for corner in 0..count {
                // Adding 0 makes -0 the same as 0.
                let bits = (at(corner) + Vec3::ZERO).to_array().map(f32::to_bits);
                // Some corners of a face may lie on each other, at the pole of a sphere for example.
                let here = point(corner);
                let [back, forth] = steps.get(corner).copied().unwrap_or([1; 2]);
                let edge = |other: usize| Some(point(other) - here).filter(|edge| *edge != DVec3::ZERO);
                let (before, after) = (edge(corner + count - back), edge(corner + forth));
                let angle = before.zip(after).map_or(0.0, |(a, b)| a.cross(b).length().atan2(a.dot(b)));
                let incident =
                    Incident { corner: first + corner, smoothing_group: face.smoothing_group, normal, angle };
                match index.get(&bits) {
                    Some(&index) => points[index].push(incident),
                    None => {
                        index.insert(bits, points.len());
                        points.push(vec![incident]);
                    }
                }
            }
            first += corners.len();
        }
        points.into_iter()
    }
}
/// For each of the corners of a face, how many steps back and forth it is to the nearest one that lies elsewhere, at most `count`; empty if that is one step
/// for all. In time proportional to the corners, however many lie on each other.
fn steps_to_others(count: usize, same: impl Fn(usize, usize) -> bool) -> Vec<[usize; 2]> {
    if !(0..count).any(|corner| same(corner, corner + 1)) {
        return Vec::new();
    }
    let mut steps = vec![[count; 2]; count];
    // Twice around, so that a run over the end is counted whole.
    for i in 0..2 * count {
        let (corner, before) = (i % count, (i + count - 1) % count);
        steps[corner][0] = if same(before, before + 1) { (steps[before][0] + 1).min(count) } else { 1 };
        let corner = count - 1 - corner;
        let after = (corner + 1) % count;
        steps[corner][1] = if same(corner, corner + 1) { (steps[after][1] + 1).min(count) } else { 1 };
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_on_each_other_are_stepped_over() {
        let steps = |places: &[u32]| {
            let count = places.len();
            steps_to_others(count, |a, b| places[a % count] == places[b % count])
        };
        assert!(steps(&[1, 2, 3]).is_empty());
        assert_eq!(steps(&[1, 1, 2]), [[1, 2], [2, 1], [1, 1]]);
        // The run goes over the end.
        assert_eq!(steps(&[7, 1, 2, 7]), [[2, 1], [1, 1], [1, 1], [1, 2]]);
        assert_eq!(steps(&[4; 3]), [[3; 2]; 3]);
    }
}
