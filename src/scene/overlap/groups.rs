//! Lamps of one light that overlap in a plane, cut anew so that each place emits once, and what lamps are cut out of.

use super::edits::Edits;
use super::face::{Face, Relation};
use super::lamps::Merger;
use super::union::{MOST_UNITED, Part, union};
use crate::scene::Mesh;
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// A group with more pairs that overlap is left as it is, but for eight for each triangle: it is no lamp but a tangle.
const MOST_OVERLAPS: usize = 20_000;
/// Pairs of triangles of one group that are compared.
const MOST_IN_GROUP: usize = 1 << 22;

impl Merger<'_> {
    /// Whether any other triangles of the plane could stand for it: it has no maps, and is flat.
    fn is_plain(&self, of: &Face) -> bool {
        let mesh: &Mesh = &self.scene.meshes[self.scene.objects[of.object as usize].mesh as usize];
        let material = &self.scene.materials[of.material as usize];
        let flat = mesh.normals.is_empty() || material.is_black() || {
            let normals = mesh.triangles[of.triangle as usize].vertices.map(|v| mesh.normals[v as usize]);
            normals.iter().all(|n| n.distance(normals[0]) < 1e-3)
        };
        let physical = material.physical.as_ref();
        let uncoloured = mesh.colours.is_empty()
            || (material.lambert == Vec3::ZERO && material.ambient == Vec3::ZERO && physical.is_none());
        // A brushed one lies along its texture coordinates.
        let mapped = material.has_maps() || physical.is_some_and(|p| p.anisotropy > 0.0);
        !mapped && flat && uncoloured
    }

    /// Of faces of one light that overlap, leaves those that cover the whole by themselves, or puts in their place what they cover together, without what
    /// earlier ones of another light cover.
    pub(super) fn unite(&mut self, edits: &mut Edits) {
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for index in (0..self.faces.len()).filter(|index| !self.dropped[*index]).collect::<Vec<_>>() {
            groups.entry(self.sets.of(index)).or_default().push(index);
        }
        for group in groups.into_values() {
            let none = Vec::new();
            let above = |index: &usize| self.covered_by.get(index).unwrap_or(&none);
            let cuts: usize = group.iter().map(|index| above(index).len()).sum();
            if group.len() == 1 && cuts == 0 {
                continue;
            }
            let part = |index: &usize| Part {
                face: &self.faces[*index],
                without: above(index).iter().map(|index| &self.faces[*index]).collect(),
            };
            // The work of uniting grows with the crossings.
            let overlaps: usize = group.iter().map(|index| self.overlaps[*index] as usize).sum();
            let few = group.len() <= MOST_UNITED && overlaps + cuts <= MOST_OVERLAPS + 8 * group.len();
            let united = if few { union(&group.iter().map(part).collect::<Vec<_>>()) } else { None };
            let other = self.faces[group[group.len() - 1]].clone();
            if cuts > 0 && united.as_ref().is_some_and(Vec::is_empty) {
                group.iter().for_each(|index| self.dropped[*index] = true);
                self.note(|report| &mut report.other_light, group.len(), &other, "");
                continue;
            }
            if let Some(kept) = united.as_ref().filter(|_| cuts == 0).and_then(|united| self.cover(&group, united)) {
                let lift = self.highest(&group);
                kept.iter().filter(|_| lift > 0.0).for_each(|index| self.raise(*index, lift));
                group.iter().filter(|index| !kept.contains(index)).for_each(|index| self.dropped[*index] = true);
                self.note(|report| &mut report.same, group.len() - kept.len(), &other, "");
                continue;
            }
            let plain = group.iter().all(|index| self.is_plain(&self.faces[*index]) && !self.both_ways[*index]);
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
            self.note(|report| if cuts > 0 { &mut report.cut } else { &mut report.united }, group.len(), &other, "");
        }
    }

    /// Cuts lamps out of triangles that do not emit, where they cannot be moved off their plane.
    pub(super) fn cut_out(&mut self, edits: &mut Edits) {
        for (face, lamps) in std::mem::take(&mut self.cut_out) {
            let without = lamps.iter().map(|lamp| &self.faces[*lamp]).collect();
            let few = self.is_plain(&face) && lamps.len() <= MOST_OVERLAPS;
            let left = if few { union(&[Part { face: &face, without }]) } else { None };
            let Some(left) = left else {
                lamps.iter().for_each(|lamp| self.leave(|report| &mut report.stuck, *lamp));
                continue;
            };
            edits.remove(face.object, face.triangle);
            left.iter().for_each(|corners| edits.add(face.object, *corners, face.material, 0.0));
            self.note(|report| &mut report.cut_out, 1, &face, "");
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
}
