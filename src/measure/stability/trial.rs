//! Samples of a scene, kept one by one, and what they cost.

use crate::Result;
use crate::film::{Batch, Tile};
use crate::measure::statistics::Estimate;
use crate::render::Tracer;
use std::time::Instant;

/// Rays of one batch, about: a second of a software device, and far less than what a desktop's watchdog minds.
const BATCH_RAYS: f64 = 4e6;

/// Every sample of a picture, with its cost.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// Radiance, the mean of the channels: sample by sample, in each all pixels. Samples that were not finite count as 0.
    pub samples: Vec<f64>,
    /// Pixels of the picture.
    pub pixels: usize,
    /// Rays of all kinds.
    pub rays: u64,
    /// Seconds that it took.
    pub seconds: f64,
}

impl Trial {
    /// Traces samples 0 to `samples` of `width` by `height` pixels, which have about `rays` rays each.
    pub(super) fn new(tracer: &mut dyn Tracer, (width, height): (u32, u32), samples: u32, rays: f64) -> Result<Self> {
        let tile = Tile { x: 0, y: 0, width, height };
        let pixels = tile.pixels();
        let most = (tracer.max_sums() / pixels).min(32_768) as f64;
        let step = (BATCH_RAYS / (pixels as f64 * rays)).clamp(1.0, most) as u32;
        let mut trial = Trial { samples: Vec::new(), pixels, rays: 0, seconds: 0.0 };
        let start = Instant::now();
        for first in (0..samples).step_by(step as usize) {
            let batch = Batch { tile, samples: first..samples.min(first + step), group: 1 };
            let traced = tracer.trace(&batch)?;
            trial.samples.extend(traced.sums.iter().map(|s| s.radiance.iter().sum::<f64>() / 3.0));
            trial.rays += traced.sums.iter().map(|s| u64::from(s.rays)).sum::<u64>();
        }
        trial.seconds = start.elapsed().as_secs_f64();
        Ok(trial)
    }

    /// Mean of the picture with its standard error.
    pub(super) fn mean(&self) -> Estimate {
        let mean = self.samples.iter().sum::<f64>() / self.samples.len() as f64;
        Estimate { mean, error: (self.variance() / self.samples.len() as f64).sqrt() }
    }

    /// Variance of one sample of a pixel, in the mean of the pixels.
    pub(super) fn variance(&self) -> f64 {
        let count = (self.samples.len() / self.pixels) as f64;
        let of_pixel = |pixel: usize| {
            let estimate = Estimate::new(self.samples.iter().skip(pixel).step_by(self.pixels).copied());
            estimate.error * estimate.error * count
        };
        (0..self.pixels).map(of_pixel).sum::<f64>() / self.pixels as f64
    }

    /// The same picture less another one, sample by sample: for tracers that drew the same random numbers.
    pub(super) fn less(&self, other: &Trial) -> Trial {
        let samples = self.samples.iter().zip(&other.samples).map(|(a, b)| a - b).collect();
        Trial { samples, ..self.clone() }
    }

    /// Rays for one sample.
    pub(super) fn rays_a_sample(&self) -> f64 {
        self.rays as f64 / self.samples.len() as f64
    }

    /// Seconds for one ray.
    pub(super) fn seconds_a_ray(&self) -> f64 {
        self.seconds / self.rays as f64
    }
}
