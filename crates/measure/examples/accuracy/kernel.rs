//! The kernel against the reference, scene by scene: at equal random numbers, and as independent pictures.

use crate::tables::Folder;
use crate::{Effort, Texts};
use luminaire::backend::Backend;
use luminaire::scene::{self, Integrator, Sampler, Scene};
use luminaire_measure::Workbench;
use luminaire_measure::report::table::Table;
use luminaire_measure::statistics::{Image, compare, render, sidak, total, two_sided};
use std::error::Error;
use std::path::Path;

/// The scenes; every feature is in one of them.
const SCENES: [&str; 8] = ["cornell", "instances", "glass", "textures", "environment", "plates", "simple", "furnace"];
/// Samples a pixel for the comparison at equal seeds, and for the test with other seeds.
const EQUAL: u32 = 64;
const OTHER: u32 = 256;
const OTHER_LONG: u32 = 1024;
const GROUPS: u32 = 16;
/// Width of the pictures.
const WIDTH: u32 = 64;

/// Measures every scene on every GPU backend; writes the table.
pub fn measure(bench: &Workbench, effort: Effort, tables: &Folder, texts: &mut Texts) -> Result<(), Box<dyn Error>> {
    let backends: Vec<Backend> = bench.backends().into_iter().filter(|backend| *backend != Backend::Cpu).collect();
    let (equal, samples) = (effort.of([GROUPS, EQUAL, EQUAL]), effort.of([2 * GROUPS, OTHER, OTHER_LONG]));
    texts.insert("kernel-samples", samples.to_string());
    if backends.is_empty() {
        texts.insert("kernel", format!("Not measured: {}.", bench.device));
        texts.insert("kernel-verdict", String::new());
        return Ok(());
    }
    let picture = |scene: &Scene, backend, samples| -> luminaire::Result<Image> {
        Ok(render(bench.tracer(scene, backend)?.as_mut(), scene.film.width, scene.film.height, samples, GROUPS))
    };
    let mut table = Table::new([
        "scene",
        "backend",
        "one bounce: max",
        "99.9 %",
        "full paths: max",
        "99.9 %",
        "means: ratio",
        "p",
        "pixels: p",
    ]);
    let mut ps = Vec::new();
    let mut found: Vec<Vec<[f64; 3]>> = backends.iter().map(|_| Vec::new()).collect();
    for name in SCENES {
        eprintln!("kernel against reference: {name}");
        let mut scene = scene::load(Path::new(&format!("scenes/{name}/{name}.toml")))?;
        scene.film.height = (WIDTH * scene.film.height / scene.film.width).max(1);
        scene.film.width = WIDTH;
        let mut short = scene.clone();
        if let Integrator::Path(estimator) = &mut short.integrator {
            estimator.max_bounces = Some(1);
        }
        let short_reference = picture(&short, Backend::Cpu, equal)?;
        let reference = picture(&scene, Backend::Cpu, equal)?;
        // Independent numbers: successive groups of Sobol points depend on each other.
        let mut independent = scene.clone();
        independent.settings.sampler = Sampler::Independent;
        let long_reference = picture(&independent, Backend::Cpu, samples)?;
        for (index, &backend) in (1..).zip(&backends) {
            let one = differences(&picture(&short, backend, equal)?, &short_reference);
            let full = differences(&picture(&scene, backend, equal)?, &reference);
            // Other seeds for each: independent pictures.
            let mut other = independent.clone();
            other.settings.seed = scene.settings.seed + index;
            let long = picture(&other, backend, samples)?;
            let (a, b) = (total(&long), total(&long_reference));
            let p_mean = two_sided((a.mean - b.mean) / a.error.hypot(b.error).max(1e-7 * b.mean));
            let p_pixels = compare(&long, &long_reference);
            ps.extend([p_mean, p_pixels]);
            let mut cells = vec![name.to_owned(), backend.to_string()];
            for differences in [&one, &full] {
                cells.extend([differences.largest, differences.percentile].map(|d| format!("{d:.1e}")));
            }
            cells.push(format!("{:.5}", a.mean / b.mean));
            cells.extend([p_mean, p_pixels].map(|p| format!("{p:.2}")));
            table.rows.push(cells);
            found[index as usize - 1].push([one.percentile, full.percentile, p_mean.min(p_pixels)]);
        }
    }
    let smallest = ps.iter().copied().fold(1.0, f64::min);
    tables.save("kernel", &table)?;
    let mut summary = Table::new([
        "backend",
        "one bounce: median scene",
        "worst scene",
        "full paths: median scene",
        "worst scene",
        "least p",
    ]);
    for (backend, found) in backends.iter().zip(&found) {
        let [one, full, p] = [0, 1, 2].map(|which| {
            let mut values: Vec<f64> = found.iter().map(|values| values[which]).collect();
            values.sort_by(f64::total_cmp);
            values
        });
        let middle = one.len() / 2;
        let worst = one.len() - 1;
        let mut cells = vec![backend.to_string()];
        cells.extend([one[middle], one[worst], full[middle], full[worst]].map(|d| format!("{d:.1e}")));
        cells.push(format!("{:.2}", p[0]));
        summary.rows.push(cells);
    }
    texts.insert("kernel", summary.markdown());
    let among = sidak(smallest, ps.len());
    texts.insert(
        "kernel-verdict",
        format!(
            "The smallest of these {} p is {smallest:.2}, which among so many has p = {among:.2} (Sidak).",
            ps.len()
        ),
    );
    Ok(())
}

/// How far the channels of two pictures' pixels are apart, relative to the mean of the picture.
struct Differences {
    largest: f64,
    /// The 99.9th percentile.
    percentile: f64,
}

fn differences(a: &Image, b: &Image) -> Differences {
    let mut all: Vec<f64> = a.mean.iter().flatten().zip(b.mean.iter().flatten()).map(|(a, b)| (a - b).abs()).collect();
    all.sort_by(f64::total_cmp);
    let last = all.len() - 1;
    let mean = total(b).mean;
    Differences { largest: all[last] / mean, percentile: all[last - all.len() / 1000] / mean }
}
