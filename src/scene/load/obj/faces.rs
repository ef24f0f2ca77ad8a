//! The faces of an OBJ file, and the vertex normals that are made from them.

use super::positions::Positions;
use crate::scene::load::polygon::{self, Cut, Fault};
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};

/// More faces than this at one point get no normal there by angle: each is compared with each.
const MOST_FACES_AT_A_POINT: usize = 4096;

/// Unit normals that differ by less, single precision's rounding of the corners, are those of one plane.
const SAME_PLANE: f64 = 1e-5;

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

/// A corner, seen from the point at which it lies.
#[derive(Debug, Clone, Copy, Default)]
struct Incident {
    corner: u32,
    face: u32,
    /// The angle of the face there: a sum with these weights does not depend on how a surface is cut into faces (Thürmer and
    /// Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998).
    angle: f64,
}

/// The corners of all faces, sorted by the point at which they lie.
#[derive(Debug)]
struct Points {
    /// One point after the other.
    incidents: Vec<Incident>,
    /// For each point, one past the last of its incidents.
    ends: Vec<u32>,
    /// Unit normal of each face; zero if it has no area.
    normals: Vec<DVec3>,
}

impl Points {
    /// The corners at each point.
    fn iter(&self) -> impl Iterator<Item = &[Incident]> {
        let mut first = 0;
        self.ends.iter().map(move |end| {
            let incidents = &self.incidents[first..*end as usize];
            first = *end as usize;
            incidents
        })
    }
}

impl Faces {
    /// The corners that were added since the last face are the next one.
    pub(super) fn end_face(&mut self, material: u32, smoothing_group: u32, line: usize) {
        self.faces.push(Face { end: self.corners.len() as u32, material, smoothing_group, line: line as u32 });
    }

    /// A normal for each corner of a face that has a smoothing group and no normals of its own: the mean over the faces of the
    /// group at that point; zero for other corners. Empty if there is no such face.
    pub(super) fn normals_by_group(&self, positions: &Positions) -> Vec<Vec3> {
        let wants = |corners: &[[u32; 3]], face: &Face| {
            face.smoothing_group > 0 && corners.iter().all(|[_, _, normal]| *normal == 0)
        };
        if !self.iter().any(|(corners, face)| wants(corners, face)) {
            return Vec::new();
        }
        let mut normals = vec![Vec3::ZERO; self.corners.len()];
        let points = self.points(positions);
        for incidents in points.iter() {
            let mut sums: BTreeMap<u32, DVec3> = BTreeMap::new();
            let group = |at: &Incident| self.faces[at.face as usize].smoothing_group;
            for at in incidents.iter().filter(|at| group(at) > 0) {
                let part = at.angle * points.normals[at.face as usize];
                sums.entry(group(at)).and_modify(|sum| *sum += part).or_insert(part);
            }
            for at in incidents {
                let sum = sums.get(&group(at)).copied().unwrap_or_default();
                normals[at.corner as usize] = sum.normalize_or_zero().as_vec3();
            }
        }
        let mut first = 0;
        for (corners, face) in self.iter() {
            if !wants(corners, face) {
                normals[first..first + corners.len()].fill(Vec3::ZERO);
            }
            first += corners.len();
        }
        normals
    }

    /// A normal for each corner: the mean over the faces at that point whose normals differ from this face's by less than so many
    /// degrees; zero for none. Empty for 0 degrees. Also whether any two faces that lie in different planes share a normal.
    pub(super) fn normals_by_angle(&self, positions: &Positions, degrees: f32) -> (Vec<Vec3>, bool) {
        if degrees <= 0.0 {
            return (Vec::new(), false);
        }
        let mut bent = false;
        let least_cosine = f64::from(degrees).to_radians().cos();
        let mut normals = vec![Vec3::ZERO; self.corners.len()];
        let points = self.points(positions);
        let normal = |at: &Incident| points.normals[at.face as usize];
        for incidents in points.iter().filter(|incidents| incidents.len() <= MOST_FACES_AT_A_POINT) {
            for this in incidents {
                let near =
                    |other: &&Incident| other.corner == this.corner || normal(other).dot(normal(this)) > least_cosine;
                let sum: DVec3 = incidents.iter().filter(near).map(|other| other.angle * normal(other)).sum();
                let mean = sum.normalize_or_zero();
                bent |= mean.distance_squared(normal(this)) > SAME_PLANE * SAME_PLANE;
                normals[this.corner as usize] = mean.as_vec3();
            }
        }
        (normals, bent)
    }

    /// Calls `triangle` with the material and the corners of each triangle, face after face, and `fault` with what is wrong with
    /// a polygon and its line.
    pub(super) fn cut(
        &self,
        positions: &Positions,
        mut triangle: impl FnMut(u32, [[u32; 3]; 3]),
        mut fault: impl FnMut(Fault, usize),
    ) {
        let mut outline: Vec<DVec3> = Vec::new();
        for (corners, face) in self.iter() {
            let mut cut = Cut { triangles: None, fault: None };
            if corners.len() > 3 {
                outline.clear();
                outline.extend(corners.iter().map(|[vertex, ..]| positions.at(*vertex as usize - 1)));
                cut = polygon::cut(&outline);
            }
            if let Some(what) = cut.fault {
                fault(what, face.line as usize);
            }
            match cut.triangles {
                None => {
                    (2..corners.len()).for_each(|k| triangle(face.material, [corners[0], corners[k - 1], corners[k]]))
                }
                Some(triangles) => {
                    triangles.iter().for_each(|t| triangle(face.material, t.map(|corner| corners[corner as usize])));
                }
            }
        }
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
    fn points(&self, positions: &Positions) -> Points {
        let mut index: HashMap<[u32; 3], u32> = HashMap::new();
        let mut number = |position: Vec3| {
            let next = index.len() as u32;
            // Adding 0 makes -0 the same as 0.
            *index.entry((position + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
        };
        let point_of: Vec<u32> = (0..positions.len()).map(|vertex| number(positions.rounded(vertex))).collect();
        let mut ends = vec![0; index.len()];
        drop(index);
        let point_at = |[vertex, ..]: &[u32; 3]| point_of[*vertex as usize - 1] as usize;
        // Counting sort: how many corners lie at each point, then where they begin; that moves on with each that is filled in.
        self.corners.iter().for_each(|corner| ends[point_at(corner)] += 1);
        let mut sum = 0;
        ends.iter_mut().for_each(|end| sum += std::mem::replace(end, sum));
        let mut points = Points {
            incidents: vec![Incident::default(); self.corners.len()],
            ends,
            normals: Vec::with_capacity(self.faces.len()),
        };
        let mut first = 0;
        for (face, (corners, _)) in (0..).zip(self.iter()) {
            let point = |corner: usize| positions.at(corners[corner % corners.len()][0] as usize - 1);
            // Newell's method: the area vector of any polygon.
            let edge = |corner: usize| (point(corner) - point(0)).cross(point(corner + 1) - point(0));
            points.normals.push((1..corners.len() - 1).map(edge).sum::<DVec3>().normalize_or_zero());
            let count = corners.len();
            let steps = steps_to_others(count, |a, b| point(a) == point(b));
            for (corner, vertex) in corners.iter().enumerate() {
                // Some corners of a face may lie on each other, at the pole of a sphere for example.
                let here = point(corner);
                let [back, forth] = steps.get(corner).copied().unwrap_or([1; 2]);
                let edge = |other: usize| Some(point(other) - here).filter(|edge| *edge != DVec3::ZERO);
                let (before, after) = (edge(corner + count - back), edge(corner + forth));
                let angle = before.zip(after).map_or(0.0, |(a, b)| a.cross(b).length().atan2(a.dot(b)));
                let end = &mut points.ends[point_at(vertex)];
                points.incidents[*end as usize] = Incident { corner: (first + corner) as u32, face, angle };
                *end += 1;
            }
            first += count;
        }
        points
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
