//! A lamp above a floor, its light found in every way: what the sweeps over a lamp's distance and tilt share.

use super::judge::light;
use super::light::{Spot, Tally, chart, irradiance_of_mesh, looking_from, noise_axis, off, series, without_roulette};
use super::verdict::{NOISY_VARIANCE, Verdict, Worse};
use crate::Workbench;
use crate::chart::{Axis, Chart, Series};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::build::{add, lamp, matte, quad};
use luminaire::scene::{AreaSampling, Directions, Estimator, LightSampling, Mesh, Scene};
use std::f64::consts::PI;

const ALBEDO: f32 = 0.5;

/// The powers of ten between two exponents, with steps between them in a long run.
pub(super) fn powers(bench: &Workbench, low: i32, high: i32) -> Vec<f64> {
    let steps = if bench.long { 4 } else { 1 };
    (low * steps..=high * steps).map(|i| 10f64.powf(f64::from(i) / f64::from(steps))).collect()
}

/// Samples of a point.
pub(super) fn samples(bench: &Workbench) -> u32 {
    if bench.long { 1 << 17 } else { 1 << 15 }
}

/// A floor with the origin, on which the camera looks from `eye`, and a lamp of this shape; and the radiance of the origin.
pub(super) fn lit_by(eye: Vec3, shape: Mesh) -> (Scene, f64) {
    let truth = f64::from(ALBEDO) / PI * irradiance_of_mesh(&shape);
    let mut scene = looking_from(eye);
    add(&mut scene, floor(), matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    add(&mut scene, shape, lamp(Vec3::ONE), Affine3A::IDENTITY);
    (scene, truth)
}

fn floor() -> Mesh {
    quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0)
}

/// The default, as a method.
pub(super) const DEFAULT: &str = "by solid angle, MIS";

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
        (DEFAULT, by(LightSampling::Mis, AreaSampling::SolidAngle)),
    ]
}

/// What was found in all ways, a series a method.
pub(super) struct Found {
    /// Of the light, on the CPU.
    pub shares: Vec<Series>,
    /// Of the light, on the GPU's backends: by solid angle alone and by the default, in turn.
    pub gpu: Vec<Series>,
    noise: Vec<Series>,
    /// The largest sample over the mean.
    pub fireflies: Vec<Series>,
    /// All samples.
    pub tally: Tally,
    /// The default comes first.
    pub verdicts: Vec<Verdict>,
}

/// Finds the light of a scene at each of some values in every way. `scene` gives what is seen, and its radiance.
///
/// # Errors
/// If a device fails.
pub(super) fn measure(
    bench: &Workbench,
    (values, samples): (&[f64], u32),
    worse: Worse,
    scene: fn(f64) -> (Scene, f64),
) -> Result<Found> {
    let mut tally = Tally::default();
    let methods = methods();
    let names = || series(methods.iter().map(|(name, _)| name));
    let (mut shares, mut noise, mut fireflies) = (names(), names(), names());
    // The two that sample by solid angle, on the GPU: light sampling alone and the default.
    let on_gpu: Vec<(Backend, usize)> =
        bench.backends().into_iter().skip(1).flat_map(|backend| [(backend, 2), (backend, 4)]).collect();
    let mut gpu = series(on_gpu.iter().map(|(backend, method)| format!("{}, {backend}", methods[*method].0)));
    for &value in values {
        let (scene, truth) = scene(value);
        let mut measure = |backend, estimator| -> Result<Spot> {
            let spot = Spot::new(bench, backend, &scene, estimator, samples)?;
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
    let verdict = |method: usize| {
        let gpu = gpu.iter().zip(&on_gpu).filter(|(_, (_, of))| *of == method).map(|(series, _)| series);
        let shares: Vec<_> = std::iter::once(&shares[method]).chain(gpu).collect();
        light(methods[method].0, &[&noise[method]], &shares, worse)
    };
    let verdicts: Vec<Verdict> = [4, 0, 1, 2, 3].map(verdict).into();
    Ok(Found { shares, gpu, noise, fireflies, tally, verdicts })
}

impl Found {
    /// Noise, fireflies and energy of what `of` names, over `x`.
    pub(super) fn charts(mut self, x: &str, of: &str) -> Vec<Chart> {
        self.shares.iter_mut().for_each(|series| series.name += ", cpu");
        self.shares.extend(self.gpu);
        let heading = |what: &str| format!("{what} {of}");
        vec![
            chart("noise", &heading("Noise"), x, noise_axis(), self.noise),
            chart("fireflies", &heading("Largest sample"), x, Axis::log("largest sample / mean"), self.fireflies),
            chart("energy", &heading("Energy"), x, Axis::linear("share found of the light"), self.shares),
        ]
    }
}

/// What the table of the verdicts goes by.
pub(super) fn starts() -> String {
    format!("A sample varies by more than ten times its mean (variance above {NOISY_VARIANCE}):")
}

/// The largest value of a series that is a number.
pub(super) fn highest(series: &Series) -> f64 {
    series.points.iter().map(|p| p.y).filter(|y| !y.is_nan()).fold(0.0, f64::max)
}

/// Farthest off of several series in a range.
pub(super) fn farthest<'a>(series: impl IntoIterator<Item = &'a Series>, range: std::ops::RangeInclusive<f64>) -> f64 {
    series.into_iter().map(|s| off(s, range.clone())).fold(0.0, f64::max)
}
