//! Lamps that lie on each other, and what else must not lie in one place twice: double-sided exports, an object listed twice, a quad cut along
//! both diagonals.
//!
//! Light sampling finds each of two lamps in one place, and a ray only one of them; so their light would be counted twice by one way of finding
//! it and once by the other. What is meant is one lamp, and one is left.

use super::edits::Edits;
use super::face::{Face, Relation};
use super::report::{Found, Report};
use super::search::{Near, select};
use crate::scene::sets::Sets;
use crate::scene::{Material, Scene};
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};

/// Partly transparent triangles are compared in scenes of at most so many: instanced trees have more leaves than memory has room for.
const MOST_LEAVES: usize = 1 << 22;

/// The triangles that are compared, and what becomes of them.
pub(super) struct Merger<'a> {
    pub scene: &'a Scene,
    pub faces: Vec<Face>,
    /// By face: another one stands for it.
    pub dropped: Vec<bool>,
    /// By face: it is one-sided, and from now on shines both ways.
    pub both_ways: Vec<bool>,
    /// By face: how far it is moved off its plane, to its outward side, and to both sides if it shines both ways.
    pub lift: Vec<f64>,
    /// By face: there is a warning of it already, as of one that is left as it is.
    told: Vec<bool>,
    /// Materials that only differ by which sides shine: the new ones, and by the old one's number and sides the new one's.
    variants: Vec<Material>,
    variant_of: BTreeMap<(u32, bool), u32>,
    /// Faces of one light that overlap are in one set.
    pub sets: Sets,
    /// By face: with how many later ones of its light it overlaps.
    pub overlaps: Vec<u32>,
    /// By face: earlier ones of another light, which cover a part of it.
    pub covered_by: BTreeMap<usize, Vec<usize>>,
    /// Triangles that do not emit, and lamps in their plane from which they cannot be told apart: these are cut out of them.
    pub cut_out: Vec<(Face, Vec<usize>)>,
    pub report: Report,
}

impl Scene {
    /// Leaves one lamp where several lie on each other, and says what it did, one sentence each: lamps that emit the same become one; of others the
    /// first shows; one-sided lamps back to back go on shining each its own way. Partly transparent triangles in one place become one, too, and
    /// what does not emit goes where it lies exactly on a lamp. [`load`](fn@crate::scene::load) has called this already.
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
            sets: Sets::new(count),
            overlaps: vec![0; count],
            covered_by: BTreeMap::new(),
            cut_out: Vec::new(),
            report: Report::default(),
        };
        merger.exactly_equal();
        let mut edits = Edits::default();
        merger.compare(&mut edits);
        merger.unite(&mut edits);
        merger.cut_out(&mut edits);
        merger.edit(&mut edits);
        let Merger { report, variants, .. } = merger;
        let path = self.path.display().to_string();
        let plan = edits.plan(self);
        if let Some(copies) = plan.too_many(self) {
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
    let leaves = |m: &Material| (m.has_holes() || m.is_sheet()) && !emits(m);
    let mut faces = select(scene, emits, usize::MAX).unwrap_or_default();
    if scene.materials.iter().any(leaves) {
        let count = faces.len();
        faces.extend(select(scene, leaves, MOST_LEAVES).unwrap_or_default());
        if faces.len() > count {
            faces.sort_by_key(|face| (face.object, face.triangle));
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
    pub fn one_sided(&self, face: usize) -> bool {
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

    /// How far a triangle has to be moved off one in whose plane it lies. None if it would be seen to have moved.
    fn gap(&self, moved: &Face, other: &Face) -> Option<f64> {
        moved.lift(moved.needed(self.scene, other))
    }

    /// Moves a lamp at least so far.
    pub fn raise(&mut self, lamp: usize, by: f64) {
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
    pub fn leave(&mut self, kind: impl Fn(&mut Report) -> &mut Found, lamp: usize) {
        if !std::mem::replace(&mut self.told[lamp], true) {
            let face = self.faces[lamp].clone();
            self.note(kind, 1, &face, "");
        }
    }

    /// Counts `count` more of a kind, of which `face` is one.
    pub fn note(&mut self, kind: impl Fn(&mut Report) -> &mut Found, count: usize, face: &Face, more: &str) {
        kind(&mut self.report).add(count, || face.describe(self.scene) + more);
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
        let near = Near::new(&self.faces, left, |_| 0.0);
        let searched = near.each_pair(|index, other| {
            if !self.dropped[index] && !self.dropped[other] {
                match self.faces[index].relation(&self.faces[other]) {
                    Relation::Apart => {}
                    Relation::Same => self.equal(index, other),
                    Relation::Overlapping => self.overlapping(index, other),
                }
            }
        });
        self.report.unsearched = !searched;
        self.compare_with_the_rest(&near, edits);
    }

    /// What becomes of two faces that overlap in a plane.
    fn overlapping(&mut self, a: usize, b: usize) {
        if !self.emits(a) || !self.emits(b) {
            return;
        }
        if self.transmits(a) || self.transmits(b) {
            // Glass gives way later.
            return;
        }
        let opposite = self.faces[a].normal.dot(self.faces[b].normal) < 0.0;
        if opposite && self.one_sided(a) && self.one_sided(b) {
            self.part(a, b);
        } else if self.alike(a, b) && self.one_sided(a) == self.one_sided(b) {
            self.overlaps[a] += 1;
            self.sets.join(a, b);
        } else if self.material(a).has_holes() {
            // What is behind it shows through.
            let face = self.faces[b].clone();
            self.note(|report| &mut report.unresolved, 1, &face, "");
        } else {
            self.covered_by.entry(b).or_default().push(a);
        }
    }

    /// The number of a material like this one, of which one side shines, or both.
    pub fn variant(&mut self, material: u32, one_sided: bool) -> u32 {
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
    fn compare_with_the_rest(&mut self, near: &Near, edits: &mut Edits) {
        let scene = self.scene;
        let dark: Vec<bool> = scene.materials.iter().map(|m| m.emission == Vec3::ZERO).collect();
        let lamps: Vec<bool> = (0..self.faces.len()).map(|index| self.emits(index)).collect();
        let searched = near.each_other(
            scene,
            &dark,
            |index| lamps[index],
            |face, near| {
                let relation = |lamp: &usize| (*lamp, self.faces[*lamp].relation(&face));
                let found: Vec<_> = near
                    .iter()
                    .filter(|index| !self.dropped[**index])
                    .map(relation)
                    .filter(|(_, relation)| *relation != Relation::Apart)
                    .collect();
                match found.iter().find(|(_, relation)| *relation == Relation::Same) {
                    Some((lamp, relation)) => self.on_a_lamp(*lamp, &face, *relation, edits),
                    None => found.iter().for_each(|(lamp, relation)| self.on_a_lamp(*lamp, &face, *relation, edits)),
                }
            },
        );
        self.report.unsearched |= !searched;
    }

    /// What becomes of a triangle that does not emit and lies on a lamp.
    fn on_a_lamp(&mut self, lamp: usize, face: &Face, relation: Relation, edits: &mut Edits) {
        if face.normal == DVec3::ZERO || self.faces[lamp].normal == DVec3::ZERO {
            // Nobody sees it.
            return;
        }
        if self.scene.materials[face.material as usize].transmits() || self.transmits(lamp) {
            // Glass gives way to what touches it, when the lamps are where they stay.
            return;
        }
        if relation == Relation::Overlapping {
            // Two one-sided veils in the place of one would take away twice.
            if self.material(lamp).has_holes() && !self.one_sided(lamp) {
                self.leave(|report| &mut report.glowing, lamp);
            } else if let Some(by) = self.gap(&self.faces[lamp], face) {
                self.raise(lamp, by);
                self.note(|report| &mut report.in_plane, 1, face, "");
            } else {
                match self.cut_out.last_mut() {
                    Some((last, lamps)) if (last.object, last.triangle) == (face.object, face.triangle) => {
                        lamps.push(lamp)
                    }
                    _ => self.cut_out.push((face.clone(), vec![lamp])),
                }
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
