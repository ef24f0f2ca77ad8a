//! Metallic-roughness surfaces as the GPU does them, against the reference, direction by direction; furnaces; absorption.

use super::functions::{call, floats, vector};
use super::pictures::{mean, pixels};
use super::*;
use crate::common::directions::tilted;
use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, INSIDE, Probe};
use luminaire::reference::Reference;
use luminaire::reference::bsdf::bsdf_pdf;
use luminaire::reference::scatter::scatter;
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::uniform_hemisphere;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Directions, Environment, LEAST_ALPHA, Material, Physical};

/// Directions for every surface and viewing direction.
const N: u32 = 3000;

/// Surfaces of every kind, with whether they are sheets.
fn surfaces() -> Vec<(Physical, bool)> {
    let mut all = vec![];
    for roughness in [0.0, 0.05, 0.25, 0.6, 1.0] {
        let base_color = Vec3::new(0.9, 0.5, 0.1);
        let plastic = Physical { roughness, base_color, ..Physical::default() };
        all.push((plastic.clone(), false));
        all.push((copper(roughness), false));
        all.push((Physical { metallic: 1.0, anisotropy: 0.6, ..plastic.clone() }, false));
        all.push((Physical { anisotropy: 0.8, metallic: 0.2, transmission: 0.4, ..plastic.clone() }, false));
        for ior in [1.05, 1.5, 2.4] {
            all.push((Physical { transmission: 1.0, ior, ..plastic.clone() }, false));
        }
        all.push((Physical { transmission: 0.6, metallic: 0.2, ..plastic.clone() }, true));
        let coated = Physical { clearcoat: 0.8, clearcoat_roughness: 0.2, metallic: 0.3, transmission: 0.5, ..plastic };
        all.push((coated.clone(), false));
        let specular_color = Vec3::new(3.0, 1.0, 0.2);
        all.push((
            Physical { transmission: 0.0, clearcoat_roughness: 0.0, specular: 0.7, specular_color, ior: 0.0, ..coated },
            false,
        ));
    }
    // Where a square of single precision may fall to the other side; where what is rough hardly bends; and the limits of indices.
    let [white, black] = [Vec3::ONE, Vec3::ZERO];
    let glass = Physical { transmission: 1.0, base_color: white, ..Physical::default() };
    all.push((Physical { metallic: 1.0, roughness: 0.01, ..Physical::default() }, false));
    all.push((Physical { clearcoat: 1.0, clearcoat_roughness: 0.01, ..Physical::default() }, false));
    for (roughness, ior) in [(0.02, 1.25), (0.012, 1.5), (0.03, 1.05), (0.5, 1.0003)] {
        all.push((Physical { roughness, ior, ..glass.clone() }, false));
    }
    let specular_color = Vec3::new(1.0, 0.2, 0.0);
    for (roughness, ior) in [(0.0, 10.0), (0.5, 5.0)] {
        all.push((Physical { roughness, ior, specular_color, base_color: black, ..Physical::default() }, false));
    }
    let conductor = Some([Vec3::new(0.0, 1.0, 0.2), Vec3::new(0.0, 0.0, 3.9)]);
    all.push((Physical { metallic: 1.0, conductor, ..Physical::default() }, false));
    all.push((Physical { metallic: 1.0, clearcoat: 1.0, clearcoat_roughness: 0.0, ..Physical::default() }, false));
    all
}

/// By how much of itself a value at a direction may be off, through rounding of the half vector.
fn tolerance(surfel: &Surfel, wo: DVec3, wi: DVec3) -> f64 {
    let p = surfel.physical().expect("a surface");
    let width = (p.roughness * p.roughness).max(LEAST_ALPHA);
    let narrow = if wi.z < 0.0 && p.body { (p.ior - 1.0).abs().min(1.0) } else { 1.0 };
    let coat = if p.clearcoat > 0.0 { (p.clearcoat_roughness * p.clearcoat_roughness).max(LEAST_ALPHA) } else { 1.0 };
    // Near the critical angle of the microfacet what it lets through is the root of a small difference.
    let eta = if p.body && !surfel.front { 1.0 / p.ior } else { p.ior };
    let sum = if wi.z < 0.0 { wo + eta * wi } else { wo + wi };
    let sine2 = 1.0 - wo.dot(sum.normalize_or_zero()).powi(2);
    let critical = 1e-6 / (eta * eta - sine2).abs().max(1e-7);
    let critical = if p.body && !surfel.front { critical } else { 0.0 };
    5e-5 + critical + 1e-5 / (width.min(coat) * narrow) + 1e-6 / wo.z.min(wi.z.abs()).max(1e-4)
}

/// For every surface from both sides: values and densities at any pair of directions; and which way a path goes, with its weight and its density.
#[test]
fn surfaces_are_those_of_the_reference() {
    let surfaces = surfaces();
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let first = scene.materials.len() as u32;
    let materials =
        surfaces.iter().map(|(p, thin)| Material { physical: Some(p.clone()), thin: *thin, ..Material::default() });
    scene.materials.extend(materials);
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let (mut compared, mut elsewhere, mut taken) = (0, 0, 0);
        for (index, (p, thin)) in surfaces.iter().enumerate() {
            for (degrees, front) in [(3.0, true), (50.0, true), (83.0, true), (20.0, false), (65.0, false)] {
                let surfel = physical_surfel(p, *thin, front);
                let material = (first + index as u32) | if front { 0 } else { INSIDE };
                let view = tilted(degrees).as_vec3();
                let wo = view.as_dvec3();
                let surfel = viewed_from(&surfel, wo);
                let name = format!("{p:?}, thin {thin}, front {front}, at {degrees} degrees");
                let calls: Vec<Call> = (0..N)
                    .map(|i| {
                        let mut call = call([view.x, view.y, view.z, 0.0], [0.0; 4]);
                        call[0][3] = material;
                        call[1] = random4(i, material, 3, 41);
                        call
                    })
                    .collect();
                let paths = probe.call(Function::Scatter, &calls).expect("the probe runs");
                for (arguments, path) in calls.iter().zip(&paths) {
                    let ([.., pdf], [.., eta2]) = (floats(path[0]), floats(path[1]));
                    let (wi, weight) = (vector(path[0]), vector(path[1]));
                    let [u, v, lobe, _] = arguments[1].map(uniform);
                    let twin = scatter(&surfel, wo, Directions::Bsdf, [u, v, lobe]);
                    let what = format!("{name}, ({u}, {v}, {lobe}): {wi} {weight} {pdf} {eta2} {twin:?}");
                    taken += 1;
                    // A choice between lobes, or what is just below the horizon, may fall otherwise.
                    if (pdf < 0.0) != twin.pdf.is_none() || (wi - twin.wi).length() > 2e-3 {
                        elsewhere += 1;
                        continue;
                    }
                    if pdf < 0.0 {
                        let expected = twin.weight * twin.eta2;
                        assert!((weight - expected).abs().cmple(expected * 1e-4 + 1e-6).all(), "{what}");
                        continue;
                    }
                    if pdf == 0.0 || twin.pdf == Some(0.0) {
                        continue;
                    }
                    let again = bsdf_pdf(&surfel, wo, wi, Directions::Bsdf);
                    let off = tolerance(&surfel, wo, wi);
                    assert!((pdf - again).abs() <= off * again, "{what}: pdf {again}");
                    let expected = surfel.bsdf(wo, wi) * wi.z.abs() / again * eta2;
                    assert!((weight - expected).abs().cmple(expected * off + 1e-6).all(), "{what}: weight {expected}");
                    assert!((eta2 - twin.eta2).abs() <= 1e-5 * eta2, "{what}");
                    compared += 1;
                }
                // Any directions: near what is mirrored, and far from it, above and below.
                let pairs: Vec<Call> = (0..N)
                    .map(|i| {
                        let [a, b, c, _] = random4(i, material, 4, 41).map(uniform);
                        let far = uniform_hemisphere(DVec3::Z, a.max(1e-3), b).as_vec3();
                        let near = (Vec3::new(-view.x, -view.y, view.z) + 0.1 * far).normalize();
                        let wi =
                            [far, near][i as usize % 2] * if c < 0.5 { Vec3::ONE } else { Vec3::new(1.0, 1.0, -1.0) };
                        let mut call = call([view.x, view.y, view.z, 0.0], [wi.x, wi.y, wi.z, 0.0]);
                        call[0][3] = material;
                        call
                    })
                    .collect();
                let found = probe.call(Function::Bsdf, &pairs).expect("the probe runs");
                for (pair, found) in pairs.iter().zip(found) {
                    let (wi, [r, g, b, pdf]) = (vector(pair[1]), floats(found[0]));
                    let value = DVec3::new(r, g, b);
                    let expected = surfel.bsdf(wo, wi) * surfel.dilution(wi);
                    let density = bsdf_pdf(&surfel, wo, wi, Directions::Bsdf);
                    let off = tolerance(&surfel, wo, wi);
                    assert!(
                        (value - expected).abs().cmple(expected * off + 1e-5).all(),
                        "{name}, {wi}: {value} {expected}"
                    );
                    assert!((pdf - density).abs() <= density * off + 1e-5, "{name}, {wi}: {pdf} {density}");
                }
            }
        }
        println!("{}: {compared} of {taken} compared, {elsewhere} went elsewhere", backend.name());
        assert!(elsewhere < taken / 200, "{elsewhere} of {taken} went elsewhere");
    });
}

/// White surfaces under a white sky: the picture is white. Balls of rough metal, plastic, rough glass, within 0.5 %.
#[test]
fn white_balls_under_a_white_sky_are_white() {
    for (p, samples) in [
        (Physical { metallic: 1.0, roughness: 0.05, ..Physical::default() }, 64),
        (Physical { metallic: 1.0, roughness: 0.5, ..Physical::default() }, 64),
        (Physical { metallic: 1.0, roughness: 1.0, ..Physical::default() }, 64),
        (Physical { roughness: 0.3, ..Physical::default() }, 64),
        (Physical { roughness: 0.4, transmission: 1.0, ..Physical::default() }, 128),
        // Hardly bent: what goes through is an impulse, what is reflected is none.
        (Physical { roughness: 0.05, ior: 1.03, transmission: 1.0, ..Physical::default() }, 16),
        (Physical { roughness: 0.8, transmission: 0.5, metallic: 0.3, ..Physical::default() }, 256),
    ] {
        let mut scene = empty(12, 12);
        scene.sensor = pinhole(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 26.0);
        add(
            &mut scene,
            icosphere(3),
            Material { physical: Some(p.clone()), ..Material::default() },
            Affine3A::IDENTITY,
        );
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        let check = |name: &str, pixels: &[DVec3]| {
            let off = (mean(pixels) - 1.0).abs().max_element();
            let square: f64 = pixels.iter().map(|p| (p.x - 1.0).powi(2)).sum();
            let error = square.sqrt() / pixels.len() as f64;
            let Physical { roughness, metallic, transmission, .. } = p;
            println!(
                "{name}, roughness {roughness}, metallic {metallic}, transmission {transmission}: off by {off:.1e} +- {error:.1e}"
            );
            assert!(off < 5e-3 + 3.0 * error, "{name}, {p:?}: {}", mean(pixels));
            assert!(error < 1.5e-2, "{name}, {p:?}: {error}");
        };
        check("reference", &pixels(&mut Reference::new(&scene), &scene, samples));
        on_every_backend(|backend| check(backend.name(), &pixels(&mut backend.tracer(&scene), &scene, 8 * samples)));
    }
}

/// A white metal that is brushed sends out all of what falls on it, at every roughness, strength, angle and azimuth: mean weights of the kernel's directions, within 0.5 %.
#[test]
fn white_brushed_metal_is_white_at_every_angle() {
    const N: u32 = 6000;
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let first = scene.materials.len() as u32;
    let mut materials = vec![];
    for roughness in [0.05, 0.2, 0.4, 0.7, 0.95] {
        for anisotropy in [0.0, 0.1, 0.4, 0.7, 1.0] {
            materials.push(Physical { metallic: 1.0, roughness, anisotropy, ..Physical::default() });
        }
    }
    let material = |p: &Physical| Material { physical: Some(p.clone()), ..Material::default() };
    scene.materials.extend(materials.iter().map(material));
    let mut cases = vec![];
    for (number, p) in (first..).zip(&materials) {
        for degrees in [0.0, 40.0, 75.0, 89.5f64] {
            for turn in [0.0, 30.0, 65.0, 90.0f64] {
                let ((sin, cos), (y, x)) = (degrees.to_radians().sin_cos(), turn.to_radians().sin_cos());
                let wo = DVec3::new(sin * x, sin * y, cos).as_vec3();
                let what =
                    format!("roughness {}, anisotropy {}, at {degrees}, {turn} degrees", p.roughness, p.anisotropy);
                cases.push((number, wo, what));
            }
        }
    }
    // Roberts' sequence for three dimensions.
    let bits = |i: u32| {
        let even = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3f64];
        let [u, v, lobe] = even.map(|step| ((0.5 + step * f64::from(i + 1)).fract() * 2f64.powi(32)) as u32);
        [u, v, lobe, 0]
    };
    let calls: Vec<Call> = cases
        .iter()
        .flat_map(|(number, wo, _)| {
            (0..N).map(move |i| {
                let mut call = call([wo.x, wo.y, wo.z, 0.0], [0.0; 4]);
                (call[0][3], call[1]) = (*number, bits(i));
                call
            })
        })
        .collect();
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let paths = probe.call(Function::Scatter, &calls).expect("the probe runs");
        let off = cases.iter().zip(paths.chunks_exact(N as usize)).map(|((.., what), paths)| {
            let sum: f64 =
                paths.iter().map(|path| if floats(path[0])[3] == 0.0 { 0.0 } else { vector(path[1]).x }).sum();
            (sum / f64::from(N) - 1.0, what)
        });
        let (off, what) = off.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).expect("some");
        println!("{}: off by at most {off:.1e}: {what}", backend.name());
        assert!(off.abs() <= 5e-3, "{}, {what}: {off}", backend.name());
    });
}

/// Beer's law: a body of index 1, twice as long as the distance in which the light takes on the colour, lets the square of the colour through.
#[test]
fn bodies_absorb_by_their_length() {
    for roughness in [0.0, 0.5] {
        let p = Physical {
            roughness,
            ior: 1.0,
            transmission: 1.0,
            attenuation_color: Vec3::new(0.9, 0.5, 0.1),
            attenuation_distance: 1.0,
            ..Physical::default()
        };
        let mut scene = empty(2, 2);
        scene.sensor = pinhole(Vec3::new(0.0, 0.0, 400.0), Vec3::ZERO, Vec3::Y, 0.05);
        add(&mut scene, cube(), Material { physical: Some(p), ..Material::default() }, Affine3A::IDENTITY);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        let expected = DVec3::new(0.81, 0.25, 0.01);
        let check = |name: &str, found: DVec3| assert!((found - expected).length() < 1e-4, "{name}: {found}");
        check("reference", mean(&pixels(&mut Reference::new(&scene), &scene, 4)));
        on_every_backend(|backend| check(backend.name(), mean(&pixels(&mut backend.tracer(&scene), &scene, 4))));
    }
}
