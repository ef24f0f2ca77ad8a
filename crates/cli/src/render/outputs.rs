//! The files of a render except for its checkpoint: their names are checked before it, and they are written after it.

use super::options::Options;
use super::outcome::Outcome;
use super::stats::Stats;
use crate::shared::outputs::Outputs;
use crate::shared::printing::warn;
use luminaire::film::{Demand, HDR_HAS_NO_ALPHA};
use luminaire::part::Provenance;
use luminaire::scene::FilmSettings;
use luminaire::{Error, Result, files, part, picture};
use luminaire_measure::heat_map;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Whether a file is EXR by its name.
pub fn is_exr(path: &Path) -> bool {
    matches!(picture::Format::of(path), Ok(picture::Format::Exr))
}

/// Refuses `--samples` and `--aov` where no output is an EXR file, the only format that holds a part or layers, and `--transparent` where one has no alpha.
pub fn check_layers(options: &Options) -> Result<()> {
    if options.samples.is_some() && options.pixel.is_none() && !options.output.iter().any(|path| is_exr(path)) {
        return Err(Error::Usage(
            "--samples renders a part, which only an EXR file holds: say which with -o PART.exr".into(),
        ));
    }
    if options.aov && !options.output.iter().any(|path| is_exr(path)) {
        return Err(Error::Usage("--aov adds layers, which only an EXR file holds: name one with -o FILE.exr".into()));
    }
    let hdr = |path: &&PathBuf| matches!(picture::Format::of(path), Ok(picture::Format::Hdr));
    if options.transparent
        && let Some(path) = options.output.iter().find(hdr)
    {
        return Err(Error::Usage(format!("--transparent -o {}: {HDR_HAS_NO_ALPHA}", path.display())));
    }
    Ok(())
}

/// The pictures to write, declared. A usage error if one of them is named twice.
pub fn pictures(options: &Options, outputs: &mut Outputs) -> Result<Vec<PathBuf>> {
    for path in &options.output {
        picture::Format::of(path)?;
        outputs.add("-o", path)?;
    }
    if !options.output.is_empty() {
        return Ok(options.output.clone());
    }
    let stem = options.scene.file_stem().ok_or_else(|| Error::read(&options.scene, "it is not a file"))?;
    let mut name = stem.to_owned();
    name.push(".png");
    outputs.add_default("-o", name.as_ref())?;
    Ok(vec![name.into()])
}

/// Declares the other files. A usage error where one is of a wrong kind or named already.
pub fn declare_others(options: &Options, outputs: &mut Outputs) -> Result<()> {
    #[cfg(feature = "denoise")]
    if let Some(path) = &options.denoised {
        picture::Format::of(path)?;
        outputs.add("--denoised", path)?;
    }
    if let Some(path) = &options.error_map {
        check_error_map(options, options.spp, "")?;
        if picture::Format::of(path)? != picture::Format::Png {
            return Err(Error::Usage(format!("--error-map {}: the name must end in .png", path.display())));
        }
        outputs.add("--error-map", path)?;
    }
    if let Some(path) = &options.stats {
        if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("json")) {
            return Err(Error::Usage(format!("--stats {}: the name must end in .json", path.display())));
        }
        outputs.add("--stats", path)?;
    }
    Ok(())
}

/// Refuses `--error-map` where all that is rendered is one sample a pixel: `spp`, which is from `whence`, or that of `--samples`.
pub fn check_error_map(options: &Options, spp: Option<u32>, whence: &str) -> Result<()> {
    if options.error_map.is_none() {
        return Ok(());
    }
    let why = "one sample tells nothing of its error";
    if options.samples.as_ref().is_some_and(|samples| samples.len() == 1) {
        return Err(Error::Usage(format!("--error-map wants at least two samples in --samples A..B: {why}")));
    }
    if options.samples.is_none() && spp == Some(1) {
        return Err(Error::Usage(format!("--error-map wants at least --spp 2{whence}: {why}")));
    }
    Ok(())
}

/// What the film and its files take of this machine's memory.
pub fn demand(options: &Options, film: &FilmSettings) -> Demand {
    let exr = options.output.iter().any(|path| is_exr(path));
    let crop = options.crop_of((film.width, film.height));
    let (width, height) = crop.map_or((film.width, film.height), |crop| (crop.width, crop.height));
    Demand {
        width,
        height,
        sums: options.checkpoint.is_some() || options.samples.is_some(),
        exr,
        aovs: options.wants_aovs(),
        errors: options.error_map.is_some(),
        alpha: options.transparent,
    }
}

/// Writes the pictures, and then the figures of `--stats`.
pub fn write(outcome: &mut Outcome, pictures: &[PathBuf]) -> Result<()> {
    let start = Instant::now();
    write_pictures(outcome, pictures)?;
    if let Some(path) = &outcome.options.error_map
        && outcome.rendered.film.most_samples() < 2
    {
        let missing =
            format!("{}: not written: no pixel has two samples, and one tells nothing of its error", path.display());
        if !outcome.options.quiet {
            warn(&missing);
        }
        outcome.warnings.push(missing);
    }
    outcome.seconds.write = start.elapsed().as_secs_f64();
    if let Some(path) = &outcome.options.stats {
        save_stats(path, &Stats::new(outcome, pictures))?;
    }
    Ok(())
}

/// Writes the pictures of a frame, each with the mark of its format.
pub fn write_frame(outcome: &Outcome, pictures: &[PathBuf], mark: impl Fn(picture::Format) -> String) -> Result<()> {
    for path in pictures {
        let aovs = outcome.aovs.as_ref().filter(|_| outcome.options.aov);
        let mark = mark(picture::Format::of(path)?);
        outcome.rendered.film.save_marked(path, outcome.foreseen.development, aovs, &mark)?;
    }
    Ok(())
}

/// Saves the figures of a run as JSON.
pub fn save_stats(path: &Path, figures: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(figures).map_err(|e| Error::write(path, e))?;
    files::save_text(path, &(text + "\n"))
}

/// Writes the pictures, the error map and the denoised picture.
fn write_pictures(outcome: &Outcome, pictures: &[PathBuf]) -> Result<()> {
    let Outcome { options, scene, rendered, .. } = outcome;
    let development = outcome.foreseen.development;
    let provenance = options.samples.as_ref().map(|_| Provenance::of(scene).cropped(rendered.film.crop));
    let save = |path: &PathBuf| match (&provenance, &outcome.aovs, picture::Format::of(path)?) {
        (Some(provenance), _, picture::Format::Exr) => part::save(path, rendered, provenance),
        (_, Some(aovs), picture::Format::Exr) if options.aov => rendered.film.save_with_aovs(path, aovs),
        _ => rendered.film.save(path, development),
    };
    // All are tried before an error is returned: if one cannot be written, the others still are.
    let saved: Vec<_> = pictures.iter().map(save).collect();
    saved.into_iter().collect::<Result<()>>()?;
    let (width, height) = (rendered.film.width, rendered.film.height);
    if let (Some(path), Some(errors)) = (&options.error_map, rendered.film.error_map()) {
        let [low, high] = heat_map::RELATIVE_ERRORS;
        picture::save_png(path, &heat_map::heat_map(width, height, &errors.relative, low, high))?;
    }
    #[cfg(feature = "denoise")]
    if let (Some(path), Some(aovs)) = (&options.denoised, &outcome.aovs) {
        let picture = luminaire::denoise::denoise(&rendered.film, aovs)?;
        picture::save_linear(path, width, height, &picture, development)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Args, FromArgMatches};

    #[test]
    fn the_default_output_is_named_after_the_scene() {
        let command = Options::augment_args(clap::Command::new("render"));
        let matches = command.try_get_matches_from(["render", "a/b.scene.toml"]).unwrap();
        let options = Options::from_arg_matches(&matches).unwrap();
        assert_eq!(pictures(&options, &mut Outputs::default()).unwrap(), [PathBuf::from("b.scene.png")]);
    }
}
