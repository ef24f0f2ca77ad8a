//! Glossy lobes from flat to mirror-like: who finds the light, and whether any is lost or made.

use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use crate::stability::judge::{everywhere, light};
use crate::stability::light::{
    Spot, Tally, chart, looking_from, noise_axis, off, over_parallelogram, series, within, without_roulette,
};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{NOISY_VARIANCE, Verdict, Worse, stretch};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::reference::bsdf::glossy_normalization;
use luminaire::scene::build::{add, lamp, matte, quad};
use luminaire::scene::{Directions, Environment, Estimator, Extinction, LightSampling, Material, Scene};
use std::f64::consts::TAU;

/// The sweep over the exponent.
pub const DEFINITION: Definition = Definition {
    name: "glossy",
    family: Family::Light,
    title: "exponent of a glossy plate, 0 to 1e8: under an even sky, and with a small, a middling and a large lamp in it",
    run,
};

/// Where the camera is; it looks at the plate at the origin, whose normal is +y.
const EYE: Vec3 = Vec3::new(0.8, 0.6, 0.3);
/// Half the side of the lamps, at the distance 1 in the mirrored direction.
const LAMPS: [(&str, f64); 3] = [("small", 0.003), ("middling", 0.03), ("large", 0.3)];
/// Albedo of the plate with the lamp: a varnish, so dark that roulette by its albedo would end most paths.
const VARNISH: f32 = 0.05;

/// How light is found under the lamp.
const METHODS: [&str; 4] = ["light sampling", "BSDF sampling", "both (MIS)", WITH_ROULETTE];
/// The default.
const WITH_ROULETTE: &str = "both, with roulette";

/// Which points.
pub struct Steps {
    /// Exponents, in ascending order.
    pub exponents: Vec<f32>,
    /// Samples of a point.
    pub samples: u32,
}

fn run(bench: &Workbench) -> Result<Sweep> {
    let decades = [1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8];
    let mut steps = Steps { exponents: vec![0.0], samples: 1 << 15 };
    for decade in decades {
        steps.exponents.push(decade);
        if bench.long && decade < 1e8 {
            steps.exponents.push(3.0 * decade);
        }
    }
    if bench.long {
        steps.samples *= 8;
    }
    sweep(bench, &steps)
}

fn plate(exponent: f32, albedo: f32) -> Scene {
    let mut scene = looking_from(EYE);
    let material = Material { glossy: Vec3::splat(albedo), exponent, ..matte(Vec3::ZERO) };
    add(&mut scene, quad(Vec3::new(-2.0, 0.0, -2.0), Vec3::Z * 4.0, Vec3::X * 4.0), material, Affine3A::IDENTITY);
    scene
}

/// Towards the camera.
fn wo() -> DVec3 {
    EYE.as_dvec3().normalize()
}

/// The plate's BRDF without its albedo.
fn lobe(exponent: f64, wi: DVec3) -> f64 {
    let h = (wi + wo()).normalize();
    // cos^m by the sine, which is small.
    let sine2 = h.x * h.x + h.z * h.z;
    glossy_normalization(exponent) * (0.5 * exponent * f64::ln_1p(-sine2.min(1.0))).exp()
}

/// Share of the light that a plate of albedo 1 reflects to the camera from a sky of radiance 1: the midpoint rule over half vectors, spaced
/// evenly under the density `(m + 1) / 2 pi cos^m`.
fn directional_albedo(exponent: f64) -> f64 {
    const POINTS: u32 = 500;
    let mut sum = 0.0;
    for i in 0..POINTS {
        // Of cos^(m + 1), evenly; the sine without cancellation.
        let log_cosine = ((f64::from(i) + 0.5) / f64::from(POINTS)).ln() / (exponent + 1.0);
        let (cosine, sine) = (log_cosine.exp(), (-f64::exp_m1(2.0 * log_cosine)).sqrt());
        let density = (exponent + 1.0) / TAU * (exponent * log_cosine).exp();
        for j in 0..POINTS {
            let (sin, cos) = (TAU * (f64::from(j) + 0.5) / f64::from(POINTS)).sin_cos();
            let h = DVec3::new(sine * cos, cosine, sine * sin);
            let wi = 2.0 * wo().dot(h) * h - wo();
            if wo().dot(h) > 0.0 && wi.y > 0.0 {
                sum +=
                    glossy_normalization(exponent) * (exponent * log_cosine).exp() * wi.y * 4.0 * wo().dot(h) / density;
            }
        }
    }
    sum / f64::from(POINTS * POINTS)
}

/// The plate under a lamp, and the radiance that the camera sees.
fn lit(exponent: f32, half: f64) -> (Scene, f64) {
    let towards = DVec3::new(-wo().x, wo().y, -wo().z);
    let across = towards.any_orthonormal_vector();
    let [a, b] = [across, towards.cross(across)].map(|edge| (2.0 * half * edge).as_vec3());
    let corner = towards.as_vec3() - 0.5 * (a + b);
    let mut scene = plate(exponent, VARNISH);
    add(&mut scene, quad(corner, a, b), lamp(Vec3::ONE), Affine3A::IDENTITY);
    let [corner, a, b] = [corner, a, b].map(|v| v.as_dvec3());
    let normal = a.cross(b).normalize();
    // Half vectors are half as wide as the lobe.
    let sharpness = 0.5 * (1.0 + f64::from(exponent)).sqrt();
    let truth = over_parallelogram([corner, a, b], [0.5, 0.5], sharpness, |point| {
        let (wi, distance2) = (point.normalize(), point.length_squared());
        lobe(exponent.into(), wi) * wi.y.max(0.0) * normal.dot(wi).abs() / distance2
    });
    (scene, f64::from(VARNISH) * truth)
}

/// Runs these steps.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, steps: &Steps) -> Result<Sweep> {
    let mut tally = Tally::default();
    let backends = bench.backends();
    let by_backend = |method: &str| series(backends.iter().map(|b| format!("{method}, {b}")));
    let (mut sky_bsdf, mut sky_mis, mut lamp_mis) =
        (by_backend("BSDF sampling"), by_backend("MIS with the sky"), by_backend("MIS with the middling lamp"));
    let mut sky_even = series(["cosine sampling, cpu", "uniform sampling, cpu"]);
    let of_lamps = || -> Vec<Vec<Series>> { LAMPS.iter().map(|_| series(METHODS)).collect() };
    let (mut noise, mut found) = (of_lamps(), of_lamps());
    for &exponent in &steps.exponents {
        let x = f64::from(exponent);
        let mut sky = plate(exponent, 1.0);
        sky.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        let albedo = directional_albedo(x);
        let mut measure =
            |scene: &Scene, truth: f64, backend: Backend, estimator: Estimator| -> Result<(Spot, Point)> {
                let spot = Spot::new(bench, backend, scene, estimator, steps.samples)?;
                tally.add(&spot);
                Ok((spot, spot.share(x, truth)))
            };
        let chance = without_roulette(LightSampling::None, 0);
        let both = without_roulette(LightSampling::Mis, 0);
        for (series, directions) in sky_even.iter_mut().zip([Directions::Cosine, Directions::Uniform]) {
            series.points.push(measure(&sky, albedo, Backend::Cpu, Estimator { directions, ..chance })?.1);
        }
        for (index, &backend) in backends.iter().enumerate() {
            sky_bsdf[index].points.push(measure(&sky, albedo, backend, chance)?.1);
            sky_mis[index].points.push(measure(&sky, albedo, backend, both)?.1);
            let (scene, truth) = lit(exponent, LAMPS[1].1);
            lamp_mis[index].points.push(measure(&scene, truth, backend, both)?.1);
        }
        for ((noise, found), (_, half)) in noise.iter_mut().zip(&mut found).zip(LAMPS) {
            let (scene, truth) = lit(exponent, half);
            let light = without_roulette(LightSampling::Direct, 0);
            let roulette = Estimator { extinction: Extinction::Throughput, ..both };
            for (method, estimator) in [light, chance, both, roulette].into_iter().enumerate() {
                let (spot, share) = measure(&scene, truth, Backend::Cpu, estimator)?;
                noise[method].points.push(spot.noise(x, truth));
                found[method].points.push(share);
            }
        }
    }
    let verdicts = verdicts(&noise, &found, &[&sky_mis[..], &lamp_mis].concat(), &sky_bsdf);
    let range = stretch(steps.exponents.iter().map(|exponent| f64::from(*exponent)), Worse::Upwards, "(exponent)");
    let summary = everywhere(&verdicts, WITH_ROULETTE, "The defaults find every highlight, and are nowhere noisy.");
    let findings = findings(&sky_even, &[&sky_bsdf[..], &sky_mis, &lamp_mis].concat(), &noise, &tally);
    let energy: Vec<Series> = [sky_even, sky_bsdf, sky_mis, lamp_mis].concat();
    const EXPONENT: &str = "glossy exponent";
    let axis = Axis::linear("share found of the energy");
    let mut charts =
        vec![chart("energy", "Energy that a glossy plate reflects, over the truth", EXPONENT, axis, energy)];
    for (series, (name, half)) in noise.into_iter().zip(LAMPS) {
        let title = format!("Noise of a glossy plate that mirrors a {name} lamp ({half} of its distance)");
        charts.push(chart(&format!("noise-{name}-lamp"), &title, EXPONENT, noise_axis(), series));
    }
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// The default first. Each by the noise and the light that was found under every lamp, and by shares of more scenes on every backend: with roulette by
/// those of both without it.
fn verdicts(noise: &[Vec<Series>], found: &[Vec<Series>], both: &[Series], bsdf: &[Series]) -> Vec<Verdict> {
    let of = |method: usize, shares: &[Series]| {
        let variances: Vec<_> = noise.iter().map(|lamp| &lamp[method]).collect();
        let shares: Vec<_> = found.iter().map(|lamp| &lamp[method]).chain(shares).collect();
        light(METHODS[method], &variances, &shares, Worse::Upwards)
    };
    vec![of(3, both), of(2, both), of(0, &[]), of(1, bsdf)]
}

fn findings(even: &[Series], kept: &[Series], noise: &[Vec<Series>], tally: &Tally) -> Findings {
    let highest = |method: usize| {
        let points = noise.iter().flat_map(|lamp| &lamp[method].points);
        points.map(|p| p.y).filter(|y| !y.is_nan()).fold(0.0, f64::max)
    };
    let blind = even[0].points.iter().find(|p| p.y < 0.5).map(|p| p.x);
    let farthest = kept.iter().map(|s| off(s, 0.0..=f64::INFINITY)).fold(0.0, f64::max);
    Findings {
        starts: format!(
            "Cosine sampling of the plate under the sky {}. With the small, the middling and the large lamp, of which the worst counts, a sample \
             varies by more than ten times its mean (variance above {NOISY_VARIANCE}):",
            blind.map_or("finds the light at every exponent".into(), |x| format!("loses more than half of it from {x:e} on")),
        ),
        how: "By noise, not by bias: a sharp lobe is rarely met by a point on a large lamp or by a direction that ignores it, a small \
              lamp rarely by a direction of a wide lobe. What is rarely met is bright when it is: fireflies, and between them a picture \
              that is too dark."
            .into(),
        mends: format!(
            "Both ways at once, by the power heuristic: a sample varies by at most {:.2} times the squared mean. Roulette by throughput would \
             end nearly all paths of this dark plate (albedo {VARNISH}), and be as noisy as the survivors are rare; therefore it begins behind \
             the first surface whose lobes scatter a path, and with it a sample varies by at most {:.2} times the squared mean. Directions are chosen by the half vector, with sines where cosines are nearly 1. On every backend the \
             light, held against the truth, is {} at every exponent. {}",
            highest(2),
            highest(3),
            within(farthest),
            tally.sentence(),
        ),
        sees: "With the defaults, even noise at every exponent, on dark plates too. With `--light-sampling direct` grainy highlights of large lamps in sharp \
               plates, with `none` fireflies of small lamps on rough ones, with cosine directions no highlights at all."
            .into(),
    }
}
