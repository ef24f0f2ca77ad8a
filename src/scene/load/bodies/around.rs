//! What glass is around a point: the solid angle of all faces, over that of a sphere (van Oosterom and Strackee 1983).

use super::glass::{Face, Glass, SAME_INDEX, Use};
use super::seams::{Part, Seams};
use crate::scene::{Object, Scene, moved_box, widen};
use glam::{DAffine3, DVec3};
use std::collections::HashSet;
use std::f64::consts::PI;

/// Bodies that are inside out of which it is found out whether they are hollows in another: one at a time costs all triangles around it.
const MOST_HOLLOWS: usize = 16;
/// Of a body, so many points are tested: it may reach into another one.
const POINTS: usize = 4;

/// The closed bodies of glass.
pub(super) struct Bodies<'a> {
    scene: &'a Scene,
    uses: &'a [Use],
    seams: &'a Seams,
    /// By use and object, its box in world space; none where it is closed by others only, and points outside of its box are within the body.
    boxes: Vec<Vec<Option<[DVec3; 2]>>>,
}

impl<'a> Bodies<'a> {
    pub fn new(scene: &'a Scene, uses: &'a [Use], seams: &'a Seams) -> Self {
        let shared: HashSet<usize> = seams.closed.iter().map(|(object, _)| *object).collect();
        let boxes = uses.iter().map(|of| {
            let mesh = scene.objects[of.objects[0]].mesh;
            let (low, high) = scene.meshes[mesh as usize].bounds();
            let place = |object: &usize| {
                let map = widen(scene.objects[*object].object_to_world);
                (!shared.contains(object)).then(|| moved_box([low, high].map(|corner| corner.as_dvec3()), &map))
            };
            of.objects.iter().map(place).collect()
        });
        Self { scene, uses, seams, boxes: boxes.collect() }
    }

    /// The objects around a point of world space, by how much each does to the logarithm of the index of refraction there.
    pub fn index_at(&self, point: DVec3) -> Vec<(usize, f64)> {
        let around = self.around(point, |face| face.index, &HashSet::new());
        around.into_iter().filter(|(_, index)| index.abs() > 0.5 * SAME_INDEX).collect()
    }

    /// How many bodies that are inside out are no hollows of others: by use the number and the materials, and the same for those of several objects.
    pub fn inside_out(&self) -> Vec<(Vec<usize>, usize, Vec<u32>)> {
        let mut found = Vec::new();
        for of in self.uses {
            let surfaces = of.glass.inside_out();
            let object = of.objects[0];
            let lost: Vec<u32> = surfaces
                .into_iter()
                .take(MOST_HOLLOWS)
                .filter(|surface| !self.is_hollow(&HashSet::from([(object, *surface)])))
                .collect();
            if let Some(surface) = lost.first() {
                let faces = &of.glass.faces;
                let materials = of.glass.materials((0..faces.len()).filter(|face| faces[*face].surface == *surface));
                found.push((of.objects.clone(), lost.len(), materials));
            }
        }
        for body in self.seams.joined.iter().take(MOST_HOLLOWS) {
            let body: HashSet<Part> = body.iter().copied().collect();
            let (volume, usual) = self.volume(&body);
            if usual && volume < 0.0 && !self.is_hollow(&body) {
                let mut objects: Vec<usize> = body.iter().map(|(object, _)| *object).collect();
                objects.sort_unstable();
                objects.dedup();
                let mut materials: Vec<u32> = self.faces(&body).map(|(_, _, face)| face.material).collect();
                materials.sort_unstable();
                materials.dedup();
                found.push((objects, 1, materials));
            }
        }
        found
    }

    /// The faces of a body, with their glass and their object's number.
    fn faces<'b>(&'b self, body: &'b HashSet<Part>) -> impl Iterator<Item = (usize, &'b Glass, &'b Face)> {
        let objects: HashSet<usize> = body.iter().map(|(object, _)| *object).collect();
        let of_body = self.uses.iter().flat_map(move |of| {
            let objects: Vec<usize> = of.objects.iter().copied().filter(|object| objects.contains(object)).collect();
            objects.into_iter().map(move |object| (object, &of.glass))
        });
        of_body
            .flat_map(|(object, glass)| glass.faces.iter().map(move |face| (object, glass, face)))
            .filter(|(object, _, face)| body.contains(&(*object, face.surface)))
    }

    /// The signed volume of a body in world space, and whether all of its faces have an index above 1. None is known of flat ones.
    fn volume(&self, body: &HashSet<Part>) -> (f64, bool) {
        let (mut volume, mut size, mut usual) = (0.0, 0.0, true);
        let mut origin = None;
        for (object, glass, face) in self.faces(body) {
            let map = widen(self.scene.objects[object].object_to_world);
            let [a, b, c] = glass.corners(face).map(|corner| map.transform_point3(corner));
            let origin = *origin.get_or_insert(a);
            let of_face = (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
            volume += of_face * map.matrix3.determinant().signum();
            size += of_face.abs();
            usual &= face.index > 0.0;
        }
        (if volume.abs() > 1e-6 * size { volume } else { 0.0 }, usual)
    }

    /// Whether a body that is inside out is a hollow in other glass.
    fn is_hollow(&self, body: &HashSet<Part>) -> bool {
        let count = self.faces(body).count();
        // Some points of it: it may reach into another body.
        self.faces(body).step_by(count.div_ceil(POINTS)).all(|(object, glass, face)| {
            let map = widen(self.scene.objects[object].object_to_world);
            let [a, b, c] = glass.corners(face);
            let point = map.transform_point3((a + b + c) / 3.0);
            let sign = |face: &Face| if face.index < 0.0 { -1.0 } else { 1.0 };
            self.around(point, sign, body).iter().map(|(_, around)| around).sum::<f64>() > 0.5
        })
    }

    /// The sum of the closed surfaces around a point, each with the weight of its faces, by object; without those of one body.
    fn around(&self, point: DVec3, weight: impl Fn(&Face) -> f64, without: &HashSet<Part>) -> Vec<(usize, f64)> {
        let inside = |[low, high]: [DVec3; 2]| point.cmpge(low).all() && point.cmple(high).all();
        let mut around = Vec::new();
        for (of, boxes) in self.uses.iter().zip(&self.boxes) {
            let near = of.objects.iter().zip(boxes).filter(|(_, bounds)| bounds.is_none_or(inside));
            for (&object, _) in near {
                let counts = |surface: u32| {
                    let closed = !of.glass.is_loose[surface as usize] || self.seams.closed.contains(&(object, surface));
                    closed && !without.contains(&(object, surface))
                };
                let counts: Vec<bool> = (0..of.glass.is_loose.len() as u32).map(counts).collect();
                let place: &Object = &self.scene.objects[object];
                let map: DAffine3 = widen(place.object_to_world);
                let faces = of.glass.faces.iter().filter(|face| counts[face.surface as usize]);
                let angle = faces.map(|face| {
                    let corners = of.glass.corners(face).map(|corner| map.transform_point3(corner));
                    weight(face) * solid_angle(corners, point)
                });
                let angle = angle.sum::<f64>() * map.matrix3.determinant().signum();
                around.push((object, angle / (4.0 * PI)));
            }
        }
        around
    }
}

/// The solid angle of a triangle, positive where its corners are counter-clockwise from outside and the point is behind it.
pub(super) fn solid_angle(corners: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = corners.map(|corner| (corner - point).normalize_or_zero());
    2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
