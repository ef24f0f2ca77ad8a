//! One contender on one scene and backend: its renders, round by round.

use super::contenders::Contender;
use super::power_law::PowerLaw;
use super::spread;
use crate::{Workbench, metrics};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::picture::Picture;
use luminaire::render::{End, Limits, Rendered, Tracer, render};
use luminaire::scene::Scene;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Every render takes so many times the samples of the one before.
pub(super) const STEP: u32 = 4;
/// Samples of the last render, however much time is left.
const MOST_SAMPLES: u32 = 1 << 18;
/// There are at least so many renders, however slow they are.
const LEAST_RUNGS: usize = 3;

/// The renders at one number of samples, a value a round.
#[derive(Debug, Clone)]
pub(super) struct Rung {
    /// Samples a pixel.
    pub spp: u32,
    /// Wall-clock seconds.
    pub seconds: Vec<f64>,
    /// Seconds that the device was busy by its own clock; 0 where it has none.
    pub device_seconds: Vec<f64>,
    /// relMSE against the reference, less the reference's own.
    pub relmse: Vec<f64>,
    /// Samples, rays and shadow rays of a round, in the mean.
    pub counts: [f64; 3],
}

impl Rung {
    /// Mean over the rounds and its standard error; NaN where there is one round.
    pub fn error(&self) -> (f64, f64) {
        let estimate = crate::statistics::Estimate::new(self.relmse.iter().copied());
        (estimate.mean, estimate.error)
    }

    /// Median of the seconds.
    pub fn median_seconds(&self) -> f64 {
        spread(&self.seconds)[0]
    }

    /// A quantity by the second in every round.
    pub fn rates(&self, count: f64) -> Vec<f64> {
        self.seconds.iter().map(|seconds| count / seconds).collect()
    }

    /// relMSE times seconds in every round.
    pub fn costs(&self) -> Vec<f64> {
        self.relmse.iter().zip(&self.seconds).map(|(error, seconds)| error * seconds).collect()
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
    pub ready_seconds: Vec<f64>,
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
            ready_seconds: Vec::new(),
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
        let law = PowerLaw::fit(self.rungs.iter().map(|r| (f64::from(r.spp), r.error().0)))?;
        law.error.map(|_| law.exponent)
    }

    /// Adds a round: the tracer is built anew with the scene's seed, used once, and then renders with more and more samples. The first round
    /// goes on while a longer render seems to fit into the seconds that are left; the others do the same renders.
    pub fn round(
        &mut self,
        bench: &Workbench,
        scene: &Scene,
        (reference, own_error): (&Picture, f64),
        budget: f64,
    ) -> Result<()> {
        let start = Instant::now();
        let mut tracer = bench.tracer(scene, self.backend)?;
        warm_up(tracer.as_mut(), scene)?;
        self.ready_seconds.push(start.elapsed().as_secs_f64());
        let first = self.ready_seconds.len() == 1;
        let (mut left, mut spp) = (budget, 1);
        for rung in 0.. {
            if !first && rung == self.rungs.len() {
                break;
            }
            let rendered = render_samples(tracer.as_mut(), scene, spp)?;
            let seconds = rendered.progress.seconds;
            if first {
                self.rungs.push(Rung {
                    spp,
                    seconds: vec![],
                    device_seconds: vec![],
                    relmse: vec![],
                    counts: [0.0; 3],
                });
            }
            let n = self.ready_seconds.len() as f64;
            let here = &mut self.rungs[rung];
            here.seconds.push(seconds);
            here.device_seconds.push(rendered.device_seconds);
            here.relmse.push(metrics::compare(&picture(&rendered), reference, 0)?.relmse - own_error);
            let p = &rendered.progress;
            for (mean, count) in here.counts.iter_mut().zip([p.samples, p.rays, p.shadow_rays]) {
                *mean += (count as f64 - *mean) / n;
            }
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

/// The first samples of a tracer, which may compile shaders.
fn warm_up(tracer: &mut dyn Tracer, scene: &Scene) -> Result<()> {
    let tile = Tile { x: 0, y: 0, width: scene.film.width.min(8), height: scene.film.height.min(8) };
    tracer.trace(&Batch { tile, samples: 0..4, group: 1 }).map(drop)
}

/// How long a tracer of a scene takes to be ready, and what it takes. In this order: seconds of building, those from the scene to the first samples, and the bytes of device memory that it takes (none for the CPU).
pub(super) fn ready(bench: &Workbench, scene: &Scene, backend: Backend) -> Result<(f64, f64, Option<u64>)> {
    let before = bench.allocated_bytes(backend);
    let start = Instant::now();
    let mut tracer = bench.tracer(scene, backend)?;
    let built = start.elapsed().as_secs_f64();
    let bytes = bench.allocated_bytes(backend).zip(before).map(|(now, before)| now.saturating_sub(before));
    warm_up(tracer.as_mut(), scene)?;
    Ok((built, start.elapsed().as_secs_f64(), bytes))
}

/// A whole render of so many samples a pixel.
fn render_samples(tracer: &mut dyn Tracer, scene: &Scene, spp: u32) -> Result<Rendered> {
    let limits = Limits { spp: Some(spp), ..Limits::default() };
    let size = (scene.film.width, scene.film.height);
    let rendered = render(tracer, size, limits, &mut |_| {}, &AtomicBool::new(false))?;
    match rendered.end {
        End::Failed(error) => Err(error),
        _ => Ok(rendered),
    }
}

fn picture(rendered: &Rendered) -> Picture {
    let film = &rendered.film;
    let rgb = (0..film.pixels()).map(|pixel| film.mean(pixel).map(|v| v as f32)).collect();
    Picture { width: film.width, height: film.height, rgb, error: None, clamped: false }
}

/// What the picture is held against.
pub(super) struct Reference {
    pub picture: Picture,
    /// Its own relMSE, as it is estimated; none where nothing tells.
    pub own_error: Option<f64>,
    /// Where it comes from.
    pub words: String,
}

impl Reference {
    /// A file's picture, whose error is known if it holds standard errors.
    pub fn given(picture: &Picture) -> Self {
        let own_error = picture.error.as_ref().and_then(|errors| {
            let pairs = errors.iter().zip(&picture.rgb).filter(|(e, b)| metrics::finite(e) && metrics::finite(b));
            let all: Vec<f64> = pairs
                .flat_map(|(e, b)| {
                    (0..3).map(|c| f64::from(e[c]).powi(2) / (f64::from(b[c]).powi(2) + luminaire::film::REL_MSE_FLOOR))
                })
                .collect();
            (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
        });
        Reference { picture: picture.clone(), own_error, words: "the picture that was given".into() }
    }

    /// Seconds of a short render, the least of three: what else the machine does can only make it slower.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn pace(bench: &Workbench, scene: &Scene, backend: Backend) -> Result<f64> {
        let mut tracer = bench.tracer(scene, backend)?;
        warm_up(tracer.as_mut(), scene)?;
        (0..3).try_fold(f64::INFINITY, |least, _| {
            Ok(least.min(render_samples(tracer.as_mut(), scene, 4)?.progress.seconds))
        })
    }

    /// Renders a scene in about so many seconds: a power of two of samples, so that a run on the same machine mostly gets the same.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn rendered(
        bench: &Workbench,
        scene: &Scene,
        contender: &Contender,
        backend: Backend,
        seconds: f64,
    ) -> Result<Self> {
        let mut tracer = bench.tracer(scene, backend)?;
        warm_up(tracer.as_mut(), scene)?;
        let mut spp = 4;
        let mut rendered = render_samples(tracer.as_mut(), scene, spp)?;
        // Short renders are slower by the sample: the pace is looked at again.
        while rendered.progress.seconds < 0.5 * seconds {
            let more = (seconds / rendered.progress.seconds.max(1e-9)).clamp(2.0, 16.0).log2().floor().exp2() as u32;
            spp = spp.saturating_mul(more).min(1 << 22);
            rendered = render_samples(tracer.as_mut(), scene, spp)?;
            if spp == 1 << 22 {
                break;
            }
        }
        let own_error = rendered.film.error().map(|error| error.rel_mse);
        let words = format!("{spp} samples a pixel of `{}` on {backend}, with another seed", contender.name);
        Ok(Reference { picture: picture(&rendered), own_error, words })
    }
}
