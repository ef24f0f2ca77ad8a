//! What comes before the first sample: loading a scene, building its structures, and the memory that they take.

use super::trial::ready;
use super::words::{bytes, with_spread};
use super::{Better, Definition, Figure, Section, Settings, Table, Tell, spread};
use crate::Workbench;
use luminaire::{Result, scene};
use std::time::Instant;

/// The section of loading, building and memory.
pub(super) const DEFINITION: Definition =
    Definition { name: "preparation", title: "Loading, building and memory", scenes: true, run };

fn run(bench: &Workbench, settings: &Settings, tell: Tell) -> Result<Section> {
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
        tell(&format!("{}/{} {}", number + 1, settings.scenes.len(), of.name));
        let mut load = Vec::new();
        let mut builds = vec![(Vec::new(), Vec::new(), Vec::new()); settings.backends.len()];
        for round in 0..=settings.rounds {
            // The first round compiles shaders and fills caches.
            let counts = round > 0;
            let start = Instant::now();
            scene::load(&of.path)?;
            load.extend(counts.then(|| start.elapsed().as_secs_f64()));
            for (backend, (build, first, memory)) in settings.backends.iter().zip(&mut builds) {
                let (built, ready, taken) = ready(bench, &of.scene, *backend)?;
                if counts {
                    build.push(built);
                    first.push(ready - built);
                    memory.extend(taken.map(|bytes| bytes as f64));
                }
            }
        }
        let name = |part: &str| format!("{}/{}/{part}", DEFINITION.name, of.name);
        figures.extend(Figure::of(name("load-seconds"), "s", Better::Lower, &load));
        for (backend, (build, first, memory)) in settings.backends.iter().zip(&builds) {
            rows.push(vec![
                of.name.clone(),
                of.scene.triangle_count().to_string(),
                of.scene.objects.len().to_string(),
                with_spread(spread(&load)),
                backend.to_string(),
                with_spread(spread(build)),
                with_spread(spread(first)),
                if memory.is_empty() { "-".into() } else { bytes(spread(memory)[0]) },
            ]);
            let name = |part: &str| name(&format!("{backend}/{part}"));
            figures.extend(Figure::of(name("build-seconds"), "s", Better::Lower, build));
            figures.extend(Figure::of(name("device-bytes"), "bytes", Better::Lower, memory));
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
        tables: vec![Table { columns: columns.map(String::from).to_vec(), rows }],
        charts: vec![],
        figures,
    })
}
