//! The table of `docs/performance.md`: what each switch of the kernel saves where a scene does not use the feature.
//!
//! usage: cargo run --release --example switch_table -- SCENE...
//!
//! Takes minutes a scene. For each feature that a scene does not use, the kernel without it and the kernel with it trace the same picture in turn. The ratio is
//! seconds with over seconds without: 1.10 means that the switch saves 10 %.

use luminaire::film::{Batch, Tile};
use luminaire::gpu::specialization::{Features, KernelModel};
use luminaire::gpu::{Device, GpuTracer, Instance};
use luminaire::render::Tracer;
use luminaire::scene::{self, Scene};
use luminaire_measure::bench::rounds::{Rounds, Spread};
use luminaire_measure::report::markdown;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const SIZE: u32 = 192;
const ROUNDS: usize = 5;

fn open(device: &Arc<Device>, scene: &Scene, ray_query: bool, adjust: impl FnOnce(&mut Features)) -> GpuTracer {
    GpuTracer::with_model(device, scene, ray_query, |model| adjust(&mut model.features))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// Seconds for one batch.
fn seconds(tracer: &mut GpuTracer) -> f64 {
    let tile = Tile { x: 0, y: 0, width: SIZE, height: SIZE };
    let start = Instant::now();
    tracer.trace(&Batch { tile, samples: 0..32, group: 8 }).expect("the tracer works");
    start.elapsed().as_secs_f64()
}

fn main() {
    if std::env::args().len() < 2 {
        eprintln!("usage: switch_table SCENE...");
        std::process::exit(2);
    }
    let instance = Instance::new().unwrap_or_else(|e| panic!("{e}"));
    let physical = instance.devices().unwrap_or_else(|e| panic!("{e}"));
    let preferred = luminaire::backend::devices().unwrap_or_else(|e| panic!("{e}")).into_iter().find(|d| d.preferred);
    let physical = &physical[preferred.expect("a usable device").index];
    let columns = ["scene", "backend", "with", "seconds with / without: median (least to most)", "first use, s"];
    print!("{}", markdown::head(&columns));
    for path in std::env::args().skip(1) {
        let mut scene = scene::load(Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
        scene.film.width = SIZE;
        scene.film.height = SIZE;
        let name = Path::new(&path).file_stem().map(|s| s.to_string_lossy()).unwrap_or_default();
        let used = KernelModel::of(&scene).features.values();
        for ray_query in if physical.ray_query { vec![false, true] } else { vec![false] } {
            let device = Device::open(physical, ray_query).unwrap_or_else(|e| panic!("{e}"));
            let mut tracers = vec![("the scene's own".to_owned(), open(&device, &scene, ray_query, |_| {}))];
            for (number, feature) in Features::NAMES.iter().enumerate() {
                // Refraction is a part of impulses.
                if !used[number] && *feature != "dielectrics" {
                    tracers.push((feature.to_string(), open(&device, &scene, ray_query, |f| f.switch_on(number))));
                }
            }
            tracers.push(("everything".into(), open(&device, &scene, ray_query, |f| *f = Features::ALL)));
            let first: Vec<f64> = tracers
                .iter_mut()
                .map(|(feature, tracer)| {
                    let seconds = seconds(tracer);
                    eprintln!("{name}, {feature}: {seconds:.1} s");
                    seconds
                })
                .collect();
            let mut ratios = vec![Rounds::default(); tracers.len()];
            for _ in 0..ROUNDS {
                for which in 1..tracers.len() {
                    let without = seconds(&mut tracers[0].1);
                    ratios[which].0.push(seconds(&mut tracers[which].1) / without);
                }
            }
            let backend = if ray_query { "ray-query" } else { "compute-bvh" };
            for ((feature, _), (ratios, first)) in tracers.iter().zip(ratios.iter().zip(first)).skip(1) {
                let Spread { median, least, most } = ratios.spread();
                let ratio = format!("{median:.2} ({least:.2} to {most:.2})");
                let first = format!("{first:.1}");
                print!("{}", markdown::row(&[name.as_ref(), backend, feature, &ratio, &first]));
            }
        }
    }
}
