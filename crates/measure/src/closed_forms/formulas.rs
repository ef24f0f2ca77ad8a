//! The closed forms themselves, in double precision, from the literature: none of the tracers' code is used here.

use glam::DVec3;
use std::f64::consts::PI;

/// Irradiance at `point`, on a surface with the unit normal `normal`, from a flat convex polygon of radiance 1 (either winding), less what
/// lies below the horizon: `1/2 sum of angle_i (n . normal_i)` over the edges (Lambert, "Photometria", 1760).
pub fn polygon(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let height = |v: &DVec3| normal.dot(*v);
    let mut above = Vec::new();
    for (i, corner) in corners.iter().enumerate() {
        let (a, b) = (*corner - point, corners[(i + 1) % corners.len()] - point);
        if height(&a) >= 0.0 {
            above.push(a);
        }
        if height(&a) * height(&b) < 0.0 {
            above.push(a.lerp(b, height(&a) / (height(&a) - height(&b))));
        }
    }
    let edges = (0..above.len()).map(|i| (above[i], above[(i + 1) % above.len()]));
    let part = |(a, b): (DVec3, DVec3)| {
        let across = a.cross(b);
        across.length().atan2(a.dot(b)) * normal.dot(across.normalize_or_zero())
    };
    0.5 * edges.map(part).sum::<f64>().abs()
}

/// The same from a closed convex polyhedron, as the triangles of its surface, that does not contain the point: those that face the point
/// fill what it sees of the body, each place once.
pub fn polyhedron(point: DVec3, normal: DVec3, triangles: &[[DVec3; 3]]) -> f64 {
    let faces = |t: &&[DVec3; 3]| (t[1] - t[0]).cross(t[2] - t[0]).dot(point - t[0]) > 0.0;
    triangles.iter().filter(faces).map(|t| polygon(point, normal, t)).sum()
}

/// Solid angle of a triangle (van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983).
pub fn solid_angle(point: DVec3, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| (corner - point).normalize());
    2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

/// Solid angle of a rectangle with the sides `a` and `b`, at the distance `d` above its middle.
pub fn solid_angle_of_rectangle(a: f64, b: f64, d: f64) -> f64 {
    4.0 * (a * b / (2.0 * d * (a * a + b * b + 4.0 * d * d).sqrt())).atan()
}

/// Share of the light of a diffuse rectangle with the sides `a` and `b` that reaches an equal one opposite at the distance `c` (Howell, "A Catalog of
/// Radiation Heat Transfer Configuration Factors", C-11).
pub fn parallel_rectangles(a: f64, b: f64, c: f64) -> f64 {
    let (x, y) = (a / c, b / c);
    let (x1, y1) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    let logarithm = (x1 * y1 / (1.0 + x * x + y * y).sqrt()).ln();
    let arcs = x * y1 * (x / y1).atan() + y * x1 * (y / x1).atan() - x * x.atan() - y * y.atan();
    2.0 / (PI * x * y) * (logarithm + arcs)
}

/// Share of the light of a diffuse rectangle, `l` along the common edge and `w` deep, that reaches a perpendicular one of the height `h`
/// (Howell, C-14).
pub fn perpendicular_rectangles(w: f64, h: f64, l: f64) -> f64 {
    let (h, w) = (h / l, w / l);
    let (h2, w2) = (h * h, w * w);
    let d = (h2 + w2).sqrt();
    let logarithm = ((1.0 + w2) * (1.0 + h2) / (1.0 + w2 + h2)).ln()
        + w2 * (w2 * (1.0 + w2 + h2) / ((1.0 + w2) * (w2 + h2))).ln()
        + h2 * (h2 * (1.0 + h2 + w2) / ((1.0 + h2) * (h2 + w2))).ln();
    (w * (1.0 / w).atan() + h * (1.0 / h).atan() - d * (1.0 / d).atan() + 0.25 * logarithm) / (PI * w)
}

/// Irradiance at `point` through a rectangular opening with a corner and two edges, from a sky whose radiance depends on the direction: Simpson's
/// rule, to 1e-9 of itself where the opening is not closer than a tenth of its size.
pub fn sky_through(point: DVec3, normal: DVec3, [corner, a, b]: [DVec3; 3], sky: impl Fn(DVec3) -> f64) -> f64 {
    const STEPS: usize = 256;
    let weight = |i: usize| if i == 0 || i == STEPS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    let area = a.cross(b);
    let mut sum = 0.0;
    for i in 0..=STEPS {
        for j in 0..=STEPS {
            let to = corner + a * (i as f64 / STEPS as f64) + b * (j as f64 / STEPS as f64) - point;
            let direction = to.normalize();
            let projected = area.dot(direction).abs() / to.length_squared();
            sum += weight(i) * weight(j) * sky(direction) * normal.dot(direction).max(0.0) * projected;
        }
    }
    sum / 9.0 / (STEPS * STEPS) as f64
}

/// Share of light from everywhere, weighted by the cosine to +y, for a sky that is `radiance(cosine of the angle to +y)`; a smooth one.
pub fn hemisphere(radiance: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 1000;
    let weight = |i: usize| if i == 0 || i == STEPS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    let sum: f64 = (0..=STEPS).map(|i| (i, i as f64 / STEPS as f64)).map(|(i, c)| weight(i) * radiance(c) * c).sum();
    2.0 * PI * sum / (3.0 * STEPS as f64)
}

/// Reflectance of a smooth surface for unpolarised light that arrives at `angle` in radian from the normal; `eta` is the index behind it
/// over that in front: `1/2 (sin^2(i - t) / sin^2(i + t) + tan^2(i - t) / tan^2(i + t))` (Fresnel 1823; Born and Wolf, "Principles of Optics",
/// section 1.5.2).
pub fn reflectance(eta: f64, angle: f64) -> f64 {
    let sine = angle.sin() / eta;
    if sine >= 1.0 {
        return 1.0;
    }
    // The form above is 0/0 at normal incidence.
    if angle < 1e-6 {
        return ((eta - 1.0) / (eta + 1.0)).powi(2);
    }
    let refracted = sine.asin();
    let (difference, sum) = (angle - refracted, angle + refracted);
    0.5 * ((difference.sin() / sum.sin()).powi(2) + (difference.tan() / sum.tan()).powi(2))
}

/// Share of a disc that lies beyond a line at the distance `s` from its middle, in radii.
pub fn disc_beyond(s: f64) -> f64 {
    (s.acos() - s * (1.0 - s * s).sqrt()) / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: f64, expected: f64, relative: f64) {
        assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
    }

    /// Published values: equal squares at the distance of their side, and with a common edge (tables of Howell, and of Siegel and Howell).
    #[test]
    fn form_factors_are_the_published_ones() {
        assert_close(parallel_rectangles(1.0, 1.0, 1.0), 0.199_825, 1e-5);
        assert_close(perpendicular_rectangles(1.0, 1.0, 1.0), 0.200_044, 1e-5);
        // A closed box: what leaves one face reaches the other five.
        let (a, b, c) = (1.0, 2.0, 0.7);
        let sides = 2.0 * perpendicular_rectangles(a, c, b) + 2.0 * perpendicular_rectangles(b, c, a);
        assert_close(parallel_rectangles(a, b, c) + sides, 1.0, 1e-12);
    }

    /// A square overhead by the textbook's formula; a polygon that half lies below the horizon; the whole sky.
    #[test]
    fn polygons() {
        let square = |h: f64, r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(x, z)| DVec3::new(x, h, z));
        // Four times the corner's `1/2 (a/A atan(b/A) + b/B atan(a/B))`.
        let expected = |a: f64| 4.0 * a / (1.0 + a * a).sqrt() * (a / (1.0 + a * a).sqrt()).atan();
        assert_close(polygon(DVec3::ZERO, DVec3::Y, &square(1.0, 0.5)), expected(0.5), 1e-12);
        assert_close(polygon(DVec3::ZERO, DVec3::Y, &square(1.0, 1e7)), PI, 1e-6);
        let wall = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
        let upper = [(-1.0, 0.0), (1.0, 0.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
        assert_close(polygon(DVec3::ZERO, DVec3::Y, &wall), polygon(DVec3::ZERO, DVec3::Y, &upper), 1e-12);
        assert_eq!(polygon(DVec3::ZERO, DVec3::Y, &wall.map(|v| v - 3.0 * DVec3::Y)), 0.0);
        // By quadrature.
        let edges = [upper[0], upper[1] - upper[0], upper[3] - upper[0]];
        assert_close(polygon(DVec3::ZERO, DVec3::Y, &upper), sky_through(DVec3::ZERO, DVec3::Y, edges, |_| 1.0), 1e-9);
    }

    #[test]
    fn solid_angles() {
        let corners = [(-0.5, -1.0), (0.5, -1.0), (0.5, 1.0), (-0.5, 1.0)].map(|(x, z)| DVec3::new(x, 0.75, z));
        let [a, b, c, d] = corners;
        let two = solid_angle(DVec3::ZERO, [a, b, c]) + solid_angle(DVec3::ZERO, [a, c, d]);
        assert_close(solid_angle_of_rectangle(1.0, 2.0, 0.75), two, 1e-12);
        assert_close(solid_angle_of_rectangle(1.0, 1.0, 0.5), 4.0 * PI / 6.0, 1e-12);
    }

    #[test]
    fn skies_and_glass() {
        assert_close(hemisphere(|_| 1.0), PI, 1e-12);
        // Moon and Spencer's overcast sky: 7/9 of the uniform one of its zenith.
        assert_close(hemisphere(|c| (1.0 + 2.0 * c) / 3.0), 7.0 / 9.0 * PI, 1e-12);
        // Hecht, "Optics": glass at 0 and at 60 degrees.
        assert_close(reflectance(1.5, 0.0), 0.04, 1e-12);
        assert_close(reflectance(1.5, 1e-5), 0.04, 1e-8);
        assert_close(reflectance(1.5, 60f64.to_radians()), 0.0892, 1e-3);
        assert_eq!(disc_beyond(0.0), 0.5);
        assert_eq!(disc_beyond(1.0), 0.0);
    }
}
