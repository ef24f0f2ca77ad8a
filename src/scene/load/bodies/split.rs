//! Corners that lie on edges of other faces: a large face may border on several small ones, as CAD programs write them.

use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Edges without a partner of which it is found out whether corners of other faces lie on them: each is held against the ends of all.
const MOST_SPLIT: usize = 4096;

/// For edges without a partner, the ends of others that lie on them, in order. `near`: how far off such a vertex may lie, for each edge.
pub(super) fn between(
    lonely: &HashSet<(u32, u32)>,
    place: impl Fn(u32) -> DVec3,
    near: impl Fn(u32, u32) -> f64,
) -> HashMap<(u32, u32), Vec<u32>> {
    let mut between = HashMap::new();
    if lonely.len() > MOST_SPLIT {
        return between;
    }
    let ends: HashSet<u32> = lonely.iter().flat_map(|&(a, b)| [a, b]).collect();
    for &(a, b) in lonely {
        let (start, along) = (place(a), place(b) - place(a));
        let length = along.length();
        let near = near(a, b);
        let mut on: Vec<(f64, u32)> = Vec::new();
        for &vertex in &ends {
            let at = (place(vertex) - start).dot(along) / length;
            let off = (start + at / length * along).distance(place(vertex));
            if at > near && at < length - near && off <= near {
                on.push((at, vertex));
            }
        }
        if !on.is_empty() {
            on.sort_by(|a, b| a.0.total_cmp(&b.0));
            between.insert((a, b), on.into_iter().map(|(_, vertex)| vertex).collect());
        }
    }
    between
}
