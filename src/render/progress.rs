//! When a render ends, and how far it is.

use crate::film::ErrorEstimate;

/// When to end. Whichever limit is met first counts; without any, only `stop` ends a render.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Limits {
    /// Samples a pixel: the number of the sample before which to end.
    pub spp: Option<u32>,
    /// Seconds of wall-clock time, over all runs of a render, met at the next end of a batch.
    pub seconds: Option<f64>,
    /// Estimated relative error without the fireflies, as careful as a promise wants it ([`ErrorEstimate::careful`](crate::film::ErrorEstimate::careful)), met when all pixels
    /// have equally many samples, at least [`LEAST_FOR_NOISE`], and their blocks are whole. Where there is no estimate ([`MOST_WITHOUT_ESTIMATE`]) it ends the render, too.
    pub noise: Option<f64>,
    /// Whether a limit of the noise may give tiles of the picture different numbers of samples ([`Shares`](super::Shares)). `spp` is then that of a pixel in the mean.
    pub adaptive: bool,
}

/// A limit of the noise ends a render without being met after this many samples a pixel if there is still nothing to estimate: the picture is black
/// but for fireflies, or every sample was lost.
pub const MOST_WITHOUT_ESTIMATE: u32 = 1024;

/// No noise limit is met before this many samples a pixel: fewer may all have missed the same light.
pub const LEAST_FOR_NOISE: u32 = 32;

/// How far a render is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Progress {
    /// Number of the first sample of every pixel.
    pub first_sample: u32,
    /// Samples so far, over all pixels.
    pub samples: u64,
    /// Pixels of the film.
    pub pixels: u64,
    /// Rays so far, of all kinds.
    pub rays: u64,
    /// Shadow rays among them; one of the others for each sample comes from the camera, unless a driver did not finish it.
    pub shadow_rays: u64,
    /// Wall-clock seconds so far.
    pub seconds: f64,
    /// The limits.
    pub limits: Limits,
    /// The error as it was estimated when all pixels last had equally many samples; at the end, that of the picture.
    pub error: Option<ErrorEstimate>,
    /// Where tiles have different shares of the samples: the samples a pixel, averaged over the pixels, with which a limit of the noise is to be met.
    pub shared_aim: Option<f64>,
}

impl Progress {
    /// Samples a pixel so far, averaged over the pixels.
    pub fn spp(&self) -> f64 {
        self.samples as f64 / self.pixels as f64
    }

    /// Millions of rays a second; 0 before any time has passed.
    pub fn mrays_per_second(&self) -> f64 {
        if self.seconds > 0.0 { self.rays as f64 / self.seconds * 1e-6 } else { 0.0 }
    }

    /// The part that is done, 0 to 1, by the limit that will be met first; 0 without limits.
    pub fn fraction(&self) -> f64 {
        let wanted = |spp: u32| f64::from(spp.saturating_sub(self.first_sample).max(1));
        let by_samples = self.limits.spp.map_or(0.0, |spp| self.spp() / wanted(spp));
        let by_time = self.limits.seconds.map_or(0.0, |seconds| self.seconds / seconds);
        // The squared error falls with the number of samples.
        let by_noise = match (self.limits.noise, self.error, self.shared_aim) {
            (Some(_), _, Some(aim)) => self.spp() / aim,
            (Some(limit), Some(error), None) => (limit / error.careful()).powi(2),
            _ => 0.0,
        };
        by_samples.max(by_time).max(by_noise).min(1.0)
    }

    /// Seconds left at the present pace, if there is a limit and any work was done.
    pub fn seconds_left(&self) -> Option<f64> {
        let fraction = self.fraction();
        (fraction > 0.0).then(|| self.seconds * (1.0 - fraction) / fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_by_the_nearer_limit() {
        let limits = Limits { spp: Some(10), seconds: Some(100.0), ..Limits::default() };
        let progress =
            Progress { samples: 500, pixels: 100, rays: 4_000_000, seconds: 2.0, limits, ..Progress::default() };
        assert_eq!(progress.fraction(), 0.5);
        assert_eq!(progress.seconds_left(), Some(2.0));
        assert_eq!(progress.mrays_per_second(), 2.0);
        assert_eq!(Progress { limits: Limits::default(), ..progress }.seconds_left(), None);
        let limits = Limits { noise: Some(0.1), ..Limits::default() };
        assert_eq!(Progress { limits, shared_aim: Some(50.0), ..progress }.fraction(), 0.1);
        let nearly_over = Progress { seconds: 90.0, ..progress };
        assert_eq!(nearly_over.fraction(), 0.9);
    }
}
