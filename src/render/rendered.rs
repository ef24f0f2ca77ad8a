//! What a render did so far.

use super::progress::{LEAST_FOR_NOISE, Progress};
use super::shares::Shares;
use super::tracer::Traced;
use crate::film::{Batch, Blocks, Film, SampleId};
use crate::picture::Crop;
use crate::{Error, Result};

/// How many of the samples that were not finite are remembered.
pub const DROPPED_NAMED: usize = 15;

/// Why a render ended.
#[derive(Debug)]
pub enum End {
    /// Every pixel has the samples it was to get.
    Samples,
    /// The time was up.
    Time,
    /// The estimated error, without the fireflies, is below the limit.
    Noise,
    /// There was a limit of the noise, but after [`MOST_WITHOUT_ESTIMATE`](super::MOST_WITHOUT_ESTIMATE) samples a pixel still nothing to
    /// estimate: the picture is black but for fireflies, or every sample was lost.
    NoEstimate,
    /// `stop` was set.
    Stopped,
    /// The tracer failed; what it had done before is on the film.
    Failed(Error),
}

/// What a render did so far: enough to go on with it.
#[derive(Debug)]
pub struct Rendered {
    /// The sums.
    pub film: Film,
    /// Samples, rays and seconds, over all runs.
    pub progress: Progress,
    /// How many samples were not finite and are left out.
    pub dropped: u64,
    /// Some of them, in the order in which they were rendered; at most [`DROPPED_NAMED`].
    pub dropped_samples: Vec<SampleId>,
    /// Seconds that the device was busy by its own clock; 0 if it has none.
    pub device_seconds: f64,
    /// The number of samples at which a limit of the noise is looked at next.
    pub noise_aim: u32,
    /// How many times that number each tile gets, where a limit of the noise has found that they should differ.
    pub shares: Option<Shares>,
    /// Why the last run ended.
    pub end: End,
}

impl Rendered {
    /// Nothing yet of a picture of `width` by `height` pixels, whose samples will begin with number `first_sample`.
    ///
    /// # Errors
    /// If the film does not fit into memory.
    pub fn nothing((width, height): (u32, u32), first_sample: u32) -> Result<Self> {
        let mut film = Film::new(width, height)?;
        film.first_sample = first_sample;
        let pixels = u64::from(width) * u64::from(height);
        Ok(Rendered {
            film,
            progress: Progress { pixels, first_sample, ..Progress::default() },
            dropped: 0,
            dropped_samples: Vec::new(),
            device_seconds: 0.0,
            noise_aim: LEAST_FOR_NOISE,
            shares: None,
            end: End::Stopped,
        })
    }

    /// Nothing yet of a part of a picture.
    ///
    /// # Errors
    /// If the film does not fit into memory.
    pub fn nothing_of_crop(crop: Crop, first_sample: u32) -> Result<Self> {
        let mut rendered = Self::nothing((crop.width, crop.height), first_sample)?;
        rendered.film.crop = Some(crop);
        Ok(rendered)
    }

    /// Takes in what a tracer did.
    pub(super) fn add(&mut self, batch: &Batch, traced: &Traced) {
        self.film.add(batch, &traced.sums);
        self.dropped += traced.sums.iter().map(|s| u64::from(s.dropped)).sum::<u64>();
        let room = DROPPED_NAMED.saturating_sub(self.dropped_samples.len());
        self.dropped_samples.extend(traced.dropped.iter().take(room));
        self.device_seconds += traced.device_seconds.unwrap_or(0.0);
        self.progress.samples += samples_of(batch);
        self.progress.rays += traced.sums.iter().map(|s| u64::from(s.rays.all)).sum::<u64>();
        self.progress.shadow_rays += traced.sums.iter().map(|s| u64::from(s.rays.shadow)).sum::<u64>();
    }

    /// Adds a part whose samples go on where these end.
    pub(crate) fn append(&mut self, next: &Rendered) {
        self.film.append(&next.film);
        self.dropped = self.dropped.saturating_add(next.dropped);
        let room = DROPPED_NAMED.saturating_sub(self.dropped_samples.len());
        self.dropped_samples.extend(next.dropped_samples.iter().take(room));
        self.device_seconds += next.device_seconds;
        self.progress.samples = self.progress.samples.saturating_add(next.progress.samples);
        self.progress.rays = self.progress.rays.saturating_add(next.progress.rays);
        self.progress.shadow_rays = self.progress.shadow_rays.saturating_add(next.progress.shadow_rays);
        self.progress.seconds += next.progress.seconds;
    }

    /// Estimates the error and says whether it is below `limit`; if not, when to look again, and, if `adaptive`, whether tiles are to have different
    /// shares from now on. Only where all pixels have [`Rendered::noise_aim`] samples, or their share of it.
    pub(super) fn quiet_enough(&mut self, limit: f64, adaptive: bool) -> bool {
        self.progress.error = self.film.error();
        // No estimate at all: no light was found, or every sample was lost.
        let relative = self.progress.error.map_or(f64::INFINITY, |error| error.careful());
        if relative > limit {
            let may_differ =
                adaptive && self.shares.is_none() && self.noise_aim.is_power_of_two() && self.film.first_sample == 0;
            let shares = if may_differ { Shares::of(&self.film, (relative / limit).powi(2)) } else { None };
            let most = f64::from(self.progress.limits.spp.unwrap_or(u32::MAX));
            let shares = shares.filter(|shares| shares.mean_samples(self.noise_aim) <= most);
            match shares {
                // The smallest share is there already.
                Some(shares) => self.shares = Some(shares),
                None => self.noise_aim = samples_to_reach(self.noise_aim, relative, limit),
            }
        }
        relative <= limit
    }
}

pub(super) fn samples_of(batch: &Batch) -> u64 {
    batch.tile.pixels() as u64 * u64::from(batch.samples.end - batch.samples.start)
}

/// How many samples to take before the error is looked at again: those that bring it from `relative` to `limit`, but at most as many again as there are, and whole
/// blocks. The estimate of an error from few samples is not to be relied on, and who looks often meets one that is too small by chance.
fn samples_to_reach(samples: u32, relative: f64, limit: f64) -> u32 {
    let needed = f64::from(samples) * (relative / limit).powi(2);
    // Rust's `as` saturates.
    let wanted = (needed.ceil() as u32).clamp(samples.saturating_add(1), samples.saturating_mul(2));
    at_a_look(wanted)
}

/// The least number of samples at which a limit of the noise is looked at that is not below this one: that of whole blocks, where both picture and estimate are better than
/// between.
pub(super) fn at_a_look(samples: u32) -> u32 {
    let samples = samples.max(LEAST_FOR_NOISE);
    samples.checked_next_multiple_of(Blocks::of(0..samples).length()).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{PixelSum, Tile, group_length};
    use crate::sampling::{random4, uniform};

    #[test]
    fn a_limit_of_the_noise_goes_by_the_careful_error() {
        let mut rendered = Rendered::nothing((8, 8), 0).unwrap();
        let tile = Tile { x: 0, y: 0, width: 8, height: 8 };
        for sample in 0..LEAST_FOR_NOISE {
            let value = |pixel: u32| 1.0 + uniform(random4(pixel, sample, 0, 5)[0]);
            let sums: Vec<_> =
                (0..64).map(|pixel| PixelSum { radiance: [value(pixel); 3], ..Default::default() }).collect();
            rendered.film.add(&Batch { tile, samples: sample..sample + 1, group: group_length(0) }, &sums);
        }
        let error = rendered.film.error().unwrap();
        assert!(error.careful() > 1.02 * error.relative(), "{error:?}");
        assert!(!rendered.quiet_enough(1.01 * error.relative(), false) && rendered.noise_aim > LEAST_FOR_NOISE);
        rendered.noise_aim = LEAST_FOR_NOISE;
        assert!(rendered.quiet_enough(1.001 * error.careful(), false) && rendered.noise_aim == LEAST_FOR_NOISE);
    }

    #[test]
    fn the_next_look_at_the_noise() {
        // Four times the error needs sixteen times the samples, and is not believed at once.
        assert_eq!(samples_to_reach(96, 0.4, 0.1), 192);
        assert_eq!(samples_to_reach(96, 0.11, 0.1), 128);
        assert_eq!(samples_to_reach(96, 0.1001, 0.1), 112);
        assert_eq!(samples_to_reach(96, f64::INFINITY, 0.1), 192);
        assert_eq!(samples_to_reach(128, 0.11, 0.1), 160, "from there on by 32");
        assert_eq!(samples_to_reach(u32::MAX - 1, 0.2, 0.1), u32::MAX);
        let looks: Vec<u32> =
            std::iter::successors(Some(LEAST_FOR_NOISE), |n| Some(at_a_look(n + 1))).take(10).collect();
        assert_eq!(looks, [32, 40, 48, 56, 64, 80, 96, 112, 128, 160]);
        assert_eq!([0, 7, 33, 1000].map(at_a_look), [32, 32, 40, 1024]);
    }
}
