//! Lamps that lie on each other, and what else must not lie in one place twice: double-sided exports, an object listed twice, a quad cut along
//! both diagonals.
//!
//! Light sampling finds each of two lamps in one place, and a ray only one of them; so their light would be counted twice by one way of finding
//! it and once by the other. What is meant is one lamp, and one is left.

mod edits;
mod face;
mod union;

use self::edits::Edits;
use self::face::{Face, Relation};
use self::union::{MOST_UNITED, union};
use super::{Maps, Material, Scene, widen};
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
/// Triangles of meshes that are made anew.
const MOST_COPIED: usize = 50_000_000;

/// Something that was found, how often, and where first.
#[derive(Debug, Default)]
struct Found {
    count: usize,
    first: String,
}

/// What was found, each a warning.
#[derive(Debug, Default)]
struct Report {
    same: Found,
    veils: Found,
    united: Found,
    back_to_back: Found,
    other_light: Found,
    apart: Found,
    hidden: Found,
    unresolved: Found,
    undecided: Found,
    unsearched: bool,
}

/// The triangles that are compared, and what becomes of them.
struct Merger<'a> {
    scene: &'a Scene,
    faces: Vec<Face>,
    /// By face: another one stands for it.
    dropped: Vec<bool>,
    /// By face: it is one-sided, and from now on shines both ways.
    both_ways: Vec<bool>,
    /// By face: it is moved off its plane, to its outward side.
    lifted: Vec<bool>,
    /// Faces of one light that overlap, as a forest: the parent of each.
    parent: Vec<usize>,
    report: Report,
}

impl Scene {
    /// Leaves one lamp where several lie on each other, and says what it did, one sentence each: lamps that emit the same become one; of others the
    /// first shows; one-sided lamps back to back go on shining each its own way. Partly transparent triangles in one place become one, too, and
    /// what does not emit goes where it lies exactly on a lamp. [`load`](super::load) has called this already.
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
            lifted: vec![false; count],
            parent: (0..count).collect(),
            report: Report::default(),
        };
        merger.exactly_equal();
        let mut edits = Edits::default();
        merger.compare(&mut edits);
        merger.unite(&mut edits);
        let Merger { faces, dropped, both_ways, lifted, report, .. } = merger;
        let mut two_sided: BTreeMap<u32, u32> = BTreeMap::new();
        let mut materials = Vec::new();
        for (index, face) in faces.iter().enumerate() {
            if dropped[index] {
                edits.remove(face.object, face.triangle);
                continue;
            }
            if lifted[index] {
                edits.shift(face.object, face.triangle, face.normal * face.lift());
            }
            if both_ways[index] {
                let next = (self.materials.len() + materials.len()) as u32;
                let material = *two_sided.entry(face.material).or_insert(next);
                if material == next {
                    materials.push(Material { one_sided: false, ..self.materials[face.material as usize].clone() });
                }
                edits.give(face.object, face.triangle, material);
            }
        }
        let path = self.path.display().to_string();
        if edits.copies(self) > MOST_COPIED {
            return vec![format!(
                "{path}: lamps lie on each other in so many instances that they are left as they are: their light is counted twice"
            )];
        }
        self.materials.extend(materials);
        edits.apply(self);
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
        if !self.emits(other) {
            if self.alike(first, other) {
                self.dropped[other] = true;
                self.note(|report| &mut report.veils, 1, &face, "");
            }
            return;
        }
        let opposite = self.faces[first].normal.dot(face.normal) < 0.0;
        let back_to_back = opposite && self.one_sided(first) && self.one_sided(other);
        let alike = self.alike(first, other);
        if back_to_back && !alike {
            self.lifted[first] = true;
            self.lifted[other] = true;
            self.note(|report| &mut report.apart, 1, &face, "");
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
        let opposite = self.faces[a].normal.dot(self.faces[b].normal) < 0.0;
        if opposite && self.one_sided(a) && self.one_sided(b) {
            self.lifted[a] = true;
            self.lifted[b] = true;
            let face = self.faces[b].clone();
            self.note(|report| &mut report.apart, 1, &face, "");
        } else if self.alike(a, b) && self.one_sided(a) == self.one_sided(b) && self.is_plain(a) && self.is_plain(b) {
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
        material.maps == Maps::default() && flat && (mesh.colours.is_empty() || material.lambert == Vec3::ZERO)
    }

    fn root(&mut self, mut face: usize) -> usize {
        while self.parent[face] != face {
            self.parent[face] = self.parent[self.parent[face]];
            face = self.parent[face];
        }
        face
    }

    /// Puts what faces of one light cover together in their place.
    fn unite(&mut self, edits: &mut Edits) {
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for index in (0..self.faces.len()).filter(|index| !self.dropped[*index]).collect::<Vec<_>>() {
            groups.entry(self.root(index)).or_default().push(index);
        }
        for group in groups.into_values().filter(|group| group.len() > 1) {
            let faces: Vec<&Face> = group.iter().map(|index| &self.faces[*index]).collect();
            let united = if group.len() > MOST_UNITED { None } else { union(&faces) };
            let (lamp, other) = (faces[0].clone(), faces[1].clone());
            // Where a one-sided lamp shines both ways, the new triangles would need its new material.
            let united = united.filter(|_| !group.iter().any(|index| self.both_ways[*index]));
            let Some(united) = united else {
                self.note(|report| &mut report.unresolved, group.len(), &other, "");
                continue;
            };
            let lifted = group.iter().any(|index| self.lifted[*index]);
            let by = if lifted { lamp.normal * lamp.lift() } else { DVec3::ZERO };
            united.iter().for_each(|t| edits.add(lamp.object, t.map(|corner| corner + by), lamp.material));
            group.iter().for_each(|index| self.dropped[*index] = true);
            self.note(|report| &mut report.united, group.len(), &other, "");
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
        let mut budget = MOST_OTHERS;
        for (object_index, object) in (0..).zip(&scene.objects) {
            let mesh = &scene.meshes[object.mesh as usize];
            if object.material.is_some_and(|material| !dark[material as usize]) {
                continue;
            }
            let to_world = widen(object.object_to_world);
            if scene.objects.len() > 1 {
                let (low, high) = mesh.bounds();
                let corners: Vec<_> = (0..8)
                    .map(|k| {
                        let pick = |axis: usize| f64::from(if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
                        to_world.transform_point3(DVec3::new(pick(0), pick(1), pick(2))).as_vec3a()
                    })
                    .collect();
                if !Aabb::from_points(&corners).intersect_aabb(&bounds) {
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
                    near.len() < PAIRS
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
                if let Some((lamp, relation)) = found.iter().min_by_key(|(_, r)| *r != Relation::Same) {
                    self.on_a_lamp(*lamp, &face, *relation, edits);
                }
            }
        }
    }

    /// What becomes of a triangle that does not emit and lies on a lamp.
    fn on_a_lamp(&mut self, lamp: usize, face: &Face, relation: Relation, edits: &mut Edits) {
        let passes = self.scene.materials[face.material as usize].transmission != Vec3::ZERO;
        // One side of a body of glass has to stay where it is.
        if relation == Relation::Overlapping || passes {
            self.note(|report| &mut report.undecided, 1, face, "");
        } else if self.one_sided(lamp) && self.faces[lamp].normal.dot(face.normal) < 0.0 {
            // The back of a lamp: behind it.
            edits.shift(face.object, face.triangle, -self.faces[lamp].normal * face.lift());
            self.note(|report| &mut report.apart, 1, face, "");
        } else {
            edits.remove(face.object, face.triangle);
            self.note(|report| &mut report.hidden, 1, face, "");
        }
    }
}

impl Report {
    /// A warning for each kind of thing that was found.
    fn sentences(&self, path: &str) -> Vec<String> {
        let kinds = [
            (&self.same, "that emit lie on others of the same light: they are dropped, and the light is counted once"),
            (&self.united, "that emit cover each other in a plane: they are cut anew so that each place emits once"),
            (
                &self.back_to_back,
                "of one-sided lamps lie back to back with others of the same light: they are dropped, and the others shine both ways",
            ),
            (
                &self.apart,
                "lie back to back with one-sided lamps: both are moved apart by a hair, so that each side shows its own",
            ),
            (
                &self.other_light,
                "that emit lie on others of another light, of which only one can be seen: the first counts, and they are dropped",
            ),
            (&self.hidden, "that do not emit lie exactly on lamps: they are dropped, and the lamps show"),
            (
                &self.veils,
                "that are partly transparent lie on others of the same material: they are dropped, so that the opacity counts once",
            ),
            (
                &self.unresolved,
                "that emit lie in the plane of other lamps and cover a part of them: where they overlap, the light is counted twice; cut or move them",
            ),
            (
                &self.undecided,
                "that do not emit lie in the plane of lamps and cover a part of them: which of the two is seen is left to rounding; move one of them",
            ),
        ];
        let mut sentences: Vec<String> = kinds
            .iter()
            .filter(|(found, _)| found.count > 0)
            .map(|(Found { count, first }, what)| format!("{path}: {count} triangle(s) {what} ({first})"))
            .collect();
        if self.unsearched {
            sentences.push(format!(
                "{path}: too many lamps lie close together to compare all of them; light may be counted twice where they overlap"
            ));
        }
        sentences
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
