//! The environment: lookup, density, and directions.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::means;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::sampling::random4;
use luminaire::scene::*;
use std::f64::consts::{PI, TAU};

fn under(environment: Environment) -> Scene {
    let mut scene = empty(8, 8);
    // The sensor looks past it.
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::from_translation(Vec3::Z * 10.0));
    scene.environment = Some(environment);
    scene
}

/// The middle of the image is -z, the right half +x, the top +y; turned by 90 degrees counter-clockwise from above, the middle is -x.
#[test]
fn lookup_at_known_directions() {
    let image =
        |texels: Vec<Vec3>, width: u32, height: u32| EnvironmentImage { name: "i".into(), width, height, texels };
    let grey = |v: &[f32]| v.iter().map(|v| Vec3::splat(*v)).collect::<Vec<_>>();
    let look = |image: &EnvironmentImage, rotation: f32, w: DVec3| {
        let environment = Environment { radiance: Vec3::splat(2.0), image: Some(image.clone().into()), rotation };
        Reference::new(&under(environment)).environment_radiance(w.normalize()).x
    };
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} instead of {b}");
    // Four columns: centres at -135, -45, 45 and 135 degrees from -z towards +x.
    let row = image(grey(&[1.0, 2.0, 3.0, 4.0]), 4, 1);
    for rotation in [0.0, 90.0, -270.0] {
        let turned = |x: f64, z: f64| if rotation == 0.0 { DVec3::new(x, 0.0, z) } else { DVec3::new(z, 0.0, -x) };
        close(look(&row, rotation, turned(0.0, -1.0)), 5.0);
        close(look(&row, rotation, turned(1.0, -1.0)), 6.0);
        close(look(&row, rotation, turned(-1.0, -1.0)), 4.0);
        close(look(&row, rotation, turned(1.0, 0.0)), 7.0);
        close(look(&row, rotation, turned(1.0, 1.0)), 8.0);
        // Behind, the last column meets the first.
        close(look(&row, rotation, turned(0.0, 1.0)), 5.0);
        close(look(&row, rotation, turned(-1.0, 1.0)), 2.0);
    }
    // Two rows: centres at 45 and 135 degrees from +y; nothing beyond the poles.
    let column = image(grey(&[1.0, 3.0]), 1, 2);
    close(look(&column, 0.0, DVec3::Y), 2.0);
    close(look(&column, 0.0, DVec3::new(0.0, 1.0, 1.0)), 2.0);
    close(look(&column, 0.0, DVec3::X), 4.0);
    close(look(&column, 0.0, DVec3::new(1.0, -1.0, 0.0)), 6.0);
    close(look(&column, 0.0, -DVec3::Y), 6.0);
}

/// Directions fall into the parts of each texel in proportion to density times solid angle.
#[test]
fn directions_have_their_density() {
    const N: u32 = 400_000;
    let tracer = Reference::new(&under(sky()));
    let mut expected = shares_of_sky(|w| tracer.environment_density(w));
    let mass: f64 = expected.iter().sum();
    assert!((mass - 1.0).abs() < 1e-12, "the density integrates to {mass}");
    expected.iter_mut().for_each(|share| *share *= f64::from(N));
    let mut counts = vec![0; expected.len()];
    for i in 0..N {
        let wi = tracer.sample_environment(random4(i, 0, 1, 7)).expect("not black");
        assert!((wi.length() - 1.0).abs() < 1e-14);
        counts[part_of_sky(wi)] += 1;
    }
    let p = chi_square_against(&counts, &expected);
    assert!(p >= SIGNIFICANCE, "p = {p:.1e}");
}

/// Radiance over density averages to the integral of the radiance, and no direction with light has the density zero.
#[test]
fn directions_find_all_light() {
    let tracer = Reference::new(&under(sky()));
    let mut integral = 0.0;
    let n = 800;
    for i in 0..n * n {
        let w = sky_direction(
            (f64::from(i % n) + 0.5) / f64::from(n) * TAU,
            1.0 - 2.0 * (f64::from(i / n) + 0.5) / f64::from(n),
        );
        let radiance = tracer.environment_radiance(w).y;
        assert!(radiance == 0.0 || tracer.environment_density(w) > 0.0, "light without density at {w}");
        integral += radiance * 4.0 * PI / f64::from(n * n);
    }
    let found = Estimate::new((0..200_000).map(|i| {
        let wi = tracer.sample_environment(random4(i, 0, 1, 8)).expect("not black");
        tracer.environment_radiance(wi).y / tracer.environment_density(wi)
    }));
    // The quadrature is good to 1e-4.
    found.assert_within(integral * 0.9999, integral * 1.0001, 2e-3);
}

/// Without an image all directions are the same; a black environment is no luminaire; and what the camera sees is the radiance itself.
#[test]
fn constant_and_black_environments() {
    let constant = |radiance: Vec3| Environment { radiance, image: None, rotation: 30.0 };
    let scene = under(constant(Vec3::new(1.0, 2.0, 3.0)));
    let tracer = Reference::new(&scene);
    for i in 0..100 {
        let wi = tracer.sample_environment(random4(i, 0, 1, 7)).expect("not black");
        assert!((tracer.environment_density(wi) * 4.0 * PI - 1.0).abs() < 1e-12);
        assert_eq!(tracer.environment_radiance(wi), DVec3::new(1.0, 2.0, 3.0));
    }
    assert!(tracer.environment_pdf(DVec3::Y) > 0.0);
    assert_eq!(means(&scene, 2).map(|e| e.mean), [1.0, 2.0, 3.0]);
    let tracer = Reference::new(&under(constant(Vec3::ZERO)));
    assert!(tracer.sample_environment([7; 4]).is_none());
    assert_eq!(tracer.environment_pdf(DVec3::Y), 0.0);
}

/// A white surface in a white environment is white, also where light sampling is busy elsewhere half of the time: the probability of
/// choosing the environment belongs to the weights.
#[test]
fn white_is_white_among_other_luminaires() {
    let mut scene = empty(8, 8);
    add(
        &mut scene,
        quad(Vec3::new(-9.0, -9.0, -2.0), Vec3::X * 18.0, Vec3::Y * 18.0),
        matte(Vec3::ONE),
        Affine3A::IDENTITY,
    );
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    // Behind the surface.
    scene.luminaires.push(Luminaire::Point { position: -Vec3::Z * 4.0, intensity: Vec3::splat(500.0) });
    let share = Reference::new(&scene).environment_pdf(DVec3::Z) * 4.0 * PI;
    assert!((0.3..0.7).contains(&share), "the environment is chosen with probability {share}");
    for light_sampling in [LightSampling::None, LightSampling::Direct, LightSampling::Mis] {
        for directions in [Directions::Uniform, Directions::Cosine] {
            scene.integrator = Integrator::Path(Estimator { light_sampling, directions, ..Estimator::default() });
            means(&scene, 1500)[1].assert_is(1.0, 1e-2);
        }
    }
}
