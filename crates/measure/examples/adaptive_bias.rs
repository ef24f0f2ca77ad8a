//! Has `--adaptive` a bias? The mean of many adaptive renders against even ones of other seeds.
//!
//! usage: cargo run --release --example adaptive_bias -- [--width PIXELS] [--renders N] SCENE...
//!
//! 1000 renders a scene unless it is said, pictures 64 pixels wide, ended by the noise that 64 samples have. What is compared is one number a render: the mean over pixels and channels of what was found over what is
//! about right and a third of the half-power mean, so that dark and bright places say as much. The truth is 32 even renders of 4096 samples. z is the difference over its standard error.

use luminaire::backend::Backend;
use luminaire::film::{Brightness, Film};
use luminaire::render::{End, Limits, Rendered, resume};
use luminaire::scene::{self, Scene};
use luminaire_measure::Workbench;
use luminaire_measure::report::markdown;
use std::error::Error;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Even renders, and the samples of each.
const TRUTHS: u32 = 32;
const TRUTH: u32 = 4096;
/// Samples whose error is the limit.
const AT: u32 = 64;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut width, mut renders, mut paths) = (64, 1000, vec![]);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|n| n.parse().ok()).ok_or(format!("{argument} wants a number"));
        match argument.as_str() {
            "--width" => width = number()?,
            "--renders" => renders = number()?,
            _ => paths.push(argument),
        }
    }
    let bench = Workbench::new(false)?;
    let backend = if bench.backends().contains(&Backend::ComputeBvh) { Backend::ComputeBvh } else { Backend::Cpu };
    let render = |scene: &mut Scene, seed: u32, limits: Limits| -> Result<Rendered, Box<dyn Error>> {
        scene.settings.seed = seed;
        let nothing = Rendered::nothing((scene.film.width, scene.film.height), 0)?;
        let mut tracer = bench.tracer(scene, backend)?;
        let rendered = resume(tracer.as_mut(), nothing, limits, &mut |_| {}, &AtomicBool::new(false));
        match rendered.end {
            End::Failed(error) => Err(error.into()),
            _ => Ok(rendered),
        }
    };
    let samples = |spp: u32| Limits { spp: Some(spp), ..Limits::default() };
    print!("{}", markdown::head(&["scene", "renders", "with shares", "adaptive over even", "standard error", "z"]));
    for path in &paths {
        let mut scene = scene::load(Path::new(path))?;
        scene.film = scene.film.at_width(width);
        let about = render(&mut scene, 0, samples(TRUTH))?.film;
        let dark = Brightness::of((0..about.pixels()).flat_map(|pixel| about.mean(pixel))).half_power_mean() / 3.0;
        let number = |film: &Film| {
            let one = |pixel: usize, c: usize| film.mean(pixel)[c] / (about.mean(pixel)[c] + dark);
            (0..film.pixels()).flat_map(|pixel| [0, 1, 2].map(|c| one(pixel, c))).sum::<f64>()
                / (3 * film.pixels()) as f64
        };
        let even: Vec<f64> = (1..=TRUTHS)
            .map(|seed| Ok(number(&render(&mut scene, seed, samples(TRUTH))?.film)))
            .collect::<Result<_, Box<dyn Error>>>()?;
        let at = render(&mut scene, TRUTHS + 1, samples(AT))?.film;
        let noise = at.error().ok_or("no estimate of the error")?.relative();
        let limits = Limits { spp: Some(64 * AT), noise: Some(noise), adaptive: true, ..Limits::default() };
        let (mut found, mut shares) = (vec![], 0);
        for seed in 1000..1000 + renders {
            let rendered = render(&mut scene, seed, limits)?;
            shares += u32::from(rendered.shares.is_some());
            found.push(number(&rendered.film));
        }
        let ((mean, error), (expected, its_error)) = (mean_and_error(&found), mean_and_error(&even));
        let error = error.hypot(its_error) / expected;
        let cells = [
            Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            renders.to_string(),
            shares.to_string(),
            format!("{:.5}", mean / expected),
            format!("{error:.5}"),
            format!("{:+.2}", (mean / expected - 1.0) / error),
        ];
        print!("{}", markdown::row(&cells));
    }
    Ok(())
}

/// The mean, and its standard error.
fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}
