//! `luminaire merge`.

use crate::shared::error_line::{black_picture, error_line};
use crate::shared::outputs::Outputs;
use crate::shared::printing::{print, warn};
use crate::shared::tone_name::{ToneName, stops_alone};
use luminaire::film::HDR_HAS_NO_ALPHA;
use luminaire::picture::Development;
use luminaire::{Error, Result, part, picture};
use std::path::PathBuf;
use std::process::ExitCode;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire merge part-*.exr -o picture.png -o picture.exr
      the picture of a render that was divided by --samples 0..64, 64..128, ...
  luminaire merge part-*.exr -o picture.png --exposure 0.5 --tone agx
      shown in another way than the parts say

The parts must be of the same scene, size, seed, estimator and version, and hold every sample from number 0 on once. The picture is the one of a single
render, but for rounding (1e-6 of each number at most). Where parts
want to be shown in different ways, that of the one with sample 0 counts.

Exit codes:
  0  merged
  1  a file cannot be read or written
  2  wrong usage: samples are missing or doubled, a part is not finished, or of another render";

/// What to join.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// Files of `luminaire render --samples`, in any order.
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,
    /// A file to write; .png, .exr or .hdr says the format. May be given several times.
    #[arg(short, long, required = true, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Exposure of a PNG in stops [default: that of the parts].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops_alone)]
    exposure: Option<f32>,
    /// Tone curve of a PNG [default: that of the parts].
    #[arg(long, value_name = "NAME")]
    tone: Option<ToneName>,
}

/// Joins parts of a render, and writes the picture.
pub fn run(options: &Options) -> Result<ExitCode> {
    let mut outputs = Outputs::default();
    for path in &options.output {
        picture::Format::of(path)?;
        outputs.add("-o", path)?;
    }
    outputs.check(options.parts.iter().map(|part| ("one of the parts", &**part)))?;
    let (whole, provenance, shown) = part::merge(&options.parts)?;
    if whole.film.missed.is_some()
        && let Some(path) =
            options.output.iter().find(|path| matches!(picture::Format::of(path), Ok(picture::Format::Hdr)))
    {
        return Err(Error::Usage(format!("{}: {HDR_HAS_NO_ALPHA}", path.display())));
    }
    let of_the_parts = provenance.development();
    let development = Development {
        exposure: options.exposure.unwrap_or(of_the_parts.exposure),
        tone: options.tone.map_or(of_the_parts.tone, ToneName::tone),
    };
    if let Some(disagreement) = disagreement(options, &shown) {
        warn(disagreement);
    }
    let mut text = String::new();
    for path in &options.output {
        whole.film.save(path, development)?;
        text += &format!(
            "{}: {} x {} pixels, {} samples a pixel from {} part{}\n",
            path.display(),
            whole.film.width,
            whole.film.height,
            whole.film.least_samples(),
            options.parts.len(),
            if options.parts.len() == 1 { "" } else { "s" }
        );
    }
    text += &error_line(&whole.film, whole.progress.error, false);
    if let Some(black) = black_picture(&whole.film, false) {
        warn(black);
    }
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Which parts want to be shown in different ways, as a sentence for a warning; none where they agree, an option decides, or no PNG is written.
fn disagreement(options: &Options, parts: &[part::Shown]) -> Option<String> {
    let png = |path: &PathBuf| matches!(picture::Format::of(path), Ok(picture::Format::Png));
    let ((first, counts), others) = parts.split_first()?;
    let differ = |other: &Development| {
        (options.exposure.is_none() && other.exposure != counts.exposure)
            || (options.tone.is_none() && other.tone != counts.tone)
    };
    let (other, wanted) = others.iter().find(|(_, other)| differ(other))?;
    options.output.iter().any(png).then(|| {
        let words = |how: &Development| format!("exposure {:+}, tone `{}`", how.exposure, how.tone.name());
        format!(
            "{} says {}, {} says {}: the first of them, which has sample 0, counts; --exposure and --tone choose",
            first.display(),
            words(counts),
            other.display(),
            words(wanted)
        )
    })
}
