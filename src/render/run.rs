//! A render at work, a batch at a time.

use super::budget::Budget;
use super::patches::Patches;
use super::rendered::{Rendered, at_a_look, samples_of};
use super::schedule::Schedule;
use super::tracer::Tracer;
use crate::Result;
use crate::film::Batch;
use std::time::Instant;

/// Seconds between two estimates of the error that nothing depends on, ...
const ESTIMATE_SECONDS: f64 = 1.0;
/// ... and how many times as long as an estimate takes, so that it costs next to nothing.
const ESTIMATE_SHARE: f64 = 20.0;

/// One run of a render: what was rendered, and which batch comes next.
#[derive(Debug)]
pub struct Run {
    rendered: Rendered,
    /// The number of the sample before which to end.
    end: u32,
    schedule: Schedule,
    /// In place of the schedule where tiles have different shares.
    patches: Patches,
    /// The seconds of the progress at which the error is estimated again.
    next_estimate: f64,
}

impl Run {
    /// Goes on from `rendered` until every pixel has all samples before number `end`; where tiles have different shares, until the next ones would be more than that in
    /// the mean. Which batches are left follows from what the film holds.
    pub fn new(rendered: Rendered, end: u32) -> Self {
        let schedule = Schedule::of(&rendered.film, end);
        let next_estimate = rendered.progress.seconds + ESTIMATE_SECONDS;
        Run { rendered, end, schedule, patches: Patches::new(), next_estimate }
    }

    /// Whether every pixel has the samples it was to get.
    pub fn is_done(&self) -> bool {
        match &self.rendered.shares {
            None => self.schedule.is_done(),
            Some(shares) => shares.mean_samples(self.rendered.noise_aim) > f64::from(self.end),
        }
    }

    /// Traces one batch of at most `budget`, adds it and the time that it took, and adapts the budget. Does nothing if all is done.
    ///
    /// # Errors
    /// If the tracer fails; nothing was added then, and the next step begins with the same pixels again.
    pub fn step<T: Tracer + ?Sized>(&mut self, tracer: &mut T, budget: &mut Budget) -> Result<()> {
        let Some(batch) = self.next(budget.samples(), tracer.max_sums()) else { return Ok(()) };
        let start = Instant::now();
        let traced = match tracer.trace(&batch) {
            Ok(traced) => traced,
            Err(error) => {
                // What is left follows from the film, which has nothing of this batch.
                self.schedule = Schedule::of(&self.rendered.film, self.end);
                return Err(error);
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        budget.adapt(samples_of(&batch), seconds, traced.device_seconds, tracer.batch_seconds());
        self.rendered.add(&batch, &traced);
        self.rendered.progress.seconds += seconds;
        Ok(())
    }

    /// The next batch.
    fn next(&mut self, budget: u64, max_sums: usize) -> Option<Batch> {
        if self.is_done() {
            return None;
        }
        if self.rendered.shares.is_some() && self.is_at_noise_aim() {
            // Nobody looks at the noise any more.
            self.rendered.noise_aim = at_a_look(self.rendered.noise_aim.saturating_add(1));
            self.aim_at_noise();
            return self.next(budget, max_sums);
        }
        let Rendered { film, noise_aim, shares, .. } = &self.rendered;
        match shares {
            None => self.schedule.next(budget, max_sums),
            Some(shares) => self.patches.next(film, shares, *noise_aim, budget, max_sums),
        }
    }

    /// Whether it is time to estimate the error again where nothing depends on it: only so often that it costs next to nothing.
    pub fn estimate_is_due(&self) -> bool {
        self.rendered.progress.seconds >= self.next_estimate
    }

    /// Estimates the error for the progress.
    pub fn estimate(&mut self) {
        let start = Instant::now();
        self.rendered.progress.error = self.rendered.film.error();
        let pause = ESTIMATE_SECONDS.max(ESTIMATE_SHARE * start.elapsed().as_secs_f64());
        self.next_estimate = self.rendered.progress.seconds + pause;
    }

    /// What was rendered so far. Its seconds are those that tracing took.
    pub fn rendered(&self) -> &Rendered {
        &self.rendered
    }

    /// Ends the run.
    pub fn into_rendered(self) -> Rendered {
        self.rendered
    }

    /// For a loop that counts the time by another clock.
    pub(super) fn set_seconds(&mut self, seconds: f64) {
        self.rendered.progress.seconds = seconds;
    }

    /// Whether all pixels have equally many samples, or their share.
    pub(super) fn is_between_passes(&mut self) -> bool {
        match self.rendered.shares {
            None => self.schedule.pass_done().is_some(),
            Some(_) => self.is_at_noise_aim(),
        }
    }

    /// Whether all pixels have as many samples as a limit of the noise wants to be looked at with, or their share of it.
    pub(super) fn is_at_noise_aim(&mut self) -> bool {
        let Rendered { film, noise_aim, shares, .. } = &self.rendered;
        match shares {
            None => self.schedule.pass_done() == Some(*noise_aim),
            Some(shares) => self.patches.find(film, shares, *noise_aim).is_none(),
        }
    }

    /// Lets the next passes end where a limit of the noise is looked at next.
    pub(super) fn aim_at_noise(&mut self) {
        self.schedule.aim(self.rendered.noise_aim);
        self.patches = Patches::new();
        let shares = self.rendered.shares.as_ref();
        self.rendered.progress.shared_aim = shares.map(|shares| shares.mean_samples(self.rendered.noise_aim));
    }

    /// Estimates the error and says whether it is below `limit`; if not, passes then end where to look again. Only where
    /// [`Run::is_at_noise_aim`].
    pub(super) fn is_quiet_enough(&mut self, limit: f64) -> bool {
        let quiet = self.rendered.quiet_enough(limit, self.rendered.progress.limits.adaptive);
        self.aim_at_noise();
        quiet
    }
}
