//! What is stored of a run, and read back to compare a later one with it.

use super::effort::Effort;
use super::figure::Figure;
use super::settings::Settings;
use crate::Workbench;
use luminaire::film::REL_MSE;
use serde::{Deserialize, Serialize};

/// Where a run took place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The Vulkan device and its driver, or what is missing.
    pub device: String,
    /// The processor's name where the system has it, else its architecture.
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

/// The processor's name. Only Linux has it in a file.
fn processor() -> String {
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name =
        about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, name)| name.trim()));
    name.map_or_else(|| std::env::consts::ARCH.into(), String::from)
}

/// A scene as a record has it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct SceneRecord {
    pub name: String,
    pub triangles: u64,
    pub width: u32,
    pub height: u32,
}

/// What was run, as a later run reads it back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Run {
    pub command: String,
    pub effort: Effort,
    pub rounds: usize,
    pub budget_seconds: f64,
    pub estimators: Vec<String>,
    pub scenes: Vec<SceneRecord>,
    /// What relMSE is ([`REL_MSE`]). Runs from before it was written down had a fixed 0.01 in the place of `(m/3)^2`.
    #[serde(default = "fixed_floor")]
    pub relmse: String,
}

/// What relMSE was before the record said what it is.
fn fixed_floor() -> String {
    "mean of (a - b)^2 / (b^2 + 0.01)".into()
}

impl Run {
    /// What these settings run. `command` makes it again.
    pub fn new(command: String, settings: &Settings) -> Self {
        let scenes = settings.scenes.iter().map(|of| SceneRecord {
            name: of.name.clone(),
            triangles: of.scene.triangle_count(),
            width: of.scene.film.width,
            height: of.scene.film.height,
        });
        Run {
            command,
            effort: settings.effort,
            rounds: settings.rounds,
            budget_seconds: settings.effort.budget_seconds(),
            estimators: settings.estimators.clone(),
            scenes: scenes.collect(),
            relmse: REL_MSE.into(),
        }
    }
}

/// What is read back of a run.
#[derive(Debug, Deserialize)]
pub(super) struct Record {
    pub run: Run,
    pub machine: Machine,
    pub sections: Vec<SectionRecord>,
}

/// What is read back of a section.
#[derive(Debug, Deserialize)]
pub(super) struct SectionRecord {
    pub figures: Vec<Figure>,
}
