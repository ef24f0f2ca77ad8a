//! What each stage of the lecture buys, as error times time.
//!
//! Every estimator renders the same small picture in turn, several times with other samples; the error is relMSE
//! ([`luminaire::film::REL_MSE`]) against a picture of many samples by the default estimator. Error falls as one over time, so that their
//! product does not depend on the number of samples: half of it is twice as fast.

use crate::tables::Folder;
use crate::{Effort, Texts};
use luminaire::backend::Backend;
use luminaire::film::{Batch, Brightness, Tile};
use luminaire::render::Tracer;
use luminaire::scene::{
    self, AreaSampling, Directions, Estimator, Extinction, Integrator, LightChoice, LightSampling, PRESETS, Sampler,
    Scene,
};
use luminaire_measure::Workbench;
use luminaire_measure::bench::rounds::Rounds;
use luminaire_measure::report::table::Table;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

const SCENES: [&str; 3] = ["cornell", "plates", "textures"];
const SIZE: u32 = 64;
const SAMPLES: u32 = 16;

/// A small picture, and what it took.
struct Picture {
    /// Mean radiance of each pixel.
    mean: Vec<[f64; 3]>,
    seconds: f64,
    rays: u64,
}

/// Renders some samples.
fn picture(tracer: &mut dyn Tracer, samples: std::ops::Range<u32>) -> luminaire::Result<Picture> {
    let tile = Tile { x: 0, y: 0, width: SIZE, height: SIZE };
    let mut sums = vec![[0.0; 3]; tile.pixels()];
    let mut rays = 0;
    let start = Instant::now();
    // In batches that no driver takes for a hang.
    for first in samples.clone().step_by(64) {
        let part = first..samples.end.min(first + 64);
        let traced = tracer.trace(&Batch { tile, samples: part, group: 16 })?;
        for (i, sum) in traced.sums.iter().enumerate() {
            let pixel = &mut sums[i % tile.pixels()];
            (0..3).for_each(|c| pixel[c] += sum.radiance[c]);
            rays += u64::from(sum.rays.all);
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    let n = f64::from(samples.end - samples.start);
    Ok(Picture { mean: sums.into_iter().map(|p| p.map(|x| x / n)).collect(), seconds, rays })
}

fn relative_mse(found: &[[f64; 3]], expected: &[[f64; 3]]) -> f64 {
    let brightness = Brightness::of(expected.iter().flatten().copied());
    let pairs = found.iter().flatten().zip(expected.iter().flatten());
    pairs.map(|(a, b)| brightness.relative_square(a - b, *b)).sum::<f64>() / (3 * found.len()) as f64
}

/// An estimator of the table.
struct Row {
    name: String,
    estimator: Estimator,
    sampler: Sampler,
}

/// What was measured of it on one backend.
#[derive(Default)]
struct Found {
    error: f64,
    mean: f64,
    rays: u64,
    seconds: Rounds,
}

impl Found {
    /// Error times the median of the seconds.
    fn product(&self) -> f64 {
        self.error * self.seconds.median()
    }
}

fn rows(scene: &Scene) -> Vec<Row> {
    // The scene's own limit stays.
    let max_bounces = scene.integrator.estimator().max_bounces;
    let limit = |estimator| Estimator { max_bounces, ..estimator };
    let row = |name: &str, estimator, sampler| Row { name: name.to_owned(), estimator: limit(estimator), sampler };
    let default = Estimator::default();
    let mut rows: Vec<_> =
        PRESETS.iter().map(|(name, estimator)| row(name, *estimator, Sampler::Independent)).collect();
    let changes = [
        ("default", default),
        ("default, no light sampling", Estimator { light_sampling: LightSampling::None, ..default }),
        ("default, light sampling alone", Estimator { light_sampling: LightSampling::Direct, ..default }),
        ("default, luminaires by area", Estimator { area_sampling: AreaSampling::Area, ..default }),
        ("default, luminaires by power", Estimator { light_choice: LightChoice::Power, ..default }),
        ("default, uniform directions", Estimator { directions: Directions::Uniform, ..default }),
        ("default, cosine directions", Estimator { directions: Directions::Cosine, ..default }),
        ("default, extinction by surface", Estimator { extinction: Extinction::Surface, ..default }),
    ];
    rows.extend(changes.map(|(name, estimator)| row(name, estimator, Sampler::Sobol)));
    rows.push(row("default, independent numbers", default, Sampler::Independent));
    rows
}

/// Measures every scene and estimator on every GPU backend, or on the reference if there is none; writes the table.
pub fn measure(bench: &Workbench, effort: Effort, tables: &Folder, texts: &mut Texts) -> Result<(), Box<dyn Error>> {
    let (rounds, reference_samples) = effort.of([(1, 64), (3, 1024), (8, 4096)]);
    let mut backends = bench.backends();
    if backends.len() > 1 {
        backends.retain(|backend| *backend != Backend::Cpu);
    }
    let mut columns = ["scene", "estimator", "relMSE", "rays a sample", "mean / reference"].map(String::from).to_vec();
    columns.extend(backends.iter().flat_map(|backend| [format!("{backend}: relMSE x s"), "to default".into()]));
    let mut table = Table::new(columns);
    // Error times time over the default's on the first backend: estimator by estimator, scene by scene.
    let mut summary: Vec<(String, Vec<String>)> = Vec::new();
    for name in SCENES {
        let mut scene = scene::load(Path::new(&format!("scenes/{name}/{name}.toml")))?;
        (scene.film.width, scene.film.height) = (SIZE, SIZE);
        let rows = rows(&scene);
        let default = rows.iter().position(|row| row.name == "default").ok_or("no default")?;
        let with = |seed, row: &Row| {
            let mut scene = scene.clone();
            (scene.settings.seed, scene.settings.sampler) = (seed, row.sampler);
            scene.integrator = Integrator::Path(row.estimator);
            scene
        };
        let mut tracer = bench.tracer(&with(77, &rows[default]), backends[0])?;
        let reference = picture(tracer.as_mut(), 0..reference_samples)?.mean;
        let mean = |picture: &[[f64; 3]]| picture.iter().flatten().sum::<f64>();
        let mut found: Vec<Vec<Found>> = Vec::new();
        for &backend in &backends {
            eprintln!("estimators: {name}, {backend}");
            let mut tracers =
                rows.iter().map(|row| bench.tracer(&with(1, row), backend)).collect::<luminaire::Result<Vec<_>>>()?;
            let mut here: Vec<Found> = rows.iter().map(|_| Found::default()).collect();
            for round in 0..=rounds {
                for (found, tracer) in here.iter_mut().zip(&mut tracers) {
                    let picture = picture(tracer.as_mut(), round * SAMPLES..(round + 1) * SAMPLES)?;
                    // The first round compiles the shader.
                    if round > 0 {
                        found.error += relative_mse(&picture.mean, &reference) / f64::from(rounds);
                        found.mean += mean(&picture.mean) / mean(&reference) / f64::from(rounds);
                        found.rays += picture.rays;
                        found.seconds.0.push(picture.seconds);
                    }
                }
            }
            found.push(here);
        }
        for (index, row) in rows.iter().enumerate() {
            let first = &found[0][index];
            let rays = first.rays as f64 / f64::from(rounds * SAMPLES * SIZE * SIZE);
            let mut cells = vec![
                name.to_owned(),
                row.name.clone(),
                format!("{:.2e}", first.error),
                format!("{rays:.2}"),
                format!("{:.3}", first.mean),
            ];
            let to_default = found[0][index].product() / found[0][default].product();
            match summary.iter_mut().find(|(estimator, _)| *estimator == row.name) {
                Some((_, cells)) => cells.push(format!("{to_default:.2}")),
                None => summary.push((row.name.clone(), vec![format!("{to_default:.2}")])),
            }
            for here in &found {
                let product = here[index].product();
                cells.extend([format!("{product:.2e}"), format!("{:.2}", product / here[default].product())]);
            }
            table.rows.push(cells);
        }
    }
    tables.save("estimators", &table)?;
    let short = Table::new(["estimator"].into_iter().chain(SCENES))
        .with_rows(summary.into_iter().map(|(name, cells)| [name].into_iter().chain(cells).collect()))
        .markdown();
    texts.insert("estimators", short);
    texts.insert("estimators-backend", backends[0].to_string());
    texts.insert("estimators-rounds", rounds.to_string());
    texts.insert("estimators-reference", reference_samples.to_string());
    Ok(())
}
