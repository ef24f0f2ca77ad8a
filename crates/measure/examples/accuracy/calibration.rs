//! Whether the error bar is right: estimated against true errors, scene by scene.

use crate::Texts;
use luminaire::backend::Backend;
use luminaire::scene;
use luminaire_measure::Workbench;
use luminaire_measure::calibration::{Calibration, calibrate};
use luminaire_measure::chart::{Axis, Chart, Point, Series};
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

/// Measures every scene on the fastest backend for it here.
pub fn measure(bench: &Workbench, images: &Path, texts: &mut Texts) -> Result<(), Box<dyn Error>> {
    let backend = if bench.backends().contains(&Backend::ComputeBvh) { Backend::ComputeBvh } else { Backend::Cpu };
    let (width, truth) = if bench.long { (2 * WIDTH, 4 * TRUTH) } else { (WIDTH, TRUTH) };
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
        title: format!("Estimated over true relMSE, {SEEDS} seeds each"),
        x: Axis::log("samples a pixel"),
        y: Axis::log("estimated / true"),
        series: vec![],
    };
    let (mut off, mut uncovered) = (vec![], vec![]);
    for name in SCENES {
        eprintln!("calibration: {name}");
        let mut scene = scene::load(Path::new(&format!("scenes/{name}/{name}.toml")))?;
        let film = &mut scene.film;
        film.height = (f64::from(width) * f64::from(film.height) / f64::from(film.width)).round().max(1.0) as u32;
        film.width = width;
        let found = calibrate(&|scene| bench.tracer(scene, backend), &scene, &SAMPLES, SEEDS, truth)?;
        let mut points = vec![];
        for c in &found {
            let ratio = c.ratio();
            table.rows.push(row(name, c));
            points.push(Point { x: f64::from(c.spp), y: ratio.mean, error: Some(ratio.error) });
            if !PROMISE.contains(&ratio.mean) {
                off.push(format!("`{name}` at {} ({:.2})", c.spp, ratio.mean));
            }
            if !COVERED.contains(&c.covered) {
                uncovered.push(format!("`{name}` at {} ({:.1} %)", c.spp, 100.0 * c.covered));
            }
        }
        chart.series.push(Series { name: name.into(), points });
    }
    std::fs::write(images.join("calibration.svg"), chart.svg())?;
    let outside = |what: &[String], total: usize| match what {
        [] => format!("all {total}"),
        what => format!("{} of {total}; outside: {}", total - what.len(), what.join(", ")),
    };
    let total = SCENES.len() * SAMPLES.len();
    texts.insert("calibration", table.markdown());
    texts.insert("calibration-ratio", outside(&off, total));
    texts.insert("calibration-covered", outside(&uncovered, total));
    texts.insert("calibration-backend", backend.to_string());
    texts.insert("calibration-width", width.to_string());
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
