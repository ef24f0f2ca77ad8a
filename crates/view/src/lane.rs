//! A tracer at work for the window: coarse while the camera moves, finer at rest, and then better and better.

use luminaire::Result;
use luminaire::film::{ErrorEstimate, Film};
use luminaire::render::{FIRST_BUDGET, SceneTracer, Schedule, next_budget};
use luminaire::sampling::PARTS;
use luminaire::scene::{FilmSettings, Sensor};
use std::time::Instant;

/// Seconds that one batch should take: the window answers no later than that.
const BATCH_SECONDS: f64 = 0.05;
/// The coarsest pixels, in pixels of the window.
const COARSEST: u32 = 8;
/// A finer picture is gone to at once if its first pass takes no more seconds than this.
const SOON: f64 = 0.5;
/// Seconds between two estimates of the error.
const ESTIMATE_SECONDS: f64 = 1.0;

/// What is traced: a camera and a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    /// The camera.
    pub sensor: Sensor,
    /// The film: as large as the window.
    pub film: FilmSettings,
}

/// What a tracer has done so far, and how fast it is.
pub struct Lane {
    /// None before the first sight.
    work: Option<Work>,
    /// Samples that one batch may hold.
    budget: u64,
}

/// What a tracer has done for one sight, at one resolution.
struct Work {
    sight: Sight,
    /// Pixels of the window in one of the film, across.
    coarseness: u32,
    film: Film,
    /// The coarser picture that came before, to be seen where the film has no sample yet.
    before: Option<Film>,
    schedule: Schedule,
    rays: u64,
    seconds: f64,
    error: Option<ErrorEstimate>,
    next_estimate: f64,
}

impl Lane {
    pub fn new() -> Self {
        Lane { work: None, budget: FIRST_BUDGET }
    }

    /// Forgets what was done, but not how fast it was.
    pub fn restart(&mut self) {
        self.work = None;
    }

    /// Lets a tracer that looked at something else meanwhile look at what the film shows.
    pub fn look(&self, tracer: &mut dyn SceneTracer) -> Result<()> {
        let Some(Work { sight, film, .. }) = &self.work else { return Ok(()) };
        tracer.look(&sight.sensor, &FilmSettings { width: film.width, height: film.height, ..sight.film })
    }

    /// Prepares for `sight`: at a resolution at which the first pass is quick, which is then finer and finer unless the camera is `moving`. A quick pass
    /// that has begun is ended first, or a camera that never rests would never show anything. True if there is a new film.
    pub fn aim(&mut self, tracer: &mut dyn SceneTracer, sight: &Sight, moving: bool, spp: u32) -> Result<bool> {
        let (coarseness, before) = match &self.work {
            Some(work) if work.before.is_none() && work.film.least_samples() == 0 => return Ok(false),
            Some(work) if work.sight == *sight && (moving || work.coarseness == 1) => return Ok(false),
            Some(work) if work.sight == *sight && work.film.least_samples() == 0 => return Ok(false),
            Some(work) if work.sight == *sight => {
                let coarseness = self.coarseness_within(SOON, sight).min(work.coarseness / 2);
                (coarseness, self.work.take().map(|work| work.film))
            }
            _ => (self.coarseness_within(BATCH_SECONDS, sight), None),
        };
        // Before its successor is made: films are large.
        self.work = None;
        let FilmSettings { width, height, .. } = sight.film;
        let (width, height) = (width.div_ceil(coarseness), height.div_ceil(coarseness));
        tracer.look(&sight.sensor, &FilmSettings { width, height, ..sight.film })?;
        let film = Film::new(width, height)?;
        self.work = Some(Work {
            sight: sight.clone(),
            coarseness,
            // One sample is enough where a finer picture follows.
            schedule: Schedule::of(&film, if coarseness == 1 { spp } else { 1 }),
            film,
            before,
            rays: 0,
            seconds: 0.0,
            error: None,
            next_estimate: ESTIMATE_SECONDS,
        });
        Ok(true)
    }

    /// The finest resolution at which the first pass takes no more than `seconds`: of one sample, or of the schedule's least number where others follow.
    fn coarseness_within(&self, seconds: f64, sight: &Sight) -> u32 {
        let samples = self.budget as f64 * seconds / BATCH_SECONDS;
        let pixels = |coarseness: u32| {
            let FilmSettings { width, height, .. } = sight.film;
            f64::from(width.div_ceil(coarseness)) * f64::from(height.div_ceil(coarseness))
        };
        let pass = |coarseness: u32| pixels(coarseness) * f64::from(if coarseness == 1 { PARTS } else { 1 });
        [1, 2, 4].into_iter().find(|coarseness| pass(*coarseness) <= samples).unwrap_or(COARSEST)
    }

    /// Traces one batch; false if there is nothing left to do.
    pub fn trace(&mut self, tracer: &mut dyn SceneTracer) -> Result<bool> {
        let Some(work) = &mut self.work else { return Ok(false) };
        let Some(batch) = work.schedule.next(self.budget, tracer.max_sums()) else { return Ok(false) };
        let start = Instant::now();
        let traced = tracer.trace(&batch)?;
        let seconds = start.elapsed().as_secs_f64();
        let samples = batch.tile.pixels() as u64 * u64::from(batch.samples.end - batch.samples.start);
        self.budget = next_budget(self.budget, samples, seconds, BATCH_SECONDS.min(tracer.batch_seconds()));
        work.film.add(&batch, &traced.sums);
        work.rays += traced.sums.iter().map(|sum| u64::from(sum.rays.all)).sum::<u64>();
        work.seconds += seconds;
        Ok(true)
    }

    /// Whether there is something to see, and whether it is the quick picture of a new sight.
    pub fn ready(&self) -> Option<bool> {
        let work = self.work.as_ref().filter(|work| work.before.is_some() || work.film.least_samples() > 0)?;
        Some(work.before.is_none() && work.film.most_samples() <= PARTS)
    }

    /// The film in the window's own resolution, once every pixel has a sample.
    pub fn film(&self) -> Option<&Film> {
        self.work.as_ref().filter(|work| work.coarseness == 1 && work.film.least_samples() > 0).map(|work| &work.film)
    }

    /// The film as it is, and the coarser one to see where it has no sample yet.
    pub fn films(&self) -> Option<(&Film, Option<&Film>)> {
        self.work.as_ref().map(|work| (&work.film, work.before.as_ref()))
    }

    /// Samples a pixel, millions of rays a second, and the relative error, which is estimated again where that is due.
    pub fn figures(&mut self) -> (f64, f64, Option<f64>) {
        let Some(work) = &mut self.work else { return (0.0, 0.0, None) };
        if work.seconds >= work.next_estimate || work.error.is_none() && work.film.least_samples() >= 2 {
            let start = Instant::now();
            work.error = work.film.error();
            work.next_estimate = work.seconds + ESTIMATE_SECONDS.max(20.0 * start.elapsed().as_secs_f64());
        }
        let samples: u64 = work.film.samples.iter().copied().map(u64::from).sum();
        let mrays = if work.seconds > 0.0 { work.rays as f64 / work.seconds * 1e-6 } else { 0.0 };
        (samples as f64 / work.film.samples.len() as f64, mrays, work.error.map(|error| error.relative()))
    }
}
