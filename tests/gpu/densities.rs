//! What the shaders draw against the densities that they claim: chi-square tests on the GPU's own numbers, at the significance of 1e-4
//! for all of a test together (Sidak).

use super::functions::{call, floats, vector};
use super::*;
use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::luminaire::spot_falloff;
use luminaire::reference::profile::photometric_intensity;
use luminaire::reference::sun::sample_sun;
use luminaire::reference::warp;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Luminaire, LuminaireTable, Profile, SampledLuminaire, SunDisc};
use std::f64::consts::PI;

const N: u32 = 200_000;

/// Two uniform numbers, as the samplers draw them, and a third argument.
fn units(block: u32, third: f32) -> Vec<Call> {
    (0..N)
        .map(|i| {
            let [u, v, ..] = random4(i, 0, block, 31).map(|number| uniform(number) as f32);
            call([u, v, third, 0.0], [0.0; 4])
        })
        .collect()
}

/// Point and infinite luminaires, and lamps that are the triangles of [`triangles`], with powers of the same order.
fn luminaires() -> Scene {
    let mut scene = empty(4, 4);
    for (index, (corners, _)) in triangles().into_iter().enumerate() {
        let [a, b, c] = corners.map(|corner| corner.as_vec3());
        let area = 0.5 * (b - a).cross(c - a).length();
        let emission = Vec3::new(0.5, 1.0, 1.5) * (1.0 + index as f32) / area;
        add(&mut scene, mesh(vec![a, b, c], &[[0, 1, 2]]), lamp(emission), Affine3A::IDENTITY);
    }
    scene.luminaires.push(Luminaire::Point { position: Vec3::ONE, intensity: Vec3::splat(4.0) });
    scene.luminaires.push(Luminaire::Infinite { direction: -Vec3::Y, irradiance: Vec3::new(1e-3, 2e-3, 3e-3) });
    scene
}

#[test]
fn everything_is_drawn_by_its_density() {
    let scene = luminaires();
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let mut tests = hemispheres(&probe);
        tests.extend(half_vectors(&probe));
        tests.push(("triangle by area".into(), triangle_by_area(&probe)));
        tests.push(("choice of a luminaire".into(), choice_of_a_luminaire(&probe, &scene)));
        tests.extend(spherical_triangles(&probe, &scene));
        tests.extend(discs(backend));
        print!("{}: ", backend.name());
        assert_plausible(&tests);
    });
}

/// Under the cosine density the squared cosine is uniform, under the even one the cosine; the azimuth is under both.
fn hemispheres(probe: &Probe) -> Vec<(String, f64)> {
    [(Function::CosineHemisphere, 2), (Function::UniformHemisphere, 1)]
        .map(|(function, power)| {
            let directions = probe.call(function, &units(1, 0.0)).expect("the probe runs");
            let counts = count_in_square(directions.iter().map(|result| {
                let w = vector(result[0]);
                assert!((w.length() - 1.0).abs() < 1e-6 && w.z >= 0.0, "{w}");
                (w.z.powi(power), azimuth(DVec3::Z, w))
            }));
            (format!("{function:?}"), chi_square(&counts))
        })
        .into()
}

/// Over a disc `1 - cos` is uniform, and so is the azimuth; every direction is its twin's, none is beyond the rim, and the density is one over the solid angle.
/// From the least to half of all directions.
fn discs(backend: &Intersector) -> Vec<(String, f64)> {
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::ONE), Affine3A::IDENTITY);
    for angle in [1e-4, 0.53, 20.0, 180.0] {
        for direction in [Vec3::Y, Vec3::new(2.0, -1.0, 2.0) / 3.0] {
            scene.luminaires.push(Luminaire::Sun { direction, irradiance: Vec3::ONE, angle });
        }
    }
    let table = LuminaireTable::new(&scene);
    let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
    let test = |(number, (index, sun)): (usize, (usize, &SunDisc))| {
        let uv = units(20 + index as u32, f32::from_bits(index as u32));
        let middle = sun.towards.as_dvec3();
        // By the chord, as directions round by some units in the last place of 1.
        let radius = (2.0 * sun.extent).sqrt();
        let results = probe.call(Function::SampleSun, &uv).expect("the probe runs");
        let counts = count_in_square(uv.iter().zip(results).map(|(uv, result)| {
            let ([u, v, ..], [.., density]) = (floats(uv[0]), floats(result[0]));
            let wi = vector(result[0]);
            let twin = sample_sun(sun, u, v);
            assert!((wi - twin).length() < 4e-7, "disc {number}: {wi} for {twin}");
            assert!((density / sun.density() - 1.0).abs() < 1e-6, "disc {number}: {density} for {}", sun.density());
            let chord = (wi - middle).length();
            assert!(chord <= radius + 4e-7, "disc {number}: {chord} beyond {radius}");
            // The least disc is hardly larger than roundings: by its twin.
            let wi = if radius < 1e-4 { twin } else { wi };
            (((wi - middle).length() / radius).powi(2).min(1.0), azimuth(middle, wi - middle))
        }));
        (format!("disc {number}"), chi_square(&counts))
    };
    table.suns().enumerate().map(test).collect()
}

/// What spots and photometric luminaires send in directions all around is what the reference has; narrow spots as far as directions of single precision tell.
#[test]
fn intensities_are_the_reference_s() {
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::ONE), Affine3A::IDENTITY);
    let axis = Vec3::new(0.48, -0.6, 0.64);
    let (position, intensity) = (Vec3::ZERO, Vec3::ONE);
    for (inner, outer) in [(0.0, 90.0), (20.0, 60.0), (30.0, 30.0), (1.0, 2.0), (0.01, 0.02)] {
        scene.luminaires.push(Luminaire::Spot { position, direction: axis, intensity, inner, outer });
    }
    let of = |profile, up| Luminaire::Photometric { position, direction: axis, up, intensity, profile };
    scene.luminaires.push(of(crate::common::stage::profile(), Vec3::Y));
    let even = Profile {
        horizontal: vec![0.0],
        candela: vec![3.0, 1.0, 2.0],
        vertical: vec![0.0, 30.0, 180.0],
        name: String::new(),
    };
    scene.luminaires.push(of(even.into(), Vec3::X));
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        for (index, luminaire) in (0u32..).zip(&scene.luminaires) {
            let spread = match luminaire {
                Luminaire::Spot { outer, .. } => 1.5 * f64::from(*outer).to_radians(),
                _ => 4.0,
            };
            let directions: Vec<DVec3> = (0..4000)
                .map(|i| {
                    let [a, b, c, d] = random4(i, index, 4, 3).map(uniform);
                    let aside = DVec3::new(a, b, c) - 0.5;
                    // Some along the axis itself, and against it.
                    let out = if i % 100 == 0 {
                        axis.as_dvec3() * if i % 200 == 0 { 1.0 } else { -1.0 }
                    } else {
                        axis.as_dvec3() + spread * d * aside.normalize()
                    };
                    out.normalize().as_vec3().as_dvec3()
                })
                .collect();
            let calls: Vec<Call> = directions
                .iter()
                .map(|out| {
                    let [x, y, z] = out.as_vec3().to_array().map(f32::to_bits);
                    [[x, y, z, index], [0; 4]]
                })
                .collect();
            let (mut some, mut farthest) = (0, 0.0f64);
            for (out, result) in directions.iter().zip(probe.call(Function::Intensity, &calls).expect("the probe runs"))
            {
                let found = floats(result[0])[0];
                let expected = match luminaire {
                    Luminaire::Spot { direction, inner, outer, .. } => spot_falloff(*direction, *inner, *outer, *out),
                    Luminaire::Photometric { direction, up, profile, .. } => {
                        photometric_intensity(profile, *direction, *up, *out)
                    }
                    _ => unreachable!("spots and profiles alone"),
                };
                some += u32::from(expected > 0.0);
                // This one has other candelas on its axis for each way around, and which way that is nobody knows.
                if index == 5 && out.cross(axis.as_dvec3()).length() < 1e-3 {
                    assert!((0.0..=7.0).contains(&found), "{found}");
                    continue;
                }
                farthest = farthest.max((found - expected).abs());
            }
            println!("{}, luminaire {index}: {some} lit, off by {farthest:.1e}", backend.name());
            assert!(some > 400, "luminaire {index}: {some}");
            assert!(farthest < 1e-4, "{}, luminaire {index}: off by {farthest:e}", backend.name());
        }
    });
}

/// Under the density `(m + 1) / 2 pi cos^m`, `cos^(m + 1)` is uniform.
fn half_vectors(probe: &Probe) -> Vec<(String, f64)> {
    EXPONENTS
        .map(|m| {
            let vectors = probe.call(Function::GlossyHalfVector, &units(2, m as f32)).expect("the probe runs");
            let counts = count_in_square(vectors.iter().map(|result| {
                let h = vector(result[0]);
                assert!((h.length() - 1.0).abs() < 1e-6 && h.z >= 0.0, "{h}");
                // From the sine where the cosine has few digits.
                let sin2 = h.x * h.x + h.y * h.y;
                let log_cos = if sin2 < 0.5 { 0.5 * (-sin2).ln_1p() } else { h.z.ln() };
                (((m + 1.0) * log_cos).exp(), azimuth(DVec3::Z, h))
            }));
            (format!("half vector, m = {m}"), chi_square(&counts))
        })
        .into()
}

/// For an even distribution over a triangle, `(1 - b0)^2` and `b1 / (1 - b0)` are uniform and independent.
fn triangle_by_area(probe: &Probe) -> f64 {
    let weights = probe.call(Function::UniformTriangle, &units(3, 0.0)).expect("the probe runs");
    chi_square(&count_in_square(weights.iter().map(|result| {
        let [b0, b1, b2, _] = floats(result[0]);
        assert!(b0 >= 0.0 && b1 >= 0.0 && b2 >= -1e-7 && (b0 + b1 + b2 - 1.0).abs() < 2e-7, "{b0} {b1} {b2}");
        ((1.0 - b0).powi(2).min(1.0), if b0 < 1.0 { (b1 / (1.0 - b0)).min(1.0) } else { 0.0 })
    })))
}

/// By power: `4 pi I` of a point, `pi R^2 E` of parallel light onto the scene's sphere, `2 pi A L` of a two-sided lamp.
fn choice_of_a_luminaire(probe: &Probe, scene: &Scene) -> f64 {
    let mean = |colour: Vec3| f64::from(colour.element_sum()) / 3.0;
    let (low, high) = scene.world_bounds();
    let radius2 = (0.5 * (high - low)).length_squared();
    let mut powers = vec![4.0 * PI * 4.0, PI * radius2 * 2e-3];
    for (object, (corners, _)) in triangles().into_iter().enumerate() {
        let [a, b, c] = corners;
        powers.push(2.0 * PI * 0.5 * (b - a).cross(c - a).length() * mean(scene.materials[object].emission));
    }
    let total: f64 = powers.iter().sum();
    let expected: Vec<f64> = powers.iter().map(|power| f64::from(N) * power / total).collect();
    assert!(expected.iter().all(|e| *e > 1000.0), "{expected:?}");
    let calls: Vec<Call> = (0..N).map(|i| [random4(i, 0, 4, 31), [0; 4]]).collect();
    let mut counts = vec![0; expected.len()];
    for result in probe.call(Function::ChooseLuminaire, &calls).expect("the probe runs") {
        counts[result[0][0] as usize] += 1;
    }
    chi_square_against(&counts, &expected)
}

/// Directions fall into the parts of a triangle in proportion to the solid angle of the parts, and none misses it; the solid angle, and
/// the direction, are the reference's. Seen from near, from far, almost from the edge; large, and narrow.
fn spherical_triangles(probe: &Probe, scene: &Scene) -> Vec<(String, f64)> {
    let table = LuminaireTable::new(scene);
    let mut tests = Vec::new();
    for (object, (corners, from)) in triangles().into_iter().enumerate() {
        let is_it = |entry: &SampledLuminaire| matches!(entry, SampledLuminaire::Area(t) if t.object == object as u32);
        let index = table.entries.iter().position(is_it).expect("every triangle is in the table") as u32;
        // What the shader sees.
        let corners = corners.map(|corner| corner.as_vec3().as_dvec3());
        let from = from.as_vec3();
        let [x, y, z] = from.to_array().map(f32::to_bits);
        let uv = units(5 + index, 0.0);
        let calls: Vec<Call> = uv.iter().map(|uv| [[x, y, z, index], uv[0]]).collect();
        let results = probe.call(Function::SphericalTriangle, &calls).expect("the probe runs");
        let from = from.as_dvec3();
        let [a, b, c] = corners;
        let area = 0.5 * (b - a).cross(c - a).length();
        let distance2 = ((a + b + c) / 3.0).distance_squared(from);
        if area / distance2 <= 0.05 {
            assert!(results.iter().all(|result| result[0] == [0; 4]), "triangle {object} is far");
            continue;
        }
        let seen = seen_from(from, corners);
        let omega = warp::solid_angle(seen);
        // A direction rounds by a few units in the last place of 1; on a triangle that is seen at an angle, that is the more.
        let size = (b - a).length().max((c - a).length());
        let height = ((b - a).cross(c - a).normalize().dot(a - from)).abs();
        let farthest = corners.iter().map(|corner| corner.distance(from)).fold(0.0, f64::max);
        let narrow = 2.0 * area / size;
        let tolerance = 2e-6 * farthest * farthest / (height * narrow);
        let share = shares_of_parts(corners, from);
        let expected: Vec<f64> = share.iter().map(|share| f64::from(N) * share).collect();
        let mut counts = vec![0; expected.len()];
        let mut farthest_out = 0.0f64;
        for (uv, result) in uv.iter().zip(results) {
            let ([u, v, ..], [.., found]) = (floats(uv[0]), floats(result[0]));
            let wi = vector(result[0]);
            assert!((wi.length() - 1.0).abs() < 1e-6, "triangle {object}: {wi}");
            assert!(
                (found / omega - 1.0).abs() <= 2e-6 * farthest / height.min(narrow),
                "triangle {object}: {found} for {omega}"
            );
            // Near the second corner the sine of the angle to it is the root of a small difference.
            let twin = warp::spherical_triangle(seen, u, v);
            let off = (wi - twin).length();
            let sine = twin.cross(seen[1]).length();
            assert!(
                off <= 1e-5 + 4e-7 / sine.max(5e-4),
                "triangle {object} at ({u}, {v}): {off:e} off its twin, {sine}"
            );
            let (part, outside) = part_of(corners, from, wi);
            farthest_out = farthest_out.max(outside);
            counts[part] += 1;
        }
        println!("triangle {object}: outside by {farthest_out:.1e} (allowed {tolerance:.1e})");
        assert!(farthest_out <= tolerance, "triangle {object}: outside by {farthest_out:e}");
        tests.push((format!("spherical triangle {object}"), chi_square_against(&counts, &expected)));
    }
    assert_eq!(tests.len(), 6);
    tests
}
