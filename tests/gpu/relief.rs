//! Maps of normals and heights, and smoothed terminators: the reference and every backend against what is known.

use super::pictures::{mean, pixels};
use super::*;
use crate::common::relief::*;
use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use luminaire::reference::Reference;
use luminaire::scene::{Environment, Luminaire, Material, Physical, Scene};

/// What every tracer makes of a scene.
fn everywhere(scene: &Scene, samples: u32, check: impl Fn(&str, &[DVec3])) {
    check("reference", &pixels(&mut Reference::new(scene), scene, samples));
    on_every_backend(|backend| check(backend.name(), &pixels(&mut backend.tracer(scene), scene, samples)));
}

/// A map of one normal, or a ramp of heights, on a plane: Lambert's cosine to the normal that the picture shows, wherever it lies.
#[test]
fn planes_are_as_bright_as_their_normals_say() {
    let (scene, expected) = planes();
    everywhere(&scene, 2, |who, pixels| {
        let bound = if who == "reference" { 1e-6 } else { 1e-5 };
        let off = |(expected, pixel): (&(String, f64), &DVec3)| {
            ((pixel / expected.1 - 1.0).abs().max_element(), expected.0.clone())
        };
        let off: Vec<_> = expected.iter().zip(pixels).map(off).collect();
        let worst = off.iter().map(|(off, _)| *off).fold(0.0, f64::max);
        println!("{who}: {} planes are off by at most {worst:.1e}", pixels.len());
        let wrong: Vec<_> = off.iter().filter(|(off, _)| off.is_nan() || *off > bound).collect();
        assert!(wrong.is_empty(), "{who}: {wrong:#?}");
    });
}

/// A black sheet with a coat, in the light of a sun that the coat mirrors towards the camera: a map that tilts the sheet's normal leaves the coat as it is
/// (`KHR_materials_clearcoat`), smooth or rough.
#[test]
fn coats_are_not_bent() {
    const DIAMETER: f32 = 6.0;
    let scene = |clearcoat_roughness: f32, tilted: bool| {
        let mut scene = empty(8, 8);
        scene.sensor = pinhole(Vec3::Z * 5.0, Vec3::ZERO, Vec3::Y, 1.0);
        scene.textures = vec![normals(4, 4, |_, _| Vec2::new(0.6, 0.2)).into()];
        let black = Physical {
            base_color: Vec3::ZERO,
            specular: 0.0,
            clearcoat: 1.0,
            clearcoat_roughness,
            ..Physical::default()
        };
        let material = Material { physical: Some(black), ..Material::default() };
        let mut sheet = quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0);
        sheet.uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        let material = if tilted { with_normals(0, 1.0, material) } else { material };
        add(&mut scene, sheet, material, Affine3A::IDENTITY);
        scene.luminaires = vec![Luminaire::Sun { direction: Vec3::NEG_Z, irradiance: Vec3::ONE, angle: DIAMETER }];
        scene
    };
    // A smooth coat of index 1.5 shows 4 % of the disc, of irradiance 1.
    let radius = (0.5 * f64::from(DIAMETER)).to_radians();
    let shown = 0.04 / (std::f64::consts::PI * radius.sin().powi(2));
    let plain = scene(0.3, false);
    let rough = mean(&pixels(&mut Reference::new(&plain), &plain, 16)).x;
    assert!(rough > 0.05, "{rough}");
    for (roughness, expected) in [(0.0, shown), (0.3, rough)] {
        for tilted in [false, true] {
            everywhere(&scene(roughness, tilted), 16, |who, pixels| {
                let found = mean(pixels).x;
                assert!(
                    (found / expected - 1.0).abs() < 2e-3,
                    "{who}, roughness {roughness}, tilted {tilted}: {found} {expected}"
                );
            });
        }
    }
}

/// Flat maps everywhere: the picture without them, but for rounding.
#[test]
fn flat_maps_change_nothing() {
    let [mut plain, mut flat] = flat_rooms(48);
    for scene in [&mut plain, &mut flat] {
        estimator(scene).max_bounces = Some(2);
    }
    let same = |name: &str, a: &[DVec3], b: &[DVec3], tolerance: f64, most: usize| {
        let off = |(a, b): (&DVec3, &DVec3)| ((a - b).abs() / b.max(DVec3::splat(1e-3))).max_element();
        let mut off: Vec<f64> = a.iter().zip(b).map(off).collect();
        off.sort_by(f64::total_cmp);
        let beyond = off.iter().filter(|off| **off > tolerance).count();
        println!(
            "{name}: {} of {} pixels have the same bits, {beyond} are off by more than {tolerance:e}; the worst by {:.1e}",
            off.iter().filter(|off| **off == 0.0).count(),
            off.len(),
            off[off.len() - 1]
        );
        assert!(beyond <= most, "{name}: {beyond} pixels are off");
    };
    let found = [&plain, &flat].map(|scene| pixels(&mut Reference::new(scene), scene, 4));
    same("reference", &found[0], &found[1], 1e-12, found[0].len() / 500);
    on_every_backend(|backend| {
        let found = [&plain, &flat].map(|scene| pixels(&mut backend.tracer(scene), scene, 4));
        same(backend.name(), &found[0], &found[1], 2e-5, found[0].len() / 200);
    });
}

/// White balls with a steep map under a white sky: no surface sends back more than it gets, none has black spots, and what is lost is known: the part of each lobe
/// that lies below the surface, which at a mirror is none.
#[test]
fn steep_normals_neither_gain_light_nor_make_holes() {
    // Of the light of the whole ball and of its darkest pixel, what the map may cost: slopes of up to 0.5, and of up to 1.5, each way.
    let costs = [
        (
            0.5,
            [0.05, 0.0, 0.001, 0.008, 0.045, 0.04, 0.055, 0.002, 0.08],
            [0.1, 0.2, 0.001, 0.05, 0.08, 0.1, 0.08, 0.01, 0.13],
        ),
        (
            1.5,
            [0.17, 0.33, 0.001, 0.14, 0.28, 0.29, 0.18, 0.002, 0.37],
            [0.26, 0.45, 0.001, 0.33, 0.36, 0.47, 0.23, 0.02, 0.52],
        ),
    ];
    let plain = white_balls(0.0).1;
    let plain = of_balls(&pixels(&mut Reference::new(&plain), &plain, 128));
    let least = |pixels: &[DVec3]| pixels.iter().map(|p| p.min_element()).fold(f64::INFINITY, f64::min);
    for (steepness, costs, darks) in costs {
        let (names, scene) = white_balls(steepness);
        everywhere(&scene, 128, |who, pixels| {
            let balls = of_balls(pixels);
            let bounds = costs.into_iter().zip(darks);
            for ((name, ball), (plain, (cost, dark))) in names.iter().zip(&balls).zip(plain.iter().zip(bounds)) {
                let (found, expected) = (mean(ball).x, mean(plain).x);
                let (darkest, darkest_plain) = (least(ball), least(plain));
                println!(
                    "slopes of {steepness}, {name}, {who}: mean {found:.4}, without {expected:.4}, costs {:.3} ({cost}); darkest {darkest:.3}, without \
                     {darkest_plain:.3}, costs {:.3} ({dark})",
                    1.0 - found / expected,
                    1.0 - darkest / darkest_plain
                );
                assert!(ball.iter().all(|p| p.is_finite()), "{name}, {who}");
                assert!(found <= 1.005, "{name}, {who}: {found}");
                assert!(found >= expected * (1.0 - cost), "{name}, {who}: {found}, without the map {expected}");
                assert!(darkest >= darkest_plain * (1.0 - dark), "{name}, {who}: {darkest}, without {darkest_plain}");
            }
        });
    }
}

/// A diffuse plane whose normal is bent by an angle, seen from above under an even sky: of the cosine lobe `(1 - cos) / 2` lies below the surface, and that is all
/// that is lost.
#[test]
fn what_bent_diffuse_surfaces_lose_is_what_lies_below_them() {
    for degrees in [15f32, 40.0] {
        let mut scene = empty(8, 8);
        scene.sensor = pinhole(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 1.0);
        let mut mesh = quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0);
        mesh.uvs = mesh.positions.iter().map(|p| p.truncate()).collect();
        let (sin, cos) = degrees.to_radians().sin_cos();
        scene.textures = vec![texture(1, 1, |_, _| [0.5 + 0.5 * sin, 0.5, 0.5 + 0.5 * cos, 1.0]).into()];
        add(&mut scene, mesh, with_normals(0, 1.0, matte(Vec3::ONE)), Affine3A::IDENTITY);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        let expected = 0.5 * (1.0 + f64::from(cos));
        everywhere(&scene, 1024, |who, pixels| {
            let found = mean(pixels).x;
            println!("{degrees} degrees, {who}: {found:.5} for {expected:.5}");
            assert!((found / expected - 1.0).abs() < 2e-3, "{degrees} degrees, {who}: {found} for {expected}");
        });
    }
}

/// Coarse balls lit from the side against the round one: the smoothed terminator is nearer to it, in the mean and at its worst; and it is a choice.
#[test]
fn smoothed_terminators_are_nearer_to_the_round_ball() {
    for (subdivisions, better) in [(1, 0.75), (2, 0.75)] {
        let (mut scene, truth) = coarse_ball(subdivisions, 64);
        assert!(!estimator(&mut scene).smooth_terminator, "it is off unless somebody asks for it");
        let mut smooth = scene.clone();
        estimator(&mut smooth).smooth_terminator = true;
        // The root of the mean square, and the largest error, of the brightest radiance there is.
        let error = |pixels: &[DVec3]| {
            let off = pixels.iter().zip(&truth).filter_map(|(p, truth)| Some((p.x - (*truth)?) * std::f64::consts::PI));
            let off: Vec<f64> = off.collect();
            assert!(off.len() > 2000, "{}", off.len());
            let square: f64 = off.iter().map(|off| off * off).sum();
            ((square / off.len() as f64).sqrt(), off.iter().map(|off| off.abs()).fold(0.0, f64::max))
        };
        let check = |who: &str, without: &[DVec3], with: &[DVec3]| {
            let ((rms, most), (smooth_rms, smooth_most)) = (error(without), error(with));
            println!(
                "ball {subdivisions}, {who}: root mean square {rms:.4}, smoothed {smooth_rms:.4}; largest {most:.3}, smoothed {smooth_most:.3}"
            );
            assert!(smooth_rms < better * rms && smooth_most < most, "ball {subdivisions}, {who}");
        };
        let found = [&scene, &smooth].map(|scene| pixels(&mut Reference::new(scene), scene, 16));
        check("reference", &found[0], &found[1]);
        on_every_backend(|backend| {
            let found = [&scene, &smooth].map(|scene| pixels(&mut backend.tracer(scene), scene, 16));
            check(backend.name(), &found[0], &found[1]);
        });
    }
}

/// It changes no mesh without vertex normals, to the last bit, and gains no light where it changes something.
#[test]
fn smoothed_terminators_leave_flat_meshes_alone() {
    let mut flat = cornell_like(24, 24);
    for mesh in flat.meshes.iter_mut().map(Arc::make_mut) {
        mesh.normals.clear();
    }
    let mut smooth = flat.clone();
    estimator(&mut smooth).smooth_terminator = true;
    let [a, b] = [&flat, &smooth].map(|scene| pixels(&mut Reference::new(scene), scene, 2));
    assert_eq!(a, b);
    on_every_backend(|backend| {
        let [a, b] = [&flat, &smooth].map(|scene| pixels(&mut backend.tracer(scene), scene, 2));
        assert_eq!(a, b, "{}", backend.name());
    });
    let mut ball = empty(12, 12);
    ball.sensor = pinhole(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 26.0);
    add(&mut ball, mapped_ball(1), matte(Vec3::ONE), Affine3A::IDENTITY);
    ball.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    estimator(&mut ball).smooth_terminator = true;
    everywhere(&ball, 256, |who, pixels| {
        let found = mean(pixels).x;
        println!("white ball under a white sky, {who}: {found:.4}");
        assert!((0.9..1.005).contains(&found), "{who}: {found}");
    });
}

/// Where vertex normals lean inwards nothing comes through a sheet from behind, neither at the steps of a bowl nor where they hardly lean.
#[test]
fn smoothed_terminators_let_nothing_through_from_behind() {
    for (lean, elevation) in [(30.0, 10.0), (2.0, 0.5), (0.01, 0.002)] {
        for azimuth in [20.0, 200.0] {
            let scene = hollow_sheet(lean, elevation, azimuth);
            everywhere(&scene, 4, |who, pixels| {
                let most = pixels.iter().map(|p| p.max_element()).fold(0.0, f64::max);
                assert!(most == 0.0, "{who}, {lean}, {elevation}, {azimuth}: {most}");
            });
        }
    }
}
