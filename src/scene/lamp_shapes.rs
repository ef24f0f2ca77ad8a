//! Which of a scene's emissive triangles hang together, and which of these lamps are closed.

use super::light_tree::Source;
use super::sets::Sets;
use glam::DVec3;
use rayon::prelude::*;

/// Joins the triangles that share a corner to lamps, marks those of closed lamps of which both sides emit, and turns their normals outward:
/// from outside nobody sees an inner side. Returns how many lamps there are; a point is one.
pub(super) fn lamp_shapes(sources: &mut [Source]) -> usize {
    let corners = corner_numbers(sources);
    let mut lamps = Sets::new(sources.len());
    let mut first_with = vec![u32::MAX; corners.iter().flatten().max().map_or(0, |most| *most as usize + 1)];
    for (index, triangle) in corners.iter().enumerate() {
        for corner in triangle {
            let first = &mut first_with[*corner as usize];
            match *first {
                u32::MAX => *first = index as u32,
                other => lamps.join(index, other as usize),
            }
        }
    }
    // Every edge of a closed lamp is passed once each way.
    let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let mut all: Vec<[u32; 2]> = corners.iter().flat_map(|triangle| edges(*triangle)).collect();
    all.par_sort_unstable();
    let once = |edge: [u32; 2]| {
        let at = all.partition_point(|other| *other < edge);
        all.get(at) == Some(&edge) && all.get(at + 1) != Some(&edge)
    };
    let open: Vec<bool> = corners
        .par_iter()
        .map(|triangle| edges(*triangle).iter().any(|&[a, b]| a == b || !once([a, b]) || !once([b, a])))
        .collect();
    let mut volume = vec![0.0f64; sources.len()];
    for index in 0..sources.len() {
        let lamp = lamps.of(index);
        let from = sources[lamp].corners[0].as_dvec3();
        let [a, b, c] = sources[index].corners.map(|corner| corner.as_dvec3() - from);
        volume[lamp] += if open[index] { f64::NAN } else { a.dot(b.cross(c)) };
    }
    for (index, source) in sources.iter_mut().enumerate() {
        let volume = volume[lamps.of(index)];
        if source.two_sided && source.normal != DVec3::ZERO && volume.abs() > 0.0 {
            let [a, b, c] = source.corners.map(|corner| corner.as_dvec3());
            let outward = (b - a).cross(c - a) * volume.signum();
            source.closed = true;
            source.normal *= if source.normal.dot(outward) < 0.0 { -1.0 } else { 1.0 };
        }
    }
    (0..sources.len()).filter(|index| lamps.of(*index) == *index).count()
}

/// The corners of each triangle, numbered so that those in one place are one.
fn corner_numbers(sources: &[Source]) -> Vec<[u32; 3]> {
    let mut places: Vec<([u32; 3], u32)> = (0..)
        .zip(sources.iter().flat_map(|source| source.corners))
        // Zero of either sign is one place.
        .map(|(index, corner)| ((corner + 0.0).to_array().map(f32::to_bits), index))
        .collect();
    places.par_sort_unstable();
    let mut numbers = vec![[0; 3]; sources.len()];
    let mut number = 0;
    for (at, (place, index)) in places.iter().enumerate() {
        number += u32::from(at > 0 && places[at - 1].0 != *place);
        numbers[*index as usize / 3][*index as usize % 3] = number;
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn triangle(corners: [[f32; 3]; 3]) -> Source {
        let corners = corners.map(Vec3::from);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).as_dvec3().normalize_or_zero();
        Source { entry: 0, corners, normal, two_sided: true, closed: false, cone: None, strength: 1.0 }
    }

    #[test]
    fn a_square_is_one_lamp_and_two_points_are_two() {
        let a = triangle([[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
        let b = triangle([[1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [-0.0, 1.0, 0.0]]);
        let c = triangle([[5.0, 1.0, 1.0], [6.0, 1.0, 1.0], [0.0, 1.0, 1.0]]);
        let apart = triangle([[5.0, 2.0, 1.0]; 3]);
        let count = |sources: &[&Source]| {
            let mut sources: Vec<Source> = sources.iter().map(|source| (*source).clone()).collect();
            let count = lamp_shapes(&mut sources);
            assert!(sources.iter().all(|source| !source.closed));
            count
        };
        assert_eq!(count(&[&a]), 1);
        assert_eq!(count(&[&a, &b]), 1);
        // That between comes last.
        assert_eq!(count(&[&a, &c, &b]), 1);
        assert_eq!(count(&[&a, &c]), 2);
        assert_eq!(count(&[&a, &apart, &b, &apart]), 2);
    }

    /// A tetrahedron and its mirror image: closed, and outward is outward; with a hole, with a side turned over, or one-sided they are as before.
    #[test]
    fn a_body_is_closed() {
        let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let body = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]].map(triangle);
        let inside_out = [[o, x, y], [o, z, x], [o, y, z], [x, z, y]].map(triangle);
        for mut sources in [body.clone(), inside_out] {
            assert_eq!(lamp_shapes(&mut sources), 1);
            for source in &sources {
                let outward = source.corners[0].as_dvec3() - DVec3::splat(0.2);
                assert!(source.closed && source.normal.dot(outward) > 0.0, "{source:?}");
            }
        }
        let mut open = body[..3].to_vec();
        let mut one_sided = body.clone().map(|source| Source { two_sided: false, ..source });
        let mut turned = body.clone();
        turned[0].corners.swap(0, 1);
        for sources in [&mut open[..], &mut one_sided, &mut turned] {
            assert_eq!(lamp_shapes(sources), 1);
            assert!(sources.iter().all(|source| !source.closed));
        }
    }
}
