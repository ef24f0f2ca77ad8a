//! The steps after tracing, in their order: warn, have the files written, print the summary, choose the exit code.

use super::outcome::Outcome;
use super::{outputs, summary};
use crate::shared::error_line;
use crate::shared::exit_codes::{DEVICE_FAILED, INTERRUPTED};
use crate::shared::interrupts;
use crate::shared::printing::{self, Notes, print};
use luminaire::Result;
use luminaire::picture::Format;
use luminaire::reference::path::LONGEST_PATH;
use luminaire::render::{End, Rendered};
use luminaire::scene::Scene;
use std::path::PathBuf;
use std::process::ExitCode;

/// Writes the files, prints the summary and how the render ended, and returns the exit code. Fails if a file cannot be written, or the checkpoint
/// could not be.
pub fn finish(mut outcome: Outcome, pictures: &[PathBuf], notes: Notes) -> Result<ExitCode> {
    let rendered = &outcome.rendered;
    let unfinished_part = outcome.options.samples.is_some() && !matches!(rendered.end, End::Samples);
    // An unfinished part is not written where the checkpoint holds it: somebody might take the file for the whole part.
    let nothing = rendered.progress.samples == 0 || unfinished_part && outcome.saved.is_some();
    let written = if nothing { &[] } else { pictures };
    outcome.warnings = warnings(&outcome, written);
    outcome.warnings.iter().for_each(|warning| notes.warn(warning));

    let done = interrupts::hold_off(|| outputs::write(&mut outcome, written));
    let saved = outcome.saved.take();
    let kept = matches!(saved, Some(Ok(())));
    let again = if outcome.options.resume { "the same command" } else { "the same command with --resume" };
    if done.is_err() && kept {
        notes.note(&format!("the samples are in the checkpoint; {again} writes the pictures again"));
    }
    let failures: Vec<_> = [done.err(), saved.and_then(Result::err)].into_iter().flatten().collect();
    if let (End::Failed(lost), false) = (&outcome.rendered.end, failures.is_empty()) {
        // Neither may hide the other.
        printing::error(lost);
        failures.iter().for_each(printing::error);
        return Ok(ExitCode::from(DEVICE_FAILED));
    }
    if let Some(failure) = failures.into_iter().next() {
        return Err(failure);
    }
    if !notes.quiet {
        print(&summary::summary(&outcome, written))?;
    }
    match outcome.rendered.end {
        End::Samples | End::Time | End::Noise | End::NoEstimate => Ok(ExitCode::SUCCESS),
        End::Stopped => {
            notes.note(if outcome.rendered.progress.samples == 0 {
                "interrupted before the first sample; no picture is written"
            } else if written.is_empty() {
                "interrupted; the part is not finished and not written"
            } else if outcome.options.wants_aovs() {
                "interrupted; the picture holds what was done until then, without layers and not denoised"
            } else {
                "interrupted; the picture holds what was done until then"
            });
            if kept {
                notes.note(&format!("{again} goes on from the checkpoint"));
            }
            Ok(ExitCode::from(INTERRUPTED))
        }
        End::Failed(error) => {
            printing::error(error);
            if !written.is_empty() {
                notes.note("the render failed; the picture holds what was done until then");
            }
            if kept {
                notes.note(&format!("{again} goes on from the checkpoint, also on another --device or --backend"));
            }
            Ok(ExitCode::from(DEVICE_FAILED))
        }
    }
}

/// What there is to warn of a picture that is written to these files.
pub fn warnings(outcome: &Outcome, written: &[PathBuf]) -> Vec<String> {
    let rendered = &outcome.rendered;
    let all = [
        losses(rendered, outcome.scene),
        pixels_without_samples(rendered, written),
        black(outcome, written),
        reached_without_fireflies(rendered),
    ];
    all.into_iter().flatten().collect()
}

/// Samples that are left out, and how one of them can be replayed.
fn losses(rendered: &Rendered, scene: &Scene) -> Option<String> {
    if rendered.dropped == 0 {
        return None;
    }
    let replay = rendered.dropped_samples.first().map_or(
        "; the driver ended the kernel before its time: use another driver, or --backend cpu".into(),
        |first| {
            let (x, y) = (first.pixel % scene.film.width, first.pixel / scene.film.width);
            format!(
                "; with the same options but those that name files, --pixel {x},{y} --sample {} replays one",
                first.sample
            )
        },
    );
    Some(format!(
        "{} samples are left out: not finite, or lost (light that nothing absorbs: a path ends after {LONGEST_PATH} bounces){replay}",
        rendered.dropped
    ))
}

/// Pixels without a sample in the pictures that are written.
fn pixels_without_samples(rendered: &Rendered, written: &[PathBuf]) -> Option<String> {
    let missing = rendered.film.samples.iter().filter(|samples| **samples == 0).count();
    (missing > 0 && !written.is_empty())
        .then(|| format!("{missing} pixels have no sample and are black: the render ended during the first pass"))
}

/// A picture that is black, or that a PNG of it would show so.
fn black(outcome: &Outcome, written: &[PathBuf]) -> Option<String> {
    let Outcome { rendered, scene, .. } = outcome;
    let dark = outcome.foreseen.lacks_light || scene.dark_because().is_some();
    let is_png = |path: &PathBuf| matches!(Format::of(path), Ok(Format::Png));
    error_line::black_picture(&rendered.film, dark).or_else(|| {
        let shown = written.iter().any(is_png);
        shown.then(|| error_line::black_when_developed(&rendered.film, outcome.foreseen.development)).flatten()
    })
}

/// A limit of the noise that was reached without the fireflies alone.
fn reached_without_fireflies(rendered: &Rendered) -> Option<String> {
    let End::Noise = rendered.end else { return None };
    error_line::noise_with_fireflies(rendered.progress.limits.noise?, rendered.progress.error?)
}
