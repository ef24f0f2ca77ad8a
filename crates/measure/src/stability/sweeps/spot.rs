//! Cones and discs from wide to narrow: a spot and a sun above a floor.

use crate::Workbench;
use crate::chart::{Axis, Series};
use crate::stability::judge::{light, up_to};
use crate::stability::lamp::{farthest, highest, samples};
use crate::stability::light::{Spot, Tally, chart, looking_from, noise_axis, off, series, within, without_roulette};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::build::{add, matte, quad};
use luminaire::scene::{Directions, Estimator, LightSampling, Luminaire, Scene, one_minus_cos, spot_edge};
use std::f64::consts::PI;

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "spot",
    family: Family::Light,
    title: "angle from its axis of a spot's edge, or of a sun's, 90 to 1e-4 degrees",
    run: |bench| sweep(bench, &degrees(bench), samples(bench)),
};

const ALBEDO: f32 = 0.5;
/// The method that users have.
const DEFAULT: &str = "sun, both (MIS)";
/// The spot, which light sampling alone finds.
const SPOT: &str = "spot, in its soft edge";

/// From narrow to wide.
fn degrees(bench: &Workbench) -> Vec<f64> {
    let steps = if bench.long { 4 } else { 1 };
    let powers = (-4 * steps..=steps).map(|i| 10f64.powf(f64::from(i) / f64::from(steps)));
    powers.chain([30.0, 60.0, 90.0]).collect()
}

fn floor() -> Scene {
    let mut scene = looking_from(Vec3::new(0.3, 0.5, 0.8));
    let floor = quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0);
    add(&mut scene, floor, matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    scene
}

/// A disc of this radius, as far from the zenith as it may be without touching the horizon, at most 20 degrees; and the radiance of the floor.
fn under_sun(radius: f64) -> (Scene, f64) {
    let zenith = (90.0 - radius).min(20.0).to_radians();
    let direction = -DVec3::new(zenith.sin() * 0.6, zenith.cos(), zenith.sin() * 0.8).as_vec3();
    let mut scene = floor();
    scene.luminaires = vec![Luminaire::Sun { direction, irradiance: Vec3::ONE, angle: (2.0 * radius) as f32 }];
    (scene, f64::from(ALBEDO) / PI * zenith.cos())
}

/// A spot 2 away, whole within half of its outer angle, that has the origin at three quarters of it; and the radiance there.
fn under_spot(outer: f64) -> (Scene, f64) {
    let position = Vec3::new(-0.7, 1.7, 0.9);
    let towards = -position.as_dvec3().normalize();
    let aside = towards.cross(DVec3::new(0.3, 0.2, 0.9)).normalize();
    let angle = (0.75 * outer).to_radians();
    let direction = (towards * angle.cos() + aside * angle.sin()).as_vec3();
    let (inner, outer) = ((0.5 * outer) as f32, outer as f32);
    let (edge, scale) = spot_edge(inner, outer);
    let share = ((edge - one_minus_cos(angle.to_degrees())) * scale).powi(2);
    let mut scene = floor();
    scene.luminaires = vec![Luminaire::Spot { position, direction, intensity: Vec3::ONE, inner, outer }];
    let irradiance = share * -towards.y / position.as_dvec3().length_squared();
    (scene, f64::from(ALBEDO) / PI * irradiance)
}

/// How the light of the sun is found.
fn methods() -> [(&'static str, Estimator); 3] {
    let chance = Estimator { directions: Directions::Cosine, ..without_roulette(LightSampling::None, 0) };
    [
        (DEFAULT, without_roulette(LightSampling::Mis, 0)),
        ("sun, light sampling", without_roulette(LightSampling::Direct, 0)),
        ("sun, chance (cosine)", chance),
    ]
}

/// The sweep over some angles in ascending order, with so many samples each.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, degrees: &[f64], samples: u32) -> Result<Sweep> {
    let mut tally = Tally::default();
    let methods = methods();
    let names = || series(methods.iter().map(|(name, _)| *name));
    let (mut shares, mut noise, mut fireflies) = (names(), names(), names());
    let gpus: Vec<Backend> = bench.backends().into_iter().skip(1).collect();
    let mut gpu = series(gpus.iter().map(|backend| format!("{DEFAULT}, {backend}")));
    let mut spots = series(bench.backends().iter().map(|backend| format!("{SPOT}, {backend}")));
    for &angle in degrees {
        let (scene, truth) = under_sun(angle);
        let mut measure = |scene: &Scene, backend, estimator, samples| -> Result<Spot> {
            let spot = Spot::new(bench, backend, scene, estimator, samples)?;
            tally.add(&spot);
            Ok(spot)
        };
        for (i, (_, estimator)) in methods.iter().enumerate() {
            let spot = measure(&scene, Backend::Cpu, *estimator, samples)?;
            shares[i].points.push(spot.share(angle, truth));
            noise[i].points.push(spot.noise(angle, truth));
            fireflies[i].points.push(spot.firefly(angle, truth));
        }
        for (series, backend) in gpu.iter_mut().zip(&gpus) {
            series.points.push(measure(&scene, *backend, methods[0].1, samples)?.share(angle, truth));
        }
        let (scene, truth) = under_spot(angle);
        for (series, backend) in spots.iter_mut().zip(bench.backends()) {
            // Chance does not enter.
            series.points.push(measure(&scene, backend, methods[0].1, 2)?.share(angle, truth));
        }
    }
    let sun = |method: usize| {
        let gpu = if method == 0 { &gpu[..] } else { &[] };
        let shares: Vec<&Series> = std::iter::once(&shares[method]).chain(gpu).collect();
        light(methods[method].0, &[&noise[method]], &shares, Worse::Downwards)
    };
    let of_spots = light(SPOT, &[], &spots.iter().collect::<Vec<_>>(), Worse::Downwards);
    let verdicts = vec![sun(0), of_spots, sun(1), sun(2)];
    let summary = up_to(&verdicts, SPOT, |angle| {
        format!("Suns of every size are safe; the edges of spots are right down to {angle} degrees.")
    });
    let findings = findings(&Found { shares: &shares, fireflies: &fireflies, gpu: &gpu, spots: &spots, tally: &tally });
    shares.iter_mut().for_each(|series| series.name += ", cpu");
    let energy = [shares, gpu, spots].concat();
    let x = "degrees from the axis to the edge";
    let charts = vec![
        chart("noise", "Noise of a sun wide and narrow", x, noise_axis(), noise),
        chart("fireflies", "Largest sample of a sun", x, Axis::log("largest sample / mean"), fireflies),
        chart("energy", "Energy of suns and spots", x, Axis::linear("share found of the light"), energy),
    ];
    let range = stretch(degrees.iter().copied(), Worse::Downwards, "degrees");
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// What was found.
struct Found<'a> {
    shares: &'a [Series],
    fireflies: &'a [Series],
    gpu: &'a [Series],
    spots: &'a [Series],
    tally: &'a Tally,
}

fn findings(Found { shares, fireflies, gpu, spots, tally }: &Found) -> Findings {
    let worst = spots.iter().map(|series| off(series, 0.0..=0.99e-2)).fold(0.0, f64::max);
    Findings {
        starts: "What a sample varies by, and how far the light is off:".into(),
        how: format!(
            "Directions in single precision are 3e-6 degrees apart. The axis of a spot is rounded to that, and so is the way to its light: in the soft edge of a cone \
             of a hundredth of a degree that is a thousandth of its width, below it shows ({}). Chance finds a disc as often as the hemisphere holds it, the sun \
             with one ray in 50 000: its samples are up to {:.0e} times the mean.",
            match worst {
                0.0 => "nothing of it was measured".to_owned(),
                off => format!("up to {:.2} of the light", off),
            },
            highest(&fireflies[2]),
        ),
        mends: format!(
            "Cosines of close directions are all 1: cones and discs are told by the squared chord instead, and a disc is sampled by 1 - cos. The light of a disc is {} on the \
             CPU, and {} on the GPU, at every size, with samples up to {:.1} times the mean; that of a spot is {} from 0.01 degrees on. {}",
            within(farthest([&shares[0]], 0.0..=90.0)),
            within(farthest(gpu.iter(), 0.0..=90.0)),
            highest(&fireflies[0]),
            within(farthest(spots.iter(), 0.99e-2..=90.0)),
            tally.sentence(),
        ),
        sees: "With the defaults nothing: the sun and wide skies alike. A beam as narrow as a laser's may be a little off its place.".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_truth_of_a_spot_is_its_formula() {
        // At three quarters of 40 degrees: 30, between 20 and 40.
        let [inner, at, outer] = [20.0f64, 30.0, 40.0].map(|degrees| degrees.to_radians().cos());
        let share = ((at - outer) / (inner - outer)).powi(2);
        let place = DVec3::new(f64::from(-0.7f32), f64::from(1.7f32), f64::from(0.9f32));
        let expected = f64::from(ALBEDO) / PI * share * place.y / place.length().powi(3);
        assert!((under_spot(40.0).1 / expected - 1.0).abs() < 1e-9);
    }
}
