//! One film that is traced for the window: coarse while the camera moves, finer when it rests, then with more and more samples.

use super::sight::Sight;
use luminaire::Result;
use luminaire::film::Film;
use luminaire::film::GROUPS_IN_TURN;
use luminaire::render::{Budget, Pace, Progress, Rendered, Run, SceneTracer};
use luminaire::scene::FilmSettings;

/// The seconds that one batch should take: for so long the worker does not look at what the window wants.
const BATCH_SECONDS: f64 = 0.05;
/// The widest pixel of a film, in pixels of the window.
const COARSEST: u32 = 8;
/// The next finer film is as fine as it can be with a first pass of no more seconds than this, and at least twice as fine as the last.
const SOON: f64 = 0.5;

/// What a tracer has done so far, and how fast it is.
pub struct Lane {
    /// None before the first sight.
    work: Option<Work>,
    /// How many samples fit into a batch; kept from sight to sight.
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
    /// Nothing is traced yet.
    pub fn new() -> Self {
        Lane { work: None, budget: Budget::new(Pace::WithinSeconds(BATCH_SECONDS)) }
    }

    /// Forgets what was done, but not how fast it was.
    pub fn restart(&mut self) {
        self.work = None;
    }

    /// Points a tracer, which another lane may have used meanwhile, at what this film shows.
    pub fn look(&self, tracer: &mut dyn SceneTracer) -> Result<()> {
        let Some(work) = &self.work else { return Ok(()) };
        let Film { width, height, .. } = *work.film();
        tracer.look(&work.sight.sensor, &FilmSettings { width, height, ..work.sight.film })
    }

    /// Begins a new film if `sight` needs one; true if it did. A new sight begins at a resolution at which the first pass is quick; while the camera is
    /// not `moving`, each film that has a sample everywhere is followed by a finer one. A first quick pass is always finished, for otherwise a
    /// camera that never rests would never show anything.
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
        // Films are large: the old one goes before the new one is made.
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

    /// The coarseness of the finest film whose first pass takes no more than `seconds`. A pass is one sample a pixel in a coarse film, [`GROUPS_IN_TURN`] in the
    /// window's own resolution.
    fn coarseness_within(&self, seconds: f64, sight: &Sight) -> u32 {
        let samples = self.budget.samples() as f64 * seconds / BATCH_SECONDS;
        let pixels = |coarseness: u32| {
            let FilmSettings { width, height, .. } = sight.film;
            f64::from(width.div_ceil(coarseness)) * f64::from(height.div_ceil(coarseness))
        };
        let pass = |coarseness: u32| pixels(coarseness) * f64::from(if coarseness == 1 { GROUPS_IN_TURN } else { 1 });
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
            Some(work) if work.film().most_samples() <= GROUPS_IN_TURN => Stage::Quick,
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
