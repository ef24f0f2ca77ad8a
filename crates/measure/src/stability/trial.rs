//! Samples of a scene, kept one by one, and what they cost.

use crate::statistics::Estimate;
use luminaire::Result;
use luminaire::film::{Batch, PixelSum, Tile};
use luminaire::render::Tracer;
use std::time::Instant;

/// Rays of one batch, about: a second of a software device, and far less than what a desktop's watchdog minds.
const BATCH_RAYS: f64 = 4e6;

/// Every sample of a picture, with its cost.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// Mean radiance of each group of samples, the mean of the channels: group by group, in each all pixels. Samples that were not
    /// finite count as 0.
    pub groups: Vec<f64>,
    /// Samples of a group.
    pub group: u32,
    /// Pixels of the picture.
    pub pixels: usize,
    /// Rays of all kinds.
    pub rays: u64,
    /// Seconds that it took.
    pub seconds: f64,
}

impl Trial {
    /// Traces samples 0 to `samples` of `width` by `height` pixels, which have about `rays` rays each; every sample is kept.
    pub(super) fn new(tracer: &mut dyn Tracer, size: (u32, u32), samples: u32, rays: f64) -> Result<Self> {
        Self::grouped(tracer, size, (samples, 1), rays)
    }

    /// The same for `count` groups of `group` samples, of which the means are kept. A group takes a device less time than as many samples
    /// alone, where their lengths differ: none waits for the longest.
    pub(super) fn grouped(
        tracer: &mut dyn Tracer,
        (width, height): (u32, u32),
        (count, group): (u32, u32),
        rays: f64,
    ) -> Result<Self> {
        let tile = Tile { x: 0, y: 0, width, height };
        let pixels = tile.pixels();
        let most = (tracer.max_sums() / pixels).min(32_768) as f64;
        let step = (BATCH_RAYS / (pixels as f64 * f64::from(group) * rays)).clamp(1.0, most) as u32;
        let mut trial = Trial { groups: Vec::new(), group, pixels, rays: 0, seconds: 0.0 };
        let start = Instant::now();
        for first in (0..count).step_by(step as usize) {
            let batch = Batch { tile, samples: first * group..count.min(first + step) * group, group };
            let traced = tracer.trace(&batch)?;
            let mean = |sum: &PixelSum| sum.radiance.iter().sum::<f64>() / 3.0 / f64::from(group);
            trial.groups.extend(traced.sums.iter().map(mean));
            trial.rays += traced.sums.iter().map(|s| u64::from(s.rays.all)).sum::<u64>();
        }
        trial.seconds = start.elapsed().as_secs_f64();
        Ok(trial)
    }

    /// How many samples there are, over all pixels.
    fn count(&self) -> f64 {
        self.groups.len() as f64 * f64::from(self.group)
    }

    /// Mean of the picture with its standard error.
    pub(super) fn mean(&self) -> Estimate {
        let mean = self.groups.iter().sum::<f64>() / self.groups.len() as f64;
        Estimate { mean, error: (self.variance() / self.count()).sqrt() }
    }

    /// Variance of one sample of a pixel, in the mean of the pixels. What rounding alone could be is none.
    pub(super) fn variance(&self) -> f64 {
        let samples = self.count() / self.pixels as f64;
        let of_pixel = |pixel: usize| {
            let estimate = Estimate::new(self.groups.iter().skip(pixel).step_by(self.pixels).copied());
            let rounding = 1e-14 * estimate.mean.abs();
            if estimate.error <= rounding { 0.0 } else { estimate.error * estimate.error * samples }
        };
        (0..self.pixels).map(of_pixel).sum::<f64>() / self.pixels as f64
    }

    /// The same picture less another one, group by group: for tracers that drew the same random numbers.
    pub(super) fn less(&self, other: &Trial) -> Trial {
        let groups = self.groups.iter().zip(&other.groups).map(|(a, b)| a - b).collect();
        Trial { groups, ..self.clone() }
    }

    /// Rays for one sample.
    pub(super) fn rays_a_sample(&self) -> f64 {
        self.rays as f64 / self.count()
    }

    /// Seconds for one ray.
    pub(super) fn seconds_a_ray(&self) -> f64 {
        self.seconds / self.rays as f64
    }
}
