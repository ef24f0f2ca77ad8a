//! Russian roulette: how long it lets paths live, and that it does not make dark surfaces noisy.

use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::furnace;
use glam::{Affine3A, Vec3};
use luminaire::reference::Reference;
use luminaire::reference::scatter::{SURE_IMPULSES, SURE_THROUGHPUT};
use luminaire::scene::*;
use rayon::prelude::*;

/// Rays of a path in a closed shell of albedo `a` where roulette begins at the surface number `first`: at each surface the throughput
/// falls by `a`, and the survivors are taken back to what surely lives.
fn expected_rays(a: f64, first: u32) -> f64 {
    let (mut rays, mut alive, mut throughput) = (1.0, 1.0, 1.0);
    for surface in 0.. {
        throughput *= a;
        if surface >= first && throughput < SURE_THROUGHPUT {
            alive *= throughput / SURE_THROUGHPUT;
            throughput = SURE_THROUGHPUT;
        }
        rays += alive;
        if alive < 1e-9 {
            break;
        }
    }
    rays
}

/// Matt walls, however dark, let each path meet a second surface, and mirrors a few more; from then on paths end as fast as before, also
/// where nearly nothing is absorbed.
#[test]
fn paths_are_as_long_as_the_throughput_says() {
    let mirror = |a: f32| Material { reflection: Vec3::splat(a), ..matte(Vec3::ZERO) };
    for a in [0.02f32, 0.5, 0.9, 0.99] {
        for (material, first) in [(matte(Vec3::splat(a)), 1), (mirror(a), SURE_IMPULSES)] {
            let mut scene = furnace(Vec3::ZERO);
            scene.materials[0] = material;
            scene.integrator =
                Integrator::Path(Estimator { light_sampling: LightSampling::None, ..Estimator::default() });
            let tracer = Reference::new(&scene);
            let rays: Vec<u32> = (0..20_000).into_par_iter().map(|i| tracer.radiance(i % 256, i / 256).1.all).collect();
            Estimate::new(rays.into_iter().map(f64::from)).assert_is(expected_rays(a.into(), first), 0.02);
        }
    }
}

/// A dark, sharp plate that shows a large lamp: light sampling finds nothing of that, so whatever ends the path at the plate is paid for in
/// noise. With roulette a sample varies as it does without, where the plate is seen directly, by way of a mirror, and through a pane.
#[test]
fn dark_plates_are_as_even_as_without() {
    let behind = |front: Option<Material>| {
        let mut scene = empty(16, 16);
        scene.sensor = pinhole(Vec3::new(0.0, 1.0, 2.0), Vec3::new(0.0, 1.0, 0.0), Vec3::Y, 5.0);
        let plate = Material { glossy: Vec3::splat(0.05), exponent: 1e4, ..matte(Vec3::ZERO) };
        let wall = |z: f32, material| (quad(Vec3::new(-4.0, -4.0, z), Vec3::X * 8.0, Vec3::Y * 8.0), material);
        let lamp_behind_the_camera = quad(Vec3::new(3.0, -3.0, 3.0), Vec3::X * -6.0, Vec3::Y * 6.0);
        add(&mut scene, lamp_behind_the_camera, lamp(Vec3::ONE), Affine3A::IDENTITY);
        match front {
            // Looked at over a corner: the camera sees a tilted mirror, and in it the plate beside.
            Some(mirror) if mirror.transmission == Vec3::ZERO => {
                let tilted = quad(Vec3::new(-1.0, 0.0, 1.0), Vec3::new(2.0, 0.0, -2.0), Vec3::Y * 2.0);
                add(&mut scene, tilted, mirror, Affine3A::IDENTITY);
                let side = quad(Vec3::new(-3.0, -4.0, 4.0), Vec3::Z * -8.0, Vec3::Y * 8.0);
                add(&mut scene, side, plate, Affine3A::IDENTITY);
                let opposite = quad(Vec3::new(4.0, -4.0, -4.0), Vec3::Z * 8.0, Vec3::Y * 8.0);
                add(&mut scene, opposite, lamp(Vec3::ONE), Affine3A::IDENTITY);
            }
            front => {
                let (mesh, material) = wall(-1.0, plate);
                add(&mut scene, mesh, material, Affine3A::IDENTITY);
                if let Some(pane) = front {
                    let (mesh, material) = wall(0.0, pane);
                    add(&mut scene, mesh, material, Affine3A::IDENTITY);
                }
            }
        }
        scene
    };
    let mirror = |albedo: f32| Material { reflection: Vec3::splat(albedo), ..matte(Vec3::ZERO) };
    let pane =
        Material { transmission: Vec3::ONE, reflection: Vec3::ONE, eta: Some(1.5), thin: true, ..Material::default() };
    for (name, front) in [
        ("directly", None),
        ("by way of a mirror", Some(mirror(0.9))),
        ("by way of a dark mirror", Some(mirror(0.05))),
        ("through a pane", Some(pane)),
    ] {
        let mut scene = behind(front);
        let mut measure = |extinction| {
            scene.integrator = Integrator::Path(Estimator {
                light_sampling: LightSampling::Mis,
                extinction,
                max_bounces: Some(6),
                ..Estimator::default()
            });
            let tracer = Reference::new(&scene);
            let samples: Vec<f64> = (0..8192).into_par_iter().map(|i| tracer.radiance(i % 256, i / 256).0.y).collect();
            let mean = samples.iter().sum::<f64>() / samples.len() as f64;
            samples.iter().map(|l| (l / mean - 1.0).powi(2)).sum::<f64>() / samples.len() as f64
        };
        let (without, with) = (measure(Extinction::Off), measure(Extinction::Throughput));
        println!("{name}: {without} without, {with} with");
        assert!(with <= 1.2 * without + 0.05, "{name}: variance {without} without roulette and {with} with it");
    }
}
