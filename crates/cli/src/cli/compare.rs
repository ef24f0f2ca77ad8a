//! `luminaire compare`.

use super::{CompareOptions, print, table, tell};
use luminaire::files;
use luminaire::picture::{self, Picture};
use luminaire::{Error, Result};
use luminaire_measure::flip;
use luminaire_measure::heat_map::{RELATIVE_ERRORS, heat_map};
use luminaire_measure::metrics::{self, Comparison, ErrorSource, NonFinite};
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;

/// Reads, compares, writes and judges.
pub fn run(options: &CompareOptions) -> Result<ExitCode> {
    check_output(options, "--heatmap", options.heatmap.as_deref(), "png")?;
    check_output(options, "--stats", options.stats.as_deref(), "json")?;
    let image = picture::read(&options.image)?;
    let reference = picture::read(&options.reference)?;
    let comparison = metrics::compare(&image, &reference, options.worst as usize)?;
    let flip = (comparison.pixels > 0).then(|| Flip::new(&image, &reference, options.exposure));
    let failures = failures(options, &comparison, flip.as_ref());
    warn(options, &image, &reference, &comparison);

    print(&describe(options, &image, &reference, &comparison, flip.as_ref()))?;
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
    failures.iter().for_each(|failure| tell(&format!("error: {failure}")));
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
    /// What is told as errors; empty if all is well.
    failures: &'a [String],
}

/// FLIP, and of what.
#[derive(Serialize)]
struct Flip {
    mean: f64,
    largest: f32,
    /// First and last exposure in stops.
    exposures: (f32, f32),
    /// How many exposures there were; 1 where the pictures were shown as PNGs are.
    count: u32,
}

impl Flip {
    fn new(image: &Picture, reference: &Picture, exposure: Option<f32>) -> Self {
        let (width, height) = (image.width as usize, image.height as usize);
        // What is not finite in one of them is black in both.
        let pixels = |picture: &Picture, scale: f32| -> Vec<[f32; 3]> {
            let pairs = image.rgb.iter().zip(&reference.rgb).zip(&picture.rgb);
            let known = |((a, b), pixel): ((&[f32; 3], &[f32; 3]), &[f32; 3])| {
                if metrics::finite(a) && metrics::finite(b) { pixel.map(|v| (v * scale).max(0.0)) } else { [0.0; 3] }
            };
            pairs.map(known).collect()
        };
        let (map, exposures, count) = if exposure.is_some() || image.clamped || reference.clamped {
            let exposure = exposure.unwrap_or(0.0);
            let shown = |picture: &Picture| pixels(picture, if picture.clamped { 1.0 } else { exposure.exp2() });
            let map = flip::low_dynamic_range(width, height, &shown(image), &shown(reference));
            (map, (exposure, exposure), 1)
        } else {
            let all = flip::high_dynamic_range(width, height, &pixels(image, 1.0), &pixels(reference, 1.0));
            (all.map, all.exposures, all.count)
        };
        Flip { mean: flip::mean(&map), largest: map.iter().copied().fold(0.0, f32::max), exposures, count }
    }
}

/// What makes the comparison fail, in words.
fn failures(options: &CompareOptions, comparison: &Comparison, flip: Option<&Flip>) -> Vec<String> {
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

/// Says what may mislead.
fn warn(options: &CompareOptions, image: &Picture, reference: &Picture, comparison: &Comparison) {
    if comparison.reference_non_finite.count > 0 {
        let odd = non_finite(comparison.reference_non_finite);
        tell(&format!("warning: {}: {odd}; they are left out", options.reference.display()));
    }
    if image.clamped != reference.clamped {
        let clamped = if image.clamped { &options.image } else { &options.reference };
        tell(&format!(
            "warning: {} holds whole numbers, which end at white: what is brighter in the other picture counts as a difference",
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

/// The tables.
fn describe(
    options: &CompareOptions,
    image: &Picture,
    reference: &Picture,
    comparison: &Comparison,
    flip: Option<&Flip>,
) -> String {
    let about = |name: &str, path: &Path, picture: &Picture| {
        let kind = if picture.clamped { "whole numbers, decoded as sRGB" } else { "floats" };
        let errors = if picture.error.is_some() { ", standard errors" } else { "" };
        let size = format!("{} x {} pixels, {kind}{errors}", picture.width, picture.height);
        vec![name.into(), path.display().to_string(), size]
    };
    let mut text =
        table(0, &[about("image", &options.image, image), about("reference", &options.reference, reference)]) + "\n";

    let expected = comparison.expected_rmse.map_or(String::new(), |expected| {
        format!("{} is expected of the standard errors of the pixels", number(expected))
    });
    let mut rows = vec![
        vec!["RMSE".into(), number(comparison.rmse), expected],
        vec!["relMSE".into(), number(comparison.relmse), "mean of (a - b)^2 / (b^2 + 0.01)".into()],
    ];
    let source = match comparison.error_source {
        ErrorSource::Pictures => "the standard errors in the files",
        ErrorSource::Spread => "how much the differences vary over the pixels",
    };
    for (i, (channel, bias)) in ["red", "green", "blue"].iter().zip(comparison.bias).enumerate() {
        let source = if i == 0 { format!(", from {source}") } else { String::new() };
        rows.push(vec![
            format!("bias {channel}"),
            format!("{:+.3}%", 100.0 * bias.ratio),
            format!("{} +- {}{source}", signed(bias.difference), number(bias.error)),
        ]);
    }
    if let Some(flip) = flip {
        let (start, stop) = flip.exposures;
        let how = match flip.count {
            1 => format!("as PNGs of exposure {start}"),
            count => format!("over {count} exposures from {start:+.1} to {stop:+.1} stops"),
        };
        rows.push(vec!["FLIP".into(), number(flip.mean), format!("{how}; largest {:.3}", flip.largest)]);
    }
    text += &table(0, &rows);

    if !comparison.worst.is_empty() {
        let three = |rgb: [f32; 3]| rgb.map(|v| number(f64::from(v))).join(" ");
        let mut rows = vec![["x y", "image", "reference", "part of relMSE"].map(String::from).to_vec()];
        rows.extend(comparison.worst.iter().map(|pixel| {
            let place = format!("{} {}", pixel.x, pixel.y);
            vec![place, three(pixel.image), three(pixel.reference), format!("{}%", number(100.0 * pixel.share))]
        }));
        text += &format!("\nworst pixels\n{}", table(2, &rows));
    }
    text
}

/// Four digits, with an exponent where there would be many zeros.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-4..1e6).contains(&size) => format!("{value:.3e}"),
        size => format!("{value:.*}", (3 - size.log10().floor() as i32).max(0) as usize),
    }
}

fn signed(value: f64) -> String {
    format!("{}{}", if value < 0.0 { "" } else { "+" }, number(value))
}

/// Refuses a file that cannot be written, has another ending, or is one of the pictures.
fn check_output(options: &CompareOptions, option: &str, path: Option<&Path>, ending: &str) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    if path.extension().is_none_or(|found| !found.eq_ignore_ascii_case(ending)) {
        return Err(Error::Usage(format!("{option} {}: the name must end in .{ending}", path.display())));
    }
    if path == options.image || path == options.reference {
        return Err(Error::Usage(format!("{option} {} would replace one of the pictures", path.display())));
    }
    files::check_writable(path)
}
