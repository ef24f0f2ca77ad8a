//! Textures and the environment: what is looked up, and which directions are chosen.

use super::functions::{call, floats, vector};
use super::pictures::{differing, pixels};
use super::*;
use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine2, Affine3A, DVec2, DVec3, Vec2, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::{Reference, texture::bilinear};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Environment, EnvironmentDistribution, EnvironmentImage, LightSampling, Texture};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Under a turned sky with a sun; textures of odd sizes, that repeat and that end.
fn scene() -> Scene {
    let mut scene = empty(4, 4);
    let mut material = matte(Vec3::splat(0.5));
    material.maps.lambert = Some(0);
    add(&mut scene, cube(), material, Affine3A::IDENTITY);
    scene.environment = Some(sky());
    for (index, (width, height)) in [(1, 1), (2, 2), (5, 3), (1, 7), (64, 33)].into_iter().enumerate() {
        for clamp in [false, true] {
            let mut texture = texture(width, height, |x, y| {
                random4(x, y, index as u32, 1).map(|number| (4.0 * uniform(number)) as f32)
            });
            texture.clamp = clamp;
            scene.textures.push(texture.into());
        }
    }
    scene
}

/// The same with a few of them in other places, one image in several: scales and offsets of the size that people write.
#[test]
fn lookups_of_placed_maps_match() {
    let mut scene = scene();
    for (index, (scale, offset)) in
        [((2.0, 2.0), (0.5, 0.0)), ((-1.0, 10.0), (0.25, -0.75)), ((0.0, 1.0), (0.1, 0.2))].into_iter().enumerate()
    {
        for texture in [4 + index, 8, 9] {
            let transform = Affine2::from_scale_angle_translation(Vec2::from(scale), 0.0, Vec2::from(offset));
            let placed = Texture { transform, ..Texture::clone(&scene.textures[texture]) };
            scene.textures.push(placed.into());
        }
    }
    let mut rng = StdRng::seed_from_u64(24);
    let mut calls: Vec<Call> = Vec::new();
    for map in 0..scene.textures.len() as u32 {
        let mut look = |u: f32, v: f32| calls.push([[map, u.to_bits(), v.to_bits(), 0], [0; 4]]);
        (0..2000).for_each(|_| look(rng.random_range(-3.0..4.0), rng.random_range(-3.0..4.0)));
        [(f32::NAN, 0.3), (0.6, f32::INFINITY)].into_iter().for_each(|(u, v)| look(u, v));
    }
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        for (arguments, result) in calls.iter().zip(probe.call(Function::TextureAt, &calls).expect("the probe runs")) {
            let texture = &scene.textures[arguments[0][0] as usize];
            let [u, v] = [1, 2].map(|i| f64::from(f32::from_bits(arguments[0][i])));
            let expected = bilinear(texture, DVec2::new(u, v)).to_array();
            // Up to 40 times the size of the picture, rounded three times; and the texels are 4 at most.
            let tolerance = 4.0 * (40.0 * 3.6e-7 * f64::from(texture.width.max(texture.height)) + 3.6e-7);
            for (found, expected) in floats(result[0]).into_iter().zip(expected) {
                assert!((found - expected).abs() <= tolerance, "{arguments:?}, {u} {v}: {found} {expected}");
            }
        }
    });
}

#[test]
fn lookups_match_and_directions_have_their_density() {
    let scene = scene();
    let reference = Reference::new(&scene);
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        textures(&probe, &scene);
        environment(&probe, &reference);
        sampled_directions(&probe, &reference);
    });
}

/// Coordinates of a hundred thousand turns, as of pictures that lie by the metre on a map of a country: the picture is there as the reference
/// has it, within a thousandth of a texel, since whole turns are left out.
#[test]
fn coordinates_of_many_turns_keep_their_digits() {
    let mut scene = empty(32, 32);
    scene.sensor = pinhole(Vec3::new(0.5, 0.5, 1.0), Vec3::new(0.5, 0.5, 0.0), Vec3::Y, 40.0);
    let mut sheet = quad(Vec3::ZERO, Vec3::X, Vec3::Y);
    sheet.uvs = sheet.positions.iter().map(|p| p.truncate() + Vec2::new(1e5, -3e5)).collect();
    let mut glow = lamp(Vec3::ONE);
    glow.maps.emission = Some(0);
    add(&mut scene, sheet, glow, Affine3A::IDENTITY);
    let image = texture(64, 64, |x, y| random4(x, y, 0, 2).map(|number| uniform(number) as f32));
    scene.textures.push(image.into());
    let expected = pixels(&mut Reference::new(&scene), &scene, 4);
    on_every_backend(|backend| {
        let found = pixels(&mut backend.tracer(&scene), &scene, 4);
        let count = differing(&found, &expected, 2e-3);
        assert!(count <= found.len() / 100, "{}: {count} pixels differ", backend.name());
    });
}

/// Texture coordinates of all sorts: inside, outside, exactly on borders and centres, huge, and no numbers at all.
fn textures(probe: &Probe, scene: &Scene) {
    let mut rng = StdRng::seed_from_u64(21);
    let special = [
        0.0,
        -0.0,
        1.0,
        0.5,
        -1.0,
        2.0,
        -0.25,
        0.1,
        -1e-9,
        1e-9,
        1f32.next_down(),
        1f32.next_up(),
        1e4 + 0.37,
        -12345.678,
        3e9,
        f32::MIN_POSITIVE,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    let mut calls: Vec<Call> = Vec::new();
    for map in 0..scene.textures.len() as u32 {
        let mut look = |u: f32, v: f32| calls.push([[map, u.to_bits(), v.to_bits(), 0], [0; 4]]);
        special.iter().for_each(|u| special.iter().for_each(|v| look(*u, *v)));
        for _ in 0..5000 {
            look(rng.random_range(-3.0..4.0), rng.random_range(-3.0..4.0));
            look(rng.random_range(-1e4..1e4), rng.random());
        }
    }
    for (arguments, result) in calls.iter().zip(probe.call(Function::TextureAt, &calls).expect("the probe runs")) {
        let texture = &scene.textures[arguments[0][0] as usize];
        let [u, v] = [1, 2].map(|i| f64::from(f32::from_bits(arguments[0][i])));
        let expected = bilinear(texture, DVec2::new(u, v)).to_array();
        // The place rounds by three units in the last place of 1, times the texels; from one texel to the next it is 4 at most.
        let tolerance = 4.0 * (3.6e-7 * f64::from(texture.width.max(texture.height)) + 3.6e-7);
        for (found, expected) in floats(result[0]).into_iter().zip(expected) {
            let size = [texture.width, texture.height];
            assert!(
                (found - expected).abs() <= tolerance,
                "{size:?} clamp {}, {u} {v}: {found} {expected}",
                texture.clamp
            );
        }
    }
}

/// Whether rounding may put a direction into the next texel.
fn on_an_edge(w: DVec3) -> bool {
    let [x, y] = sky_position(w);
    // Near the poles a little makes many columns, but f32 vectors keep their digits there.
    [x, y].iter().any(|x| (x - x.round()).abs() < 2e-5)
}

/// Radiance and density, on the whole sphere, around its poles, at the seam.
fn environment(probe: &Probe, reference: &Reference) {
    let mut rng = StdRng::seed_from_u64(22);
    let mut directions: Vec<Vec3> = (0..100_000)
        .map(|i| {
            let phi: f64 = rng.random_range(-4.0..4.0);
            let cos: f64 = rng.random_range(-1.0..1.0);
            let cos: f64 = if i % 10 == 0 { cos.signum() * (1.0 - 1e-6 * cos.abs()) } else { cos };
            sky_direction(phi, cos).as_vec3()
        })
        .collect();
    // At the poles themselves the azimuth is anything.
    directions.extend([Vec3::X, -Vec3::X, Vec3::Z, -Vec3::Z]);
    let seam = sky_direction(std::f64::consts::PI - 37f64.to_radians(), 0.3);
    directions.extend([seam.as_vec3(), (seam + 1e-7 * DVec3::X).as_vec3(), (seam - 1e-7 * DVec3::X).as_vec3()]);
    let calls: Vec<Call> = directions.iter().map(|w| call([w.x, w.y, w.z, 0.0], [0.0; 4])).collect();
    let (mut dark, mut bright) = (0, 0);
    for (w, result) in directions.iter().zip(probe.call(Function::EnvironmentAt, &calls).expect("the probe runs")) {
        let w = w.as_dvec3();
        let (found, expected) = (vector(result[0]), reference.environment_radiance(w));
        // The sun is 60 times the rest: the place rounds by 1e-6 texels.
        assert!((found - expected).abs().max_element() <= 120.0 * 4e-6, "{w}: {found} {expected}");
        let ([.., found], expected) = (floats(result[0]), reference.environment_density(w));
        assert!((found - expected).abs() <= 1.2e-7 * expected || on_an_edge(w), "{w}: {found} {expected}");
        dark += u32::from(expected < 0.02);
        bright += u32::from(expected > 0.5);
    }
    assert!(dark > 1000 && bright > 1000, "{dark} {bright}");
}

/// Directions fall into parts of texels by their density, at the significance of 1e-4; and the density that a direction comes with is
/// the one that is found when it is looked up.
fn sampled_directions(probe: &Probe, reference: &Reference) {
    const N: u32 = 200_000;
    let expected: Vec<f64> =
        shares_of_sky(|w| reference.environment_density(w)).into_iter().map(|share| share * f64::from(N)).collect();
    let random: Vec<[u32; 4]> = (0..N).map(|i| random4(i, 0, 1, 23)).collect();
    let sampled = assert_directions_are_the_twin_s(probe, reference, &random);
    let back: Vec<Call> = sampled.iter().map(|result| [*result, [0; 4]]).collect();
    let looked_up = probe.call(Function::EnvironmentAt, &back).expect("the probe runs");
    let mut counts = vec![0; expected.len()];
    let mut edges = 0;
    for (sampled, looked_up) in sampled.into_iter().zip(looked_up) {
        let w = vector(sampled);
        counts[part_of_sky(w)] += 1;
        if on_an_edge(w) {
            edges += 1;
        } else {
            assert_eq!(sampled[3], looked_up[0][3], "{w}: the same bits");
        }
    }
    assert!(edges < N / 1000, "{edges} on edges");
    let p = chi_square_against(&counts, &expected);
    println!("environment: p = {p:.3}");
    assert!(p >= SIGNIFICANCE, "p = {p:e}");
}

/// The same numbers choose the same texel, to the last one of them, with the same density, and the same direction up to rounding.
fn assert_directions_are_the_twin_s(probe: &Probe, reference: &Reference, random: &[[u32; 4]]) -> Vec<[u32; 4]> {
    let calls: Vec<Call> = random.iter().map(|r| [[r[0], r[1], 0, 0], [0; 4]]).collect();
    let sampled = probe.call(Function::SampleEnvironment, &calls).expect("the probe runs");
    for (random, sampled) in random.iter().zip(&sampled) {
        let (w, [.., density]) = (vector(sampled[0]), floats(sampled[0]));
        let (twin, expected) = reference.sample_environment([random[0], random[1]]).expect("not black");
        assert_eq!(density as f32, expected as f32, "{random:?}: {w} {twin}");
        // Where the sine is the root of a small difference, it is known to half its digits.
        let tolerance = 1e-6 + 2e-7 / twin.x.hypot(twin.z).max(5e-4);
        assert!((w - twin).length() <= tolerance, "{random:?}: {w} {twin}");
    }
    sampled.into_iter().map(|result| result[0]).collect()
}

/// Skies of one texel, of one row or column, of sizes around the powers of four in which the kernel searches, black rows among them, and a small
/// sun in four million texels: the same texels as the reference's.
#[test]
fn skies_of_all_sizes() {
    let sizes = [[1, 1], [1, 5], [17, 1], [4, 16], [5, 64], [67, 3], [4097, 1024]];
    let skies = sizes.map(|[width, height]| {
        let texel = |i: u32| {
            let [grey, black, ..] = random4(i, i / width, 0, width).map(|r| uniform(r) as f32);
            if width > 3 && (black < 0.2 || (i / width).is_multiple_of(5)) { Vec3::ZERO } else { Vec3::splat(grey) }
        };
        let mut texels: Vec<Vec3> = (0..width * height).map(texel).collect();
        texels[(width * height / 3) as usize] = Vec3::splat(0.5 * (width * height) as f32);
        EnvironmentImage { name: "sky".into(), width, height, texels }
    });
    on_every_backend(|backend| {
        for sky in &skies {
            let (width, height) = (sky.width, sky.height);
            let mut scene = empty(4, 4);
            add(&mut scene, quad(-Vec3::ONE, Vec3::X, Vec3::Z), matte(Vec3::ONE), Affine3A::IDENTITY);
            estimator(&mut scene).light_sampling = LightSampling::Direct;
            scene.environment =
                Some(Environment { radiance: Vec3::ONE, image: Some(sky.clone().into()), rotation: 0.0 });
            let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
            let mut random: Vec<[u32; 4]> = (0..4000).map(|i| random4(i, 0, 1, 23)).collect();
            // The first and the last number of rows and columns.
            let distribution = EnvironmentDistribution::new(scene.environment.as_ref().expect("a sky"), 0.0);
            let distribution = distribution.expect("not black");
            for cdf in [&distribution.rows, &distribution.columns[height as usize / 3]] {
                let some = cdf.starts.iter().step_by(1 + cdf.starts.len() / 100);
                let numbers = some.flat_map(|start| [2 * u64::from(*start), (2 * u64::from(*start)).saturating_sub(1)]);
                let sun = 2 * distribution.rows.starts[height as usize / 3];
                random.extend(
                    numbers.filter(|n| *n < 1 << 32).flat_map(|n| [[n as u32, 77, 0, 0], [sun, n as u32, 0, 0]]),
                );
            }
            assert_directions_are_the_twin_s(&probe, &Reference::new(&scene), &random);
            println!("{width} x {height}, {}", backend.name());
        }
    });
}
