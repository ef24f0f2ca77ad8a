//! A run of the benchmark: where it ran, what it found, as JSON and as CSV.

use super::baseline::{first_part, last_part};
use super::{Definition, Effort, Figure, Section, Settings};
use crate::Workbench;
use crate::chart::CSV_HEADER;
use luminaire::Result;
use serde::{Deserialize, Serialize};

/// A part with what became of it.
pub type Outcome = (Definition, Result<Section>);

/// Where a run took place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The Vulkan device and its driver, or what is missing.
    pub device: String,
    /// The processor's name, as far as the system tells it.
    pub processor: String,
    /// How many threads the program uses on it.
    pub threads: usize,
    /// The backends that ran.
    pub backends: Vec<String>,
    /// The version of luminaire.
    pub version: String,
}

impl Machine {
    /// This machine.
    pub fn new(bench: &Workbench, settings: &Settings) -> Self {
        Machine {
            device: bench.device.clone(),
            processor: processor(),
            threads: rayon::current_num_threads(),
            backends: settings.backends.iter().map(ToString::to_string).collect(),
            version: env!("CARGO_PKG_VERSION").into(),
        }
    }
}

/// The processor's name; Linux alone tells it without more ado.
fn processor() -> String {
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name =
        about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, name)| name.trim()));
    name.map_or_else(|| std::env::consts::ARCH.into(), String::from)
}

/// The most memory that this process has held, in bytes; Linux alone tells it.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * peak.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

/// A scene as a record has it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct SceneRecord {
    pub name: String,
    pub triangles: u64,
    pub width: u32,
    pub height: u32,
}

/// What was run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Run {
    pub command: String,
    pub effort: Effort,
    pub rounds: usize,
    pub budget_seconds: f64,
    pub estimators: Vec<String>,
    pub scenes: Vec<SceneRecord>,
}

/// A run with all that it found.
#[derive(Debug)]
pub struct Report {
    pub(super) run: Run,
    /// Where it took place.
    pub machine: Machine,
    /// What it found.
    pub outcomes: Vec<Outcome>,
    /// The most memory that the process has held, in bytes, where the system tells.
    pub peak_bytes: Option<u64>,
}

/// What is read back of a run.
#[derive(Debug, Deserialize)]
pub(super) struct Record {
    pub run: Run,
    pub machine: Machine,
    pub sections: Vec<SectionRecord>,
}

#[derive(Debug, Deserialize)]
pub(super) struct SectionRecord {
    pub figures: Vec<Figure>,
}

impl Report {
    /// Gathers a run. `command` makes it again.
    pub fn new(command: String, settings: &Settings, machine: Machine, mut outcomes: Vec<Outcome>) -> Self {
        for section in outcomes.iter_mut().filter_map(|(_, outcome)| outcome.as_mut().ok()) {
            section.figures.retain(|f| [f.median, f.least, f.most].iter().all(|value| value.is_finite()));
        }
        let scenes = settings.scenes.iter().map(|of| SceneRecord {
            name: of.name.clone(),
            triangles: of.scene.triangle_count(),
            width: of.scene.film.width,
            height: of.scene.film.height,
        });
        let run = Run {
            command,
            effort: settings.effort,
            rounds: settings.rounds,
            budget_seconds: settings.effort.budget_seconds(),
            estimators: settings.estimators.clone(),
            scenes: scenes.collect(),
        };
        Report { run, machine, outcomes, peak_bytes: peak_bytes() }
    }

    /// What was found, without what failed.
    pub fn sections(&self) -> impl Iterator<Item = &Section> {
        self.outcomes.iter().filter_map(|(_, outcome)| outcome.as_ref().ok())
    }

    /// All figures.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.sections().flat_map(|section| &section.figures)
    }

    /// Everything: where and what was run, texts, tables, points of charts, figures. What is no number is null.
    pub fn json(&self) -> String {
        #[derive(Serialize)]
        struct Everything<'a> {
            run: &'a Run,
            machine: &'a Machine,
            peak_bytes: Option<u64>,
            sections: Vec<&'a Section>,
            failed: Vec<[String; 2]>,
        }
        let failed = self.outcomes.iter().filter_map(|(section, outcome)| {
            outcome.as_ref().err().map(|error| [section.name.to_owned(), error.to_string()])
        });
        let everything = Everything {
            run: &self.run,
            machine: &self.machine,
            peak_bytes: self.peak_bytes,
            sections: self.sections().collect(),
            failed: failed.collect(),
        };
        // Strings, numbers and lists: nothing that could fail.
        serde_json::to_string_pretty(&everything).unwrap_or_default() + "\n"
    }

    /// The figures, a row each: section, what it is of, quantity, unit, median, least, most, rounds.
    pub fn figures_csv(&self) -> String {
        let mut rows = "section,of,quantity,unit,median,least,most,rounds\n".to_owned();
        for Figure { name, unit, median, least, most, rounds, .. } in self.figures() {
            let (section, quantity) = (first_part(name), last_part(name));
            let of =
                name.strip_prefix(section).and_then(|rest| rest.strip_suffix(quantity)).unwrap_or("").trim_matches('/');
            rows += &format!("{section},{of},{quantity},{unit},{median:?},{least:?},{most:?},{rounds}\n");
        }
        rows
    }

    /// The points of all charts, a row each.
    pub fn points_csv(&self) -> String {
        let mut rows = format!("section,{CSV_HEADER}");
        for section in self.sections() {
            let lines = section.charts.iter().map(|chart| chart.csv()).collect::<String>();
            lines.lines().for_each(|line| rows += &format!("{},{line}\n", section.name));
        }
        rows
    }
}
