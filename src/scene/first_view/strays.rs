//! Where a scene is, apart from a few vertices that lie far from all others.

use super::visit::{for_points, for_some_points, for_triangles, points};
use crate::scene::Scene;
use glam::DVec3;

/// Bins along an axis.
const BINS: usize = 64;
/// Strays are beyond a gap of so many bins,
const GAP: usize = 40;
/// and so few of the vertices.
const FEW: f64 = 0.03;
/// Axes times the strays that one scene may have on both their sides.
const ROUNDS: usize = 12;
/// Vertices that are counted.
const COUNTED: usize = 200_000;

/// The bounds of a scene's vertices, without strays.
pub(super) fn bounds_without(scene: &Scene) -> (DVec3, DVec3) {
    let mut within = (DVec3::NEG_INFINITY, DVec3::INFINITY);
    let mut bounds = bounds_within(scene, within);
    for _ in 0..ROUNDS {
        let Some((axis, from, to)) = without_strays(scene, bounds) else { break };
        (within.0[axis], within.1[axis]) = (from, to);
        bounds = bounds_within(scene, within);
    }
    bounds
}

fn bounds_within(scene: &Scene, within: (DVec3, DVec3)) -> (DVec3, DVec3) {
    let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for_points(scene, &mut |p| {
        if p.cmpge(within.0).all() && p.cmple(within.1).all() {
            bounds = (bounds.0.min(p), bounds.1.max(p));
        }
    });
    bounds
}

/// An axis, and where along it what is no stray begins and ends; none if there are no strays.
fn without_strays(scene: &Scene, (low, high): (DVec3, DVec3)) -> Option<(usize, f64, f64)> {
    let mut counts = [[0u64; BINS]; 3];
    let scale = BINS as f64 / (high - low);
    let mut all = 0;
    let step = points(scene).div_ceil(COUNTED).max(1);
    for_some_points(scene, step, &mut |p| {
        if p.cmpge(low).all() && p.cmple(high).all() {
            all += 1;
            for axis in 0..3 {
                counts[axis][(((p[axis] - low[axis]) * scale[axis]) as usize).min(BINS - 1)] += 1;
            }
        }
    });
    let few = |count: u64| (count as f64) < FEW * all as f64;
    (0..3).filter(|axis| high[*axis] > low[*axis]).find_map(|axis| {
        let counts = &counts[axis];
        let (mut longest, mut run) = (0..0, 0..0);
        for (bin, count) in counts.iter().enumerate() {
            run = if *count == 0 { run.start..bin + 1 } else { bin + 1..bin + 1 };
            if run.len() > longest.len() {
                longest = run.clone();
            }
        }
        let before: u64 = counts[..longest.start].iter().sum();
        let middle = low[axis] + (longest.start + longest.end) as f64 / 2.0 / scale[axis];
        let kept = match (few(before), few(all - before)) {
            _ if longest.len() < GAP => return None,
            (true, _) => (axis, middle, high[axis]),
            (_, true) => (axis, low[axis], middle),
            _ => return None,
        };
        // What reaches over the gap is no stray, as the walls around a thing.
        let mut is_bridged = false;
        for_triangles(scene, 0.0, &mut |corners, _| {
            let sides = corners.map(|corner| corner[axis] < middle);
            is_bridged |= sides.contains(&true) && sides.contains(&false);
        });
        (!is_bridged).then_some(kept)
    })
}
