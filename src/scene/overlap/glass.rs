//! Glass that touches other surfaces: of two surfaces in one place a ray meets one, leaves it by what it rounds by, and is past the other.
//!
//! What is meant is that they touch, and a hair between them looks the same: a body of glass is drawn in there, so that it stays closed, and a thin pane
//! goes off what it lies on.

use super::contact::{Separation, Surfaces, margin, separation, told_apart};
use super::doubled::doubled;
use super::edits::Edits;
use super::face::{Face, Relation};
use super::pull::Depth;
use super::report::Found;
use super::search::{Near, select};
use crate::scene::{Material, Scene};
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// Glass of more triangles is not compared with anything.
const MOST_GLASS: usize = 1 << 21;
/// Faces whose normals enclose an angle of a smaller cosine lie in no plane.
const PARALLEL: f64 = 0.99;

/// What was found of glass, each a warning.
#[derive(Debug, Default)]
struct Report {
    bodies: Found,
    panes: Found,
    stuck: Found,
    panes_in_one_place: Found,
}

/// The faces that are compared, and what becomes of them.
struct Parter<'a> {
    scene: &'a Scene,
    faces: Vec<Face>,
    /// By face of a body: how far it is drawn in.
    depths: BTreeMap<usize, Depth>,
    /// By face of a pane: how far it moves, to its outward side, or to the other if that is negative.
    shifts: BTreeMap<usize, f64>,
    /// Faces that stay where they are, of which there is a warning.
    told: BTreeSet<usize>,
    report: Report,
}

impl Scene {
    /// Parts glass by a hair from what it touches, and says what it did, one sentence each: faces of closed bodies that lie in the plane of others are
    /// drawn in, and thin panes moved off. [`load`](fn@crate::scene::load) has called this already, behind
    /// [`merge_overlapping_lamps`](Self::merge_overlapping_lamps).
    pub fn part_touching_glass(&mut self) -> Vec<String> {
        let path = self.path.display().to_string();
        let Some(faces) = select(self, Material::transmits, MOST_GLASS) else {
            return vec![format!(
                "{path}: there are more than {MOST_GLASS} triangles of glass, so that nobody looks whether they touch others; where they do, \
                 which of the two is met first is left to rounding"
            )];
        };
        if faces.is_empty() {
            return Vec::new();
        }
        let near = Near::new(&faces, (0..faces.len()).collect(), margin);
        let mut parter = Parter {
            scene: self,
            faces,
            depths: BTreeMap::new(),
            shifts: BTreeMap::new(),
            told: BTreeSet::new(),
            report: Report::default(),
        };
        let searched = parter.compare(&near);
        let mut edits = Edits::default();
        for (index, depth) in &parter.depths {
            let face = &parter.faces[*index];
            edits.pull(face.object, face.triangle, *depth);
        }
        for (index, by) in &parter.shifts {
            let face = &parter.faces[*index];
            edits.shift(face.object, face.triangle, *by);
        }
        let plan = edits.plan(self);
        if let Some(copies) = plan.too_many(self) {
            return vec![format!(
                "{path}: glass touches other triangles, in instances that would each need a mesh of its own, of {copies} triangles together; all \
                 are left as they are: there, which of the two is met first is left to rounding; leave a gap"
            )];
        }
        let Parter { faces, depths, mut report, .. } = parter;
        let number: BTreeMap<(u32, u32), usize> =
            depths.keys().map(|index| ((faces[*index].object, faces[*index].triangle), *index)).collect();
        for place in plan.stuck() {
            report.stuck.add(1, || faces[number[&place]].describe(self));
            report.bodies.count -= 1;
        }
        let mut sentences = report.sentences(&path);
        if !searched {
            sentences.push(format!(
                "{path}: too many triangles lie close to glass to compare all of them; where it touches others, which of the two is met first is \
                 left to rounding"
            ));
        }
        if report.bodies.count + report.panes.count > 0 {
            plan.apply(self);
        }
        sentences
    }
}

impl Parter<'_> {
    fn material(&self, face: &Face) -> &Material {
        &self.scene.materials[face.material as usize]
    }

    /// Finds what lies in one plane; false if there is too much to look at all.
    fn compare(&mut self, near: &Near) -> bool {
        let scene = self.scene;
        let mut touching: Vec<(usize, usize, Relation, Separation)> = Vec::new();
        // Only what is no plane exactly asks for them.
        let surfaces = OnceCell::new();
        let mut searched = near.each_pair(|earlier, later| {
            if let Some((relation, separation)) = self.between(later, earlier, &surfaces) {
                touching.push((later, earlier, relation, separation));
            }
        });
        let others: Vec<bool> = scene.materials.iter().map(|material| !material.transmits()).collect();
        searched &= near.each_other(
            scene,
            &others,
            |_| true,
            |other, near| {
                for index in near {
                    let face = &self.faces[*index];
                    if let Some((_, separation)) = contact(face, &other)
                        && separation.is_within(told_apart(scene, face, &other))
                    {
                        self.on_another(*index, &other, separation);
                    }
                }
            },
        );
        let like =
            touching.iter().filter(|(a, b, ..)| self.may_be_one(*a, *b)).flat_map(|(a, b, ..)| [*a, *b]).collect();
        let doubled = doubled(&self.faces, &like);
        // Of two of glass the later one gives way, so that the earlier one's place is known.
        touching.sort_unstable_by_key(|(later, earlier, ..)| (*later, *earlier));
        for (later, earlier, relation, separation) in touching {
            let surface = doubled.contains(&later) && doubled.contains(&earlier);
            // What becomes of a body that is there twice: nothing. The check of bodies says so.
            let twice = self.may_be_one(later, earlier)
                && (surface || relation == Relation::Same && self.same_way(later, earlier));
            if !twice {
                self.on_glass(later, earlier, separation);
            }
        }
        searched
    }

    /// How two faces of glass lie, if they touch, and how far the earlier one is from the later.
    fn between(&self, later: usize, earlier: usize, surfaces: &OnceCell<Surfaces>) -> Option<(Relation, Separation)> {
        let (face, other) = (&self.faces[later], &self.faces[earlier]);
        let (relation, separation) = contact(face, other)?;
        if separation == Separation::NONE {
            return Some((relation, separation));
        }
        let near = told_apart(self.scene, face, other);
        let bodies = !self.material(face).thin && !self.material(other).thin;
        let touch = if bodies && !self.same_way(later, earlier) {
            // A body that reaches into another one is met before that is left.
            let side_by_side = || {
                let surfaces = surfaces.get_or_init(|| Surfaces::new(&self.faces));
                surfaces.are_side_by_side(&self.faces, later, earlier)
            };
            separation.least < near && (face.material != other.material || side_by_side())
        } else {
            separation.is_within(near)
        };
        touch.then_some((relation, separation))
    }

    fn same_way(&self, a: usize, b: usize) -> bool {
        self.faces[a].normal.dot(self.faces[b].normal) > 0.0
    }

    /// Whether two faces that lie on each other may be the same face of one body, listed twice.
    fn may_be_one(&self, a: usize, b: usize) -> bool {
        let (face, other) = (&self.faces[a], &self.faces[b]);
        let bodies = !self.material(face).thin;
        bodies && face.material == other.material && (face.object == other.object || self.same_way(a, b))
    }

    /// Says of a face, once, that it is left as it is.
    fn leave(&mut self, kind: impl Fn(&mut Report) -> &mut Found, index: usize) {
        if self.told.insert(index) {
            kind(&mut self.report).add(1, || self.faces[index].describe(self.scene));
        }
    }

    /// What becomes of a face of glass that touches one that lets no light through.
    fn on_another(&mut self, index: usize, other: &Face, separation: Separation) {
        let needed = self.faces[index].needed(self.scene, other);
        if self.material(&self.faces[index]).thin {
            self.move_pane(index, other, needed, separation);
        } else {
            self.draw_in(index, needed, separation.overlap());
        }
    }

    /// What becomes of a face of glass that touches an earlier one of glass.
    fn on_glass(&mut self, later: usize, earlier: usize, separation: Separation) {
        let (face, other) = (self.faces[later].clone(), self.faces[earlier].clone());
        let needed = face.needed(self.scene, &other);
        match (self.material(&face).thin, self.material(&other).thin) {
            (false, true) => self.draw_in(later, needed, separation.overlap()),
            (true, false) => {
                let separation = separation.of_the_other(self.same_way(later, earlier));
                self.draw_in(earlier, needed, separation.overlap());
            }
            (true, true) if face.material == other.material => {
                self.leave(|report| &mut report.panes_in_one_place, later);
            }
            (true, true) => self.move_pane(later, &other, needed, separation),
            (false, false) => {
                let behind = self.depths.get(&earlier).copied().filter(|_| self.same_way(later, earlier));
                self.draw_in(later, needed, separation.overlap() + behind.map_or(0.0, |depth| depth.usual));
            }
        }
    }

    /// Draws a face of a body in at least so far, behind where something else is or goes to, which is so far behind the face.
    fn draw_in(&mut self, index: usize, needed: f64, behind: f64) {
        let face = &self.faces[index];
        let depth = Depth { usual: needed.max(face.usual_lift()) + behind, least: needed + behind };
        if !self.depths.contains_key(&index) {
            self.report.bodies.add(1, || face.describe(self.scene));
        }
        self.depths.entry(index).and_modify(|known| *known = known.max(depth)).or_insert(depth);
    }

    /// Moves a pane off a face, to the side to which that faces.
    fn move_pane(&mut self, index: usize, other: &Face, needed: f64, separation: Separation) {
        let face = &self.faces[index];
        let behind = separation.of_the_other(face.normal.dot(other.normal) > 0.0).overlap();
        let Some(by) = face.lift(needed + behind) else {
            self.leave(|report| &mut report.stuck, index);
            return;
        };
        let by = if face.normal.dot(other.normal) < 0.0 { -by } else { by };
        if !self.shifts.contains_key(&index) {
            self.report.panes.add(1, || face.describe(self.scene));
        }
        let known = self.shifts.entry(index).or_insert(by);
        *known = known.signum() * known.abs().max(by.abs());
    }
}

/// How two faces lie, and how far the other one is from the first; none of what is apart, or not even nearly parallel.
fn contact(face: &Face, other: &Face) -> Option<(Relation, Separation)> {
    if face.normal.dot(other.normal).abs() < PARALLEL {
        return None;
    }
    match face.relation(other) {
        Relation::Apart => separation(face, other).map(|separation| (Relation::Overlapping, separation)),
        relation => Some((relation, Separation::NONE)),
    }
}

impl Report {
    fn sentences(&self, path: &str) -> Vec<String> {
        let kinds = [
            (
                &self.bodies,
                "of glass lie in the plane of others that they touch: their bodies are drawn in there by a hair, so that rays tell them apart",
            ),
            (
                &self.panes,
                "of thin panes lie in the plane of others: they are moved off by a hair, to the side to which those face",
            ),
            (
                &self.stuck,
                "of glass lie in the plane of others that they touch, and are left as they are, since to move them by what single precision tells apart there would show: their bodies are too thin, too far from the origin, or too small beside what they touch; which of the two is met first is left to rounding; leave a gap",
            ),
            (
                &self.panes_in_one_place,
                "of thin panes lie in the plane of others of the same material and cover a part of them: whether one of them is met or both is left to rounding; remove one, or move it",
            ),
        ];
        kinds.iter().filter_map(|(found, what)| found.sentence(path, what)).collect()
    }
}
