//! Whether the error bar is right: estimated against true errors, scene by scene.

use crate::tables::Folder;
use crate::{Effort, Texts};
use luminaire::backend::Backend;
use luminaire::scene;
use luminaire_measure::Workbench;
use luminaire_measure::calibration::{Calibration, calibrate};
use luminaire_measure::chart::{Axis, Chart, Point, Series};
use luminaire_measure::report::markdown;
use luminaire_measure::report::table::Table;
use std::error::Error;
use std::path::Path;

/// Scenes with every kind of light and surface; the last one is known to be too hard for so few samples.
const SCENES: [&str; 10] =
    ["cornell", "directions", "lamps", "textures", "environment", "mirror", "lens", "plates", "glass", "many-lights"];
const SAMPLES: [u32; 3] = [16, 64, 256];
const SEEDS: u32 = 20;
const WIDTH: u32 = 32;
/// Samples of the truth.
const TRUTH: u32 = 8192;
/// The ratio that is promised.
const PROMISE: std::ops::RangeInclusive<f64> = 0.8..=1.25;
/// The part of the values that is promised to have the truth in their 95 % interval.
const COVERED: std::ops::RangeInclusive<f64> = 0.92..=0.98;

/// Measures every scene on the fastest backend for it here; writes the chart and the table.
pub fn measure(
    bench: &Workbench,
    effort: Effort,
    images: &Path,
    tables: &Folder,
    texts: &mut Texts,
) -> Result<(), Box<dyn Error>> {
    let backend = if bench.backends().contains(&Backend::ComputeBvh) { Backend::ComputeBvh } else { Backend::Cpu };
    let (width, truth, seeds) =
        effort.of([(WIDTH / 2, TRUTH / 16, 2), (WIDTH, TRUTH, SEEDS), (2 * WIDTH, 4 * TRUTH, SEEDS)]);
    let mut table = Table::new([
        "scene",
        "samples",
        "true relative error",
        "estimated / true relMSE: mean",
        "least to most of the seeds",
        "in the 95 % interval",
        "fireflies",
        "relMSE with them / without",
    ]);
    let mut chart = Chart {
        name: "calibration".into(),
        title: format!("Estimated over true relMSE, {seeds} seeds each"),
        x: Axis::log("samples a pixel"),
        y: Axis::log("estimated / true"),
        series: vec![],
    };
    let (mut kept, mut covered, mut outside) = ([0; SAMPLES.len()], [0; SAMPLES.len()], String::new());
    for name in SCENES {
        eprintln!("calibration: {name}");
        let mut scene = scene::load(Path::new(&format!("scenes/{name}/{name}.toml")))?;
        scene.film = scene.film.at_width(width);
        let found = calibrate(&|scene| bench.tracer(scene, backend), &scene, &SAMPLES, seeds, truth)?;
        let mut points = vec![];
        for (index, c) in found.iter().enumerate() {
            let ratio = c.ratio();
            table.rows.push(row(name, c));
            points.push(Point { x: f64::from(c.spp), y: ratio.mean, error: Some(ratio.error) });
            let (is_kept, is_covered) = (PROMISE.contains(&ratio.mean), COVERED.contains(&c.covered));
            kept[index] += u32::from(is_kept);
            covered[index] += u32::from(is_covered);
            if !(is_kept && is_covered) {
                let bold = |text: String, fine: bool| if fine { text } else { format!("**{text}**") };
                outside += &markdown::row(&[
                    format!("`{name}`"),
                    c.spp.to_string(),
                    bold(format!("{:.2}", ratio.mean), is_kept),
                    bold(format!("{:.1} %", 100.0 * c.covered), is_covered),
                    format!("{:.2} %", 100.0 * c.fireflies),
                ]);
            }
        }
        chart.series.push(Series { name: name.into(), points });
    }
    std::fs::write(images.join("calibration.svg"), chart.svg())?;
    tables.save("calibration", &table)?;
    let total = SCENES.len();
    let columns = ["samples", "scenes whose ratio is within 0.8 to 1.25", "whose interval holds 92 to 98 %"];
    let summary = SAMPLES.iter().zip(kept).zip(covered);
    let summary = summary.map(|((samples, kept), covered)| {
        vec![samples.to_string(), format!("{kept} of {total}"), format!("{covered} of {total}")]
    });
    let summary = Table::new(columns).with_rows(summary).markdown();
    let count = |each: [u32; SAMPLES.len()]| format!("{} of {}", each.iter().sum::<u32>(), total * SAMPLES.len());
    texts.insert("calibration", summary);
    texts.insert("calibration-outside", outside);
    texts.insert("calibration-ratio", count(kept));
    texts.insert("calibration-covered", count(covered));
    texts.insert("calibration-backend", backend.to_string());
    texts.insert("calibration-width", width.to_string());
    texts.insert("calibration-seeds", seeds.to_string());
    texts.insert("calibration-truth", truth.to_string());
    Ok(())
}

fn row(name: &str, c: &Calibration) -> Vec<String> {
    let least = c.ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = c.ratios.iter().copied().fold(0.0, f64::max);
    vec![
        name.to_owned(),
        c.spp.to_string(),
        format!("{:.1} %", 100.0 * c.rel_mse.sqrt()),
        format!("{:.2}", c.ratio().mean),
        format!("{least:.2} to {most:.2}"),
        format!("{:.1} %", 100.0 * c.covered),
        format!("{:.2} %", 100.0 * c.fireflies),
        format!("{:.2}", c.with_fireflies),
    ]
}
