//! Small shader functions against their twins in Rust, over everything that they may be asked. Every bound says what rounding it
//! stands for; 1.2e-7 is one unit in the last place of 1.

use super::functions::{call, floats, scene, units, vector};
use super::*;
use crate::common::directions::EXPONENTS;
use glam::DVec3;
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::{impulse, warp};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

#[test]
fn small_functions_match_to_rounding() {
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene(), backend.ray_query).expect("a probe");
        sines_and_angles(&probe);
        hemispheres(&probe);
        half_vectors(&probe);
        refraction(&probe);
    });
}

/// Sine and cosine to two units in the last place of 1, between -2 and 2 turns; the angle to three in its own last place, in every
/// direction and for vectors of any length.
fn sines_and_angles(probe: &Probe) {
    let mut rng = StdRng::seed_from_u64(11);
    let mut calls: Vec<Call> = (0..100_000)
        .map(|_| {
            let mut coordinate = || {
                let length = 10f32.powf(rng.random_range(-15.0..15.0));
                match rng.random_range(0..10) {
                    0 => 0.0,
                    1..=3 => length,
                    4..=6 => -length,
                    _ => rng.random_range(-1.0..1.0),
                }
            };
            let (y, x) = (coordinate(), coordinate());
            call([rng.random_range(-2.0..2.0), 0.0, 0.0, 0.0], [y, x, 0.0, 0.0])
        })
        .collect();
    for eighth in -16..=16 {
        let turns = eighth as f32 / 8.0;
        for turns in [turns, turns.next_up(), turns.next_down()] {
            let diagonal = [1.0, 1f32.next_up(), -1.0, 0.5][eighth as usize % 4];
            calls.push(call([turns, 0.0, 0.0, 0.0], [1.0, diagonal, 0.0, 0.0]));
        }
    }
    for (arguments, result) in calls.iter().zip(probe.call(Function::SinCos, &calls).expect("the probe runs")) {
        let ([turns, ..], [y, x, ..]) = (floats(arguments[0]), floats(arguments[1]));
        let [sin, cos, angle, _] = floats(result[0]);
        let expected = (TAU * turns).sin_cos();
        assert!((sin - expected.0).abs().max((cos - expected.1).abs()) <= 2.4e-7, "{turns} turns: {sin} {cos}");
        // What is smaller may be flushed to zero.
        let expected = y.atan2(x);
        assert!((angle - expected).abs() <= 3.6e-7 * expected.abs() + 1e-37, "angle of ({x}, {y}): {angle} {expected}");
    }
}

fn hemispheres(probe: &Probe) {
    let mut rng = StdRng::seed_from_u64(12);
    let uv: Vec<[f32; 2]> = (0..100_000).map(|_| units(&mut rng)).collect();
    let calls: Vec<Call> = uv.iter().map(|[u, v]| call([*u, *v, 0.0, 0.0], [0.0; 4])).collect();
    let results = probe.call(Function::UniformHemisphere, &calls).expect("the probe runs");
    for ([u, v], result) in uv.iter().zip(results) {
        let (found, expected) = (vector(result[0]), warp::uniform_hemisphere(DVec3::Z, f64::from(*u), f64::from(*v)));
        assert_eq!(found.z, expected.z, "1 - u is exact");
        // Sine, cosine, root and product.
        assert!((found - expected).abs().max_element() <= 4e-7, "({u}, {v}): {found} {expected}");
    }
}

/// The squared sine is the difference of 1 and a power: to 2e-5 of itself, since `exp` and `log` may be off by several units.
fn half_vectors(probe: &Probe) {
    let mut rng = StdRng::seed_from_u64(13);
    let arguments: Vec<[f32; 3]> = (0..100_000)
        .map(|i| {
            let [u, v] = units(&mut rng);
            [u, v, EXPONENTS[i % EXPONENTS.len()] as f32]
        })
        .collect();
    let calls: Vec<Call> = arguments.iter().map(|[u, v, m]| call([*u, *v, *m, 0.0], [0.0; 4])).collect();
    let results = probe.call(Function::GlossyHalfVector, &calls).expect("the probe runs");
    for (arguments, result) in arguments.iter().zip(results) {
        let [u, v, m] = arguments.map(f64::from);
        let (found, expected) = (vector(result[0]), warp::glossy_half_vector(DVec3::Z, m, u, v));
        let sine2 = expected.truncate().length_squared();
        let off = (found - expected).truncate().length();
        assert!(off <= (1e-5 + 5e-7) * sine2.sqrt(), "m = {m}, ({u}, {v}): {found} {expected}");
        let off = (found.z * found.z - expected.z * expected.z).abs();
        assert!(off <= 2e-5 * sine2 + 2.4e-7, "m = {m}, ({u}, {v}): {found} {expected}");
    }
}

/// Snell and Fresnel, for indices above and below 1, from the normal to grazing angles, through total reflection.
fn refraction(probe: &Probe) {
    const INDICES: [f32; 9] = [1.5, 1.0 / 1.5, 1.0, 1.33, 2.4, 1.0 / 2.4, 1.0001, 0.9999, 10.0];
    let mut rng = StdRng::seed_from_u64(14);
    let mut calls = Vec::new();
    for (i, eta) in (0..180_000).map(|i| (i, INDICES[i % INDICES.len()])) {
        let u: f64 = rng.random();
        let cosine = match i / INDICES.len() % 4 {
            0 => u,
            1 => 10f64.powf(-6.0 * u),                                              // grazing
            2 => 1.0 - 10f64.powf(-7.0 * u),                                        // near the normal
            _ => (1.0 - f64::from(eta).powi(2).min(1.0)).sqrt() + 1e-3 * (u - 0.5), // the critical angle
        };
        let cosine = cosine.clamp(1e-7, 1.0);
        let phi = TAU * rng.random::<f64>();
        let wo =
            DVec3::new((1.0 - cosine * cosine).sqrt() * phi.cos(), (1.0 - cosine * cosine).sqrt() * phi.sin(), cosine);
        let wo = wo.as_vec3();
        calls.push(call([wo.x, wo.y, wo.z, eta], [0.0; 4]));
    }
    let (mut total, mut partial) = (0, 0);
    for (arguments, result) in calls.iter().zip(probe.call(Function::Refract, &calls).expect("the probe runs")) {
        let (wo, [.., eta]) = (vector(arguments[0]), floats(arguments[0]));
        let (found, [.., reflectance]) = (vector(result[0]), floats(result[0]));
        let sine2 = (1.0 - wo.z * wo.z) / (eta * eta);
        // What the rounding of 1 - cos^2, of the quotient, and of 1 minus that may do to the squared cosine behind the surface.
        let margin = 1.2e-7 / (eta * eta) + 3e-7 * sine2 + 6e-8;
        let expected = impulse::fresnel(eta, wo.z);
        let what = format!("eta = {eta}, wo {wo}: {found}, {reflectance} instead of {expected}");
        if (1.0 - sine2).abs() <= 2.0 * margin {
            // Either is right. The reflectance falls from 1 like the root of the distance to the critical angle.
            let cos_t = (4.0 * margin).sqrt();
            assert!(reflectance <= 1.0 && reflectance > 1.0 - 4.0 * (1.0 / eta).max(eta) * cos_t / wo.z, "{what}");
        } else if sine2 > 1.0 {
            total += 1;
            assert!(found == DVec3::ZERO && reflectance == 1.0, "{what}");
        } else {
            partial += 1;
            let cos_t = (1.0 - sine2).sqrt();
            let off = margin / cos_t;
            let direction = impulse::refract(wo, DVec3::Z, eta).expect("not total");
            assert!((found - direction).length() <= 1e-6 + 2.0 * off, "{what}: {direction}");
            let slope = 2.0 * eta * wo.z * ((wo.z + eta * cos_t).powi(-2) + (eta * wo.z + cos_t).powi(-2));
            assert!((reflectance - expected).abs() <= 1e-6 + slope * off, "{what}");
        }
    }
    assert!(total > 20_000 && partial > 100_000, "{total} {partial}");
}
