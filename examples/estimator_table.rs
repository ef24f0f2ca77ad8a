//! The table of `docs/accuracy.md`: what each stage of the lecture buys, as error times time.
//!
//! usage: cargo run --release --example estimator_table -- [--size PIXELS] [--only TEXT] SCENE...
//!
//! Every estimator renders the same small picture in turn, several times with other samples; the error is the mean of
//! `(a - b)^2 / (b^2 + 0.01)` over pixels and channels (relMSE), against a picture of 4096 samples by the default estimator. Error falls
//! as one over time, so that their product does not depend on the number of samples: half of it is twice as fast.

use luminaire::backend::{self, Backend, Request};
use luminaire::film::{Batch, Tile};
use luminaire::render::Tracer;
use luminaire::scene::{
    self, AreaSampling, Directions, Estimator, Extinction, Integrator, LightSampling, PRESETS, Sampler, Scene,
};
use std::path::Path;
use std::time::Instant;

const SAMPLES: u32 = 16;
const ROUNDS: u32 = 6;
const REFERENCE_SAMPLES: u32 = 4096;

/// Mean radiance of each pixel over some samples, the seconds it took, and the rays.
fn picture(tracer: &mut dyn Tracer, size: u32, samples: std::ops::Range<u32>) -> (Vec<[f64; 3]>, f64, u64) {
    let tile = Tile { x: 0, y: 0, width: size, height: size };
    let mut sums = vec![[0.0; 3]; tile.pixels()];
    let mut rays = 0;
    let start = Instant::now();
    // In batches that no driver takes for a hang.
    for first in samples.clone().step_by(64) {
        let part = first..samples.end.min(first + 64);
        let traced = tracer.trace(&Batch { tile, samples: part, group: 16 }).expect("the tracer works");
        for (i, sum) in traced.sums.iter().enumerate() {
            let pixel = &mut sums[i % tile.pixels()];
            (0..3).for_each(|c| pixel[c] += sum.radiance[c]);
            rays += u64::from(sum.rays);
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    let n = f64::from(samples.end - samples.start);
    (sums.into_iter().map(|p| p.map(|x| x / n)).collect(), seconds, rays)
}

fn relative_mse(found: &[[f64; 3]], expected: &[[f64; 3]]) -> f64 {
    let pairs = found.iter().flatten().zip(expected.iter().flatten());
    pairs.map(|(a, b)| (a - b).powi(2) / (b * b + 0.01)).sum::<f64>() / (3 * found.len()) as f64
}

/// Name, estimator, sampler of each row.
fn rows(scene: &Scene) -> Vec<(String, Estimator, Sampler)> {
    let own = match scene.integrator {
        Integrator::Path(estimator) => estimator,
        Integrator::Simple { .. } => Estimator::default(),
    };
    // The scene's own limit stays.
    let limit = |estimator| Estimator { max_bounces: own.max_bounces, ..estimator };
    let default = limit(Estimator::default());
    let mut rows: Vec<_> =
        PRESETS.iter().map(|(name, estimator)| (name.to_string(), limit(*estimator), Sampler::Independent)).collect();
    let changes = [
        ("default", default),
        ("default, no light sampling", Estimator { light_sampling: LightSampling::None, ..default }),
        ("default, light sampling alone", Estimator { light_sampling: LightSampling::Direct, ..default }),
        ("default, luminaires by area", Estimator { area_sampling: AreaSampling::Area, ..default }),
        ("default, uniform directions", Estimator { directions: Directions::Uniform, ..default }),
        ("default, cosine directions", Estimator { directions: Directions::Cosine, ..default }),
        ("default, extinction by surface", Estimator { extinction: Extinction::Surface, ..default }),
    ];
    rows.extend(changes.map(|(name, estimator)| (name.to_string(), estimator, Sampler::Sobol)));
    rows.push(("default, independent numbers".into(), default, Sampler::Independent));
    rows
}

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let (mut size, mut only) = (96, String::new());
    while arguments.first().is_some_and(|a| a.starts_with("--")) {
        match (arguments[0].as_str(), arguments.get(1)) {
            ("--size", Some(pixels)) => size = pixels.parse().expect("--size PIXELS"),
            ("--only", Some(text)) => only = text.clone(),
            _ => panic!("--size PIXELS, --only TEXT"),
        }
        arguments.drain(..2);
    }
    if arguments.is_empty() {
        eprintln!("usage: estimator_table [--size PIXELS] [--only TEXT] SCENE...");
        std::process::exit(2);
    }
    let open = |scene: &Scene, backend| {
        backend::open(scene, &Request { backend: Some(backend), device: None }).unwrap_or_else(|e| panic!("{e}")).tracer
    };
    println!(
        "| scene | backend | estimator | relMSE at {SAMPLES} | rays a sample | seconds | relMSE x s | to default | mean / reference |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for path in &arguments {
        let mut scene = scene::load(Path::new(path)).unwrap_or_else(|e| panic!("{e}"));
        scene.film.width = size;
        scene.film.height = size;
        let name = Path::new(path).file_stem().map(|s| s.to_string_lossy()).unwrap_or_default();
        let mut rows = rows(&scene);
        rows.retain(|(label, ..)| label == "default" || label.contains(&only));
        let default = rows.iter().position(|(name, ..)| name == "default").expect("there is one");
        let with = |seed, (_, estimator, sampler): &(String, Estimator, Sampler)| {
            let mut scene = scene.clone();
            scene.settings.seed = seed;
            scene.settings.sampler = *sampler;
            scene.integrator = Integrator::Path(*estimator);
            scene
        };
        let mut tracer = open(&with(77, &rows[default]), Backend::ComputeBvh);
        let (reference, ..) = picture(tracer.as_mut(), size, 0..REFERENCE_SAMPLES);
        let mean = |picture: &[[f64; 3]]| picture.iter().flatten().sum::<f64>();
        for backend in [Backend::ComputeBvh, Backend::RayQuery] {
            let mut tracers: Vec<_> = rows.iter().map(|row| open(&with(1, row), backend)).collect();
            let (mut error, mut seconds, mut bias) =
                (vec![0.0; rows.len()], vec![Vec::new(); rows.len()], vec![0.0; rows.len()]);
            let mut rays = vec![0; rows.len()];
            for round in 0..=ROUNDS {
                for (row, tracer) in tracers.iter_mut().enumerate() {
                    let (found, time, traced) = picture(tracer.as_mut(), size, round * SAMPLES..(round + 1) * SAMPLES);
                    // The first round compiles the shader.
                    if round > 0 {
                        error[row] += relative_mse(&found, &reference) / f64::from(ROUNDS);
                        bias[row] += mean(&found) / mean(&reference) / f64::from(ROUNDS);
                        seconds[row].push(time);
                        rays[row] += traced;
                    }
                }
            }
            let time = |row: usize| {
                let mut times = seconds[row].clone();
                times.sort_by(f64::total_cmp);
                times[times.len() / 2]
            };
            for (row, (label, ..)) in rows.iter().enumerate() {
                let product = error[row] * time(row);
                println!(
                    "| {name} | {backend} | {label} | {:.3e} | {:.2} | {:.3} | {product:.3e} | {:.2} | {:.3} |",
                    error[row],
                    rays[row] as f64 / f64::from(ROUNDS * SAMPLES * size * size),
                    time(row),
                    product / (error[default] * time(default)),
                    bias[row]
                );
            }
        }
    }
}
