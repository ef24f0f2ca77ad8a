//! A lamp from so near that it fills the sky to so far that it is a point, and one seen from its edge.

use super::judge::{everywhere, light};
use super::spot::{
    Spot, Tally, chart, irradiance_of_mesh, looking_from, noise_axis, off, percent, series, without_roulette,
};
use super::sweep::{Definition, Family, Findings, Sweep};
use super::verdict::{Judgement, NOISY_VARIANCE, Verdict, Worse, place, stretch};
use crate::Workbench;
use crate::chart::{Axis, Chart, Series};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::build::{add, lamp, matte, quad};
use luminaire::scene::{AreaSampling, Directions, Estimator, LightSampling, Mesh, Scene};
use std::f64::consts::PI;

/// The sweep over the distance.
pub const DISTANCE: Definition = Definition {
    name: "luminaire",
    family: Family::Light,
    title: "distance of a square lamp above a floor, 1e-6 to 1e6 of its side",
    run: |bench| sweep(bench, &Steps::new(bench, Case::Distance)),
};

/// The sweep over the tilt.
pub const TILT: Definition = Definition {
    name: "edge-on",
    family: Family::Light,
    title: "sine of the angle between a lamp's plane and the direction to it, 1 to 1e-5",
    run: |bench| sweep(bench, &Steps::new(bench, Case::Tilt)),
};

const ALBEDO: f32 = 0.5;

/// What is swept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Case {
    /// The lamp's distance over its side: 1e-6 is all but on the floor, 1e6 as small as a star.
    Distance,
    /// The sine of the angle between its plane and the direction to its middle: at 0 its edge is seen.
    Tilt,
}

/// Which points.
pub struct Steps {
    /// What is swept.
    pub case: Case,
    /// In ascending order.
    pub values: Vec<f64>,
    /// Samples of a point.
    pub samples: u32,
}

impl Steps {
    fn new(bench: &Workbench, case: Case) -> Self {
        let (low, high) = if case == Case::Distance { (-6, 6) } else { (-5, 0) };
        let steps = if bench.long { 4 } else { 1 };
        let values = (low * steps..=high * steps).map(|i| 10f64.powf(f64::from(i) / f64::from(steps))).collect();
        Steps { case, values, samples: if bench.long { 1 << 17 } else { 1 << 15 } }
    }
}

/// A floor with the origin, on which the camera looks, and the lamp; and the radiance of the origin.
fn scene(case: Case, value: f64) -> (Scene, f64) {
    let value32 = value as f32;
    let (eye, shape) = match case {
        // The camera between the floor and the lamp, which does not hang symmetrically.
        Case::Distance => {
            let near = value32.min(1.0);
            let lamp = quad(Vec3::new(-0.4, value32, -0.3), Vec3::X, Vec3::Z);
            (Vec3::new(0.25 * near, 0.5 * near, near), lamp)
        }
        Case::Tilt => {
            let along = Vec3::new(value32, (1.0 - value * value).sqrt() as f32, 0.0) * 0.5;
            (Vec3::new(0.3, 0.5, 0.8), quad(Vec3::Y - 0.5 * along - 0.2 * Vec3::Z, along, 0.5 * Vec3::Z))
        }
    };
    let truth = f64::from(ALBEDO) / PI * irradiance_of_mesh(&shape);
    let mut scene = looking_from(eye);
    add(&mut scene, floor(), matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    add(&mut scene, shape, lamp(Vec3::ONE), Affine3A::IDENTITY);
    (scene, truth)
}

fn floor() -> Mesh {
    quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0)
}

/// How light is found, and by which point of the lamp.
fn methods() -> [(&'static str, Estimator); 5] {
    let by = |light_sampling, area_sampling| Estimator { area_sampling, ..without_roulette(light_sampling, 0) };
    [
        (
            "chance (cosine)",
            Estimator { directions: Directions::Cosine, ..by(LightSampling::None, AreaSampling::Area) },
        ),
        ("by area", by(LightSampling::Direct, AreaSampling::Area)),
        ("by solid angle", by(LightSampling::Direct, AreaSampling::SolidAngle)),
        ("by area, MIS", by(LightSampling::Mis, AreaSampling::Area)),
        ("by solid angle, MIS", by(LightSampling::Mis, AreaSampling::SolidAngle)),
    ]
}

/// Runs these steps.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, steps: &Steps) -> Result<Sweep> {
    let mut tally = Tally::default();
    let methods = methods();
    let names = || series(methods.iter().map(|(name, _)| name));
    let (mut shares, mut noise, mut fireflies) = (names(), names(), names());
    // The two that sample by solid angle, on the GPU: light sampling alone and the default.
    let on_gpu: Vec<(Backend, usize)> =
        bench.backends().into_iter().skip(1).flat_map(|backend| [(backend, 2), (backend, 4)]).collect();
    let mut gpu = series(on_gpu.iter().map(|(backend, method)| format!("{}, {backend}", methods[*method].0)));
    for &value in &steps.values {
        let (scene, truth) = scene(steps.case, value);
        let mut measure = |backend, estimator| -> Result<Spot> {
            let spot = Spot::new(bench, backend, &scene, estimator, steps.samples)?;
            tally.add(&spot);
            Ok(spot)
        };
        for (i, (_, estimator)) in methods.iter().enumerate() {
            let spot = measure(Backend::Cpu, *estimator)?;
            shares[i].points.push(spot.share(value, truth));
            noise[i].points.push(spot.noise(value, truth));
            fireflies[i].points.push(spot.firefly(value, truth));
        }
        for (series, (backend, method)) in gpu.iter_mut().zip(&on_gpu) {
            series.points.push(measure(*backend, methods[*method].1)?.share(value, truth));
        }
    }
    let (worse, unit) = match steps.case {
        Case::Distance => (Worse::Upwards, "sides away"),
        Case::Tilt => (Worse::Downwards, "(sine)"),
    };
    let verdict = |method: usize| {
        let gpu = gpu.iter().zip(&on_gpu).filter(|(_, (_, of))| *of == method).map(|(series, _)| series);
        let shares: Vec<_> = std::iter::once(&shares[method]).chain(gpu).collect();
        light(methods[method].0, &[&noise[method]], &shares, worse)
    };
    let verdicts: Vec<Verdict> = [4, 0, 1, 2, 3].map(verdict).into();
    let range = stretch(steps.values.iter().copied(), worse, unit);
    let summary = match steps.case {
        Case::Distance => of_nearest(&verdicts[0]),
        Case::Tilt => everywhere(
            &verdicts,
            methods[4].0,
            "The defaults find the light of a lamp at every tilt; chance alone soon loses it.",
        ),
    };
    let findings = match steps.case {
        Case::Distance => of_distance(&fireflies, &shares, &gpu, &tally),
        Case::Tilt => of_tilt(&fireflies, &shares, &gpu, &tally),
    };
    let (x, place) = match steps.case {
        Case::Distance => ("distance / side of the lamp", "of a lamp near and far"),
        Case::Tilt => ("sine of the angle between the lamp's plane and the direction to it", "of a lamp seen edge-on"),
    };
    shares.iter_mut().for_each(|series| series.name += ", cpu");
    shares.extend(gpu);
    let heading = |what: &str| format!("{what} {place}");
    let charts: Vec<Chart> = vec![
        chart("noise", &heading("Noise"), x, noise_axis(), noise),
        chart("fireflies", &heading("Largest sample"), x, Axis::log("largest sample / mean"), fireflies),
        chart("energy", &heading("Energy"), x, Axis::linear("share found of the light"), shares),
    ];
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// How near a lamp may be by the defaults.
fn of_nearest(default: &Verdict) -> String {
    let nearest = default.ranges.iter().filter(|range| range.judgement == Judgement::Safe).map(|range| range.from);
    nearest.reduce(f64::min).map_or("Nothing of this range is safe.".into(), |nearest| {
        format!("Hang no lamp nearer to a surface than {} of its side.", place(nearest))
    })
}

/// What the table of the verdicts goes by.
fn starts() -> String {
    format!("A sample varies by more than ten times its mean (variance above {NOISY_VARIANCE}):")
}

fn highest(series: &Series) -> f64 {
    series.points.iter().map(|p| p.y).filter(|y| !y.is_nan()).fold(0.0, f64::max)
}

/// Farthest off of several series in a range.
fn farthest<'a>(series: impl IntoIterator<Item = &'a Series>, range: std::ops::RangeInclusive<f64>) -> f64 {
    series.into_iter().map(|s| off(s, range.clone())).fold(0.0, f64::max)
}

fn of_distance(fireflies: &[Series], shares: &[Series], gpu: &[Series], tally: &Tally) -> Findings {
    let default = gpu.iter().skip(1).step_by(2);
    let lost = default.flat_map(|s| &s.points).filter(|p| p.y < 0.95).map(|p| p.x).reduce(f64::max);
    Findings {
        starts: starts(),
        how: format!(
            "Sampled by area alone, a lamp at a small distance is all in the few points straight above, whose inverse square is not bounded: a \
             sample of up to {:.0e} times the mean where they are met, and darkness where not. Chance finds near lamps at once and far \
             ones never. {} Nearer than a few millionths of the \
             floor's own size that is the rounding of single precision: a ray starts off its surface by as much, and so behind the lamp.",
            highest(&fireflies[1]),
            lost.map_or("The GPU finds the light at every distance.".into(), |x| format!("The GPU loses light at {x:.0e} and nearer.")),
        ),
        mends: format!(
            "By solid angle where the lamp is near, by area where it is far, and MIS over both: its largest sample is {:.1} times the \
             mean, and the light is that of Lambert's formula, beyond three standard errors, to {} on the CPU everywhere, on the GPU to {} \
             from 1e-5 on. {}",
            highest(&fireflies[4]),
            percent(farthest([&shares[4]], 0.0..=1e9)),
            percent(farthest(gpu.iter().skip(1).step_by(2), 9e-6..=1e9)),
            tally.sentence(),
        ),
        sees: "With `area_sampling = \"area\"` and light sampling alone, fireflies and dark spots where a lamp nearly touches a wall. With \
               the defaults nothing."
            .into(),
    }
}

fn of_tilt(fireflies: &[Series], shares: &[Series], gpu: &[Series], tally: &Tally) -> Findings {
    Findings {
        starts: starts(),
        how: "A lamp seen from its edge takes up less of the sky, in proportion to the sine: chance meets it as much more rarely. \
              Sampling its area is not disturbed, because the same cosine makes every sample as much fainter."
            .into(),
        mends: format!(
            "A triangle of less than a thousandth of a steradian is sampled by area even where it is near, because solid angles cancel. \
             The largest sample of the default is {:.1} times the mean, and the light is that of Lambert's formula, beyond three standard \
             errors, to {} on the CPU and to {} on the GPU at a sine of 1e-3 and above, below that to {} and {}. {}",
            highest(&fireflies[4]),
            percent(farthest([&shares[4]], 9e-4..=2.0)),
            percent(farthest(gpu, 9e-4..=2.0)),
            percent(farthest([&shares[4]], 0.0..=9e-4)),
            percent(farthest(gpu, 0.0..=9e-4)),
            tally.sentence(),
        ),
        sees: "With the defaults nothing; without light sampling, fireflies in the light of screens and panels that are seen from the side."
            .into(),
    }
}
