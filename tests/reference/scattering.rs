//! Directions against their densities: hemispheres, lobes, mixtures, triangles. Every chi-square test and every mean has the
//! significance 1e-4.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::sampling::histogram;
use glam::{Affine3A, DVec3};
use luminaire::reference::Reference;
use luminaire::reference::bsdf::bsdf_pdf;
use luminaire::reference::scatter::scatter;
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::*;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{AreaSampling, Directions, Scene, coat_transmittance};
use std::f64::consts::PI;

const N: u32 = 300_000;

fn numbers(i: u32, block: u32) -> [f64; 4] {
    random4(i, 3, block, 11).map(uniform)
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

/// What the tests of `scatter` look at: Lambert, glossy lobes of all widths, both under a coat and in glass, and with two normals.
fn surfels() -> Vec<(Surfel, DVec3, Directions)> {
    let mut all = vec![];
    for m in EXPONENTS {
        let mixed = flat_surfel(DVec3::splat(0.3), DVec3::new(0.2, 0.3, 0.1), m);
        let glossy = flat_surfel(DVec3::ZERO, DVec3::splat(0.6), m);
        all.push((mixed, tilted(40.0), Directions::Bsdf));
        all.push((glossy, tilted(75.0), Directions::Bsdf));
        let coated = Surfel {
            reflection: DVec3::splat(0.4),
            transmission: DVec3::splat(if m == 1.0 { 0.2 } else { 0.0 }),
            eta: Some(1.5),
            coat_transmittance: coat_transmittance(1.5),
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
/// mean weight does not depend on how directions are chosen, nor on the probability of impulses. Under a coat, and in glass.
#[test]
fn directional_albedo_is_at_most_one() {
    let mut block = 100;
    for m in EXPONENTS {
        for (degrees, transmission) in [(0.0, 0.0), (45.0, 0.3), (80.0, 0.0), (89.9, 0.3)] {
            let wo = tilted(degrees);
            let glossy = directional_albedo(&flat_surfel(DVec3::ZERO, DVec3::ONE, m), wo);
            let surfel = Surfel {
                reflection: DVec3::splat(0.3),
                transmission: DVec3::splat(transmission),
                eta: Some(1.5),
                coat_transmittance: coat_transmittance(1.5),
                ..flat_surfel(DVec3::splat(0.3), DVec3::splat(0.4), m)
            };
            let impulses = surfel.impulses(wo);
            let impulse = (impulses.reflection + impulses.transmission).x;
            assert!(transmission == 0.0 || (impulse - 0.3).abs() < 1e-15);
            // Under the coat there is a little less of the base than beside it.
            let lobe = directional_albedo(&Surfel { lambert: DVec3::ZERO, ..surfel }, wo);
            let base = 0.3 * (1.0 - if surfel.is_coated() { impulse } else { 0.0 }) + lobe;
            let expected = base + impulse;
            assert!(base <= 0.3 + 0.4 * glossy + 1e-3, "m = {m} at {degrees} degrees: {base}");
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
    for (index, (corners, from)) in triangles().into_iter().enumerate() {
        let mut expected = shares_of_parts(corners, from);
        expected.iter_mut().for_each(|share| *share *= f64::from(N));
        let mut counts = vec![0; expected.len()];
        for n in 0..N {
            let [u, v, ..] = numbers(n, 200 + index as u32);
            let wi = spherical_triangle(seen_from(from, corners), u, v);
            assert!((wi.length() - 1.0).abs() < 1e-12, "triangle {index}: {wi}");
            let (part, outside) = part_of(corners, from, wi);
            assert!(outside < 1e-7, "triangle {index}: outside by {outside}");
            counts[part] += 1;
        }
        let p = chi_square_against(&counts, &expected);
        assert!(p >= SIGNIFICANCE, "triangle {index}: p = {p:.1e}");
    }
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
