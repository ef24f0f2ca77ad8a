//! Is the error bar right? The estimated error of many renders against their true one.

use super::statistics::Estimate;
use luminaire::Result;
use luminaire::film::{Film, INTERVAL_95};
use luminaire::render::{End, Limits, Tracer, render};
use luminaire::scene::Scene;
use std::sync::atomic::AtomicBool;

/// Seeds of the pictures under test are `FIRST_SEED` and those after it; the truth has the one before.
const FIRST_SEED: u32 = 1000;

/// A scene at a number of samples, over several seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Samples a pixel.
    pub spp: u32,
    /// Mean over the seeds of the true relMSE, without fireflies.
    pub rel_mse: f64,
    /// Estimated over true relMSE, both without the fireflies, of each seed.
    pub ratios: Vec<f64>,
    /// Estimated over true mean square error (not relative), likewise.
    pub mse_ratios: Vec<f64>,
    /// The part of the values (pixels, channels and seeds; no fireflies) whose truth is within [`INTERVAL_95`] standard errors.
    pub covered: f64,
    /// The part of the pixels that are fireflies.
    pub fireflies: f64,
    /// The true relMSE with the fireflies over that without them, averaged over the seeds.
    pub with_fireflies: f64,
}

impl Calibration {
    /// Estimated over true relMSE: the mean of the seeds' ratios, and its standard error.
    pub fn ratio(&self) -> Estimate {
        Estimate::new(self.ratios.iter().copied())
    }
}

/// Renders `scene` with `seeds` seeds at each of `spp` samples a pixel, and once with `truth` samples.
///
/// `open` gives a tracer for a scene; the truth should have many times the samples of the pictures (its own variance is taken
/// off).
///
/// # Errors
/// If a tracer cannot be had, or fails.
///
/// # Panics
/// If there are fewer than two samples a pixel, or there is no light.
pub fn calibrate(
    open: &dyn Fn(&Scene) -> Result<Box<dyn Tracer>>,
    scene: &Scene,
    spp: &[u32],
    seeds: u32,
    truth: u32,
) -> Result<Vec<Calibration>> {
    let mut scene = scene.clone();
    let mut picture = |seed: u32, spp: u32| -> Result<Film> {
        scene.settings.seed = seed;
        let size = (scene.film.width, scene.film.height);
        let limits = Limits { spp: Some(spp), ..Limits::default() };
        let rendered = render(open(&scene)?.as_mut(), size, limits, &mut |_| {}, &AtomicBool::new(false))?;
        match rendered.end {
            End::Failed(error) => Err(error),
            _ => Ok(rendered.film),
        }
    };
    let truth = picture(FIRST_SEED - 1, truth)?;
    // Of each pixel by itself: beside a small lamp its neighbours' would be far too much.
    let convergence = truth.error_map().expect("many samples").convergence;
    let truth_variance: Vec<[f64; 3]> =
        (0..truth.pixels()).map(|pixel| truth.variance(pixel, convergence).expect("many samples")).collect();
    let brightness = truth.brightness();
    let mut found = vec![];
    for &spp in spp {
        let mut c = Calibration {
            spp,
            rel_mse: 0.0,
            ratios: vec![],
            mse_ratios: vec![],
            covered: 0.0,
            fireflies: 0.0,
            with_fireflies: 0.0,
        };
        let (mut covered, mut values) = (0u64, 0u64);
        for seed in FIRST_SEED..FIRST_SEED + seeds {
            let film = picture(seed, spp)?;
            let errors = film.error_map().expect("several samples a pixel");
            let total = errors.total.expect("there is light");
            let (mut square, mut relative, mut all_relative) = (0.0, 0.0, 0.0);
            for (pixel, (estimated, own)) in std::iter::zip(&errors.standard_error, &truth_variance).enumerate() {
                let pairs = std::iter::zip(film.mean(pixel), truth.mean(pixel));
                let variances = std::iter::zip(estimated, own);
                for ((found, expected), (estimated, own)) in pairs.zip(variances) {
                    let estimated = f64::from(*estimated).powi(2);
                    let off = (found - expected).powi(2);
                    let relative_here = brightness.relative_square(found - expected, expected)
                        - brightness.relative_square(own.sqrt(), expected);
                    all_relative += relative_here;
                    if !errors.firefly[pixel] {
                        square += off - own;
                        relative += relative_here;
                        covered += u64::from(off <= INTERVAL_95 * INTERVAL_95 * (estimated + own));
                        values += 1;
                    }
                }
            }
            let left_out = (total.fireflies + total.unknown) as f64;
            let counted = 3.0 * (film.pixels() as f64 - left_out);
            c.ratios.push(total.rel_mse * counted / relative);
            c.mse_ratios.push(total.rmse.powi(2) * counted / square);
            c.rel_mse += relative / counted / f64::from(seeds);
            c.fireflies += left_out / film.pixels() as f64 / f64::from(seeds);
            let with = all_relative / (3 * film.pixels()) as f64;
            c.with_fireflies += with / (relative / counted) / f64::from(seeds);
        }
        c.covered = covered as f64 / values as f64;
        found.push(c);
    }
    Ok(found)
}
