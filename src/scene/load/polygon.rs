//! Polygons of more than three corners become triangles.
//!
//! A fan from the first corner covers a convex polygon, and is kept wherever it covers the polygon exactly. What remains is
//! projected along its normal (the area vector of Newell's method) and cut by the `i_triangle` crate: a sweep over whole
//! numbers, so that no rounding can make it fail or run for ever.

use glam::{DVec2, DVec3};
use i_triangle::i_overlay::core::fill_rule::FillRule;
use i_triangle::i_overlay::core::overlay::IntOverlayOptions;
use i_triangle::i_overlay::core::solver::Solver;
use i_triangle::i_overlay::i_float::int::point::IntPoint;
use i_triangle::int::triangulator::IntTriangulator;
use i_triangle::int::validation::Validation;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Most corners of a polygon that is cut other than as a fan: the time grows with up to their square, to a second here.
pub(super) const MOST_CORNERS: usize = 1 << 15;
/// The larger side of a polygon in steps of the grid on which it is cut: much finer than single precision.
const GRID: f64 = (1u64 << 40) as f64;
/// Backward triangles of so small a part of the polygon's area are rounding.
const ROUNDING: f64 = 1e-6;
/// A corner further from the polygon's plane than this part of its size is worth a warning.
const FLAT: f64 = 0.01;
/// A polygon with more crossings than this for each corner is not untangled: their number grows with the square of the corners'.
const MOST_CROSSINGS: usize = 4;

/// How a polygon is cut into triangles.
#[derive(Debug, PartialEq)]
pub(super) struct Cut {
    /// Corners of the triangles, in the polygon's own sense of rotation; none: the fan from the first corner.
    pub triangles: Option<Vec<[u32; 3]>>,
    /// What is wrong with the polygon.
    pub fault: Option<Fault>,
}

/// What is wrong with a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    /// Its outline crosses or covers itself, so that there is no saying what is inside.
    Tangled,
    /// Its corners do not lie in a plane.
    NotFlat,
    /// It is not convex and has more than [`MOST_CORNERS`] corners.
    TooLarge,
}

/// Cuts a polygon with these corners.
pub(super) fn cut(corners: &[DVec3]) -> Cut {
    let fan = |fault| Cut { triangles: None, fault };
    if corners.len() < 4 {
        return fan(None);
    }
    let areas = || corners[1..].windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]));
    let area: DVec3 = areas().sum();
    let Some(normal) = area.try_normalize() else {
        // The two halves of a bow tie cancel; what has no area at all is dropped later.
        return fan(areas().any(|area| area != DVec3::ZERO).then_some(Fault::Tangled));
    };
    let flat = if corners.len() > 4 { flatness(corners, normal) } else { None };
    if is_fan(corners, 0, normal, area.length()) {
        return fan(flat);
    }
    if corners.len() == 4 {
        // One of the two diagonals of a quadrangle lies inside, unless two sides cross.
        return match is_fan(corners, 1, normal, area.length()) {
            true => Cut { triangles: Some(vec![[1, 2, 3], [1, 3, 0]]), fault: None },
            false => fan(Some(Fault::Tangled)),
        };
    }
    if corners.len() > MOST_CORNERS {
        return fan(Some(Fault::TooLarge));
    }
    match (sweep(&projected(corners, normal)), flat) {
        (Some((triangles, true)), None) => Cut { triangles: Some(triangles), fault: None },
        // A bent polygon may look simple from the front although corners are hidden there: the fan has them all.
        (Some((triangles, true)), Some(_)) if triangles.len() == corners.len() - 2 => {
            Cut { triangles: Some(triangles), fault: flat }
        }
        (_, Some(_)) => fan(flat),
        (Some((triangles, false)), None) => Cut { triangles: Some(triangles), fault: Some(Fault::Tangled) },
        (None, None) => fan(Some(Fault::Tangled)),
    }
}

/// Whether the fan from corner `from` covers the polygon once: no triangle of it turns backwards, and all of them together
/// do not turn by more than a full circle.
fn is_fan(corners: &[DVec3], from: usize, normal: DVec3, area: f64) -> bool {
    let count = corners.len();
    let spoke = |k: usize| corners[(from + k) % count] - corners[from];
    let mut turned = 0.0;
    for k in 1..count - 1 {
        let (a, b) = (spoke(k), spoke(k + 1));
        let twice = a.cross(b).dot(normal);
        // An outline that comes back to where it began has turned without any triangle to show for it.
        if twice < -ROUNDING * area || count > 4 && a == DVec3::ZERO {
            return false;
        }
        if count > 4 {
            turned += twice.atan2(a.dot(b)).max(0.0);
        }
    }
    turned < TAU + ROUNDING
}

/// [`Fault::NotFlat`] if some corner lies far from the plane through the mean of all.
fn flatness(corners: &[DVec3], normal: DVec3) -> Option<Fault> {
    let mean = corners.iter().map(|corner| *corner / corners.len() as f64).sum::<DVec3>();
    let size = corners.iter().map(|corner| corner.distance(mean)).fold(0.0, f64::max);
    let height = corners.iter().map(|corner| (*corner - mean).dot(normal).abs()).fold(0.0, f64::max);
    (height > FLAT * size).then_some(Fault::NotFlat)
}

/// The corners seen along `normal`, sheared into the plane of the two axes that it is furthest from: what lies in a coordinate
/// plane keeps its numbers. Counter-clockwise.
fn projected(corners: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let depth = (0..3).max_by(|i, j| normal[*i].abs().total_cmp(&normal[*j].abs())).unwrap_or(2);
    let (mut u, mut v) = ((depth + 1) % 3, (depth + 2) % 3);
    if normal[depth] < 0.0 {
        (u, v) = (v, u);
    }
    let slope = DVec2::new(normal[u], normal[v]) / normal[depth];
    let seen = |corner: &DVec3| {
        let p = *corner - corners[0];
        DVec2::new(p[u], p[v]) - slope * p[depth]
    };
    corners.iter().map(seen).collect()
}

/// Triangles that cover what the outline winds around, and whether it winds around all of it once. None if that takes points
/// that are not corners: the outline crosses itself.
fn sweep(corners: &[DVec2]) -> Option<(Vec<[u32; 3]>, bool)> {
    let size = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    let whole = |x: f64| (x / size * GRID).round() as i64;
    let points: Vec<_> = corners.iter().map(|corner| IntPoint::new(whole(corner.x), whole(corner.y))).collect();
    if is_tangled(&points) {
        return None;
    }
    let mut corner_at = HashMap::with_capacity(points.len());
    for (corner, point) in (0..).zip(&points) {
        corner_at.entry((point.x, point.y)).or_insert(corner);
    }
    let how = Validation { fill_rule: FillRule::NonZero, options: IntOverlayOptions::keep_all_points() };
    // The other solvers of the crate can take a gigabyte for the polygons that this one is slow for.
    let found = IntTriangulator::<i64, u32>::new(points.len(), how, Solver::LIST).triangulate_contour(&points);
    let corner_of: Option<Vec<u32>> =
        found.points.iter().map(|point| corner_at.get(&(point.x, point.y)).copied()).collect();
    let corner_of = corner_of?;
    let triangles: Vec<_> =
        found.indices.chunks_exact(3).map(|t| [0, 1, 2].map(|k| corner_of[t[k] as usize])).collect();
    let twice = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| points[corner as usize]);
        turn(a, b, c)
    };
    let covered: i128 = triangles.iter().map(|triangle| twice(*triangle)).sum();
    let outline: i128 = (2..points.len() as u32).map(|corner| twice([0, corner - 1, corner])).sum();
    (!triangles.is_empty()).then_some((triangles, covered == outline))
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
fn turn(a: IntPoint<i64>, b: IntPoint<i64>, c: IntPoint<i64>) -> i128 {
    let wide = |from: i64, to: i64| i128::from(to) - i128::from(from);
    wide(a.x, b.x) * wide(a.y, c.y) - wide(a.y, b.y) * wide(a.x, c.x)
}

/// Whether a sample of the pairs of sides says that there are too many crossings to find them all.
fn is_tangled(points: &[IntPoint<i64>]) -> bool {
    const PAIRS: usize = 16;
    let count = points.len();
    if count < 256 {
        return false;
    }
    // Xorshift (Marsaglia 2003): the same pairs every time.
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut side = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let first = (state % count as u64) as usize;
        (points[first], points[(first + 1) % count])
    };
    let crossing = |_: &usize| {
        let ((a, b), (c, d)) = (side(), side());
        let apart = |p, q, r, s| turn(p, q, r).signum() * turn(p, q, s).signum() < 0;
        apart(a, b, c, d) && apart(c, d, a, b)
    };
    let crossings = (0..PAIRS * count).filter(crossing).count();
    // Of count^2 / 2 pairs there are this many times the sample.
    crossings * count / (2 * PAIRS) > MOST_CROSSINGS * count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect()
    }

    fn area_of(corners: &[DVec3], [a, b, c]: [u32; 3]) -> DVec3 {
        let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
        0.5 * (b - a).cross(c - a)
    }

    /// Every triangle faces as the polygon does, and their areas sum up to its own.
    #[track_caller]
    fn covers(corners: &[DVec3]) -> Vec<[u32; 3]> {
        let Cut { triangles, fault } = cut(corners);
        assert_eq!(fault, None);
        let fan = || (2..corners.len() as u32).map(|k| [0, k - 1, k]).collect();
        let triangles: Vec<[u32; 3]> = triangles.unwrap_or_else(fan);
        let polygon: DVec3 = (2..corners.len() as u32).map(|k| area_of(corners, [0, k - 1, k])).sum();
        let total: f64 = triangles.iter().map(|t| area_of(corners, *t).length()).sum();
        assert!((total - polygon.length()).abs() < 1e-9 * total, "{total} for {}", polygon.length());
        assert!(triangles.iter().all(|t| area_of(corners, *t).dot(polygon) > -1e-9 * total * total));
        triangles
    }

    fn comb(teeth: usize) -> Vec<DVec3> {
        let mut points = vec![[2.0 * teeth as f64, -1.0], [2.0 * teeth as f64, 0.0]];
        points.extend((0..2 * teeth).rev().map(|k| [k as f64, if k % 2 == 1 { 5.0 } else { 0.0 }]));
        points.push([0.0, -1.0]);
        flat(&points)
    }

    fn star(spikes: usize) -> Vec<DVec3> {
        let corner = |k: usize| {
            let radius = [2.0, 0.5][k % 2];
            let (y, x) = (TAU * k as f64 / (2 * spikes) as f64).sin_cos();
            [radius * x, radius * y]
        };
        flat(&(0..2 * spikes).map(corner).collect::<Vec<_>>())
    }

    #[test]
    fn convex_polygons_are_fans() {
        for count in [4, 5, 6, 17, 100_000] {
            let corner = |k: usize| (TAU * k as f64 / count as f64).sin_cos();
            let corners: Vec<_> = (0..count).map(corner).map(|(y, x)| DVec3::new(3.0 * x, y, 0.0)).collect();
            assert_eq!(cut(&corners), Cut { triangles: None, fault: None });
            let mut rotated = corners.clone();
            rotated.reverse();
            assert_eq!(cut(&rotated), Cut { triangles: None, fault: None });
        }
        let halved = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]]);
        assert_eq!(cut(&halved).triangles, None, "corners on the sides");
    }

    #[test]
    fn a_concave_quadrangle_is_cut_along_the_diagonal_inside() {
        let arrow = [[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]];
        for turn in 0..4 {
            let corners: Vec<_> = (0..4).map(|k| arrow[(k + turn) % 4]).collect();
            assert_eq!(covers(&flat(&corners)).len(), 2);
            let reversed: Vec<_> = corners.into_iter().rev().collect();
            assert_eq!(covers(&flat(&reversed)).len(), 2);
        }
    }

    #[test]
    fn concave_polygons_are_covered_exactly() {
        assert_eq!(covers(&comb(50)).len(), 103 - 2);
        assert_eq!(covers(&star(7)).len(), 12);
        // Tilted, far away, and small.
        let turned = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -2.0);
        let tilted = |p: &DVec3| (turned * *p * 1e-3 + DVec3::new(14.0, 9.0, -3.0)).as_vec3().as_dvec3();
        let corners: Vec<_> = star(12).iter().map(tilted).collect();
        assert_eq!(cut(&corners).fault, None);
        assert_eq!(cut(&corners).triangles.map(|t| t.len()), Some(22));
    }

    #[test]
    fn corners_on_a_side_are_kept() {
        let corners = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]);
        let triangles = covers(&corners);
        assert!(triangles.iter().flatten().any(|corner| *corner == 1), "{triangles:?}");
    }

    /// A hole is joined to the outline by a side that is walked both ways.
    #[test]
    fn a_hole_on_a_bridge_stays_empty() {
        let outer = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
        let hole = [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0]];
        let corners = flat(&[&outer[..], &hole[..]].concat());
        let triangles = covers(&corners);
        let middle = DVec3::new(1.5, 1.5, 0.0);
        let inside = |t: &[u32; 3]| {
            (0..3).all(|k| {
                let [a, b] = [t[k], t[(k + 1) % 3]].map(|corner| corners[corner as usize]);
                (b - a).cross(middle - a).z > 0.0
            })
        };
        assert!(!triangles.iter().any(inside));
    }

    #[test]
    fn what_has_no_inside_is_told() {
        let bow_tie = flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        let pentagram: Vec<_> = (0..5).map(|k| star(5)[4 * k % 10]).collect();
        let twice_around: Vec<_> = (0..8).map(|k| star(2)[k % 4]).collect();
        for corners in [bow_tie, pentagram, twice_around] {
            assert_eq!(cut(&corners).fault, Some(Fault::Tangled), "{corners:?}");
        }
        let line: Vec<_> = (0..9).map(|k| DVec3::splat(f64::from(k))).collect();
        assert_eq!(cut(&line), Cut { triangles: None, fault: None }, "no area at all is another matter");
        let mut bent = star(5);
        bent[3].z = 0.5;
        assert_eq!(cut(&bent).fault, Some(Fault::NotFlat));
        assert!(cut(&bent).triangles.is_some());
    }

    #[test]
    fn no_polygon_takes_for_ever() {
        let start = std::time::Instant::now();
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let tangle: Vec<_> = (0..MOST_CORNERS).map(|_| [random(), random()]).collect();
        assert_eq!(cut(&flat(&tangle)), Cut { triangles: None, fault: Some(Fault::Tangled) });
        let walk: Vec<_> = (0..MOST_CORNERS).map(|k| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k % 4]).collect();
        assert_eq!(cut(&flat(&walk)).fault, Some(Fault::Tangled));
        let mut line: Vec<_> = (0..MOST_CORNERS - 2).map(|k| [k as f64, 0.0]).collect();
        line.extend([[1e6, 1e6], [5e4, 4e4]]);
        assert_eq!(cut(&flat(&line)).fault, None);
        assert_eq!(covers(&comb(MOST_CORNERS / 2 - 2)).len(), MOST_CORNERS - 3);
        assert_eq!(cut(&comb(MOST_CORNERS / 2)).fault, Some(Fault::TooLarge));
        assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
    }
}
