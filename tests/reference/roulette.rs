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
    for a in [0.02f32, 0.5, 0.95] {
        for (material, first) in [(matte(Vec3::splat(a)), 1), (mirror(a), SURE_IMPULSES)] {
            let mut scene = furnace(Vec3::ZERO);
            scene.materials[0] = material;
            scene.integrator =
                Integrator::Path(Estimator { light_sampling: LightSampling::None, ..Estimator::default() });
            let tracer = Reference::new(&scene);
            let rays: Vec<u32> = (0..4096).into_par_iter().map(|i| tracer.radiance(i % 256, i / 256).1.all).collect();
            Estimate::new(rays.into_iter().map(f64::from)).assert_is(expected_rays(a.into(), first), 0.05);
        }
    }
}

/// A dark, sharp plate that shows a large lamp: light sampling finds little of that, so whatever ends the path at the plate is paid for in
/// noise. With roulette a sample varies as it does without, where the plate is seen directly, by way of a mirror, and through a pane.
#[test]
fn dark_plates_are_as_even_as_without() {
    // The ray arrives along +x and is mirrored upwards.
    let lit_plate = |from: Vec3, front: Option<(Mesh, Material)>| {
        let mut scene = empty(16, 16);
        scene.sensor = pinhole(from, Vec3::Y, Vec3::Y, 1.0);
        let plate = Material { glossy: Vec3::splat(0.05), exponent: 1e4, ..matte(Vec3::ZERO) };
        let tilted = quad(Vec3::new(2.0, 0.0, 1.0), Vec3::new(2.0, 2.0, 0.0), Vec3::Z * -2.0);
        add(&mut scene, tilted, plate, Affine3A::IDENTITY);
        let ceiling = quad(Vec3::new(1.0, 6.0, -2.0), Vec3::X * 4.0, Vec3::Z * 4.0);
        add(&mut scene, ceiling, lamp(Vec3::ONE), Affine3A::IDENTITY);
        if let Some((mesh, material)) = front {
            add(&mut scene, mesh, material, Affine3A::IDENTITY);
        }
        scene
    };
    let (before, beside) = (Vec3::new(-2.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 2.0));
    let mirror = |albedo: f32| {
        let diagonal = quad(Vec3::new(-1.0, 0.0, 1.0), Vec3::new(2.0, 0.0, -2.0), Vec3::Y * 2.0);
        Some((diagonal, Material { reflection: Vec3::splat(albedo), ..matte(Vec3::ZERO) }))
    };
    let glass =
        Material { transmission: Vec3::ONE, reflection: Vec3::ONE, eta: Some(1.5), thin: true, ..Material::default() };
    let pane = Some((quad(Vec3::new(0.0, 0.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0), glass));
    for (name, scene) in [
        ("directly", lit_plate(before, None)),
        ("by way of a mirror", lit_plate(beside, mirror(0.9))),
        ("by way of a dark mirror", lit_plate(beside, mirror(0.05))),
        ("through a pane", lit_plate(before, pane)),
    ] {
        let measure = |extinction| {
            let mut scene = scene.clone();
            scene.integrator = Integrator::Path(Estimator { extinction, max_bounces: Some(4), ..Estimator::default() });
            let tracer = Reference::new(&scene);
            let samples: Vec<f64> = (0..4096).into_par_iter().map(|i| tracer.radiance(i % 256, i / 256).0.y).collect();
            let mean = samples.iter().sum::<f64>() / samples.len() as f64;
            samples.iter().map(|l| (l / mean - 1.0).powi(2)).sum::<f64>() / samples.len() as f64
        };
        let (without, with) = (measure(Extinction::Off), measure(Extinction::Throughput));
        println!("{name}: {without} without, {with} with");
        assert!(with <= 1.1 * without + 0.01, "{name}: variance {without} without roulette and {with} with it");
        assert!(without < 0.5, "{name}: {without}");
    }
}
