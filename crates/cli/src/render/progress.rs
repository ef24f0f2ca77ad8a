//! How far a render is: a bar on a terminal, plain lines elsewhere.

use crate::shared::printing::note;
use crate::shared::units::duration;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use luminaire::render::Progress;
use std::io::IsTerminal;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Seconds between two plain lines.
const LINE_SECONDS: f64 = 10.0;

/// Shows progress on stderr.
pub enum Reporter {
    /// Nothing.
    Quiet,
    /// A bar.
    Bar(ProgressBar),
    /// Plain lines; the next one is due at this many seconds.
    Lines(f64),
}

impl Reporter {
    /// A bar on a terminal, lines elsewhere, nothing if `quiet`.
    pub fn new(quiet: bool) -> Self {
        if quiet {
            return Reporter::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            return Reporter::Lines(LINE_SECONDS);
        }
        let style = ProgressStyle::with_template("{bar:32} {percent:>3}%  {msg}").expect("a valid template");
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
        Reporter::Bar(bar.with_style(style))
    }

    /// Shows `progress`; as lines, only when the next one is due.
    pub fn update(&mut self, progress: &Progress) {
        match self {
            Reporter::Quiet => {}
            Reporter::Bar(bar) => {
                bar.set_message(describe(progress));
                bar.set_position((progress.fraction() * STEPS as f64) as u64);
            }
            Reporter::Lines(due) => {
                if progress.seconds >= *due {
                    *due = progress.seconds + LINE_SECONDS;
                    note(&format!("{:>3.0}%  {}", progress.fraction() * 100.0, describe(progress)));
                }
            }
        }
    }

    /// Removes the bar.
    pub fn finish(&mut self) {
        if let Reporter::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// Samples, speed and the time left.
fn describe(progress: &Progress) -> String {
    let of = progress.limits.spp.map_or(String::new(), |spp| format!(" of {spp}"));
    let left = progress.seconds_left().map_or(String::new(), |seconds| format!(", {} left", duration(seconds)));
    let error = progress.error.map_or(String::new(), |error| format!(", error {}", error.in_words()));
    format!("{:.1}{of} samples a pixel, {:.2} Mrays/s{error}{left}", progress.spp(), progress.mrays_per_second())
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::film::ErrorEstimate;
    use luminaire::render::Limits;

    #[test]
    fn lines_say_how_far_how_fast_and_how_good() {
        let limits = Limits { spp: Some(64), seconds: None, noise: None };
        let progress =
            Progress { samples: 1600, pixels: 100, rays: 6_000_000, seconds: 2.0, limits, ..Progress::default() };
        assert_eq!(describe(&progress), "16.0 of 64 samples a pixel, 3.00 Mrays/s, 6.00 s left");
        let error =
            ErrorEstimate { rmse: 0.1, rel_mse: 0.0625, fireflies: 0, unknown: 0, rel_mse_with_fireflies: 0.0625 };
        let limits = Limits { noise: Some(0.125), ..limits };
        let with_error = Progress { limits, error: Some(error), ..progress };
        assert_eq!(describe(&with_error), "16.0 of 64 samples a pixel, 3.00 Mrays/s, error 25 %, 6.00 s left");
        let fireflies = Some(ErrorEstimate { fireflies: 1, rel_mse_with_fireflies: 0.25, ..error });
        let said = describe(&Progress { error: fireflies, ..with_error });
        assert!(said.contains(", error 25 % (50 % with fireflies), "), "{said}");
    }
}
