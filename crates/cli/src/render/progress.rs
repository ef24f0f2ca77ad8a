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
pub struct Reporter {
    shown: Shown,
    /// The frames of a sequence; none for one picture.
    frames: Option<Frames>,
}

/// How progress is shown.
enum Shown {
    /// Not at all.
    Quiet,
    /// As a bar.
    Bar(ProgressBar),
    /// As plain lines; the next one is due at this many seconds.
    Lines(f64),
}

/// Which frame of a sequence is rendered.
#[derive(Debug, Clone, Copy, Default)]
struct Frames {
    /// Frames that this run has rendered.
    done: usize,
    /// Frames that it will have rendered in the end.
    all: usize,
    /// Seconds that those which are done took.
    seconds: f64,
}

impl Reporter {
    /// A bar on a terminal, lines elsewhere, nothing if `quiet`.
    pub fn new(quiet: bool) -> Self {
        let shown = if quiet {
            Shown::Quiet
        } else if std::io::stderr().is_terminal() {
            Shown::Bar(bar())
        } else {
            Shown::Lines(LINE_SECONDS)
        };
        Reporter { shown, frames: None }
    }

    /// The same for a sequence of so many frames.
    pub fn of_frames(quiet: bool, all: usize) -> Self {
        Reporter { frames: Some(Frames { all, ..Frames::default() }), ..Reporter::new(quiet) }
    }

    /// Shows `progress`; as lines, only when the next one is due.
    pub fn update(&mut self, progress: &Progress) {
        let part = self.frames.map_or(progress.fraction(), |frames| frames.fraction(progress));
        let text = || match &self.frames {
            None => describe(progress, progress.seconds_left()),
            Some(frames) => {
                let what = describe(progress, frames.seconds_left(progress));
                format!("frame {} of {}: {what}", frames.done + 1, frames.all)
            }
        };
        match &mut self.shown {
            Shown::Quiet => {}
            Shown::Bar(bar) => {
                bar.set_message(text());
                bar.set_position((part * STEPS as f64) as u64);
            }
            Shown::Lines(due) => {
                let seconds = progress.seconds + self.frames.map_or(0.0, |frames| frames.seconds);
                if seconds >= *due {
                    *due = seconds + LINE_SECONDS;
                    note(&format!("{:>3.0}%  {}", part * 100.0, text()));
                }
            }
        }
    }

    /// Removes the bar.
    pub fn finish(&mut self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }

    /// Goes on to the next frame of a sequence, after one that took so many seconds.
    pub fn next_frame(&mut self, seconds: f64) {
        if let Some(frames) = &mut self.frames {
            frames.done += 1;
            frames.seconds += seconds;
        }
        if let Shown::Bar(old) = &mut self.shown {
            *old = bar();
        }
    }
}

impl Frames {
    /// The part of all frames that is done.
    fn fraction(&self, progress: &Progress) -> f64 {
        (self.done as f64 + progress.fraction()) / self.all.max(1) as f64
    }

    /// Seconds left for all frames at the present pace.
    fn seconds_left(&self, progress: &Progress) -> Option<f64> {
        let fraction = self.fraction(progress);
        (fraction > 0.0).then(|| (self.seconds + progress.seconds) * (1.0 - fraction) / fraction)
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:32} {percent:>3}%  {msg}").expect("a valid template");
    ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr()).with_style(style)
}

/// Samples, speed and the time left.
fn describe(progress: &Progress, seconds_left: Option<f64>) -> String {
    let of = progress.limits.spp.map_or(String::new(), |spp| format!(" of {spp}"));
    let left = seconds_left.map_or(String::new(), |seconds| format!(", {} left", duration(seconds)));
    let error = progress.error.map_or(String::new(), |error| format!(", error {}", error.in_words()));
    format!("{:.1}{of} samples a pixel, {:.2} Mrays/s{error}{left}", progress.spp(), progress.mrays_per_second())
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::film::ErrorEstimate;
    use luminaire::render::Limits;

    #[test]
    fn a_sequence_has_the_time_of_all_its_frames_left() {
        let limits = Limits { spp: Some(64), ..Limits::default() };
        let half = Progress { samples: 3200, pixels: 100, seconds: 1.0, limits, ..Progress::default() };
        let mut reporter = Reporter::of_frames(true, 4);
        assert_eq!(reporter.frames.unwrap().seconds_left(&half), Some(7.0));
        reporter.next_frame(2.0);
        reporter.next_frame(4.0);
        let frames = reporter.frames.unwrap();
        assert_eq!((frames.done, frames.fraction(&half)), (2, 0.625));
        assert!((frames.seconds_left(&half).unwrap() - 7.0 * 0.6).abs() < 1e-12);
    }

    #[test]
    fn lines_say_how_far_how_fast_and_how_good() {
        let limits = Limits { spp: Some(64), ..Limits::default() };
        let progress =
            Progress { samples: 1600, pixels: 100, rays: 6_000_000, seconds: 2.0, limits, ..Progress::default() };
        assert_eq!(
            describe(&progress, progress.seconds_left()),
            "16.0 of 64 samples a pixel, 3.00 Mrays/s, 6.00 s left"
        );
        let error = ErrorEstimate {
            rmse: 0.1,
            rel_mse: 0.0625,
            careful_rel_mse: 0.0625,
            fireflies: 0,
            unknown: 0,
            rel_mse_with_fireflies: 0.0625,
        };
        let limits = Limits { noise: Some(0.125), ..limits };
        let with_error = Progress { limits, error: Some(error), ..progress };
        assert_eq!(
            describe(&with_error, with_error.seconds_left()),
            "16.0 of 64 samples a pixel, 3.00 Mrays/s, error 25 %, 6.00 s left"
        );
        let fireflies = Some(ErrorEstimate { fireflies: 1, rel_mse_with_fireflies: 0.25, ..error });
        let said = describe(&Progress { error: fireflies, ..with_error }, with_error.seconds_left());
        assert!(said.contains(", error 25 % (50 % with fireflies), "), "{said}");
    }
}
