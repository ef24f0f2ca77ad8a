//! `luminaire compare`.

mod flip;
mod tables;

use self::flip::Flip;
use self::tables::{Source, describe, number};
use crate::shared::outputs::Outputs;
use crate::shared::printing::{self, print, warn};
use crate::shared::values::{limit, stops};
use luminaire::files;
use luminaire::picture::{self, Picture, free_memory};
use luminaire::{Error, Result};
use luminaire_measure::heat_map::{RELATIVE_ERRORS, heat_map};
use luminaire_measure::metrics::{self, Comparison, NonFinite};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire compare cornell.exr reference.exr
      how far they are apart: RMSE, relMSE, bias, FLIP, and the worst pixels
  luminaire compare cornell.exr reference.exr --heatmap error.png
      and a picture of where
  luminaire compare cornell.exr reference.exr --max-relmse 0.01 --max-bias 0.005 && echo good enough
      as a test: relMSE at most 0.01, and no channel's mean off by more than 0.5 %

Exit codes:
  0  compared; every limit that was given is kept
  1  a limit is exceeded, pixels of IMAGE are not finite, or a file cannot be read or written
  2  wrong usage: an option, or pictures of different sizes";

/// What to compare, and within which limits.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// The picture: EXR, PFM, HDR, PNG and most others.
    image: PathBuf,
    /// What is right, or held to be.
    reference: PathBuf,

    /// Fail above this root-mean-square error, in units of the pictures.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    max_rmse: Option<f64>,
    /// Fail above this relMSE, the mean of (a - b)^2 / (b^2 + (m/3)^2), m the half-power mean of b, the reference: it does not depend on the unit of
    /// the pictures.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    max_relmse: Option<f64>,
    /// Fail if the mean of a channel is off by more than this part of the reference's; 0.01 is 1 %.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    max_bias: Option<f64>,
    /// Fail above this mean FLIP, from 0 (they look the same) to 1.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    max_flip: Option<f64>,

    /// Take FLIP as the pictures look in a PNG of this exposure [default: over all exposures that show something; 0 if a picture holds
    /// whole numbers].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops)]
    exposure: Option<f32>,
    /// How many of the worst pixels to list.
    #[arg(long, value_name = "N", default_value_t = 5, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(..=100_000), help_heading = "Output")]
    worst: u32,
    /// Write a picture of the relative error of every pixel, with its scale.
    #[arg(long, value_name = "FILE.png", help_heading = "Output")]
    heatmap: Option<PathBuf>,
    /// Write the figures to a JSON file.
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    stats: Option<PathBuf>,
}

/// Reads, compares, writes and judges.
pub fn run(options: &Options) -> Result<ExitCode> {
    let mut outputs = Outputs::default();
    declare(&mut outputs, "--heatmap", options.heatmap.as_deref(), "png")?;
    declare(&mut outputs, "--stats", options.stats.as_deref(), "json")?;
    outputs.check([("one of the pictures", &*options.image), ("one of the pictures", &*options.reference)])?;
    let image = picture::read(&options.image)?;
    let reference = picture::read(&options.reference)?;
    for (path, picture) in [(&options.image, &image), (&options.reference, &reference)] {
        picture.warnings.iter().for_each(|warning| warn(format!("{}: {warning}", path.display())));
    }
    let comparison = metrics::compare(&image, &reference, options.worst as usize)?;
    let flip = match Flip::fits((image.width, image.height), free_memory()) {
        _ if comparison.pixels == 0 => None,
        Ok(()) => Some(Flip::new(&image, &reference, options.exposure)),
        // A limit that is asked for is not left out.
        Err(error) if options.max_flip.is_some() => return Err(error),
        Err(error) => {
            warn(format_args!("{error}; it is left out"));
            None
        }
    };
    let failures = failures(options, &comparison, flip.as_ref());
    warn_of_pitfalls(options, &image, &reference, &comparison);

    print(&describe(
        Source { path: &options.image, picture: &image },
        Source { path: &options.reference, picture: &reference },
        &comparison,
        flip.as_ref(),
    ))?;
    if let Some(path) = &options.heatmap {
        let [low, high] = RELATIVE_ERRORS;
        let errors = metrics::relative_errors(&image, &reference);
        picture::save_png(path, &heat_map(image.width, image.height, &errors, low, high))?;
        print(&format!("{}: relative error of every pixel, from 0.1 % (black) to 100 % (white)\n", path.display()))?;
    }
    if let Some(path) = &options.stats {
        let stats = Stats {
            version: env!("CARGO_PKG_VERSION"),
            image: options.image.display().to_string(),
            reference: options.reference.display().to_string(),
            width: image.width,
            height: image.height,
            comparison: &comparison,
            flip: flip.as_ref(),
            failures: &failures,
        };
        let text = serde_json::to_string_pretty(&stats).map_err(|e| Error::write(path, e))?;
        files::save_text(path, &(text + "\n"))?;
        print(&format!("{}: the figures of this comparison\n", path.display()))?;
    }
    failures.iter().for_each(printing::error);
    Ok(if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What `--stats` writes; numbers that are not finite become null.
#[derive(Serialize)]
struct Stats<'a> {
    version: &'static str,
    image: String,
    reference: String,
    width: u32,
    height: u32,
    #[serde(flatten)]
    comparison: &'a Comparison,
    flip: Option<&'a Flip>,
    /// What is printed as errors; empty if all is well.
    failures: &'a [String],
}

/// What makes the comparison fail, in words.
fn failures(options: &Options, comparison: &Comparison, flip: Option<&Flip>) -> Vec<String> {
    let mut failures = Vec::new();
    if comparison.image_non_finite.count > 0 {
        failures.push(format!("{}: {}", options.image.display(), non_finite(comparison.image_non_finite)));
    }
    if comparison.pixels == 0 {
        failures.push("no pixel is finite in both pictures: there is nothing to compare".into());
        return failures;
    }
    let mut check = |name: &str, value: f64, option: &str, limit: Option<f64>| {
        let Some(limit) = limit.filter(|limit| value > *limit) else { return };
        let factor = if limit > 0.0 { format!(", {} times that", number(value / limit)) } else { String::new() };
        failures.push(format!("{name} is {}, more than {option} {limit}{factor}", number(value)));
    };
    check("RMSE", comparison.rmse, "--max-rmse", options.max_rmse);
    check("relMSE", comparison.relmse, "--max-relmse", options.max_relmse);
    for (channel, bias) in ["red", "green", "blue"].iter().zip(comparison.bias) {
        check(&format!("the bias of {channel}"), bias.ratio.abs(), "--max-bias", options.max_bias);
    }
    check("FLIP", flip.map_or(0.0, |flip| flip.mean), "--max-flip", options.max_flip);
    failures
}

/// Warns where the measures may mislead.
fn warn_of_pitfalls(options: &Options, image: &Picture, reference: &Picture, comparison: &Comparison) {
    if comparison.reference_non_finite.count > 0 {
        let odd = non_finite(comparison.reference_non_finite);
        warn(format_args!("{}: {odd}; they are left out", options.reference.display()));
    }
    if comparison.pixels > 0 && comparison.half_power_mean == 0.0 {
        warn(format_args!(
            "{} is black: there is no light that an error could be relative to",
            options.reference.display()
        ));
    }
    if image.clamped != reference.clamped {
        let clamped = if image.clamped { &options.image } else { &options.reference };
        warn(format_args!(
            "{} holds whole numbers, which end at white: what is brighter in the other picture counts as a difference",
            clamped.display()
        ));
    }
}

fn non_finite(odd: NonFinite) -> String {
    let (x, y) = odd.first.unwrap_or_default();
    match odd.count {
        1 => format!("1 pixel is NaN or infinite, at {x} {y}"),
        count => format!("{count} pixels are NaN or infinite, the first at {x} {y}"),
    }
}

/// Declares a file to write. A usage error if it has another ending.
fn declare(outputs: &mut Outputs, option: &str, path: Option<&Path>, ending: &str) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    if path.extension().is_none_or(|found| !found.eq_ignore_ascii_case(ending)) {
        return Err(Error::Usage(format!("{option} {}: the name must end in .{ending}", path.display())));
    }
    outputs.add(option, path)
}
