//! What part of a picture is seen, and whether its background is: shifted, cropped and transparent pictures, by the reference and the kernel.

use super::pictures::{differing, pixels};
use super::sensor::distant_sheet;
use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use luminaire::film::{AovSum, Film, Tile};
use luminaire::picture::Crop;
use luminaire::reference::Reference;
use luminaire::render::{Cropped, Limits, Tracer, aovs, render};
use luminaire::scene::{Environment, Integrator, Material, Projection, Sampler, Scene};
use std::sync::atomic::AtomicBool;

static NEVER: AtomicBool = AtomicBool::new(false);

fn film(tracer: &mut dyn Tracer, size: (u32, u32), spp: u32) -> Film {
    let limits = Limits { spp: Some(spp), ..Limits::default() };
    render(tracer, size, limits, &mut |_| {}, &NEVER).expect("the film fits").film
}

/// Runs a test on the reference and on every intersector.
fn on_every_tracer(scene: &Scene, test: impl Fn(&str, &mut dyn Tracer)) {
    test("reference", &mut Reference::new(scene));
    on_every_backend(|backend| test(backend.name(), &mut backend.tracer(scene)));
}

/// A shifted picture is a piece of a wider one, pixel by pixel, with its depths: film points are the pixels' middles, so that no random number shows.
#[test]
fn a_shifted_picture_is_a_piece_of_a_wider_one() {
    const PIECE: Tile = Tile { x: 50, y: 10, width: 32, height: 24 };
    for parallel in [false, true] {
        let mut wide = distant_sheet(1.0, parallel, None);
        (wide.film.width, wide.film.height, wide.film.filter_radius) = (96, 80, 1e-6);
        let mut shifted = wide.clone();
        (shifted.film.width, shifted.film.height) = (PIECE.width, PIECE.height);
        let share = f64::from(PIECE.height) / f64::from(wide.film.height);
        shifted.sensor.projection = match wide.sensor.projection {
            Projection::Perspective { fov } => {
                let half = (0.5 * f64::from(fov).to_radians()).tan() * share;
                Projection::Perspective { fov: (2.0 * half.atan()).to_degrees() as f32 }
            }
            Projection::Orthographic { height } => {
                Projection::Orthographic { height: (f64::from(height) * share) as f32 }
            }
        };
        // The piece's middle is at pixel (66, 22), that of the picture at (48, 40).
        shifted.sensor.shift = Vec2::new(18.0 / 32.0, 18.0 / 24.0);
        let all = Tile { x: 0, y: 0, ..PIECE };
        let check = |name: &str, in_wide: &mut dyn Tracer, in_shifted: &mut dyn Tracer| {
            let whole = pixels(in_wide, &wide, 1);
            let row = |y: u32| ((PIECE.y + y) * 96 + PIECE.x) as usize;
            let piece: Vec<DVec3> = (0..PIECE.height).flat_map(|y| whole[row(y)..row(y) + 32].to_vec()).collect();
            let found = pixels(in_shifted, &shifted, 1);
            // A middle that lies on an edge.
            assert!(differing(&found, &piece, 1e-6) <= 2, "{name}: {}", differing(&found, &piece, 1e-6));
            assert!(piece.contains(&DVec3::ONE) && piece.iter().any(|p| p.x < 0.5), "{name}: nothing to see");
            let depths = in_wide.aovs(PIECE, 0..1).unwrap().into_iter().zip(in_shifted.aovs(all, 0..1).unwrap());
            for (a, b) in depths {
                assert!(a.hits == b.hits && (a.depth - b.depth).abs() < 1e-5, "{name}, {parallel}: {a:?} {b:?}");
            }
        };
        check("reference", &mut Reference::new(&wide), &mut Reference::new(&shifted));
        on_every_backend(|backend| {
            check(backend.name(), &mut backend.tracer(&wide), &mut backend.tracer(&shifted));
        });
    }
}

/// The pixels of a crop are those of the whole picture to the last bit, and so are its first hits; also where samples end within a group.
#[test]
fn a_crop_is_the_whole_picture_s_to_the_last_bit() {
    let size = (40, 30);
    let mut scenes = [textured_room(size.0, size.1), open_air(size.0, size.1)];
    scenes[0].settings.sampler = Sampler::Independent;
    for scene in scenes {
        on_every_tracer(&scene, |name, tracer| {
            let (whole, hits) = (film(tracer, size, 7), aovs(tracer, size, 7, &NEVER).unwrap().unwrap());
            for (x, y, width, height) in [(7, 11, 13, 5), (39, 29, 1, 1), (0, 0, 40, 30), (0, 29, 40, 1)] {
                let crop = Crop { x, y, width, height, whole: size };
                let mut cropped = Cropped::new(tracer, Some(&crop));
                let piece = film(&mut cropped, (width, height), 7);
                let seen: Vec<AovSum> = aovs(&mut cropped, (width, height), 7, &NEVER).unwrap().unwrap().sums;
                for (pixel, seen) in seen.iter().enumerate() {
                    let (column, row) = (pixel as u32 % width, pixel as u32 / width);
                    let there = ((y + row) * size.0 + x + column) as usize;
                    assert!(piece.sums[pixel] == whole.sums[there], "{name}, {crop}: pixel {pixel}");
                    assert!(*seen == hits.sums[there], "{name}, {crop}: pixel {pixel}");
                }
            }
        });
    }
}

/// Black things that glow, one of them with holes, before a sky of one radiance.
fn glowing() -> Scene {
    let mut scene = empty(24, 16);
    add(&mut scene, icosphere(2), lamp([0.5, 2.0, 0.25]), Affine3A::from_translation(Vec3::new(0.6, 0.0, -4.0)));
    let veil = Material { opacity: 0.5, ..lamp([3.0, 0.5, 1.0]) };
    let corner = Vec3::new(-3.0, -0.8, -5.0);
    add(&mut scene, quad(corner, Vec3::X * 2.5, Vec3::Y * 1.5), veil, Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::new(0.25, 0.5, 1.5), image: None, rotation: 0.0 });
    scene
}

/// Over the sky that was hidden, a transparent picture is the opaque one: what is added is the sky, by as much as alpha leaves of it. By the path tracer and
/// the simple ray tracer, with samples that end within a group.
#[test]
fn over_its_sky_a_transparent_picture_is_the_opaque_one() {
    for simple in [false, true] {
        let mut opaque = glowing();
        if simple {
            opaque.integrator = Integrator::Simple { ambient: Vec3::ZERO };
        }
        let sky = opaque.environment.as_ref().unwrap().radiance.as_dvec3();
        let mut transparent = opaque.clone();
        transparent.settings.transparent = true;
        let check = |name: &str, of_opaque: &mut dyn Tracer, of_transparent: &mut dyn Tracer| {
            let expected = film(of_opaque, (24, 16), 18);
            let found = film(of_transparent, (24, 16), 18);
            assert!(expected.missed.is_none() && expected.alphas().is_none() && expected.alpha(0) == 1.0);
            let mut kinds = [0; 4];
            for pixel in 0..found.pixels() {
                let alpha = found.alpha(pixel);
                let over = DVec3::from(found.mean(pixel)) + (1.0 - alpha) * sky;
                let expected = DVec3::from(expected.mean(pixel));
                assert!((over - expected).abs().max_element() < 1e-6, "{name}, {pixel}: {over} {expected}");
                let kind = if alpha == 0.0 {
                    0
                } else if alpha == 1.0 {
                    1
                } else {
                    2
                };
                kinds[kind] += 1;
                // The upper left corner is sky alone, the middle of the veil half of it.
                kinds[3] += usize::from(alpha == 0.5);
                assert!(alpha > 0.0 || found.mean(pixel) == [0.0; 3], "{name}: colour without alpha");
            }
            assert!(kinds[0] > 100 && kinds[1] > 20 && kinds[2] > 40 && kinds[3] > 5, "{name}: {kinds:?}");
        };
        check("reference", &mut Reference::new(&opaque), &mut Reference::new(&transparent));
        on_every_backend(|backend| {
            check(backend.name(), &mut backend.tracer(&opaque), &mut backend.tracer(&transparent));
        });
    }
}

/// Where an edge divides a pixel, alpha is the share that is covered; elsewhere 0 or 1.
#[test]
fn alpha_is_the_share_of_the_pixel_that_is_covered() {
    let mut scene = empty(8, 8);
    scene.settings.sampler = Sampler::Sobol;
    scene.settings.transparent = true;
    scene.sensor = pinhole(Vec3::Z * 5.0, Vec3::ZERO, Vec3::Y, 60.0);
    scene.sensor.projection = Projection::Orthographic { height: 8.0 };
    // Up to a quarter of the third column. There is no light at all: alpha does not ask for any.
    add(
        &mut scene,
        quad(Vec3::new(-5.0, -5.0, 0.0), Vec3::X * 3.25, Vec3::Y * 10.0),
        matte(Vec3::ONE),
        Affine3A::IDENTITY,
    );
    on_every_tracer(&scene, |name, tracer| {
        let found = film(tracer, (8, 8), 256);
        for (pixel, alpha) in found.alphas().expect("alpha").into_iter().enumerate() {
            let expected = [1.0, 1.0, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0][pixel % 8];
            let off = if expected == 0.25 { 0.01 } else { 0.0 };
            assert!((alpha - expected).abs() <= off, "{name}, pixel {pixel}: {alpha}");
        }
    });
}

/// The sky that is hidden still lights the scene, and is seen in mirrors and through glass, which count as opaque: in a furnace each is as bright as the sky
/// times its albedo.
#[test]
fn mirrors_and_glass_are_opaque_and_show_the_sky() {
    let mirror = Material { lambert: Vec3::ZERO, reflection: Vec3::splat(0.5), ..Material::default() };
    let glass = Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.5), ..mirror.clone() };
    let white = matte(Vec3::splat(0.5));
    for (what, material, albedo) in [("mirror", mirror, 0.5), ("glass", glass, 1.0), ("matte", white, 0.5)] {
        let mut scene = empty(6, 6);
        add(&mut scene, icosphere(3), material, Affine3A::from_translation(Vec3::Z * -1.25));
        scene.sensor = pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, 20.0);
        scene.environment = Some(Environment { radiance: Vec3::splat(2.0), image: None, rotation: 0.0 });
        scene.settings.transparent = true;
        on_every_tracer(&scene, |name, tracer| {
            let found = film(tracer, (6, 6), 64);
            let mean = (0..36).map(|pixel| found.mean(pixel)[0]).sum::<f64>() / 36.0;
            assert!((0..36).all(|pixel| found.alpha(pixel) == 1.0 || found.missed.is_none()), "{name}, {what}");
            assert!((mean / (2.0 * albedo) - 1.0).abs() < 0.01, "{name}, {what}: {mean}");
        });
    }
}
