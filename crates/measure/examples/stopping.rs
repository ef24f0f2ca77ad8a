//! Whether the promise of `--noise` is kept: the true error at the moment at which renders end.
//!
//! usage: cargo run --release --example stopping -- [--adaptive] [--width PIXELS] [--seeds N] SCENE...
//!
//! Three limits a scene, 20 seeds each unless it is said; pictures 32 pixels wide. Takes minutes a scene. *Kept* is the part of the renders whose true relative error at the end, without
//! fireflies, is at most 1.1 times the limit; *samples* are those at the end over those of an oracle, which ends where the true error is first below the limit.

use luminaire::backend::Backend;
use luminaire::scene;
use luminaire_measure::Workbench;
use luminaire_measure::report::markdown;
use luminaire_measure::stopping::{Stop, stops};
use std::error::Error;
use std::path::Path;

/// The limits are the errors of so many samples a pixel.
const AT: [u32; 3] = [48, 160, 448];
/// Samples of the truth.
const TRUTH: u32 = 8192;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut adaptive, mut width, mut seeds, mut paths) = (false, 32, 20, vec![]);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|n| n.parse().ok()).ok_or(format!("{argument} wants a number"));
        match argument.as_str() {
            "--adaptive" => adaptive = true,
            "--width" => width = number()?,
            "--seeds" => seeds = number()?,
            _ => paths.push(argument),
        }
    }
    let bench = Workbench::new(false)?;
    let backend = if bench.backends().contains(&Backend::ComputeBvh) { Backend::ComputeBvh } else { Backend::Cpu };
    print!(
        "{}",
        markdown::head(&["scene", "limit", "kept", "error / limit: mean, most", "samples", "over an oracle's"])
    );
    let (mut kept, mut all, mut over) = (0, 0, vec![]);
    for path in &paths {
        let mut scene = scene::load(Path::new(path))?;
        scene.film = scene.film.at_width(width);
        let name = Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for stops in stops(&|scene| bench.tracer(scene, backend), &scene, &AT, seeds, TRUTH, adaptive)? {
            let mean = |of: &dyn Fn(&Stop) -> f64| stops.iter().map(of).sum::<f64>() / stops.len() as f64;
            let here = stops.iter().filter(|stop| stop.error <= 1.1 * stop.limit).count();
            let most = stops.iter().map(|stop| stop.error / stop.limit).fold(0.0, f64::max);
            over.push(mean(&|stop| stop.samples) / mean(&|stop| stop.oracle));
            (kept, all) = (kept + here, all + stops.len());
            let cells = [
                name.clone(),
                format!("{:.1} %", 100.0 * stops[0].limit),
                format!("{here} of {}", stops.len()),
                format!("{:.2}, {most:.2}", mean(&|stop| stop.error / stop.limit)),
                format!("{:.0}", mean(&|stop| stop.samples)),
                format!("{:.2}", over[over.len() - 1]),
            ];
            print!("{}", markdown::row(&cells));
        }
    }
    let mean = over.iter().sum::<f64>() / over.len().max(1) as f64;
    println!("\nKept in {kept} of {all} renders; {mean:.2} times the samples of an oracle, in the mean of the rows.");
    Ok(())
}
