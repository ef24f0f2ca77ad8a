//! Whether a scene has so many lamps that it pays to choose among them by place.

use super::light_tree::Source;
use std::collections::HashMap;

/// So many triangles and points are several lamps, even where they hang together: from a point much of them is not seen, or far away.
const MANY: usize = 64;

/// Whether there are several lamps: points, and triangles that do not hang together by their corners; or very many triangles.
pub(super) fn several_lamps(sources: &[Source]) -> bool {
    if sources.len() >= MANY {
        return true;
    }
    // Which lamp has a corner; joined where two turn out to be one.
    let mut lamp: Vec<usize> = (0..sources.len()).collect();
    let mut at = HashMap::new();
    for (index, source) in sources.iter().enumerate() {
        for corner in source.corners {
            // Zero of either sign is one place.
            let key = (corner + 0.0).to_array().map(f32::to_bits);
            let other = *at.entry(key).or_insert(index);
            let (own, other) = (lamp[index], lamp[other]);
            lamp.iter_mut().filter(|lamp| **lamp == other).for_each(|lamp| *lamp = own);
        }
    }
    lamp.iter().any(|other| *other != lamp[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    fn triangle(corners: [[f32; 3]; 3]) -> Source {
        Source { entry: 0, corners: corners.map(Vec3::from), normal: DVec3::Y, two_sided: true, strength: 1.0 }
    }

    #[test]
    fn a_square_is_one_lamp_and_two_points_are_two() {
        let a = triangle([[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
        let b = triangle([[1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [-0.0, 1.0, 0.0]]);
        let c = triangle([[5.0, 1.0, 1.0], [6.0, 1.0, 1.0], [0.0, 1.0, 1.0]]);
        let apart = triangle([[5.0, 2.0, 1.0]; 3]);
        assert!(!several_lamps(std::slice::from_ref(&a)));
        assert!(!several_lamps(&[a.clone(), b.clone()]));
        // Those between come last.
        assert!(!several_lamps(&[a.clone(), c.clone(), b.clone()]));
        assert!(several_lamps(&[a.clone(), c]));
        assert!(several_lamps(&[a.clone(), b, apart]));
        assert!(several_lamps(&vec![a; MANY]));
    }
}
