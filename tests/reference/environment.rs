//! The environment: lookup, density, and directions.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::means;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::sampling::{light_block, random4};
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

/// The ways to sample an environment: by all of its light, and by what is left where paths find it, too.
fn samplings(scene: &Scene) -> [Reference; 2] {
    [LightSampling::Direct, LightSampling::Mis].map(|light_sampling| {
        let mut scene = scene.clone();
        estimator(&mut scene).light_sampling = light_sampling;
        Reference::new(&scene)
    })
}

/// The first two of four random numbers.
fn pair(index: u32, seed: u32) -> [u32; 2] {
    let [a, b, ..] = random4(index, 0, 1, seed);
    [a, b]
}

/// Directions fall into the parts of each texel in proportion to density times solid angle.
#[test]
fn directions_have_their_density() {
    samplings(&under(sky())).iter().for_each(assert_directions_have_their_density);
}

fn assert_directions_have_their_density(tracer: &Reference) {
    const N: u32 = 400_000;
    let mut expected = shares_of_sky(|w| tracer.environment_density(w));
    let mass: f64 = expected.iter().sum();
    assert!((mass - 1.0).abs() < 1e-12, "the density integrates to {mass}");
    expected.iter_mut().for_each(|share| *share *= f64::from(N));
    let mut counts = vec![0; expected.len()];
    for i in 0..N {
        let (wi, density) = tracer.sample_environment(pair(i, 7)).expect("not black");
        assert!((wi.length() - 1.0).abs() < 1e-14);
        assert_eq!(density, tracer.environment_density(wi), "{wi}");
        counts[part_of_sky(wi)] += 1;
    }
    let p = chi_square_against(&counts, &expected);
    assert!(p >= SIGNIFICANCE, "p = {p:.1e}");
}

/// Radiance over density averages to the integral of the radiance, and no direction with light has the density zero.
#[test]
fn directions_find_all_light() {
    let [tracer, _] = samplings(&under(sky()));
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
        let (wi, density) = tracer.sample_environment(pair(i, 8)).expect("not black");
        tracer.environment_radiance(wi).y / density
    }));
    // The quadrature is good to 1e-4.
    found.assert_within(integral * 0.9999, integral * 1.0001, 2e-3);
}

/// Where paths find light, too, the density of a texel is in proportion to what its radiance, averaged over the channels, is above the mean of
/// the whole sky; and elsewhere zero.
#[test]
fn what_is_above_the_mean_is_sampled() {
    const N: u32 = 200;
    let [plain, compensated] = samplings(&under(sky()));
    // By the plain density, which is in proportion to the radiance: its mean over all directions is 1 / 4 pi.
    let mut excess = 0.0;
    let mut all = vec![];
    for i in 0..N * N {
        let phi = (f64::from(i % N) + 0.5) / f64::from(N) * TAU;
        let w = sky_direction(phi, 1.0 - 2.0 * (f64::from(i / N) + 0.5) / f64::from(N));
        let above = (plain.environment_density(w) - 0.25 / PI).max(0.0);
        excess += above * 4.0 * PI / f64::from(N * N);
        all.push((above, compensated.environment_density(w)));
    }
    let (mut above, mut below) = (0, 0);
    for (expected, found) in all {
        // The quadrature is coarse.
        assert!((found * excess - expected).abs() <= 0.02 * expected, "{found} of {excess}, {expected}");
        *(if expected > 0.0 { &mut above } else { &mut below }) += 1;
    }
    assert!(above > 1000 && below > 1000, "{above} {below}");
}

/// The two numbers of a pair lead to directions that are spread out as they are: what a sky of smooth gradients sends to a tilted wall by 64 Sobol
/// points has a far smaller variance than by 64 independent numbers.
#[test]
fn pairs_stay_spread_out() {
    let (width, height) = (64, 32);
    let texel = |i: u32| {
        let (x, y) = (TAU * f64::from(i % width) / f64::from(width), PI * f64::from(i / width) / f64::from(height));
        Vec3::splat((1.0 + 0.8 * x.sin() * y.sin() + 0.5 * y.cos()) as f32)
    };
    let texels = (0..width * height).map(texel).collect();
    let image = EnvironmentImage { name: "gradients".into(), width, height, texels };
    let environment = Environment { radiance: Vec3::ONE, image: Some(image.into()), rotation: 20.0 };
    let [tracer, _] = samplings(&under(environment));
    let variance = |sampler: Sampler| {
        let irradiance = |pixel: u32| -> f64 {
            let light = |sample: u32| {
                let [a, b, ..] = sampler.numbers(pixel, sample, light_block(0), 3);
                let (wi, density) = tracer.sample_environment([a, b]).expect("not black");
                tracer.environment_radiance(wi).y * wi.dot(DVec3::new(0.6, 0.6, -0.5)).max(0.0) / density
            };
            (0..64).map(light).sum()
        };
        let of_pixels: Vec<f64> = (0..400).map(irradiance).collect();
        let mean = of_pixels.iter().sum::<f64>() / 400.0;
        of_pixels.iter().map(|x| (x - mean).powi(2)).sum::<f64>()
    };
    let ratio = variance(Sampler::Sobol) / variance(Sampler::Independent);
    println!("{ratio}");
    assert!(ratio < 0.2, "{ratio}");
}

/// An even sky is left to paths alone, one with a contrast is not; of lobes that share a surface's paths one may be weak, and an estimator by which
/// paths are not good at finding the sky samples all of it.
#[test]
fn what_paths_find_well_is_left_to_them() {
    let share = |scene: &Scene| {
        let distribution = LuminaireTable::new(scene).environment;
        distribution.map_or(0.0, |distribution| distribution.sampled / (4.0 * PI))
    };
    let sky = |texels: [f32; 2]| {
        let texels = texels.map(Vec3::splat).into();
        let image = EnvironmentImage { name: "two".into(), width: 2, height: 1, texels };
        Environment { radiance: Vec3::ONE, image: Some(image.into()), rotation: 0.0 }
    };
    // The lookup smooths a quarter of the difference away.
    let mut scene = under(sky([0.5, 1.5]));
    assert!((share(&scene) - 0.125).abs() < 1e-6, "{}", share(&scene));
    for (darker, sampled) in [(1.0, false), (0.9, false), (0.6, true)] {
        scene.environment = Some(sky([darker, 1.0]));
        assert_eq!(share(&scene) > 0.0, sampled, "{darker}");
    }
    let even = under(sky([1.0, 1.0]));
    assert_eq!(share(&even), 0.0);
    let mut plates = even.clone();
    plates.materials[0].glossy = Vec3::splat(0.25);
    assert!((share(&plates) - 0.25).abs() < 1e-6);
    // What no triangle is made of does not count.
    let mut unused = even.clone();
    unused.materials.push(plates.materials[0].clone());
    assert_eq!(share(&unused), 0.0);
    let all = Estimator::default();
    for other in [
        Estimator { light_sampling: LightSampling::Direct, ..all },
        Estimator { directions: Directions::Uniform, ..all },
        Estimator { extinction: Extinction::Surface, ..all },
        Estimator { albedo_threshold: Some(0.1), ..all },
    ] {
        let scene = Scene { integrator: Integrator::Path(other), ..even.clone() };
        assert!((share(&scene) - 1.0).abs() < 1e-6, "{other:?}");
    }
}

/// Without an image all directions are the same; a black environment is no luminaire; and what the camera sees is the radiance itself.
#[test]
fn constant_and_black_environments() {
    let constant = |radiance: Vec3| Environment { radiance, image: None, rotation: 30.0 };
    let scene = under(constant(Vec3::new(1.0, 2.0, 3.0)));
    let [tracer, by_chance] = samplings(&scene);
    assert!(by_chance.sample_environment([7; 2]).is_none());
    assert_eq!(by_chance.environment_pdf(DVec3::Y), 0.0);
    for i in 0..100 {
        let (wi, density) = tracer.sample_environment(pair(i, 7)).expect("not black");
        assert!((density * 4.0 * PI - 1.0).abs() < 1e-12 && density == tracer.environment_density(wi));
        assert_eq!(tracer.environment_radiance(wi), DVec3::new(1.0, 2.0, 3.0));
    }
    assert!(tracer.environment_pdf(DVec3::Y) > 0.0);
    assert_eq!(means(&scene, 2).map(|e| e.mean), [1.0, 2.0, 3.0]);
    for tracer in samplings(&under(constant(Vec3::ZERO))) {
        assert!(tracer.sample_environment([7; 2]).is_none());
        assert_eq!(tracer.environment_pdf(DVec3::Y), 0.0);
    }
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
    let share = samplings(&scene)[0].environment_pdf(DVec3::Z) * 4.0 * PI;
    assert!((0.3..0.7).contains(&share), "the environment is chosen with probability {share}");
    for light_sampling in [LightSampling::None, LightSampling::Direct, LightSampling::Mis] {
        for directions in [Directions::Uniform, Directions::Cosine] {
            scene.integrator = Integrator::Path(Estimator { light_sampling, directions, ..Estimator::default() });
            means(&scene, 1500)[1].assert_is(1.0, 1e-2);
        }
    }
}
