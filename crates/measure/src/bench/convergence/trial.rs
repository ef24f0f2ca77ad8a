//! One contender on one scene and backend: its renders, round by round.

use super::reference_picture::Reference;
use crate::bench::power_law::PowerLaw;
use crate::bench::renders::{picture, render_samples, warm_up};
use crate::bench::rounds::Rounds;
use crate::{Workbench, metrics};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::render::Progress;
use luminaire::scene::Scene;
use std::time::Instant;

/// Samples of a render over those of the one before it.
pub(super) const STEP: u32 = 4;
/// Most samples of a render, however much time is left.
const MOST_SAMPLES: u32 = 1 << 18;
/// Least number of renders, however slow they are.
const LEAST_RUNGS: usize = 3;

/// The renders at one number of samples, a value a round.
#[derive(Debug, Clone)]
pub(super) struct Rung {
    /// Samples a pixel.
    pub spp: u32,
    /// Wall-clock seconds.
    pub seconds: Rounds,
    /// Seconds that the device was busy by its own clock; 0 where it has none.
    pub device_seconds: Rounds,
    /// relMSE against the reference, less the reference's own.
    pub relmse: Rounds,
    /// How much a round traced, in the mean.
    pub counts: Counts,
}

impl Rung {
    fn new(spp: u32) -> Self {
        let empty = Rounds::default;
        Rung { spp, seconds: empty(), device_seconds: empty(), relmse: empty(), counts: Counts::default() }
    }

    /// A quantity by the second in every round.
    pub fn rates(&self, count: f64) -> Rounds {
        self.seconds.map(|seconds| count / seconds)
    }

    /// relMSE times seconds in every round.
    pub fn costs(&self) -> Rounds {
        self.relmse.times(&self.seconds)
    }

    /// Whether the device has a clock.
    pub fn has_device_seconds(&self) -> bool {
        self.device_seconds.0.iter().any(|seconds| *seconds > 0.0)
    }
}

/// How much a render traced.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Counts {
    pub samples: f64,
    /// Rays of all kinds.
    pub rays: f64,
    pub shadow_rays: f64,
}

impl Counts {
    /// Takes render number `n` into the mean.
    fn add(&mut self, render: &Progress, n: f64) {
        let Counts { samples, rays, shadow_rays } = self;
        for (mean, count) in [(samples, render.samples), (rays, render.rays), (shadow_rays, render.shadow_rays)] {
            *mean += (count as f64 - *mean) / n;
        }
    }

    /// Rays that are no shadow rays, for one sample, without the one from the camera.
    pub fn bounce_rays_a_sample(&self) -> f64 {
        (self.rays - self.shadow_rays) / self.samples - 1.0
    }

    /// Shadow rays for one sample.
    pub fn shadow_rays_a_sample(&self) -> f64 {
        self.shadow_rays / self.samples
    }
}

/// What a contender did.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub estimator: String,
    pub backend: Backend,
    /// Seconds from the scene to the first samples, the first time of all: shaders are compiled, unless the driver has kept them.
    pub first_ready_seconds: f64,
    /// The same later, round by round.
    pub ready_seconds: Rounds,
    /// In ascending order of the samples.
    pub rungs: Vec<Rung>,
    /// Samples that were not finite.
    pub dropped: u64,
}

impl Trial {
    pub fn new(estimator: &str, backend: Backend) -> Self {
        Trial {
            estimator: estimator.into(),
            backend,
            first_ready_seconds: f64::NAN,
            ready_seconds: Rounds::default(),
            rungs: Vec::new(),
            dropped: 0,
        }
    }

    /// As charts and tables call it.
    pub fn name(&self) -> String {
        format!("{} on {}", self.estimator, self.backend)
    }

    /// The exponent of relMSE over samples, fitted to the measured points; none for fewer than three.
    pub fn exponent(&self) -> Option<f64> {
        let law = PowerLaw::fit(self.rungs.iter().map(|r| (f64::from(r.spp), r.relmse.estimate().mean)))?;
        law.error.map(|_| law.exponent)
    }

    /// Adds a round: the tracer is built anew with the scene's seed, used once, and then renders with more and more samples. The first round
    /// goes on while a longer render seems to fit into the seconds that are left; the others do the same renders.
    pub fn round(&mut self, bench: &Workbench, scene: &Scene, reference: &Reference, budget: f64) -> Result<()> {
        let start = Instant::now();
        let mut tracer = bench.tracer(scene, self.backend)?;
        warm_up(tracer.as_mut(), scene)?;
        self.ready_seconds.0.push(start.elapsed().as_secs_f64());
        let first = self.ready_seconds.0.len() == 1;
        let own_error = reference.own_error.unwrap_or(0.0);
        let (mut left, mut spp) = (budget, 1);
        for rung in 0.. {
            if !first && rung == self.rungs.len() {
                break;
            }
            let rendered = render_samples(tracer.as_mut(), scene, spp)?;
            let seconds = rendered.progress.seconds;
            if first {
                self.rungs.push(Rung::new(spp));
            }
            let n = self.ready_seconds.0.len() as f64;
            let here = &mut self.rungs[rung];
            here.seconds.0.push(seconds);
            here.device_seconds.0.push(rendered.device_seconds);
            here.relmse.0.push(metrics::compare(&picture(&rendered), &reference.picture, 0)?.relmse - own_error);
            here.counts.add(&rendered.progress, n);
            self.dropped += rendered.dropped;
            left -= seconds;
            let fits = f64::from(STEP) * seconds <= left && spp < MOST_SAMPLES;
            if first && !fits && rung + 1 >= LEAST_RUNGS {
                break;
            }
            spp *= STEP;
        }
        Ok(())
    }
}
