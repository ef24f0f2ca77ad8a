//! The steps after tracing, in their order: warn, have the files written, print the summary, choose the exit code.

use super::outcome::Outcome;
use super::{outputs, summary};
use crate::shared::exit_codes::{DEVICE_FAILED, INTERRUPTED};
use crate::shared::interrupts;
use crate::shared::printing::{self, Notes, print};
use luminaire::Result;
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
    warn_of_losses(rendered, outcome.scene, notes);
    warn_of_black_pixels(rendered, written, notes);

    let done = interrupts::hold_off(|| outputs::write(&mut outcome, written));
    let saved = outcome.saved.take();
    let kept = matches!(saved, Some(Ok(())));
    let again = if outcome.options.resume { "the same command" } else { "the same command with --resume" };
    if done.is_err() && kept {
        notes.note(&format!("the samples are in the checkpoint; {again} writes the pictures again"));
    }
    done?;
    saved.transpose()?;
    if !notes.quiet {
        print(&summary::summary(&outcome, written))?;
    }
    match outcome.rendered.end {
        End::Samples | End::Time | End::Noise => Ok(ExitCode::SUCCESS),
        End::Stopped => {
            notes.note(if outcome.rendered.progress.samples == 0 {
                "interrupted before the first sample; no picture is written"
            } else if written.is_empty() {
                "interrupted; the part is not finished and not written"
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

/// Warns of samples that are left out, and prints how one of them can be replayed.
fn warn_of_losses(rendered: &Rendered, scene: &Scene, notes: Notes) {
    if rendered.dropped == 0 {
        return;
    }
    let replay = rendered.dropped_samples.first().map_or(
        "; the driver ended the kernel before its time: use another driver, or --backend cpu".into(),
        |first| {
            let (x, y) = (first.pixel % scene.film.width, first.pixel / scene.film.width);
            format!("; with the same options, --pixel {x},{y} --sample {} replays one", first.sample)
        },
    );
    notes.warn(format_args!("{} samples that were not finite, or lost, are left out{replay}", rendered.dropped));
}

/// Warns of pixels without a sample in the pictures that are written.
fn warn_of_black_pixels(rendered: &Rendered, written: &[PathBuf], notes: Notes) {
    let black = rendered.film.samples.iter().filter(|samples| **samples == 0).count();
    if black > 0 && !written.is_empty() {
        notes.warn(format_args!("{black} pixels have no sample and are black: the render ended during the first pass"));
    }
}
