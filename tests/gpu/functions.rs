//! Single shader functions against their twins in Rust.

use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::warp;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Luminaire, LuminaireTable, Material};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A scene with lights of all kinds, and a glossy material.
pub fn scene() -> luminaire::scene::Scene {
    let mut scene = cornell_like(4, 4);
    scene.luminaires.push(Luminaire::Infinite { direction: -Vec3::Y, irradiance: Vec3::ONE });
    scene
}

/// The numbers that these are the bits of.
pub fn floats(bits: [u32; 4]) -> [f64; 4] {
    bits.map(|b| f64::from(f32::from_bits(b)))
}

/// A vector, without what follows it.
pub fn vector(bits: [u32; 4]) -> DVec3 {
    DVec3::from_slice(&floats(bits))
}

/// The bits of numbers.
pub fn call(x: [f32; 4], y: [f32; 4]) -> Call {
    [x.map(f32::to_bits), y.map(f32::to_bits)]
}

/// Two numbers as the samplers draw them.
pub fn units(rng: &mut StdRng) -> [f32; 2] {
    // Multiples of 2^-24, as the samplers draw them, the extremes included.
    [0, 1].map(|_| match rng.random_range(0..50) {
        0 => 0.0,
        1 => 1.0 - f32::EPSILON / 2.0,
        2 => 0.5,
        _ => uniform(rng.random()) as f32,
    })
}

#[test]
fn random_numbers_are_the_same_bits() {
    let mut rng = StdRng::seed_from_u64(1);
    let mut calls: Vec<Call> = (0..100_000).map(|_| [rng.random(), [0; 4]]).collect();
    calls.extend((0..4096u32).map(|i| [[i % 64, i / 64, i % 5, 0], [0; 4]]));
    calls.push([[u32::MAX; 4], [0; 4]]);
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene(), backend.ray_query).expect("a probe");
        let results = probe.call(Function::Random4, &calls).expect("the probe runs");
        for (call, result) in calls.iter().zip(results) {
            let [pixel, sample, block, seed] = call[0];
            assert_eq!(result[0], random4(pixel, sample, block, seed), "{call:?}");
        }
    });
}

#[test]
fn choice_of_a_luminaire_is_the_same() {
    let mut rng = StdRng::seed_from_u64(2);
    let calls: Vec<Call> = (0..100_000).map(|_| [[rng.random(), 0, 0, 0], [0; 4]]).collect();
    let scene = scene();
    let table = LuminaireTable::new(&scene);
    assert_eq!(table.entries.len(), 4);
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let results = probe.call(Function::ChooseLuminaire, &calls).expect("the probe runs");
        for (call, result) in calls.iter().zip(results) {
            assert_eq!(result[0][0] as usize, table.choice.choose(call[0][0]));
        }
    });
}

#[test]
fn warps_match_to_rounding() {
    let mut rng = StdRng::seed_from_u64(3);
    let calls: Vec<Call> = (0..200_000)
        .map(|_| {
            let [u, v] = units(&mut rng);
            [[u.to_bits(), v.to_bits(), 0, 0], [0; 4]]
        })
        .collect();
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene(), backend.ray_query).expect("a probe");
        let directions = probe.call(Function::CosineHemisphere, &calls).expect("the probe runs");
        let triangles = probe.call(Function::UniformTriangle, &calls).expect("the probe runs");
        for ((call, direction), triangle) in calls.iter().zip(directions).zip(triangles) {
            let [u, v, ..] = floats(call[0]);
            let found = DVec3::from_slice(&floats(direction[0]));
            let expected = warp::cosine_hemisphere(DVec3::Z, u, v);
            // x and y to two units in the last place of 1; near the horizon z is the square root of a small difference.
            assert!((found - expected).truncate().abs().max_element() < 2.4e-7, "({u}, {v}): {found} {expected}");
            assert!((found.z * found.z - expected.z * expected.z).abs() < 4.8e-7, "({u}, {v}): {found} {expected}");
            let expected = DVec3::from(warp::uniform_triangle(u, v));
            let found = DVec3::from_slice(&floats(triangle[0]));
            assert!((found - expected).abs().max_element() < 1.2e-7, "({u}, {v}): {found} {expected}");
        }
    });
}

/// The BRDF, over exponents from 0 to 10 000 and directions on both sides of the surface.
#[test]
fn bsdf_matches() {
    let mut rng = StdRng::seed_from_u64(5);
    let mut scene = scene();
    let exponents = [0.0, 0.5, 1.0, 20.0, 300.0, 10_000.0];
    let first = scene.materials.len() as u32;
    for exponent in exponents {
        let (lambert, glossy) = (Vec3::new(0.1, 0.5, 0.0), Vec3::new(0.9, 0.25, 1.0));
        scene.materials.push(Material { glossy, exponent, ..matte(lambert) });
    }
    let mut direction = || {
        let [u, v] = units(&mut rng);
        let d = warp::cosine_hemisphere(DVec3::Z, f64::from(u), f64::from(v)).as_vec3();
        if rng.random_bool(0.1) { -d } else { d }
    };
    let calls: Vec<Call> = (0..100_000u32)
        .map(|i| {
            let (wo, wi) = (direction(), direction());
            let wo = if wo.z < 0.0 { -wo } else { wo };
            // Near the mirror direction, where the lobe is.
            let wi = if i / 6 % 3 == 0 { (Vec3::new(-wo.x, -wo.y, wo.z) + 0.01 * wi).normalize() } else { wi };
            let material = first + i % exponents.len() as u32;
            let [x, y, z] = [wo.x, wo.y, wo.z].map(f32::to_bits);
            [[x, y, z, material], [wi.x.to_bits(), wi.y.to_bits(), wi.z.to_bits(), 0]]
        })
        .collect();
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let mut lobes = 0;
        for (call, result) in calls.iter().zip(probe.call(Function::Bsdf, &calls).expect("the probe runs")) {
            let material = scene.materials[call[0][3] as usize].clone();
            let (wo, wi) = (DVec3::from_slice(&floats(call[0])), DVec3::from_slice(&floats(call[1])));
            let exponent = f64::from(material.exponent);
            let surfel = flat_surfel(material.lambert.as_dvec3(), material.glossy.as_dvec3(), exponent);
            let expected = surfel.bsdf(wo, wi);
            let found = DVec3::from_slice(&floats(result[0]));
            // cos^m amplifies the rounding of the cosine (a few 2^-24) m times, and pow() has an error of its own.
            let tolerance = 1e-6 * (1.0 + exponent) * expected + 1e-6;
            let difference = (found - expected).abs();
            assert!(difference.cmple(tolerance).all(), "m = {exponent}, wo {wo}, wi {wi}: {found} {expected}");
            lobes += u32::from(expected.x > 1.0);
        }
        assert!(lobes > 1000, "the lobe was hardly met");
    });
}

#[test]
fn probe_runs_without_calls() {
    let mut plain = empty(1, 1);
    add(&mut plain, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &plain, backend.ray_query).expect("a probe");
        assert!(probe.call(Function::Random4, &[]).expect("nothing to do").is_empty());
    });
}
