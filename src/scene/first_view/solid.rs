//! The triangles of a scene as the search for a view sees them: in a unit of their own, few enough to be looked at quickly, in a tree.

use crate::scene::{Mesh, Scene, Triangle, moved_box, outward, widen};
use glam::{DAffine3, DVec3, Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

/// Scenes of at most so many triangles are looked at as they are.
const EXACT: u64 = 150_000;
/// Of what is simplified at most so many triangles are kept.
const KEPT: usize = 200_000;
/// The last points of the lattice, where strays go.
const REACH: Vec3A = Vec3A::splat(4000.0);
/// With fewer than so many left, what is simplified has lost too much.
const FEW: usize = 1000;
/// Triangles that are visited before instances are taken for their boxes, and beyond that, before some are left out.
const VISITED: u64 = 20_000_000;
/// An instance below this part of the scene is taken for its box, where there are too many triangles.
const SMALL: f64 = 0.02;
/// Steps from the middle to the side of the lattice that corners of a large scene are moved to.
const LATTICE: f32 = 64.0;

/// Corners, and whether light passes.
type Facet = ([Vec3A; 3], bool);

/// What a ray meets.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// Along the ray, in units of its direction.
    pub distance: f32,
    /// Whether the outward side is met.
    pub front: bool,
    /// Unit normal on the outward side.
    pub normal: Vec3A,
    /// A number of the triangle.
    pub triangle: u32,
}

/// The shape of a scene, mapped so that its bounds are within -1 to 1, and the largest extent is from -1 to 1. Strays are beyond that.
pub(super) struct Solid {
    /// What the middle of the bounds is in the scene.
    pub middle: DVec3,
    /// A unit here is so long in the scene.
    pub unit: f64,
    /// Half the extents of the bounds, without strays.
    pub half: Vec3A,
    triangles: Vec<RtTriangle>,
    /// By triangle: light passes it.
    clear: Vec<bool>,
    tree: Bvh2,
}

impl Solid {
    /// What lies within bounds, and all else, too; none if nothing has any extent.
    pub(super) fn new(scene: &Scene, (low, high): (DVec3, DVec3)) -> Option<Self> {
        let (middle, unit) = (0.5 * (low + high), 0.5 * (high - low).max_element());
        if !(unit > 0.0 && unit.is_finite()) {
            return None;
        }
        let mut kept: Vec<Facet> = Vec::new();
        let to_here = |p: DVec3| Vec3A::from(((p - middle) / unit).as_vec3());
        if scene.triangle_count() <= EXACT {
            for_triangles(scene, unit, &mut |corners, clear| kept.push((corners.map(to_here), clear)));
        } else {
            kept = simplified(scene, unit, &to_here);
        }
        kept.retain(|([a, b, c], _)| (*b - *a).cross(*c - *a) != Vec3A::ZERO);
        let triangles: Vec<RtTriangle> = kept.iter().map(|([a, b, c], _)| RtTriangle::new(*a, *b, *c)).collect();
        let clear = kept.iter().map(|(_, clear)| *clear).collect();
        if triangles.is_empty() {
            return None;
        }
        let indices = (0..triangles.len() as u32).collect();
        let mut builder = PlocBuilder::with_capacity(triangles.len());
        let tree = builder.build(PlocSearchDistance::Minimum, &triangles, indices, SortPrecision::U64, 0);
        let half = Vec3A::from((0.5 * (high - low) / unit).as_vec3());
        Some(Solid { middle, unit, half, triangles, clear, tree })
    }

    /// The first thing that a ray meets. Of two in one place the one that turns its outward side to the ray.
    pub(super) fn meet(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let [origin, direction] = [origin, direction].map(|v| Vec3A::from(v.as_vec3()));
        let (mut nearest, mut found, mut front) = (f32::INFINITY, 0, false);
        let mut hit = RayHit::none();
        self.tree.ray_traverse(Ray::new(origin, direction, 1e-5, f32::INFINITY), &mut hit, |ray, place| {
            let index = self.tree.primitive_indices[place];
            let triangle = &self.triangles[index as usize];
            let distance = triangle.intersect(ray);
            if distance <= nearest && distance < f32::INFINITY {
                let towards = triangle.ng.dot(direction) > 0.0;
                if distance < nearest || (towards, index) > (front, found) {
                    (nearest, found, front) = (distance, index, towards);
                }
            }
            distance
        });
        (nearest < f32::INFINITY).then(|| Hit {
            distance: nearest,
            front,
            normal: self.triangles[found as usize].compute_normal(),
            triangle: found,
        })
    }

    /// The first thing that a ray meets and cannot pass: panes are looked through.
    pub(super) fn meet_opaque(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        const MOST_PANES: u32 = 16;
        let mut passed = 0.0;
        for _ in 0..MOST_PANES {
            let mut hit = self.meet(origin + passed * direction, direction)?;
            if !self.clear[hit.triangle as usize] {
                hit.distance += passed as f32;
                return Some(hit);
            }
            passed += f64::from(hit.distance) + 1e-5;
        }
        None
    }

    /// How many triangles there are.
    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The corners of each triangle.
    pub(super) fn corners(&self) -> impl ExactSizeIterator<Item = [Vec3A; 3]> {
        self.triangles.iter().map(|t| [t.v0, t.v0 - t.e1, t.v0 + t.e2])
    }
}

/// Visits the vertices of all instances; of instances that are too many, the corners of their boxes.
pub(super) fn for_points(scene: &Scene, visit: &mut impl FnMut(DVec3)) {
    for_some_points(scene, 1, visit);
}

/// Visits each so manieth of the points.
pub(super) fn for_some_points(scene: &Scene, step: usize, visit: &mut impl FnMut(DVec3)) {
    let in_boxes = vertices(scene) > VISITED;
    let boxes: Vec<_> = scene.meshes.iter().map(|mesh| mesh.bounds()).collect();
    let mut skip = 0;
    for object in &scene.objects {
        let (mesh, to_world) = (&scene.meshes[object.mesh as usize], widen(object.object_to_world));
        if in_boxes {
            let (low, high) = boxes[object.mesh as usize];
            every(step, &mut skip, &box_corners(low, high, &to_world), |p| visit(*p));
        } else {
            every(step, &mut skip, &mesh.positions, |p| visit(to_world.transform_point3(p.as_dvec3())));
        }
    }
}

/// Visits each so manieth item, beginning with the one after `skip`, which afterwards says the same of the next items.
fn every<T>(step: usize, skip: &mut usize, items: &[T], visit: impl FnMut(&T)) {
    items.iter().skip(*skip).step_by(step).for_each(visit);
    let rest = items.len().saturating_sub(*skip);
    *skip = if rest > 0 { (step - rest % step) % step } else { *skip - items.len() };
}

/// How many points [`for_points`] visits.
pub(super) fn points(scene: &Scene) -> usize {
    let vertices = vertices(scene);
    if vertices > VISITED { 8 * scene.objects.len() } else { vertices as usize }
}

fn vertices(scene: &Scene) -> u64 {
    scene.objects.iter().map(|o| scene.meshes[o.mesh as usize].positions.len() as u64).sum()
}

/// Visits the corners of triangles, in the scene, counter-clockwise as seen from the outward side: of all triangles, if they are not too many.
pub(super) fn for_triangles(scene: &Scene, unit: f64, visit: &mut impl FnMut([DVec3; 3], bool)) {
    let all = scene.triangle_count();
    let boxes: Vec<_> = scene.meshes.iter().map(|mesh| mesh.bounds()).collect();
    let is_small = |object: &crate::scene::Object, to_world: &DAffine3| {
        let (low, high) = boxes[object.mesh as usize];
        let [low, high] = moved_box([low.as_dvec3(), high.as_dvec3()], to_world);
        all > VISITED && (high - low).max_element() < SMALL * unit
    };
    let whole: u64 = scene
        .objects
        .iter()
        .filter(|object| !is_small(object, &widen(object.object_to_world)))
        .map(|object| scene.meshes[object.mesh as usize].triangles.len() as u64)
        .sum();
    let step = whole.div_ceil(VISITED).max(1) as usize;
    for object in &scene.objects {
        let (mesh, to_world) = (&scene.meshes[object.mesh as usize], widen(object.object_to_world));
        let mirrored = to_world.matrix3.determinant() < 0.0;
        if is_small(object, &to_world) {
            let (low, high) = boxes[object.mesh as usize];
            let corners = box_corners(low, high, &to_world);
            for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
                for [a, b, c] in [[a, b, c], [a, c, d]] {
                    visit(if mirrored { [a, c, b] } else { [a, b, c] }.map(|i| corners[i]), false);
                }
            }
            continue;
        }
        for triangle in mesh.triangles.iter().step_by(step) {
            let [a, b, c] = triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
            let material = scene.material_of(object, triangle);
            let clear = material.transmits() || material.opacity < 0.5;
            visit(if mirrored != is_wound_inward(mesh, triangle) { [a, c, b] } else { [a, b, c] }, clear);
        }
    }
}

/// Whether the vertex normals say that the winding is clockwise as seen from outside.
fn is_wound_inward(mesh: &Mesh, triangle: &Triangle) -> bool {
    if mesh.normals.is_empty() {
        return false;
    }
    let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
    outward(mesh, triangle).dot((b - a).cross(c - a)) < 0.0
}

fn box_corners(low: Vec3, high: Vec3, to_world: &DAffine3) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let corner = Vec3::select(glam::BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), high, low);
        to_world.transform_point3(corner.as_dvec3())
    })
}

/// The triangles with their corners on a lattice, without those that lose their area: surfaces stay closed, and details are lost that a small
/// picture does not show either (vertex clustering: Rossignac and Borrel, "Multi-resolution 3D approximations", 1993). The lattice is made coarser
/// until they are few enough.
fn simplified(scene: &Scene, unit: f64, to_here: &impl Fn(DVec3) -> Vec3A) -> Vec<Facet> {
    let mut lattice = Lattice { steps: LATTICE, kept: Vec::new(), seen: HashSet::default() };
    for_triangles(scene, unit, &mut |corners, clear| lattice.add((corners.map(to_here), clear)));
    if lattice.kept.len() >= FEW {
        return lattice.kept;
    }
    // A cloud of specks: some of them stand for all.
    let step = (scene.triangle_count().min(VISITED) as usize).div_ceil(KEPT).max(1);
    let (mut specks, mut number) = (Vec::new(), 0);
    for_triangles(scene, unit, &mut |corners, clear| {
        if number % step == 0 {
            specks.push((corners.map(to_here), clear));
        }
        number += 1;
    });
    specks
}

/// Triangles between the points of a lattice.
struct Lattice {
    steps: f32,
    kept: Vec<Facet>,
    seen: HashSet<[u64; 2], BuildHasherDefault<Mix>>,
}

impl Lattice {
    fn add(&mut self, (corners, clear): Facet) {
        let mut points = corners.map(|p| (p * self.steps).round().clamp(-REACH, REACH));
        let [a, b, c] = points;
        if (b - a).cross(c - a) == Vec3A::ZERO {
            return;
        }
        // Fourteen bits a coordinate, which is at most half as large as that.
        let key = |p: Vec3A| p.to_array().iter().fold(0, |key, x| key << 14 | (x + f32::from(1u16 << 12)) as u64);
        // The same triangle may begin anywhere; the other way round it is another one.
        let first = (0..3).min_by_key(|i| key(points[*i])).unwrap_or(0);
        points.rotate_left(first);
        let [a, b, c] = points.map(key);
        if self.seen.insert([a | b << 42, b >> 22 | c << 20]) {
            self.kept.push((points.map(|p| p / self.steps), clear));
            if self.kept.len() > KEPT {
                self.steps *= 0.5;
                self.seen.clear();
                std::mem::take(&mut self.kept).into_iter().for_each(|facet| self.add(facet));
            }
        }
    }
}

/// A quick hash of numbers: with the one of the standard library this would take as long as all the rest.
#[derive(Default)]
pub(super) struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 29
    }

    fn write(&mut self, bytes: &[u8]) {
        for word in bytes.chunks(8) {
            let mut eight = [0; 8];
            eight[..word.len()].copy_from_slice(word);
            self.0 = (self.0.rotate_left(23) ^ u64::from_le_bytes(eight)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }
}
