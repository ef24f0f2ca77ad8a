//! Triangles of a scene that has many, with their corners on a lattice.

use super::visit::{VISITED, for_triangles};
use crate::scene::Scene;
use glam::{DVec3, Vec3A};
use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

/// Steps from the middle to the side of the lattice that corners of a large scene are moved to.
const LATTICE: f32 = 64.0;
/// The last points of the lattice, where strays go.
const REACH: Vec3A = Vec3A::splat(4000.0);
/// Of them at most so many triangles are kept.
const KEPT: usize = 200_000;
/// With fewer than so many left, the scene has lost too much.
const FEW: usize = 1000;

/// Corners, and whether light passes.
pub(super) type Facet = ([Vec3A; 3], bool);

/// The triangles with their corners on a lattice, without those that lose their area: surfaces stay closed, and details are lost that a small
/// picture does not show either (vertex clustering: Rossignac and Borrel, "Multi-resolution 3D approximations", 1993). The lattice is made coarser
/// until they are few enough.
pub(super) fn simplified(scene: &Scene, unit: f64, to_here: impl Fn(DVec3) -> Vec3A + Copy) -> Vec<Facet> {
    let mut lattice = Lattice { steps: LATTICE, kept: Vec::new(), seen: HashSet::default() };
    for_triangles(scene, unit, &mut |corners, clear| lattice.add((corners.map(to_here), clear)));
    if lattice.kept.len() >= FEW {
        return lattice.kept;
    }
    // A cloud of specks: some of them stand for all.
    let step = (scene.triangle_count().min(VISITED) as usize).div_ceil(KEPT).max(1);
    let (mut specks, mut number) = (Vec::new(), 0);
    for_triangles(scene, unit, &mut |corners, clear| {
        if usize::is_multiple_of(number, step) {
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
