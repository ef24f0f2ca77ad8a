//! What triangles of one plane cover together, without what others cover, cut into triangles that do not overlap: a sweep over whole numbers by the
//! crates that cut polygons too.

use super::face::Face;
use glam::DVec3;
use i_triangle::i_overlay::core::fill_rule::FillRule;
use i_triangle::i_overlay::core::overlay::Overlay;
use i_triangle::i_overlay::core::overlay_rule::OverlayRule;
use i_triangle::i_overlay::core::solver::Solver;
use i_triangle::i_overlay::i_float::int::point::IntPoint;
use i_triangle::int::triangulator::IntTriangulator;
use i_triangle::int::validation::Validation;
use std::collections::HashMap;

/// The larger side of the whole in steps of the grid on which it is cut: finer than single precision.
const GRID: f64 = (1u64 << 32) as f64;
/// More triangles than this are not united.
pub(super) const MOST_UNITED: usize = 1 << 16;
/// Up to so many triangles, corners nearly in one place become one; each is compared with each.
const MOST_COMPARED: usize = 64;

/// Of what is cut out of, triangles that are narrower are rounding, for each unit of their length.
const NARROW: f64 = 2e-5;

/// A face, and others that lie before it: it covers what these do not.
pub(super) struct Part<'a> {
    pub face: &'a Face,
    pub without: Vec<&'a Face>,
}

/// The triangles that cover what these faces cover, each counter-clockwise about the first one's outward normal. None if rounding made
/// something else of it.
pub(super) fn union(parts: &[Part]) -> Option<Vec<[DVec3; 3]>> {
    let first = parts.first()?.face;
    let (origin, normal) = (first.corners[0], first.normal);
    let u = (first.corners[1] - origin).try_normalize()?;
    let v = normal.cross(u);
    let own = parts.len();
    let cut = parts.iter().any(|part| !part.without.is_empty());
    // First the faces, then what is cut out of each.
    let mut corners: Vec<[DVec3; 3]> = parts.iter().map(|part| part.face.corners).collect();
    corners.extend(parts.iter().flat_map(|part| part.without.iter().map(|face| face.corners)));
    let size = corners.as_flattened().iter().map(|p| p.distance(origin)).fold(0.0, f64::max);
    if corners.len() <= MOST_COMPARED {
        let mut known: Vec<DVec3> = Vec::new();
        for p in corners.as_flattened_mut() {
            match known.iter().find(|q| q.distance(*p) < 1e-6 * size) {
                Some(q) => *p = *q,
                None => known.push(*p),
            }
        }
    }
    let mut place_of = HashMap::new();
    let mut whole = |p: DVec3| {
        let d = p - origin;
        let on_grid = |x: f64| (x / size * GRID).round() as i64;
        let point = IntPoint::new(on_grid(d.dot(u)), on_grid(d.dot(v)));
        place_of.entry((point.x, point.y)).or_insert(p);
        point
    };
    let mut shapes: Vec<Vec<Vec<IntPoint<i64>>>> = corners
        .iter()
        .map(|&[a, b, c]| {
            let turned = (b - a).cross(c - a).dot(normal) < 0.0;
            vec![(if turned { [a, c, b] } else { [a, b, c] }).map(&mut whole).to_vec()]
        })
        .collect();
    let mut without = shapes.split_off(own).into_iter();
    if cut {
        shapes = shapes
            .into_iter()
            .zip(parts)
            .flat_map(|(shape, part)| {
                let clips: Vec<_> = without.by_ref().take(part.without.len()).collect();
                if clips.is_empty() {
                    return vec![shape];
                }
                Overlay::from_subj_and_clip(&[shape][..], &clips[..])
                    .overlay(OverlayRule::Difference, FillRule::NonZero)
            })
            .collect();
        if shapes.is_empty() {
            return Some(Vec::new());
        }
    }
    let faces = &shapes;
    corners.truncate(own);
    let how = Validation { fill_rule: FillRule::NonZero, ..Validation::default() };
    let solver = if faces.len() > 256 { Solver::AUTO } else { Solver::LIST };
    let found = IntTriangulator::<i64, u32>::new(3 * faces.len(), how, solver).triangulate_shapes(&shapes);
    let point = |index: u32| {
        let point = &found.points[index as usize];
        let step = size / GRID;
        let made = || origin + u * (point.x as f64 * step) + v * (point.y as f64 * step);
        // What was a corner stays the same to the last bit.
        place_of.get(&(point.x, point.y)).copied().unwrap_or_else(made)
    };
    let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).dot(normal);
    let mut united = Vec::new();
    let narrow = |[a, b, c]: [DVec3; 3]| {
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        cut && (b - a).cross(c - a).length() < NARROW * longest
    };
    for triangle in found.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| point(triangle[k]));
        match area([a, b, c]) {
            _ if narrow([a, b, c]) => {}
            twice if twice > 0.0 => united.push([a, b, c]),
            twice if twice < 0.0 => united.push([a, c, b]),
            _ => {}
        }
    }
    let covered: f64 = united.iter().map(|t| area(*t)).sum();
    let areas = corners.iter().map(|t| area(*t).abs());
    let (largest, sum) = areas.fold((0.0, 0.0), |(largest, sum), area| (f64::max(largest, area), sum + area));
    ((cut || covered >= largest * (1.0 - 1e-6)) && covered <= sum * (1.0 + 1e-6)).then_some(united)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::build::mesh;
    use glam::{DAffine3, Vec3};

    /// The area of squares that are united, without others.
    fn area(squares: &[[f32; 3]], without: &[[f32; 3]]) -> f64 {
        let faces = |squares: &[[f32; 3]]| -> Vec<Face> {
            let triangles = squares.iter().flat_map(|&[x, y, side]| {
                let corner = |dx: f32, dy: f32| Vec3::new(x + dx * side, 0.5, y + dy * side);
                let mesh = mesh(
                    vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)],
                    &[[0, 1, 2], [2, 3, 0]],
                );
                [0, 1].map(|t| Face::new(0, t, &mesh, &DAffine3::IDENTITY, 0))
            });
            triangles.collect()
        };
        let (faces, without) = (faces(squares), faces(without));
        let parts: Vec<Part> = faces.iter().map(|face| Part { face, without: without.iter().collect() }).collect();
        let united = union(&parts).expect("a union");
        united.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum()
    }

    #[test]
    fn what_is_covered_twice_counts_once() {
        for (squares, without, expected) in [
            (&[[0.0, 0.0, 1.0], [0.5, 0.0, 1.0]][..], &[][..], 1.5),
            (&[[0.0, 0.0, 1.0], [0.25, 0.25, 0.5]], &[], 1.0),
            (&[[0.0, 0.0, 1.0], [0.1, 0.3, 1.0], [0.7, 0.2, 0.2]], &[], 2.0 - 0.63),
            // A hole, an edge, all of it, and nothing.
            (&[[0.0, 0.0, 1.0]], &[[0.25, 0.25, 0.5]], 0.75),
            (&[[0.0, 0.0, 1.0], [0.5, 0.0, 1.0]], &[[1.0, 0.0, 1.0]], 1.0),
            (&[[0.0, 0.0, 1.0]], &[[0.0, 0.0, 1.0]], 0.0),
            (&[[0.0, 0.0, 1.0]], &[[1.0, 0.0, 1.0]], 1.0),
        ] {
            let found = area(squares, without);
            assert!((found - expected).abs() < 1e-6, "{found} instead of {expected}");
        }
    }
}
