//! Directions and what they fall into: cells of the sphere, parts of triangles, texels of the sky.

use glam::{DVec3, Vec3};
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::{frame, solid_angle};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Environment, EnvironmentImage};
use std::f64::consts::{PI, TAU};

/// Exponents of glossy lobes: flat, wide, the lecture's, narrow, nearly a mirror.
pub const EXPONENTS: [f64; 5] = [0.0, 1.0, 20.0, 1e3, 1e5];

/// A viewing direction so many degrees from +z.
pub fn tilted(degrees: f64) -> DVec3 {
    DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos())
}

/// Azimuth about `n` as a share of a full turn.
pub fn azimuth(n: DVec3, w: DVec3) -> f64 {
    let (t, b) = frame(n);
    (w.dot(b).atan2(w.dot(t)) / TAU).rem_euclid(1.0)
}

/// Share of the light from `wo` that is scattered: the midpoint rule over half vectors, spaced evenly under the density
/// `(m + 1) / 2 pi * cos^m`, so that lobes of every width are resolved.
pub fn directional_albedo(surfel: &Surfel, wo: DVec3) -> f64 {
    let (n, m) = (600, surfel.exponent);
    let mut sum = 0.0;
    for i in 0..n {
        let cos = ((f64::from(i) + 0.5) / f64::from(n)).powf(1.0 / (m + 1.0));
        let sin = (1.0 - cos * cos).sqrt();
        let pdf = (m + 1.0) / (2.0 * PI) * cos.powf(m);
        for j in 0..n {
            let phi = (f64::from(j) + 0.5) / f64::from(n) * 2.0 * PI;
            let h = DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
            let wi = 2.0 * wo.dot(h) * h - wo;
            if wo.dot(h) > 0.0 && wi.z > 0.0 {
                sum += surfel.bsdf(wo, wi).x * wi.z * 4.0 * wo.dot(h) / pdf;
            }
        }
    }
    sum / f64::from(n * n)
}

/// Cells of the sphere about the direction `axis`, narrower near it: the cosine is `1 - 2 s^power`.
pub struct Cells {
    pub axis: DVec3,
    pub power: i32,
}

impl Cells {
    const S: usize = 30;
    const PHI: usize = 16;

    /// The index of the cell that a direction falls into.
    pub fn cell(&self, w: DVec3) -> usize {
        // `1 - cos` without cancellation.
        let s = (0.25 * (w - self.axis).length_squared()).powf(1.0 / f64::from(self.power));
        let cell = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
        cell(s, Self::S) * Self::PHI + cell(azimuth(self.axis, w), Self::PHI)
    }

    /// Integral of a density over each cell, by the midpoint rule.
    pub fn integrate(&self, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
        self.integrate_by::<24>(density)
    }

    /// The same by so many points each way.
    pub fn integrate_by<const SUB: usize>(&self, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
        let (t, b) = frame(self.axis);
        let mut cells = vec![0.0; Self::S * Self::PHI];
        for i in 0..Self::S * SUB {
            let s = (i as f64 + 0.5) / (Self::S * SUB) as f64;
            let rest = 2.0 * s.powi(self.power);
            let measure = 2.0 * f64::from(self.power) * s.powi(self.power - 1) / (Self::S * SUB) as f64;
            for j in 0..Self::PHI * SUB {
                let phi = TAU * (j as f64 + 0.5) / (Self::PHI * SUB) as f64;
                let sin = (rest * (2.0 - rest)).sqrt();
                let w = sin * (phi.cos() * t + phi.sin() * b) + (1.0 - rest) * self.axis;
                cells[i / SUB * Self::PHI + j / SUB] += density(w) * measure * TAU / (Self::PHI * SUB) as f64;
            }
        }
        cells
    }
}

/// Corners of triangles, and the point they are seen from: near, far, from the edge, large, tiny, narrow.
pub fn triangles() -> Vec<([DVec3; 3], DVec3)> {
    let unit = [DVec3::ZERO, DVec3::X, DVec3::Y];
    vec![
        (unit, DVec3::new(0.2, 0.3, 0.05)),
        (unit, DVec3::new(0.3, 0.3, -1.0)),
        (unit, DVec3::new(1.5, 1.5, 0.02)),
        (unit, DVec3::new(-0.01, 0.5, 0.01)),
        (unit, DVec3::new(2.0, -3.0, 2.0)),
        ([DVec3::new(-50.0, -30.0, 1.0), DVec3::new(60.0, -40.0, 1.0), DVec3::new(0.0, 80.0, 1.5)], DVec3::ZERO),
        ([DVec3::new(-2.0, 0.0, 1.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.0, 0.05, 1.0)], DVec3::ZERO),
    ]
}

/// Unit vectors to the corners.
pub fn seen_from(from: DVec3, corners: [DVec3; 3]) -> [DVec3; 3] {
    corners.map(|corner| (corner - from).normalize())
}

/// The excess of the angles of a spherical triangle over those of a plane one (Girard).
pub fn girard([a, b, c]: [DVec3; 3]) -> f64 {
    let angle = |at: DVec3, b: DVec3, c: DVec3| at.cross(b).angle_between(at.cross(c));
    angle(a, b, c) + angle(b, c, a) + angle(c, a, b) - PI
}

/// Girard's formula, or for triangles that are nearly flat, which are nothing to it, the area.
fn girard_or_flat([a, b, c]: [DVec3; 3]) -> f64 {
    let flat = 0.5 * (b - a).cross(c - a).length();
    if flat < 1e-5 { flat } else { girard([a, b, c]) }
}

/// The parts into which the sides of a triangle, cut into so many pieces, divide it.
const PARTS: usize = 12;

/// The share of a triangle's solid angle, seen from `from`, that each of its parts has; adds up to 1.
pub fn shares_of_parts(corners: [DVec3; 3], from: DVec3) -> Vec<f64> {
    let [a, b, c] = corners;
    let omega = solid_angle(seen_from(from, corners));
    let point = |i: usize, j: usize| a + (b - a) * (i as f64 / PARTS as f64) + (c - a) * (j as f64 / PARTS as f64);
    let mut shares = vec![0.0; 2 * PARTS * PARTS];
    for i in 0..PARTS {
        for j in 0..PARTS - i {
            let lower = [point(i, j), point(i + 1, j), point(i, j + 1)];
            shares[2 * (i * PARTS + j)] = girard_or_flat(seen_from(from, lower)) / omega;
            if i + j + 1 < PARTS {
                let upper = [point(i + 1, j + 1), point(i, j + 1), point(i + 1, j)];
                shares[2 * (i * PARTS + j) + 1] = girard_or_flat(seen_from(from, upper)) / omega;
            }
        }
    }
    let mass: f64 = shares.iter().sum();
    assert!((mass - 1.0).abs() < 1e-6, "the parts have {mass} of the whole");
    shares
}

/// Which part of the triangle a direction falls into; and how far outside it is, in units of the weights of corners.
pub fn part_of(corners: [DVec3; 3], from: DVec3, wi: DVec3) -> (usize, f64) {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let hit = from + wi * (a - from).dot(normal) / wi.dot(normal) - a;
    // Weights of the second and third corner.
    let s = hit.cross(c - a).dot(normal) / normal.length_squared();
    let t = (b - a).cross(hit).dot(normal) / normal.length_squared();
    let outside = (-s).max(-t).max(s + t - 1.0).max(0.0);
    let (s, t) = (s * PARTS as f64, t * PARTS as f64);
    let (i, j) = ((s.max(0.0) as usize).min(PARTS - 1), (t.max(0.0) as usize).min(PARTS - 1));
    let upper = usize::from(s.fract() + t.fract() > 1.0 && i + j + 1 < PARTS);
    (2 * (i * PARTS + j.min(PARTS - 1 - i)) + upper, outside)
}

const SKY_WIDTH: u32 = 8;
const SKY_HEIGHT: u32 = 5;
const SKY_ROTATION: f64 = 37.0;
/// Parts of a texel of the sky, each way.
const SKY_PARTS: usize = 3;

/// An image with a sun, dark texels and black ones, turned by 37 degrees.
pub fn sky() -> Environment {
    let mut texels: Vec<Vec3> = (0..SKY_WIDTH * SKY_HEIGHT)
        .map(|i| {
            let [r, g, b, dark] = random4(i, 0, 0, 5).map(|r| uniform(r) as f32);
            if dark < 0.3 { Vec3::ZERO } else { Vec3::new(r, g, b) }
        })
        .collect();
    texels[SKY_WIDTH as usize + 3] = Vec3::new(60.0, 50.0, 40.0);
    let image = EnvironmentImage { name: "sky".into(), width: SKY_WIDTH, height: SKY_HEIGHT, texels };
    Environment { radiance: Vec3::new(0.5, 1.0, 2.0), image: Some(image.into()), rotation: 37.0 }
}

/// A direction by its azimuth from -z towards +x, and the cosine of its angle to +y.
pub fn sky_direction(phi: f64, cos: f64) -> DVec3 {
    let sin = (1.0 - cos * cos).sqrt();
    DVec3::new(sin * phi.sin(), cos, -sin * phi.cos())
}

/// Where a direction falls in the [`sky`], in texels, by hand.
pub fn sky_position(w: DVec3) -> [f64; 2] {
    let phi = w.x.atan2(-w.z).to_degrees();
    let column = ((phi + 180.0 + SKY_ROTATION) / 360.0).rem_euclid(1.0) * f64::from(SKY_WIDTH);
    [column, w.x.hypot(w.z).atan2(w.y) / PI * f64::from(SKY_HEIGHT)]
}

/// The share of directions that falls into each part of each texel of the [`sky`], under a density that is constant in every texel.
pub fn shares_of_sky(density: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let (columns, rows) = (SKY_WIDTH as usize * SKY_PARTS, SKY_HEIGHT as usize * SKY_PARTS);
    let edge = |row: usize| (PI * row as f64 / rows as f64).cos();
    let share = |(column, row): (usize, usize)| {
        let phi = TAU * ((column as f64 + 0.5) / columns as f64 - 0.5 - SKY_ROTATION / 360.0);
        let density = density(sky_direction(phi, 0.5 * (edge(row) + edge(row + 1))));
        density * TAU / columns as f64 * (edge(row) - edge(row + 1))
    };
    (0..columns * rows).map(|i| share((i % columns, i / columns))).collect()
}

/// Which of those parts a direction falls into.
pub fn part_of_sky(w: DVec3) -> usize {
    let [x, y] = sky_position(w);
    let (columns, rows) = (SKY_WIDTH as usize * SKY_PARTS, SKY_HEIGHT as usize * SKY_PARTS);
    let cell = |x: f64, n: usize| ((x * SKY_PARTS as f64) as usize).min(n - 1);
    cell(y, rows) * columns + cell(x, columns)
}
