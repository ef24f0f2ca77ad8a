//! The section `preparation`: what comes before the first sample, which is loading a scene, building its structures, and the memory that they take.

use super::definition::{Definition, Progress};
use super::figure::{Better, Figure};
use super::figure_name::FigureName;
use super::renders::Preparation;
use super::rounds::Rounds;
use super::section::Section;
use super::settings::Settings;
use crate::Workbench;
use crate::report::table::Table;
use crate::report::words::bytes;
use luminaire::{Result, scene};
use std::time::Instant;

/// The section of loading, building and memory.
pub(super) const DEFINITION: Definition =
    Definition { name: "preparation", title: "Loading, building and memory", scenes: true, run };

/// What a backend took, round by round.
#[derive(Debug, Clone, Default)]
struct BackendRounds {
    /// Seconds to build the tracer.
    build: Rounds,
    /// Seconds from then to the first samples.
    first_samples: Rounds,
    /// Bytes that the tracer holds; no round for the CPU.
    device_bytes: Rounds,
}

fn run(bench: &Workbench, settings: &Settings, progress: Progress) -> Result<Section> {
    let columns = [
        "scene",
        "triangles",
        "instances",
        "load, s",
        "backend",
        "build, s",
        "first samples after, s",
        "device memory",
    ];
    let (mut rows, mut figures) = (Vec::new(), Vec::new());
    for (number, of) in settings.scenes.iter().enumerate() {
        progress(&format!("{}/{} {}", number + 1, settings.scenes.len(), of.name));
        let mut load = Rounds::default();
        let mut rounds = vec![BackendRounds::default(); settings.backends.len()];
        for round in 0..=settings.rounds {
            // The first round compiles shaders and fills caches.
            let counts = round > 0;
            let start = Instant::now();
            scene::load(&of.path)?;
            load.0.extend(counts.then(|| start.elapsed().as_secs_f64()));
            for (backend, rounds) in settings.backends.iter().zip(&mut rounds) {
                let taken = Preparation::measure(bench, &of.scene, *backend)?;
                if counts {
                    rounds.build.0.push(taken.build_seconds);
                    rounds.first_samples.0.push(taken.ready_seconds - taken.build_seconds);
                    rounds.device_bytes.0.extend(taken.device_bytes.map(|bytes| bytes as f64));
                }
            }
        }
        let mut add = |of: &str, quantity: &str, unit: &str, rounds: &Rounds| {
            let name = FigureName { section: DEFINITION.name, of, quantity };
            figures.extend(Figure::of(name.to_string(), unit, Better::Lower, &rounds.0));
        };
        add(&of.name, "load-seconds", "s", &load);
        for (backend, BackendRounds { build, first_samples, device_bytes }) in settings.backends.iter().zip(&rounds) {
            rows.push(vec![
                of.name.clone(),
                of.scene.triangle_count().to_string(),
                of.scene.objects.len().to_string(),
                load.spread().to_string(),
                backend.to_string(),
                build.spread().to_string(),
                first_samples.spread().to_string(),
                if device_bytes.0.is_empty() { "-".into() } else { bytes(device_bytes.median()) },
            ]);
            let of = format!("{}/{backend}", of.name);
            add(&of, "build-seconds", "s", build);
            add(&of, "device-bytes", "bytes", device_bytes);
        }
    }
    let text = format!(
        "Medians of {} rounds in turn (least to most) after one that compiles shaders. Loading reads the scene's files. Building is everything between the \
         loaded scene and the first batch: BVH or acceleration structures, tables, upload, the kernel. The first samples come from 8 x 8 pixels: \
         what they take is a driver's work at the first use, without compilation where the driver keeps what it has compiled. Device memory is what the tracer holds, with 48 \
         MiB of sums whatever the scene is; the reference holds no device memory.",
        settings.rounds
    );
    Ok(Section {
        name: DEFINITION.name,
        title: DEFINITION.title.into(),
        text: vec![text],
        tables: vec![Table::new(columns).with_rows(rows)],
        charts: vec![],
        figures,
    })
}
