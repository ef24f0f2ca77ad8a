//! The table of `docs/performance.md`: the three backends side by side, in turn, in one run.
//!
//! usage: cargo run --release --example speed_table -- SCENE...

use luminaire::backend::{self, Backend, Request};
use luminaire::film::{Batch, Tile};
use luminaire::scene;
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 7;

/// Median, least and most.
fn spread(values: &mut [f64]) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [values[values.len() / 2], values[0], values[values.len() - 1]]
}

/// The backends that run here; the first is what the others are compared with.
fn backends() -> Vec<Backend> {
    let devices = backend::devices().unwrap_or_else(|e| panic!("{e}"));
    let device = devices.iter().find(|d| d.preferred).expect("a usable Vulkan device");
    eprintln!("{} ({})", device.name, device.driver);
    let mut backends = vec![Backend::ComputeBvh, Backend::Cpu];
    if device.ray_query {
        backends.insert(0, Backend::RayQuery);
    }
    backends
}

fn main() {
    if std::env::args().len() < 2 {
        eprintln!("usage: speed_table SCENE...");
        std::process::exit(2);
    }
    let backends = backends();
    println!(
        "| scene | backend | build s | Mrays/s (least to most) | Msamples/s | ratio to the first (least to most) |"
    );
    println!("|---|---|---|---|---|---|");
    for path in std::env::args().skip(1) {
        let mut scene = scene::load(Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
        scene.film.width = 256;
        scene.film.height = 256;
        let mut opened: Vec<_> = backends
            .iter()
            .map(|b| {
                backend::open(&scene, &Request { backend: Some(*b), device: None }).unwrap_or_else(|e| panic!("{e}"))
            })
            .collect();
        // A full picture, 4 samples a pixel of every part: about a second each.
        let tile = Tile { x: 0, y: 0, width: 256, height: 256 };
        let batch = |samples| Batch { tile, samples, group: 4 };
        let mut rates = vec![Vec::new(); backends.len()];
        let mut samples_a_ray = 0.0;
        for round in 0..ROUNDS + 1 {
            for (which, o) in opened.iter_mut().enumerate() {
                let start = Instant::now();
                let traced = o.tracer.trace(&batch(0..16)).expect("the tracer works");
                let seconds = start.elapsed().as_secs_f64();
                let rays: u64 = traced.sums.iter().map(|s| u64::from(s.rays.all)).sum();
                samples_a_ray = 16.0 * tile.pixels() as f64 / rays as f64;
                // The first round compiles the shaders.
                if round > 0 {
                    rates[which].push(rays as f64 / seconds * 1e-6);
                }
            }
        }
        let name = Path::new(&path).file_stem().map(|s| s.to_string_lossy()).unwrap_or_default();
        for (which, o) in opened.iter().enumerate() {
            let mut ratios: Vec<f64> = rates[which].iter().zip(&rates[0]).map(|(a, b)| a / b).collect();
            let [median, least, most] = spread(&mut rates[which].clone());
            let [ratio, low, high] = spread(&mut ratios);
            println!(
                "| {name} | {} | {:.2} | {median:.2} ({least:.2} to {most:.2}) | {:.3} | {ratio:.2} ({low:.2} to {high:.2}) |",
                o.backend,
                o.build_seconds,
                median * samples_a_ray
            );
        }
    }
}
