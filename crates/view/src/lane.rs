//! A tracer at work for the window: coarse while the camera moves, finer at rest, and then better and better.

use super::sight::Sight;
use luminaire::Result;
use luminaire::film::Film;
use luminaire::render::{Budget, Pace, Progress, Rendered, Run, SceneTracer};
use luminaire::sampling::PARTS;
use luminaire::scene::FilmSettings;

/// Seconds that one batch should take: the window answers no later than that.
const BATCH_SECONDS: f64 = 0.05;
/// The coarsest pixels, in pixels of the window.
const COARSEST: u32 = 8;
/// A finer picture is gone to at once if its first pass takes no more seconds than this.
const SOON: f64 = 0.5;

/// What a tracer has done so far, and how fast it is.
pub struct Lane {
    /// None before the first sight.
    work: Option<Work>,
    /// It goes on from sight to sight.
    budget: Budget,
}

/// What a tracer has done for one sight, at one resolution.
struct Work {
    sight: Sight,
    /// Pixels of the window in one of the film, across.
    coarseness: u32,
    run: Run,
    /// The coarser picture that came before, to be seen where the film has no sample yet.
    before: Option<Film>,
}

impl Work {
    fn film(&self) -> &Film {
        &self.run.rendered().film
    }
}

/// How far a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// There is nothing to see yet.
    Nothing,
    /// The first quick picture of a new sight.
    Quick,
    /// It gets finer, or better.
    Better,
}

impl Lane {
    /// Of a tracer that has done nothing yet.
    pub fn new() -> Self {
        Lane { work: None, budget: Budget::new(Pace::WithinSeconds(BATCH_SECONDS)) }
    }

    /// Forgets what was done, but not how fast it was.
    pub fn restart(&mut self) {
        self.work = None;
    }

    /// Lets a tracer that looked at something else meanwhile look at what the film shows.
    pub fn look(&self, tracer: &mut dyn SceneTracer) -> Result<()> {
        let Some(work) = &self.work else { return Ok(()) };
        let Film { width, height, .. } = *work.film();
        tracer.look(&work.sight.sensor, &FilmSettings { width, height, ..work.sight.film })
    }

    /// Prepares for `sight`: at a resolution at which the first pass is quick, which is then finer and finer unless the camera is `moving`. A quick pass
    /// that has begun is ended first, or a camera that never rests would never show anything. True if there is a new film.
    pub fn aim(&mut self, tracer: &mut dyn SceneTracer, sight: &Sight, moving: bool, spp: u32) -> Result<bool> {
        let (coarseness, before) = match &self.work {
            Some(work) if work.before.is_none() && work.film().least_samples() == 0 => return Ok(false),
            Some(work) if work.sight == *sight && (moving || work.coarseness == 1) => return Ok(false),
            Some(work) if work.sight == *sight && work.film().least_samples() == 0 => return Ok(false),
            Some(work) if work.sight == *sight => {
                let coarseness = self.coarseness_within(SOON, sight).min(work.coarseness / 2);
                (coarseness, self.work.take().map(|work| work.run.into_rendered().film))
            }
            _ => (self.coarseness_within(BATCH_SECONDS, sight), None),
        };
        // Before its successor is made: films are large.
        self.work = None;
        let FilmSettings { width, height, .. } = sight.film;
        let (width, height) = (width.div_ceil(coarseness), height.div_ceil(coarseness));
        tracer.look(&sight.sensor, &FilmSettings { width, height, ..sight.film })?;
        // One sample is enough where a finer picture follows.
        let end = if coarseness == 1 { spp } else { 1 };
        let run = Run::new(Rendered::nothing((width, height), 0)?, end);
        self.work = Some(Work { sight: sight.clone(), coarseness, run, before });
        Ok(true)
    }

    /// The finest resolution at which the first pass takes no more than `seconds`: of one sample, or of the schedule's least number where others follow.
    fn coarseness_within(&self, seconds: f64, sight: &Sight) -> u32 {
        let samples = self.budget.samples() as f64 * seconds / BATCH_SECONDS;
        let pixels = |coarseness: u32| {
            let FilmSettings { width, height, .. } = sight.film;
            f64::from(width.div_ceil(coarseness)) * f64::from(height.div_ceil(coarseness))
        };
        let pass = |coarseness: u32| pixels(coarseness) * f64::from(if coarseness == 1 { PARTS } else { 1 });
        [1, 2, 4].into_iter().find(|coarseness| pass(*coarseness) <= samples).unwrap_or(COARSEST)
    }

    /// Traces one batch; false if there is nothing left to do.
    pub fn trace(&mut self, tracer: &mut dyn SceneTracer) -> Result<bool> {
        let Some(Work { run, .. }) = self.work.as_mut().filter(|work| !work.run.is_done()) else { return Ok(false) };
        run.step(tracer, &mut self.budget)?;
        Ok(true)
    }

    /// How far the picture is.
    pub fn stage(&self) -> Stage {
        match &self.work {
            Some(work) if work.before.is_some() => Stage::Better,
            Some(work) if work.film().least_samples() == 0 => Stage::Nothing,
            Some(work) if work.film().most_samples() <= PARTS => Stage::Quick,
            Some(_) => Stage::Better,
            None => Stage::Nothing,
        }
    }

    /// The film in the window's own resolution, once every pixel has a sample.
    pub fn film(&self) -> Option<&Film> {
        self.work.as_ref().filter(|work| work.coarseness == 1).map(Work::film).filter(|film| film.least_samples() > 0)
    }

    /// The film as it is, and the coarser one to see where it has no sample yet.
    pub fn films(&self) -> Option<(&Film, Option<&Film>)> {
        self.work.as_ref().map(|work| (work.film(), work.before.as_ref()))
    }

    /// How far the film is; the error is estimated again where that is due.
    pub fn progress(&mut self) -> Option<Progress> {
        let run = &mut self.work.as_mut()?.run;
        let unknown = run.rendered().progress.error.is_none();
        if run.estimate_is_due() || unknown && run.rendered().film.least_samples() >= 2 {
            run.estimate();
        }
        Some(run.rendered().progress)
    }
}
