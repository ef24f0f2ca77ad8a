//! Closed forms and published cases against every backend, in one table.
//!
//! A case is a scene of which a mean is known: by a formula, or by quadrature of one. Two kinds of answers are compared with it:
//!
//! - what chance estimates: `z`, the deviation over the standard error, and for all cases and backends together the probability that a right
//!   program gives a largest `z` at least as far off (Sidak). Every case and backend has its own random numbers, so that this is exact;
//! - what chance does not enter: the relative deviation, against a bound on the rounding.
//!
//! "CIE 171" is CIE 171:2006, "Test Cases to Assess the Accuracy of Lighting Computer Programs": those of its analytical cases (5.2 to 5.11) that need no
//! measured luminaire. Their formulas are computed here, not copied from the report's tables, of which some are wrong (I. Ashdown, "CIE 171:2006 -
//! Errata": tables of 5.7, 5.8 and others).
//!
//! Where curved shapes are made of triangles, the expectation is that of the triangles, unless a case has a `slack`.

mod daylight;
mod dielectrics;
mod form_factors;
pub mod formulas;
mod lens;
mod luminaires;
mod rooms;
mod table;

pub use table::{Row, Table, Verdict};

use super::Workbench;
use super::statistics::Estimate;
use glam::{Vec3, Vec3Swizzles};
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::gpu::probe::{Call, Function};
use luminaire::reference::impulse::fresnel;
use luminaire::scene::{Scene, build};
use luminaire::{Error, Result};

/// Pixels on each side of every picture.
pub const SIDE: u32 = 16;
/// Relative bound on single precision's roundings where chance does not enter.
const BOUND: f64 = 2e-6;
/// Groups of samples from whose spread the error follows.
const GROUPS: u32 = 16;
/// Samples a pixel in one batch; a multiple of [`GROUPS`].
const MOST_AT_ONCE: u32 = 1024;

/// A picture whose mean counts.
#[derive(Debug, Clone)]
pub struct View {
    /// What is seen.
    pub scene: Scene,
    /// Factor to the mean radiance of the picture.
    pub weight: f64,
}

/// What is compared with the expectation.
#[derive(Debug, Clone)]
pub enum Measured {
    /// The sum of the weighted means of some pictures, which chance estimates.
    Estimated(Vec<View>),
    /// The weighted mean of a picture that chance does not enter, to this relative bound.
    Certain(Box<View>, f64),
    /// The tracers' own function: Fresnel's reflectance for this `eta` and angle in radian, to this absolute bound.
    Reflectance(f64, f64, f64),
}

/// A closed form or published case.
#[derive(Debug, Clone)]
pub struct Case {
    /// What it is about: cases of one subject stand together.
    pub subject: &'static str,
    /// Scene and quantity, in words.
    pub name: String,
    /// The formula, in words or symbols.
    pub formula: &'static str,
    /// The true value.
    pub expected: f64,
    /// By how much, relatively, the scene's true mean may be off because its shapes are only approximated; 0 if they are not.
    pub slack: f64,
    /// Samples for each that an easy case gets: a case whose samples vary more gets more of them.
    pub effort: u32,
    /// What is compared.
    pub measured: Measured,
}

impl Case {
    fn estimated(subject: &'static str, name: String, formula: &'static str, expected: f64, views: Vec<View>) -> Self {
        Case { subject, name, formula, expected, slack: 0.0, effort: 1, measured: Measured::Estimated(views) }
    }

    fn certain(
        subject: &'static str,
        name: String,
        formula: &'static str,
        expected: f64,
        view: View,
        bound: f64,
    ) -> Self {
        let measured = Measured::Certain(Box::new(view), bound);
        Case { subject, name, formula, expected, slack: 0.0, effort: 1, measured }
    }

    fn effort(self, effort: u32) -> Self {
        Case { effort, ..self }
    }

    fn slack(self, slack: f64) -> Self {
        Case { slack, ..self }
    }
}

/// Every case, in the order of the table.
pub fn cases() -> Vec<Case> {
    [luminaires::cases(), form_factors::cases(), rooms::cases(), daylight::cases(), dielectrics::cases(), lens::cases()]
        .concat()
}

/// An empty scene of the size of every picture.
fn empty() -> Scene {
    build::empty(SIDE, SIDE)
}

/// A sensor whose whole picture is a speck of a millionth around `point`, seen from the side of `normal`, an axis, out of a distance of 1/16.
fn speck(point: Vec3, normal: Vec3) -> luminaire::scene::Sensor {
    let aside = normal.yzx();
    build::pinhole(point + normal / 16.0 + aside / 64.0, point, normal.zxy(), 1e-3)
}

/// Runs a case on a backend, with `samples` a pixel for each of its efforts.
///
/// # Errors
/// If the backend is not here or fails.
pub fn measure(bench: &Workbench, case: &Case, backend: Backend, seed: u32, samples: u32) -> Result<Estimate> {
    match &case.measured {
        Measured::Estimated(views) => {
            let (mut mean, mut variance) = (0.0, 0.0);
            for (index, view) in (0u32..).zip(views) {
                let found = picture(bench, view, backend, seed * 16 + index, samples * case.effort)?;
                mean += found.mean;
                variance += found.error * found.error;
            }
            Ok(Estimate { mean, error: variance.sqrt() })
        }
        Measured::Certain(view, _) => picture(bench, view, backend, seed, GROUPS),
        Measured::Reflectance(eta, angle, _) => {
            let mean = if backend == Backend::Cpu {
                fresnel(*eta, angle.cos())
            } else {
                reflectance_on_the_device(bench, backend, *eta, *angle)?
            };
            Ok(Estimate { mean, error: 0.0 })
        }
    }
}

/// The weighted mean of a picture. Its pixels' samples are independent, its channels are the same.
fn picture(bench: &Workbench, view: &View, backend: Backend, seed: u32, samples: u32) -> Result<Estimate> {
    let mut scene = view.scene.clone();
    scene.settings.seed = seed;
    let mut tracer = bench.tracer(&scene, backend)?;
    let tile = Tile { x: 0, y: 0, width: scene.film.width, height: scene.film.height };
    let mut means = vec![Vec::new(); tile.pixels()];
    let mut done = 0;
    while done < samples {
        // In batches that no driver takes for a hang.
        let part = (samples - done).min(MOST_AT_ONCE);
        let group = part.div_ceil(GROUPS);
        let traced = tracer.trace(&Batch { tile, samples: done..done + part, group })?;
        if !traced.dropped.is_empty() {
            return Err(Error::scene(&scene.path, format!("{} samples are not finite", traced.dropped.len())));
        }
        for (i, sum) in traced.sums.iter().enumerate() {
            means[i % tile.pixels()].push(sum.radiance.iter().sum::<f64>() / 3.0 / f64::from(group));
        }
        done += part;
    }
    let pixels: Vec<Estimate> = means.into_iter().map(|pixel| Estimate::new(pixel.into_iter())).collect();
    let factor = view.weight / tile.pixels() as f64;
    let variance: f64 = pixels.iter().map(|pixel| pixel.error * pixel.error).sum();
    let mean: f64 = pixels.iter().map(|pixel| pixel.mean).sum();
    Ok(Estimate { mean: factor * mean, error: factor * variance.sqrt() })
}

/// What the kernel's own function says.
fn reflectance_on_the_device(bench: &Workbench, backend: Backend, eta: f64, angle: f64) -> Result<f64> {
    let probe = bench.probe(&dielectrics::any_scene(), backend)?;
    let wo = [angle.sin() as f32, 0.0, angle.cos() as f32, eta as f32].map(f32::to_bits);
    let call: Call = [wo, [0; 4]];
    let [result, _] = probe.call(Function::Refract, &[call])?[0];
    Ok(f64::from(f32::from_bits(result[3])))
}
