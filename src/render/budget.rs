//! How many samples a tracer takes in one batch, by how fast it is.

/// Samples (over all pixels) of the first batch: few, because each may be a path of ten thousand bounces.
const FIRST_BUDGET: u64 = 64;

/// How long a batch should take, and by which clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// As long as the tracer asks for, by the clock of its device where it has one.
    OfTracer,
    /// No longer than so many seconds of wall-clock time, nor than the tracer asks for: somebody waits for an answer.
    WithinSeconds(f64),
}

/// Samples (over all pixels) that the next batch of a tracer may hold, by the time that the last ones took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    samples: u64,
    pace: Pace,
}

impl Budget {
    /// For a tracer of unknown speed.
    pub fn new(pace: Pace) -> Self {
        Budget { samples: FIRST_BUDGET, pace }
    }

    /// Samples that a batch may hold, over all its pixels.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Learns from a batch of `samples` that took `wall_seconds`, and `device_seconds` by the device's own clock, of a tracer that asks for batches
    /// of `asked_seconds`.
    pub(super) fn adapt(&mut self, samples: u64, wall_seconds: f64, device_seconds: Option<f64>, asked_seconds: f64) {
        let (seconds, target) = match self.pace {
            Pace::OfTracer => (device_seconds.unwrap_or(wall_seconds), asked_seconds),
            Pace::WithinSeconds(longest) => (wall_seconds, longest.min(asked_seconds)),
        };
        self.samples = next_budget(self.samples, samples, seconds, target);
    }
}

/// How many samples the next batch may hold, after one of `samples` took `seconds`: less at once if that was longer than `target`, else at
/// most four times as many. A small batch (the rest of a pass) that took little says nothing against the present budget.
fn next_budget(budget: u64, samples: u64, seconds: f64, target: f64) -> u64 {
    let fitting = samples as f64 * target / seconds.max(1e-9);
    if seconds > target {
        (fitting as u64).clamp(1, budget)
    } else {
        budget.max(fitting.min(4.0 * samples as f64) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_grows_slowly_and_shrinks_at_once() {
        // A device that turns out slow: 0.01 s a sample against a target of 0.1 s.
        assert_eq!(next_budget(4096, 4096, 40.96, 0.1), 10);
        assert_eq!(next_budget(10, 10, 0.1, 0.1), 10);
        assert_eq!(next_budget(1000, 100, 0.01, 0.1), 1000);
        assert_eq!(next_budget(1, 1, 100.0, 0.1), 1);
    }

    #[test]
    fn the_pace_says_which_clock_counts_and_which_time() {
        let adapted = |pace, device_seconds, asked_seconds| {
            let mut budget = Budget { samples: 1000, pace };
            budget.adapt(1000, 0.2, device_seconds, asked_seconds);
            budget.samples()
        };
        assert_eq!(adapted(Pace::OfTracer, Some(0.1), 0.05), 500);
        assert_eq!(adapted(Pace::OfTracer, None, 0.05), 250);
        assert_eq!(adapted(Pace::OfTracer, None, 0.3), 1500);
        assert_eq!(adapted(Pace::WithinSeconds(0.05), Some(0.1), 0.3), 250);
        assert_eq!(adapted(Pace::WithinSeconds(0.05), Some(0.01), 0.02), 100);
    }
}
