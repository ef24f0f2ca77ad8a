//! The benchmark: error over time, and the cost of rays.
//!
//! Every part of it gives a [`Section`]: what was measured as numbers with their spread, and the charts and sentences made of them.

pub mod break_even;
pub mod growth;
pub mod intersectors;
pub mod meshes;
pub mod power_law;
pub mod ray_kinds;
pub mod ray_section;
pub mod rounds;

use super::chart::Chart;

/// What a part of the benchmark found.
#[derive(Debug, Clone, PartialEq)]
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
