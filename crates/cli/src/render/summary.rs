//! The text on stdout after a render: its files, the estimated error, times and speed.

use super::outcome::Outcome;
use crate::shared::error_line::error_line;
use crate::shared::units::duration;
use luminaire::film::{Film, relative_in_words};
use luminaire::render::End;
use std::path::PathBuf;

/// The summary; `written` are the pictures that were written.
pub fn summary(outcome: &Outcome, written: &[PathBuf]) -> String {
    let Outcome { options, rendered, seconds, .. } = outcome;
    let progress = &rendered.progress;
    let film = &rendered.film;
    let spp = samples_of(film, progress.spp());
    let ended = match rendered.end {
        End::Time => ", ended by --time",
        End::Noise => ", ended by --noise",
        End::NoEstimate => ", ended by --noise without an estimate",
        End::Samples | End::Stopped | End::Failed(_) => "",
    };
    let mut text = String::new();
    for path in written {
        text += &format!("{}: {} x {} pixels, {spp} samples a pixel{ended}\n", path.display(), film.width, film.height);
    }
    if let Some(path) = options.error_map.as_ref().filter(|_| film.most_samples() > 1) {
        let unknown = if progress.error.is_some() { "" } else { "; here no pixel's is known: green" };
        text += &format!(
            "{}: estimated relative error of every pixel, 0.1 % (black) to 100 % (white){unknown}\n",
            path.display()
        );
    }
    if let Some(path) = &options.stats {
        text += &format!("{}: the figures of this run\n", path.display());
    }
    if progress.samples > 0 {
        text += &error_line(film, progress.error, outcome.foreseen.lacks_light);
    }
    if let (Some(limit), false) = (progress.limits.noise, matches!(rendered.end, End::Noise)) {
        // What is promised goes by more than the estimate.
        let careful = progress.error.filter(|error| error.relative() <= limit);
        let why = careful.map_or(String::new(), |error| {
            format!(
                ": to be promised, the error would have to be surer ({} to be on the safe side)",
                relative_in_words(error.careful())
            )
        });
        text += &format!("--noise {limit} was not reached{why}\n");
    }
    if options.adaptive && rendered.shares.is_none() && matches!(rendered.end, End::Noise) {
        text +=
            "--adaptive: every pixel got as many samples, because other numbers of them would not have saved enough\n";
    }
    text += &format!(
        "load {}, build {}, render {}; {:.2} Mrays/s, {:.3} million samples/s\n",
        duration(seconds.load),
        duration(seconds.build),
        duration(seconds.render),
        progress.mrays_per_second(),
        progress.samples as f64 / progress.seconds.max(1e-9) * 1e-6
    );
    text
}

/// The samples a pixel: one number, or, where pixels have different ones, the least, the most and the mean.
pub fn samples_of(film: &Film, mean: f64) -> String {
    let (least, most) = (film.least_samples(), film.most_samples());
    if least == most { format!("{mean:.0}") } else { format!("{least} to {most}, in the mean {mean:.0},") }
}
