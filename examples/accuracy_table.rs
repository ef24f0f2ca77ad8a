//! The table of `docs/accuracy.md`: both GPU backends against the reference, scene by scene.
//!
//! usage: cargo run --release --example accuracy_table -- SCENE...

#[path = "../tests/common/statistics.rs"]
#[allow(dead_code)]
mod statistics;

use luminaire::backend::{self, Backend, Request};
use luminaire::reference::Reference;
use luminaire::render::Tracer;
use luminaire::scene::{self, Integrator, Scene};
use statistics::{Image, compare, render, total, two_sided};
use std::path::Path;

/// Samples a pixel for the comparison at equal seeds, and for the test with other seeds.
const EQUAL: u32 = 64;
const OTHER: u32 = 1024;
const GROUPS: u32 = 16;
/// Width of the pictures.
const WIDTH: u32 = 64;

fn picture(tracer: &mut dyn Tracer, scene: &Scene, samples: u32) -> Image {
    render(tracer, scene.film.width, scene.film.height, samples, GROUPS)
}

fn open(scene: &Scene, backend: Backend) -> Box<dyn Tracer> {
    backend::open(scene, &Request { backend: Some(backend), device: None }).unwrap_or_else(|e| panic!("{e}")).tracer
}

/// The GPU backends that run here.
fn backends() -> Vec<Backend> {
    let devices = backend::devices().unwrap_or_else(|e| panic!("{e}"));
    let device = devices.iter().find(|d| d.preferred).expect("a usable Vulkan device");
    eprintln!("{} ({})", device.name, device.driver);
    if device.ray_query { vec![Backend::RayQuery, Backend::ComputeBvh] } else { vec![Backend::ComputeBvh] }
}

/// Largest and 99.9th-percentile difference of a pixel's channel, relative to the mean of the picture.
fn differences(a: &Image, b: &Image) -> [f64; 2] {
    let mut all: Vec<f64> = a.mean.iter().flatten().zip(b.mean.iter().flatten()).map(|(a, b)| (a - b).abs()).collect();
    all.sort_by(f64::total_cmp);
    let last = all.len() - 1;
    [all[last], all[last - all.len() / 1000]].map(|d| d / total(b).mean)
}

fn main() {
    if std::env::args().len() < 2 {
        eprintln!("usage: accuracy_table SCENE...");
        std::process::exit(2);
    }
    let backends = backends();
    println!(
        "| scene | backend | one bounce: max | 99.9 % | full paths: max | 99.9 % | means: ratio | p | pixels: p |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for path in std::env::args().skip(1) {
        let mut scene = scene::load(Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
        scene.film.height = (WIDTH * scene.film.height / scene.film.width).max(1);
        scene.film.width = WIDTH;
        let mut short = scene.clone();
        if let Integrator::Path(estimator) = &mut short.integrator {
            estimator.max_bounces = Some(1);
        }
        let short_reference = picture(&mut Reference::new(&short), &short, EQUAL);
        let reference = picture(&mut Reference::new(&scene), &scene, EQUAL);
        let long_reference = picture(&mut Reference::new(&scene), &scene, OTHER);
        let mut other = scene.clone();
        other.settings.seed = scene.settings.seed + 1;
        let name = Path::new(&path).file_stem().map(|s| s.to_string_lossy()).unwrap_or_default();
        for &backend in &backends {
            let one = differences(&picture(open(&short, backend).as_mut(), &short, EQUAL), &short_reference);
            let full = differences(&picture(open(&scene, backend).as_mut(), &scene, EQUAL), &reference);
            let long = picture(open(&other, backend).as_mut(), &other, OTHER);
            let (a, b) = (total(&long), total(&long_reference));
            let p_mean = two_sided((a.mean - b.mean) / a.error.hypot(b.error).max(1e-7 * b.mean));
            println!(
                "| {name} | {backend} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.5} | {p_mean:.2} | {:.2} |",
                one[0],
                one[1],
                full[0],
                full[1],
                a.mean / b.mean,
                compare(&long, &long_reference)
            );
        }
    }
}
