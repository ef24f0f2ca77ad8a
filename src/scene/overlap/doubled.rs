//! Whole surfaces that are there twice, told from bodies that touch in some faces.

use super::face::Face;
use std::collections::{HashMap, HashSet};

/// A place, as bits.
type Place = [u64; 3];

/// Of faces that lie on others like them, those that do so with all of their surface: they, and all that share edges with them, and so on. `on_others`
/// are numbers of `faces`; surfaces end with their object.
pub(super) fn doubled(faces: &[Face], on_others: &HashSet<usize>) -> HashSet<usize> {
    if on_others.is_empty() {
        return HashSet::new();
    }
    let objects: HashSet<u32> = on_others.iter().map(|index| faces[*index].object).collect();
    let edges = |face: &Face| {
        let [a, b, c] = face.corners.map(|p| (p + 0.0).to_array().map(f64::to_bits));
        [(a, b), (b, c), (c, a)].map(|(a, b): (Place, Place)| (face.object, a.min(b), a.max(b)))
    };
    let mut at_edge: HashMap<(u32, Place, Place), Vec<usize>> = HashMap::new();
    for index in on_others {
        edges(&faces[*index]).into_iter().for_each(|edge| at_edge.entry(edge).or_default().push(*index));
    }
    // Whoever is beside a face that lies on nothing is of a surface that does not, either.
    let mut left = on_others.clone();
    let others = (0..faces.len()).filter(|index| !on_others.contains(index) && objects.contains(&faces[*index].object));
    let mut beside: Vec<usize> = others.collect();
    while let Some(index) = beside.pop() {
        for edge in edges(&faces[index]) {
            let neighbours = at_edge.get_mut(&edge).map(std::mem::take).unwrap_or_default();
            beside.extend(neighbours.into_iter().filter(|neighbour| left.remove(neighbour)));
        }
    }
    left
}
