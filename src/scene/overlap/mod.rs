//! Lamps that lie on each other, and what else must not lie in one place twice: double-sided exports, an object listed twice, a quad cut along
//! both diagonals.
//!
//! Light sampling finds each of two lamps in one place, and a ray only one of them; so their light would be counted twice by one way of finding
//! it and once by the other. What is meant is one lamp, and one is left.

mod edits;
mod face;
mod report;
mod union;

use self::edits::Edits;
use self::face::{Face, Relation};
use self::report::{Found, Report};
use self::union::{MOST_UNITED, union};
use super::rounding::across;
use super::{Maps, Material, Scene, moved_box, widen};
use glam::{DVec3, Vec3};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use std::collections::{BTreeMap, HashMap};

/// Partly transparent triangles are compared in scenes of at most so many: instanced trees have more leaves than memory has room for.
const MOST_LEAVES: usize = 1 << 22;
/// Pairs of triangles that are compared, for each triangle: neighbours have about a dozen.
const PAIRS: usize = 64;
/// Other triangles that are compared with the lamps.
const MOST_OTHERS: usize = 50_000_000;
/// A group with more pairs that overlap is left as it is, but for eight for each triangle: it is no lamp but a tangle.
const MOST_OVERLAPS: usize = 20_000;
/// Pairs of triangles of one group that are compared.
const MOST_IN_GROUP: usize = 1 << 22;
/// Triangles of meshes that are made anew: as many as the scene has, or if it has few, so many.
const MOST_COPIED: usize = 1 << 18;

/// The triangles that are compared, and what becomes of them.
struct Merger<'a> {
    scene: &'a Scene,
    faces: Vec<Face>,
    /// By face: another one stands for it.
    dropped: Vec<bool>,
    /// By face: it is one-sided, and from now on shines both ways.
    both_ways: Vec<bool>,
    /// By face: how far it is moved off its plane, to its outward side, and to both sides if it shines both ways.
    lift: Vec<f64>,
    /// By face: there is a warning of it already, as of one that is left as it is.
    told: Vec<bool>,
    /// Materials that only differ by which sides shine: the new ones, and by the old one's number and sides the new one's.
    variants: Vec<Material>,
    variant_of: BTreeMap<(u32, bool), u32>,
    /// Faces of one light that overlap, as a forest: the parent of each.
    parent: Vec<usize>,
    /// By face: with how many later ones of its light it overlaps.
    overlaps: Vec<u32>,
    report: Report,
}

impl Scene {
    /// Leaves one lamp where several lie on each other, and says what it did, one sentence each: lamps that emit the same become one; of others the
    /// first shows; one-sided lamps back to back go on shining each its own way. Partly transparent triangles in one place become one, too, and
    /// what does not emit goes where it lies exactly on a lamp. [`load`](fn@super::load) has called this already.
    pub fn merge_overlapping_lamps(&mut self) -> Vec<String> {
        let faces = faces(self);
        if faces.is_empty() {
            return Vec::new();
        }
        let count = faces.len();
        let mut merger = Merger {
            scene: self,
            faces,
            dropped: vec![false; count],
            both_ways: vec![false; count],
            lift: vec![0.0; count],
            told: vec![false; count],
            variants: Vec::new(),
            variant_of: BTreeMap::new(),
            parent: (0..count).collect(),
            overlaps: vec![0; count],
            report: Report::default(),
        };
        merger.exactly_equal();
        let mut edits = Edits::default();
        merger.compare(&mut edits);
        merger.unite(&mut edits);
        merger.edit(&mut edits);
        let Merger { report, variants, .. } = merger;
        let path = self.path.display().to_string();
        let plan = edits.plan(self);
        let copies = plan.copies(self);
        let own: usize = self.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        if copies > own.max(MOST_COPIED) {
            return vec![format!(
                "{path}: lamps lie on each other or in the plane of other triangles, in instances that would each need a mesh of its own, of \
                 {copies} triangles together; all are left as they are: there light is counted twice, or which is seen is left to rounding; \
                 make the lamps a mesh of their own, or move them"
            )];
        }
        self.materials.extend(variants);
        plan.apply(self);
        report.sentences(&path)
    }
}

/// All triangles that emit or are partly transparent.
fn faces(scene: &Scene) -> Vec<Face> {
    let emits = |m: &Material| m.emission != Vec3::ZERO;
    let leaves = |m: &Material| m.has_holes() && !emits(m);
    let mut faces = select(scene, emits, usize::MAX);
    if scene.materials.iter().any(leaves) {
        let count = faces.len();
        faces.extend(select(scene, leaves, MOST_LEAVES));
        if faces.len() > count {
            faces.sort_by_key(|face| (face.object, face.triangle));
        }
    }
    faces
}

/// The triangles whose material is of a kind; none if there are more than `most`.
fn select(scene: &Scene, kind: impl Fn(&Material) -> bool, most: usize) -> Vec<Face> {
    let chosen: Vec<bool> = scene.materials.iter().map(kind).collect();
    let mut faces = Vec::new();
    if !chosen.contains(&true) {
        return faces;
    }
    // Instances of a mesh choose the same triangles.
    let mut of_mesh: Vec<Option<Vec<u32>>> = vec![None; scene.meshes.len()];
    for (index, object) in (0..).zip(&scene.objects) {
        let mesh = &scene.meshes[object.mesh as usize];
        let to_world = widen(object.object_to_world);
        let mut face = |triangle: u32| {
            let material = object.material.unwrap_or(mesh.triangles[triangle as usize].material);
            faces.push(Face::new(index, triangle, mesh, &to_world, material));
        };
        match object.material {
            Some(material) if chosen[material as usize] => (0..mesh.triangles.len() as u32).for_each(&mut face),
            Some(_) => {}
            None => of_mesh[object.mesh as usize]
                .get_or_insert_with(|| {
                    let all = (0..).zip(&mesh.triangles);
                    all.filter(|(_, t)| chosen[t.material as usize]).map(|(index, _)| index).collect()
                })
                .iter()
                .copied()
                .for_each(&mut face),
        }
        if faces.len() > most {
            return Vec::new();
        }
    }
    faces
}

impl Merger<'_> {
    fn material(&self, face: usize) -> &Material {
        &self.scene.materials[self.faces[face].material as usize]
    }

    fn emits(&self, face: usize) -> bool {
        self.material(face).emission != Vec3::ZERO
    }

    /// Whether only its outward side shines.
    fn one_sided(&self, face: usize) -> bool {
        self.material(face).one_sided && !self.both_ways[face]
    }

    /// Whether two faces look the same, whichever is seen.
    fn alike(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.material(a), self.material(b));
        let unnamed = |m: &Material| Material { name: String::new(), ..m.clone() };
        std::ptr::eq(a, b) || unnamed(a) == unnamed(b)
    }

    /// Whether light goes through a lamp, beside what its opacity lets pass: its faces have to stay where they are.
    fn transmits(&self, face: usize) -> bool {
        self.material(face).transmits()
    }

    /// How far a triangle has to be moved off one in whose plane it lies, so that rays tell them apart: the bounds on the rounding of both.
    /// None if it would be seen to have moved.
    fn gap(&self, moved: &Face, other: &Face) -> Option<f64> {
        let rounding = |face: &Face| across(self.scene, face.object, face.triangle, face.corners).0;
        moved.lift(rounding(moved) + rounding(other) + moved.tolerance(other))
    }

    /// Moves a lamp at least so far.
    fn raise(&mut self, lamp: usize, by: f64) {
        self.lift[lamp] = self.lift[lamp].max(by);
    }

    /// Moves two lamps apart that lie in a plane, each to its own side.
    fn part(&mut self, a: usize, b: usize) {
        match (self.gap(&self.faces[a], &self.faces[b]), self.gap(&self.faces[b], &self.faces[a])) {
            (Some(of_a), Some(of_b)) => {
                self.raise(a, of_a);
                self.raise(b, of_b);
                let face = self.faces[b].clone();
                self.note(|report| &mut report.apart, 1, &face, "");
            }
            _ => self.leave(|report| &mut report.stuck, b),
        }
    }

    /// Says of a lamp, once, that it is left as it is.
    fn leave(&mut self, kind: impl Fn(&mut Report) -> &mut Found, lamp: usize) {
        if !std::mem::replace(&mut self.told[lamp], true) {
            let face = self.faces[lamp].clone();
            self.note(kind, 1, &face, "");
        }
    }

    /// Object, material and place of a face, for people.
    fn place_of(&self, face: &Face) -> String {
        let object = &self.scene.objects[face.object as usize].name;
        let material = &self.scene.materials[face.material as usize].name;
        let DVec3 { x, y, z } = face.centre() + self.scene.origin;
        format!("object `{object}`, material `{material}`, at ({x:.6} {y:.6} {z:.6})")
    }

    /// Counts `count` more of a kind, of which `face` is one.
    fn note(&mut self, kind: impl Fn(&mut Report) -> &mut Found, count: usize, face: &Face, more: &str) {
        if kind(&mut self.report).count == 0 {
            kind(&mut self.report).first = self.place_of(face) + more;
        }
        kind(&mut self.report).count += count;
    }

    /// Triangles whose corners are the same to the last bit: found by hashing, so that any number in one place takes no longer.
    fn exactly_equal(&mut self) {
        let mut first_at = HashMap::with_capacity(self.faces.len());
        // Behind the first of a place, those that could not be dropped.
        let mut kept_with: HashMap<usize, Vec<usize>> = HashMap::new();
        for index in 0..self.faces.len() {
            let first = *first_at.entry(self.faces[index].key()).or_insert(index);
            if first == index {
                continue;
            }
            self.equal(first, index);
            let kept = kept_with.entry(first).or_default();
            for other in
                kept.iter().copied().filter(|other| self.emits(*other) == self.emits(index)).collect::<Vec<_>>()
            {
                if !self.dropped[index] && self.alike(other, index) {
                    self.equal(other, index);
                }
            }
            if !self.dropped[index] {
                kept.push(index);
            }
        }
    }

    /// What becomes of two faces with the same corners, of which `other` is the later one.
    fn equal(&mut self, first: usize, other: usize) {
        if self.emits(first) != self.emits(other) {
            // As for every triangle that does not emit: when the lamps are known.
            return;
        }
        let face = self.faces[other].clone();
        let opposite = self.faces[first].normal.dot(face.normal) < 0.0;
        let alike = self.alike(first, other);
        // Where bodies of glass touch, both have to keep their surface.
        let one = alike && !(opposite && self.material(other).bends());
        if !self.emits(other) {
            if one {
                self.dropped[other] = true;
                self.note(|report| &mut report.veils, 1, &face, "");
            }
            return;
        }
        if !one && (self.transmits(first) || self.transmits(other)) {
            self.leave(|report| &mut report.glowing, other);
            return;
        }
        let back_to_back = opposite && self.one_sided(first) && self.one_sided(other);
        if back_to_back && !alike {
            self.part(first, other);
            return;
        }
        self.dropped[other] = true;
        if back_to_back {
            self.both_ways[first] = true;
            self.note(|report| &mut report.back_to_back, 1, &face, "");
        } else if alike {
            self.note(|report| &mut report.same, 1, &face, "");
        } else {
            let shown = format!("; `{}` shows", self.material(first).name);
            self.note(|report| &mut report.other_light, 1, &face, &shown);
        }
    }

    /// Compares what is left: first with each other, then the rest of the scene with the lamps.
    fn compare(&mut self, edits: &mut Edits) {
        let left: Vec<usize> = (0..self.faces.len()).filter(|index| !self.dropped[*index]).collect();
        let boxes: Vec<Aabb> = left.iter().map(|index| self.faces[*index].bounds()).collect();
        let bvh = build(&boxes);
        let mut pairs = PAIRS * left.len() + 1_000_000;
        for (place, &index) in left.iter().enumerate() {
            let mut near: Vec<usize> = Vec::new();
            visit(&bvh, boxes[place], |other| {
                near.extend((left[other] > index).then_some(left[other]));
                pairs = pairs.saturating_sub(1);
                pairs > 0
            });
            for other in near {
                if !self.dropped[index] && !self.dropped[other] {
                    match self.faces[index].relation(&self.faces[other]) {
                        Relation::Apart => {}
                        Relation::Same => self.equal(index, other),
                        Relation::Overlapping => self.overlapping(index, other),
                    }
                }
            }
        }
        self.report.unsearched = pairs == 0;
        self.compare_with_the_rest(&bvh, &left, edits);
    }

    /// What becomes of two faces that overlap in a plane.
    fn overlapping(&mut self, a: usize, b: usize) {
        if !self.emits(a) || !self.emits(b) {
            return;
        }
        if self.transmits(a) || self.transmits(b) {
            self.leave(|report| &mut report.glowing, if self.transmits(b) { b } else { a });
            return;
        }
        let opposite = self.faces[a].normal.dot(self.faces[b].normal) < 0.0;
        if opposite && self.one_sided(a) && self.one_sided(b) {
            self.part(a, b);
        } else if self.alike(a, b) && self.one_sided(a) == self.one_sided(b) {
            self.overlaps[a] += 1;
            let (a, b) = (self.root(a), self.root(b));
            self.parent[a.max(b)] = a.min(b);
        } else {
            let face = self.faces[b].clone();
            self.note(|report| &mut report.unresolved, 1, &face, "");
        }
    }

    /// Whether any other triangles of the plane could stand for it: it has no maps, and is flat.
    fn is_plain(&self, face: usize) -> bool {
        let of = &self.faces[face];
        let mesh = &self.scene.meshes[self.scene.objects[of.object as usize].mesh as usize];
        let material = self.material(face);
        let dark = material.lambert == Vec3::ZERO && material.glossy == Vec3::ZERO && !material.has_impulse();
        let flat = mesh.normals.is_empty() || dark || {
            let normals = mesh.triangles[of.triangle as usize].vertices.map(|v| mesh.normals[v as usize]);
            normals.iter().all(|n| n.distance(normals[0]) < 1e-3)
        };
        let uncoloured = mesh.colours.is_empty() || (material.lambert == Vec3::ZERO && material.ambient == Vec3::ZERO);
        material.maps == Maps::default() && flat && uncoloured
    }

    fn root(&mut self, mut face: usize) -> usize {
        while self.parent[face] != face {
            self.parent[face] = self.parent[self.parent[face]];
            face = self.parent[face];
        }
        face
    }

    /// Of faces of one light that overlap, leaves those that cover the whole by themselves, or puts in their place what they cover together.
    fn unite(&mut self, edits: &mut Edits) {
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for index in (0..self.faces.len()).filter(|index| !self.dropped[*index]).collect::<Vec<_>>() {
            groups.entry(self.root(index)).or_default().push(index);
        }
        for group in groups.into_values().filter(|group| group.len() > 1) {
            let faces: Vec<&Face> = group.iter().map(|index| &self.faces[*index]).collect();
            // The work of uniting grows with the crossings.
            let overlaps: usize = group.iter().map(|index| self.overlaps[*index] as usize).sum();
            let few = group.len() <= MOST_UNITED && overlaps <= MOST_OVERLAPS + 8 * group.len();
            let united = if few { union(&faces) } else { None };
            let other = faces[faces.len() - 1].clone();
            if let Some(kept) = united.as_ref().and_then(|united| self.cover(&group, united)) {
                let lift = self.highest(&group);
                kept.iter().filter(|_| lift > 0.0).for_each(|index| self.raise(*index, lift));
                group.iter().filter(|index| !kept.contains(index)).for_each(|index| self.dropped[*index] = true);
                self.note(|report| &mut report.same, group.len() - kept.len(), &other, "");
                continue;
            }
            let plain = group.iter().all(|index| self.is_plain(*index) && !self.both_ways[*index]);
            let Some(united) = united.filter(|_| plain) else {
                self.note(|report| &mut report.unresolved, group.len(), &other, "");
                continue;
            };
            let lamp = self.faces[group[0]].clone();
            let lift = self.highest(&group);
            let material = if lift > 0.0 { self.variant(lamp.material, true) } else { lamp.material };
            for [a, b, c] in united {
                edits.add(lamp.object, [a, b, c], material, lift);
                if lift > 0.0 && !self.one_sided(group[0]) {
                    edits.add(lamp.object, [a, c, b], material, lift);
                }
            }
            group.iter().for_each(|index| self.dropped[*index] = true);
            self.note(|report| &mut report.united, group.len(), &other, "");
        }
    }

    /// How far the faces of a group are moved off their plane.
    fn highest(&self, group: &[usize]) -> f64 {
        group.iter().map(|index| self.lift[*index]).fold(0.0, f64::max)
    }

    /// Faces of a group that cover what all of it covers, and do not overlap: the first ones for which there is room. None if these leave something
    /// out.
    fn cover(&self, group: &[usize], united: &[[DVec3; 3]]) -> Option<Vec<usize>> {
        let mut kept: Vec<usize> = Vec::new();
        let mut compared = 0;
        for &index in group {
            compared += kept.len();
            if compared > MOST_IN_GROUP {
                return None;
            }
            let room = |other: &usize| self.faces[index].relation(&self.faces[*other]) == Relation::Apart;
            if kept.iter().all(room) {
                kept.push(index);
            }
        }
        let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).length();
        let covered: f64 = kept.iter().map(|index| area(self.faces[*index].corners)).sum();
        let whole: f64 = united.iter().map(|triangle| area(*triangle)).sum();
        ((covered - whole).abs() <= 1e-5 * whole).then_some(kept)
    }

    /// The number of a material like this one, of which one side shines, or both.
    fn variant(&mut self, material: u32, one_sided: bool) -> u32 {
        let old = &self.scene.materials[material as usize];
        if old.one_sided == one_sided {
            return material;
        }
        let next = (self.scene.materials.len() + self.variants.len()) as u32;
        let number = *self.variant_of.entry((material, one_sided)).or_insert(next);
        if number == next {
            self.variants.push(Material { one_sided, ..old.clone() });
        }
        number
    }

    /// What follows from the decisions about single faces.
    fn edit(&mut self, edits: &mut Edits) {
        for index in 0..self.faces.len() {
            let face = self.faces[index].clone();
            if self.dropped[index] {
                edits.remove(face.object, face.triangle);
                continue;
            }
            let one_sided = self.one_sided(index);
            if self.lift[index] > 0.0 {
                edits.shift(face.object, face.triangle, self.lift[index]);
                if !one_sided {
                    let material = self.variant(face.material, true);
                    edits.give(face.object, face.triangle, material);
                    edits.turn(face.object, face.triangle, material);
                }
            } else if self.both_ways[index] {
                let material = self.variant(face.material, false);
                edits.give(face.object, face.triangle, material);
            }
        }
    }

    /// Triangles that do not emit, against the lamps.
    fn compare_with_the_rest(&mut self, bvh: &Bvh2, left: &[usize], edits: &mut Edits) {
        let lamps: Vec<usize> = left.iter().copied().filter(|index| self.emits(*index)).collect();
        if lamps.is_empty() {
            return;
        }
        let bounds = lamps.iter().map(|index| self.faces[*index].bounds()).reduce(|a, b| a.union(&b));
        let Some(bounds) = bounds else { return };
        let scene = self.scene;
        let dark: Vec<bool> = scene.materials.iter().map(|m| m.emission == Vec3::ZERO).collect();
        let (mut budget, mut pairs) = (MOST_OTHERS, MOST_OTHERS);
        for (object_index, object) in (0..).zip(&scene.objects) {
            let mesh = &scene.meshes[object.mesh as usize];
            if object.material.is_some_and(|material| !dark[material as usize]) {
                continue;
            }
            let to_world = widen(object.object_to_world);
            if scene.objects.len() > 1 {
                let (low, high) = mesh.bounds();
                let moved = moved_box([low, high].map(|corner| corner.as_dvec3()), &to_world);
                if !Aabb::from_points(&moved.map(|corner| corner.as_vec3a())).intersect_aabb(&bounds) {
                    continue;
                }
            }
            for (triangle_index, triangle) in (0..).zip(&mesh.triangles) {
                let material = object.material.unwrap_or(triangle.material);
                budget = budget.saturating_sub(1);
                if budget == 0 || !dark[material as usize] {
                    continue;
                }
                let corners = triangle
                    .vertices
                    .map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()).as_vec3a());
                let around = Aabb::from_points(&corners);
                if !around.intersect_aabb(&bounds) {
                    continue;
                }
                let mut near = Vec::new();
                visit(bvh, around, |place| {
                    near.push(left[place]);
                    pairs = pairs.saturating_sub(1);
                    pairs > 0
                });
                if near.is_empty() {
                    continue;
                }
                let face = Face::new(object_index, triangle_index, mesh, &to_world, material);
                let relation = |lamp: &usize| (*lamp, self.faces[*lamp].relation(&face));
                let found: Vec<_> = near
                    .iter()
                    .filter(|index| self.emits(**index) && !self.dropped[**index])
                    .map(relation)
                    .filter(|(_, relation)| *relation != Relation::Apart)
                    .collect();
                match found.iter().find(|(_, relation)| *relation == Relation::Same) {
                    Some((lamp, relation)) => self.on_a_lamp(*lamp, &face, *relation, edits),
                    None => found.iter().for_each(|(lamp, relation)| self.on_a_lamp(*lamp, &face, *relation, edits)),
                }
            }
        }
        self.report.unsearched |= budget == 0 || pairs == 0;
    }

    /// What becomes of a triangle that does not emit and lies on a lamp.
    fn on_a_lamp(&mut self, lamp: usize, face: &Face, relation: Relation, edits: &mut Edits) {
        if face.normal == DVec3::ZERO || self.faces[lamp].normal == DVec3::ZERO {
            // Nobody sees it.
            return;
        }
        if self.scene.materials[face.material as usize].transmits() {
            // One side of a body of glass has to stay where it is, and light goes on through it.
            self.note(|report| &mut report.undecided, 1, face, "");
        } else if self.transmits(lamp) {
            self.leave(|report| &mut report.glowing, lamp);
        } else if relation == Relation::Overlapping {
            // Two one-sided veils in the place of one would take away twice.
            if self.material(lamp).has_holes() && !self.one_sided(lamp) {
                self.leave(|report| &mut report.glowing, lamp);
            } else if let Some(by) = self.gap(&self.faces[lamp], face) {
                self.raise(lamp, by);
                self.note(|report| &mut report.in_plane, 1, face, "");
            } else {
                self.leave(|report| &mut report.stuck, lamp);
            }
        } else if self.one_sided(lamp) && self.faces[lamp].normal.dot(face.normal) < 0.0 {
            // The back of a lamp: behind it.
            if let Some(by) = self.gap(face, &self.faces[lamp]) {
                edits.shift(face.object, face.triangle, by);
                self.note(|report| &mut report.apart, 1, face, "");
            } else {
                self.leave(|report| &mut report.stuck, lamp);
            }
        } else {
            edits.remove(face.object, face.triangle);
            self.note(|report| &mut report.hidden, 1, face, "");
        }
    }
}

fn build(boxes: &[Aabb]) -> Bvh2 {
    let indices = (0..boxes.len() as u32).collect();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    builder.build(PlocSearchDistance::Minimum, boxes, indices, SortPrecision::U64, 0)
}

/// Calls `found` with the index of each box near to this one, until it returns false.
fn visit(bvh: &Bvh2, around: Aabb, mut found: impl FnMut(usize) -> bool) {
    bvh.aabb_traverse(around, |bvh, node| {
        let node = &bvh.nodes[node as usize];
        let first = node.first_index as usize;
        bvh.primitive_indices[first..first + node.prim_count as usize].iter().all(|index| found(*index as usize))
    });
}
