//! Directions against their densities: hemispheres, lobes, mixtures, triangles. Every chi-square test and every mean has the
//! significance 1e-4.

use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::sampling::{directional_albedo, histogram};
use glam::{Affine3A, DVec3};
use luminaire::reference::Reference;
use luminaire::reference::scatter::{bsdf_pdf, scatter};
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::*;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{AreaSampling, Directions, Scene};
use std::f64::consts::{PI, TAU};

const N: u32 = 300_000;
const EXPONENTS: [f64; 5] = [0.0, 1.0, 20.0, 1e3, 1e5];

fn numbers(i: u32, block: u32) -> [f64; 4] {
    random4(i, 3, block, 11).map(uniform)
}

/// A viewing direction so many degrees from +z.
fn tilted(degrees: f64) -> DVec3 {
    DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos())
}

/// Azimuth about `n` as a share of a full turn.
fn azimuth(n: DVec3, w: DVec3) -> f64 {
    let (t, b) = frame(n);
    (w.dot(b).atan2(w.dot(t)) / TAU).rem_euclid(1.0)
}

#[test]
fn uniform_hemisphere_is_uniform() {
    for n in [DVec3::Z, -DVec3::Z, DVec3::new(0.3, -0.8, 0.2).normalize()] {
        let p = chi_square(&histogram(|u, v| {
            let w = uniform_hemisphere(n, u, v);
            assert!((w.length() - 1.0).abs() < 1e-14);
            (w.dot(n), azimuth(n, w))
        }));
        assert!(p >= SIGNIFICANCE, "about {n}: p = {p:.1e}");
    }
}

/// Under the density `(m + 1) / 2 pi cos^m`, `cos^(m + 1)` is uniform.
#[test]
fn glossy_half_vectors_have_their_density() {
    for n in [DVec3::Z, DVec3::new(0.3, -0.8, 0.2).normalize()] {
        for m in EXPONENTS {
            let p = chi_square(&histogram(|u, v| {
                let h = glossy_half_vector(n, m, u, v);
                assert!((h.length() - 1.0).abs() < 1e-14);
                // From the sine: the cosine of a narrow lobe has few digits.
                let sin2 = h.cross(n).length_squared();
                ((0.5 * (m + 1.0) * (-sin2).ln_1p()).exp(), azimuth(n, h))
            }));
            assert!(p >= SIGNIFICANCE, "m = {m} about {n}: p = {p:.1e}");
        }
    }
}

/// Cells of the sphere about the direction `axis`, narrower near it: the cosine is `1 - 2 s^power`.
struct Cells {
    axis: DVec3,
    power: i32,
}

impl Cells {
    const S: usize = 30;
    const PHI: usize = 16;

    fn cell(&self, w: DVec3) -> usize {
        // `1 - cos` without cancellation.
        let s = (0.25 * (w - self.axis).length_squared()).powf(1.0 / f64::from(self.power));
        let cell = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
        cell(s, Self::S) * Self::PHI + cell(azimuth(self.axis, w), Self::PHI)
    }

    /// Integral of a density over each cell, by the midpoint rule.
    fn integrate(&self, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
        const SUB: usize = 24;
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

/// What the tests of `scatter` look at: Lambert, glossy lobes of all widths, both with impulses, and with two normals.
fn surfels() -> Vec<(Surfel, DVec3, Directions)> {
    let mut all = vec![];
    for m in EXPONENTS {
        let mixed = flat_surfel(DVec3::splat(0.3), DVec3::new(0.2, 0.3, 0.1), m);
        let glossy = flat_surfel(DVec3::ZERO, DVec3::splat(0.6), m);
        all.push((mixed, tilted(40.0), Directions::Bsdf));
        all.push((glossy, tilted(75.0), Directions::Bsdf));
        let coated = Surfel {
            reflection: DVec3::splat(0.4),
            transmission: DVec3::splat(0.2),
            eta: Some(1.5),
            impulse_probability: (m == 20.0).then_some(0.6),
            ..mixed
        };
        all.push((coated, tilted(60.0), Directions::Bsdf));
    }
    let bent = Surfel {
        shading_normal: DVec3::new(0.6, 0.0, 0.8),
        reflection: DVec3::splat(0.25),
        ..flat_surfel(DVec3::splat(0.3), DVec3::splat(0.5), 7.0)
    };
    for directions in [Directions::Uniform, Directions::Cosine, Directions::Bsdf] {
        all.push((bent, tilted(-20.0), directions));
    }
    all
}

/// What `scatter` chooses has the density that `bsdf_pdf` claims, cell by cell; and what it does not choose among directions that count are
/// impulses and directions below the surface.
#[test]
fn scatter_has_its_density() {
    for (index, (surfel, wo, directions)) in surfels().into_iter().enumerate() {
        let mirror = 2.0 * wo.dot(surfel.shading_normal) * surfel.shading_normal - wo;
        let cells = Cells { axis: mirror, power: if surfel.exponent > 100.0 { 6 } else { 2 } };
        let mut expected = cells.integrate(|wi| f64::from(N) * bsdf_pdf(&surfel, wo, wi, directions));
        let mass = expected.iter().sum::<f64>() / f64::from(N);
        assert!(mass <= 1.0 + 1e-3, "density of {mass}");
        expected.push((1.0 - mass).max(0.0) * f64::from(N));
        let mut counts = vec![0; expected.len()];
        for i in 0..N {
            let [u, v, lobe, _] = numbers(i, index as u32);
            let scattered = scatter(&surfel, wo, directions, [u, v, lobe]);
            match scattered.pdf {
                Some(pdf) if pdf > 0.0 => {
                    assert!((scattered.wi.length() - 1.0).abs() < 1e-13);
                    let expected = surfel.bsdf(wo, scattered.wi) * surfel.shading_normal.dot(scattered.wi) / pdf;
                    assert_eq!(pdf, bsdf_pdf(&surfel, wo, scattered.wi, directions));
                    assert!((scattered.weight - expected).length() <= 1e-12 * expected.length());
                    counts[cells.cell(scattered.wi)] += 1;
                }
                below_or_impulse => {
                    assert!(below_or_impulse.is_none() || scattered.weight == DVec3::ZERO);
                    counts[expected.len() - 1] += 1;
                }
            }
        }
        let p = chi_square_against(&counts, &expected);
        assert!(p >= SIGNIFICANCE, "surfel {index}, m = {}, {directions:?}: p = {p:.1e}", surfel.exponent);
    }
}

/// The chi-square test of `scatter` notices a density that is three per cent off its direction.
#[test]
fn the_test_of_densities_has_power() {
    let surfel = flat_surfel(DVec3::splat(0.3), DVec3::splat(0.3), 20.0);
    let wo = tilted(40.0);
    let cells = Cells { axis: tilted(-40.0), power: 2 };
    let other = Surfel { glossy: DVec3::splat(0.33), ..surfel };
    let mut expected = cells.integrate(|wi| f64::from(N) * bsdf_pdf(&other, wo, wi, Directions::Bsdf));
    expected.push(f64::from(N) - expected.iter().sum::<f64>());
    let mut counts = vec![0; expected.len()];
    for i in 0..N {
        let [u, v, lobe, _] = numbers(i, 77);
        let scattered = scatter(&surfel, wo, Directions::Bsdf, [u, v, lobe]);
        counts[if scattered.pdf > Some(0.0) { cells.cell(scattered.wi) } else { expected.len() - 1 }] += 1;
    }
    let p = chi_square_against(&counts, &expected);
    assert!(p < 1e-9, "p = {p}");
}

/// All that is scattered, impulses included, is what was there, at every angle and for every exponent; and no more than what arrived. The
/// mean weight does not depend on how directions are chosen, nor on the probability of impulses.
#[test]
fn directional_albedo_is_at_most_one() {
    let mut block = 100;
    for m in EXPONENTS {
        for degrees in [0.0, 45.0, 80.0, 89.9] {
            let wo = tilted(degrees);
            let glossy = directional_albedo(&flat_surfel(DVec3::ZERO, DVec3::ONE, m), wo);
            let surfel = Surfel {
                reflection: DVec3::splat(0.3),
                transmission: DVec3::splat(0.3),
                eta: Some(1.5),
                ..flat_surfel(DVec3::splat(0.3), DVec3::splat(0.4), m)
            };
            let impulses = surfel.impulses(wo);
            assert!((impulses.reflection + impulses.transmission - 0.3).length() < 1e-15);
            let expected = 0.3 + 0.4 * glossy + 0.3;
            assert!(expected <= 1.0 + 1e-4, "m = {m} at {degrees} degrees: {expected}");
            for (directions, probability) in [
                (Directions::Bsdf, None),
                (Directions::Bsdf, Some(0.6)),
                (Directions::Cosine, Some(0.1)),
                (Directions::Uniform, None),
            ] {
                // Narrow lobes are only found by those who look for them.
                if directions != Directions::Bsdf && m > 20.0 {
                    continue;
                }
                let surfel = Surfel { impulse_probability: probability, ..surfel };
                block += 1;
                let weights = (0..50_000).map(|i| {
                    let [u, v, lobe, _] = numbers(i, block);
                    let scattered = scatter(&surfel, wo, directions, [u, v, lobe]);
                    scattered.weight.x * scattered.eta2
                });
                // The quadrature of the lobe is good to 1e-4.
                Estimate::new(weights).assert_within(expected - 1e-4, expected + 1e-4, 2e-2);
            }
        }
    }
}

/// Light may go either way, at every exponent and down to grazing angles.
#[test]
fn bsdf_is_reciprocal_at_every_exponent() {
    for m in EXPONENTS {
        let surfel = flat_surfel(DVec3::splat(0.3), DVec3::splat(0.5), m);
        for i in 0..1000 {
            let [a, b, c, d] = numbers(i, 5);
            let wo = uniform_hemisphere(DVec3::Z, 1.0 - (1.0 - a).powi(3), b);
            let wi = uniform_hemisphere(DVec3::Z, c, d);
            let (there, back) = (surfel.bsdf(wo, wi), surfel.bsdf(wi, wo));
            assert!((there - back).length() <= 1e-12 * there.length(), "m = {m}");
        }
    }
}

/// Corners of triangles, and the point they are seen from: near, far, from the edge, large, tiny, narrow.
fn triangles() -> Vec<([DVec3; 3], DVec3)> {
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

fn seen_from(from: DVec3, corners: [DVec3; 3]) -> [DVec3; 3] {
    corners.map(|corner| (corner - from).normalize())
}

/// The excess of the angles of a spherical triangle over those of a plane one (Girard).
fn girard([a, b, c]: [DVec3; 3]) -> f64 {
    let angle = |at: DVec3, b: DVec3, c: DVec3| at.cross(b).angle_between(at.cross(c));
    angle(a, b, c) + angle(b, c, a) + angle(c, a, b) - PI
}

#[test]
fn solid_angles() {
    assert!((solid_angle([DVec3::X, DVec3::Y, DVec3::Z]) - 0.5 * PI).abs() < 1e-15);
    for (corners, from) in triangles() {
        let seen = seen_from(from, corners);
        let (found, expected) = (solid_angle(seen), girard(seen));
        assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        let [a, b, c] = seen;
        assert!((solid_angle([b, a, c]) - found).abs() < 1e-14, "either winding");
    }
    // Far away it is the area over the squared distance.
    let far = seen_from(DVec3::new(0.0, 0.0, 1e6), triangles()[0].0);
    assert!((solid_angle(far) / 0.5e-12 - 1.0).abs() < 1e-9);
}

/// Directions fall into the parts of a triangle in proportion to the solid angle of the parts.
#[test]
fn spherical_triangles_are_sampled_evenly() {
    const PARTS: usize = 12;
    for (index, (corners, from)) in triangles().into_iter().enumerate() {
        let [a, b, c] = corners;
        let omega = solid_angle(seen_from(from, corners));
        let point = |i: usize, j: usize| a + (b - a) * (i as f64 / PARTS as f64) + (c - a) * (j as f64 / PARTS as f64);
        let mut expected = vec![0.0; 2 * PARTS * PARTS];
        for i in 0..PARTS {
            for j in 0..PARTS - i {
                let lower = [point(i, j), point(i + 1, j), point(i, j + 1)];
                expected[2 * (i * PARTS + j)] = girard_or_flat(seen_from(from, lower)) / omega;
                if i + j + 1 < PARTS {
                    let upper = [point(i + 1, j + 1), point(i, j + 1), point(i + 1, j)];
                    expected[2 * (i * PARTS + j) + 1] = girard_or_flat(seen_from(from, upper)) / omega;
                }
            }
        }
        let mass: f64 = expected.iter().sum();
        assert!((mass - 1.0).abs() < 1e-6, "triangle {index}: the parts have {mass} of the whole");
        expected.iter_mut().for_each(|share| *share *= f64::from(N));
        let mut counts = vec![0; expected.len()];
        let normal = (b - a).cross(c - a);
        for n in 0..N {
            let [u, v, ..] = numbers(n, 200 + index as u32);
            let wi = spherical_triangle(seen_from(from, corners), u, v);
            assert!((wi.length() - 1.0).abs() < 1e-12, "triangle {index}: {wi}");
            let hit = from + wi * (a - from).dot(normal) / wi.dot(normal) - a;
            // Weights of the second and third corner.
            let s = hit.cross(c - a).dot(normal) / normal.length_squared() * PARTS as f64;
            let t = (b - a).cross(hit).dot(normal) / normal.length_squared() * PARTS as f64;
            assert!(s > -1e-6 && t > -1e-6 && s + t < PARTS as f64 + 1e-6, "triangle {index}: outside at {s}, {t}");
            let (i, j) = ((s.max(0.0) as usize).min(PARTS - 1), (t.max(0.0) as usize).min(PARTS - 1));
            let upper = usize::from(s.fract() + t.fract() > 1.0 && i + j + 1 < PARTS);
            counts[2 * (i * PARTS + j.min(PARTS - 1 - i)) + upper] += 1;
        }
        let p = chi_square_against(&counts, &expected);
        assert!(p >= SIGNIFICANCE, "triangle {index}: p = {p:.1e}");
    }
}

/// Girard's formula, or for triangles that are nearly flat, which it cannot tell from nothing, the area.
fn girard_or_flat([a, b, c]: [DVec3; 3]) -> f64 {
    let flat = 0.5 * (b - a).cross(c - a).length();
    if flat < 1e-5 { flat } else { girard([a, b, c]) }
}

/// The densities per steradian of points on a triangle integrate to 1 over the directions to it, by area and by solid angle.
#[test]
fn triangle_densities_integrate_to_one() {
    for sampling in [AreaSampling::Area, AreaSampling::SolidAngle] {
        let mut scene: Scene = empty(1, 1);
        add(&mut scene, cube(), matte(DVec3::ONE.as_vec3()), Affine3A::IDENTITY);
        estimator(&mut scene).area_sampling = sampling;
        let tracer = Reference::new(&scene);
        for (index, (corners, from)) in triangles().into_iter().enumerate() {
            let [a, b, c] = corners;
            let omega = solid_angle(seen_from(from, corners));
            let normal = (b - a).cross(c - a);
            let samples = (0..100_000).map(|n| {
                let [u, v, ..] = numbers(n, 300 + index as u32);
                let wi = spherical_triangle(seen_from(from, corners), u, v);
                let point = from + wi * (a - from).dot(normal) / wi.dot(normal);
                omega * tracer.triangle_density(from, corners, point)
            });
            // Seen from very near by area the integrand has a heavy tail.
            Estimate::new(samples).assert_is(1.0, 0.1);
        }
    }
}
