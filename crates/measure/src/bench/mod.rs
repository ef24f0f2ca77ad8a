//! The benchmark: error over time, and the cost of rays.
//!
//! Every part of it gives a [`Section`]: what was measured as numbers with their spread, and the charts and sentences made of them.
//! [`SECTIONS`] lists the parts, [`Report`] is a run of them, [`html`] and [`markdown`] make a page of it, and [`Baseline`] holds it against an
//! earlier run.

mod baseline;
pub mod break_even;
mod contenders;
mod curve;
pub mod growth;
pub mod intersectors;
pub mod meshes;
mod page;
mod pareto;
pub mod power_law;
mod preparation;
pub mod ray_kinds;
pub mod ray_section;
mod report;
pub mod rounds;
mod settings;
mod trial;
mod words;

pub use baseline::{Baseline, Change, MARGIN, Verdict};
pub use contenders::{STANDARD, check_estimator};
pub use page::{file_name, html, markdown};
pub use pareto::front;
pub use report::{Machine, Outcome, Report};
pub use settings::{BenchScene, Effort, Settings};

use super::Workbench;
use super::chart::Chart;
use luminaire::{Error, Result};

/// Tells how far a part of the benchmark is, a line each.
pub type Tell<'a> = &'a mut dyn FnMut(&str);

/// A part of the benchmark that can be run.
#[derive(Debug, Clone, Copy)]
pub struct Definition {
    /// Name on the command line and of its files: lower-case words with hyphens.
    pub name: &'static str,
    /// What it measures.
    pub title: &'static str,
    /// Whether it measures the scenes of [`Settings::scenes`].
    pub scenes: bool,
    /// Runs it.
    pub run: fn(&Workbench, &Settings, Tell) -> Result<Section>,
}

/// Every part, in the order of the page.
pub const SECTIONS: &[Definition] =
    &[curve::DEFINITION, preparation::DEFINITION, ray_section::DEFINITION, growth::DEFINITION];

/// The parts of these names, in the order of the page; all of them for no name.
///
/// # Errors
/// [`Error::Usage`] for a name that no part has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    if let Some(unknown) = names.iter().find(|name| SECTIONS.iter().all(|section| section.name != **name)) {
        let known: Vec<_> = SECTIONS.iter().map(|section| section.name).collect();
        return Err(Error::Usage(format!("there is no section `{unknown}`; there are: {}", known.join(", "))));
    }
    let wanted = |section: &&Definition| names.is_empty() || names.iter().any(|name| name == section.name);
    Ok(SECTIONS.iter().filter(wanted).copied().collect())
}

/// What a part of the benchmark found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Section {
    /// Part of file names and of the figures' names: lower-case words with hyphens.
    pub name: &'static str,
    /// Heading.
    pub title: String,
    /// How it was measured, and what came out: paragraphs of plain text.
    pub text: Vec<String>,
    /// Tables, each below its heading.
    pub tables: Vec<Table>,
    /// Lines over a quantity.
    pub charts: Vec<Chart>,
    /// What a later run is compared with.
    pub figures: Vec<Figure>,
}

/// Cells of text.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Table {
    /// Heading of every column.
    pub columns: Vec<String>,
    /// As many cells in every row as there are columns.
    pub rows: Vec<Vec<String>>,
}

/// Which way a figure gets better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// Rates.
    Higher,
    /// Times, memory, errors.
    Lower,
}

/// A measured number and how far its rounds lie apart.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Figure {
    /// What it is, the same in every run: section, scene, backend, estimator, quantity, as far as they apply, with slashes between.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Median over the rounds.
    pub median: f64,
    /// Least of the rounds.
    pub least: f64,
    /// Most of the rounds.
    pub most: f64,
    /// How many rounds there were.
    pub rounds: usize,
    /// Which way is better.
    pub better: Better,
}

impl Figure {
    /// Median, least and most of the rounds; none if there is no round, or one gave no number.
    pub fn of(name: String, unit: &str, better: Better, values: &[f64]) -> Option<Figure> {
        if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let [median, least, most] = spread(values);
        Some(Figure { name, unit: unit.into(), median, least, most, rounds: values.len(), better })
    }
}

/// Median, least and most; NaN for no value. Of an even number, the median is the mean of the two in the middle.
pub fn spread(values: &[f64]) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    match n {
        0 => [f64::NAN; 3],
        _ => [0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted[0], sorted[n - 1]],
    }
}
