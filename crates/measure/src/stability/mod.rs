//! The stability map: every method over the range in which it can fail, on every backend.

mod albedo;
pub mod caustics;
pub mod distance;
pub mod edges;
pub mod eta;
mod extinction;
pub mod gaps;
mod geometry;
pub mod glass;
pub mod glossy;
pub mod instances;
mod many;
pub mod near_lamps;
mod page;
mod rooms;
mod samples;
pub mod scale;
mod series;
pub mod slivers;
mod spot;
mod trial;

pub use page::{Head, Outcome, page};

use super::Workbench;
use super::chart::{CSV_HEADER, Chart};
use super::report::choice;
use luminaire::Result;

/// A sweep that was run.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// One or more charts with the same horizontal axis.
    pub charts: Vec<Chart>,
    /// What they say.
    pub findings: Findings,
}

impl Sweep {
    /// All points of all charts as CSV: chart, method, x, y, standard error.
    pub fn csv(&self) -> String {
        CSV_HEADER.to_owned() + &self.charts.iter().map(Chart::csv).collect::<String>()
    }
}

/// The four answers of the map. Numbers in them come from the measured points, not from memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// Where it starts to fail, method by method.
    pub starts: String,
    /// How it fails.
    pub how: String,
    /// What luminaire does about it.
    pub mends: String,
    /// What the user sees.
    pub sees: String,
}

/// A sweep that can be run.
#[derive(Clone, Copy)]
pub struct Definition {
    /// Name on the command line and of its files: lower-case words with hyphens.
    pub name: &'static str,
    /// What is swept, from where to where.
    pub title: &'static str,
    /// Runs it.
    pub run: fn(&Workbench) -> Result<Sweep>,
}

/// Every sweep, in the order of the map.
pub const SWEEPS: &[Definition] = &[
    distance::DEFINITION,
    scale::DEFINITION,
    edges::DEFINITION,
    slivers::DEFINITION,
    gaps::DEFINITION,
    instances::DEFINITION,
    eta::DEFINITION,
    glass::DEFINITION,
    glossy::DEFINITION,
    near_lamps::DISTANCE,
    near_lamps::TILT,
    caustics::MIRROR,
    caustics::LOBE,
    albedo::DEFINITION,
    extinction::DEFINITION,
    samples::DEFINITION,
    many::DEFINITION,
];

/// The sweeps of these names, in the order of the map; all of them for no name.
///
/// # Errors
/// [`Error::Usage`](luminaire::Error::Usage) for a name that no sweep has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    choice::named("sweep", SWEEPS, |sweep| sweep.name, names)
}
