//! A scene that no file describes, rendered by every backend of this machine; how far apart are the pictures?
//!
//! `cargo run --release --example scene_in_code`. A program of your own wants `luminaire` and, for the comparison, `luminaire-measure`.

use luminaire::backend::{self, Backend, Request};
use luminaire::glam::{Affine3A, Vec3};
use luminaire::picture::Picture;
use luminaire::render::Limits;
use luminaire::scene::build::{add, cube, empty, icosphere, lamp, matte, pinhole, quad};
use luminaire::scene::{Material, Sampler, Scene};
use luminaire::{Error, Film};
use luminaire_measure::metrics::compare;

fn main() -> luminaire::Result<()> {
    let scene = still_life(192, 128);
    let pictures = on_every_backend(&scene, 64)?;
    let (_, reference) = &pictures[0];
    for (backend, film) in &pictures {
        let file = format!("scene_in_code-{backend}.png");
        film.save(file.as_ref(), backend::development(&scene))?;
        let apart = compare(&picture(film), &picture(reference), 0)?;
        let noise = film.error().map_or(f64::NAN, |error| error.rel_mse);
        println!("{file}: relMSE {:.1e} against the reference, estimated {noise:.1e} against the truth", apart.relmse);
    }
    Ok(())
}

/// A ball and a block on a floor, under a square lamp. Lengths are in any unit; radiance is linear RGB.
pub fn still_life(width: u32, height: u32) -> Scene {
    let mut scene = empty(width, height);
    scene.settings.sampler = Sampler::Sobol;
    scene.sensor = pinhole(Vec3::new(0.0, 2.0, 6.0), Vec3::new(0.0, 0.7, 0.0), Vec3::Y, 40.0);

    let floor = quad(Vec3::new(-6.0, 0.0, 6.0), Vec3::X * 12.0, Vec3::Z * -12.0);
    add(&mut scene, floor, matte(Vec3::splat(0.6)), Affine3A::IDENTITY);
    let panel = quad(Vec3::new(-1.0, 4.0, -1.0), Vec3::X * 2.0, Vec3::Z * 2.0);
    add(&mut scene, panel, lamp(Vec3::new(9.0, 8.0, 7.0)), Affine3A::IDENTITY);

    let turned = Affine3A::from_translation(Vec3::new(-1.2, 0.8, 0.0)) * Affine3A::from_rotation_y(0.5);
    add(&mut scene, cube(), matte(Vec3::new(0.7, 0.3, 0.2)), turned * Affine3A::from_scale(Vec3::splat(0.8)));
    let mut ball = icosphere(4);
    ball.normals = ball.positions.clone();
    let glossy = Material { glossy: Vec3::splat(0.4), exponent: 100.0, ..matte(Vec3::new(0.1, 0.3, 0.5)) };
    add(&mut scene, ball, glossy, Affine3A::from_translation(Vec3::new(1.2, 1.0, 0.3)));
    scene
}

/// The picture of each backend that this machine has, the double-precision reference first.
pub fn on_every_backend(scene: &Scene, spp: u32) -> luminaire::Result<Vec<(Backend, Film)>> {
    let mut pictures = Vec::new();
    for backend in [Backend::Cpu, Backend::ComputeBvh, Backend::RayQuery] {
        match backend::open(scene, &Request { backend: Some(backend), device: None }) {
            Ok(mut renderer) => {
                let film = renderer.render(Limits { spp: Some(spp), ..Limits::default() })?;
                pictures.push((backend, film));
            }
            Err(Error::NoDevice(why)) => println!("{backend} cannot run here: {why}"),
            Err(error) => return Err(error),
        }
    }
    Ok(pictures)
}

/// A film as a picture that can be compared with others, for example with one that [`picture::read`] read.
pub fn picture(film: &Film) -> Picture {
    let rgb = film.to_linear().as_chunks().0.to_vec();
    Picture { width: film.width, height: film.height, rgb, error: None, clamped: false, warnings: vec![] }
}
