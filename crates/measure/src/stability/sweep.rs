//! What a sweep is, and what it found.

use super::verdict::Verdict;
use crate::Workbench;
use crate::chart::{CSV_HEADER, Chart};
use luminaire::Result;

/// A sweep that was run.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// One or more charts with the same horizontal axis.
    pub charts: Vec<Chart>,
    /// From where to where it goes, with its unit.
    pub range: String,
    /// What each method is in that range. Of [`Family::Light`] the default comes first.
    pub verdicts: Vec<Verdict>,
    /// What to do about it, in one sentence of at most [`SUMMARY`] letters.
    pub summary: String,
    /// What they say.
    pub findings: Findings,
}

impl Sweep {
    /// All points of all charts as CSV: chart, method, x, y, standard error.
    pub fn csv(&self) -> String {
        CSV_HEADER.to_owned() + &self.charts.iter().map(Chart::csv).collect::<String>()
    }
}

/// Letters of a sweep's summary: what a cell of the page's first table holds in two lines.
pub const SUMMARY: usize = 100;

/// What a sweep compares of that which a user can choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Backends, by what they make of geometry.
    Geometry,
    /// Estimators, by what they make of light.
    Light,
}

/// The four answers of the map. Numbers in them come from the measured points, not from memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// Where it starts to fail: what is to be said before the table of the verdicts, if anything.
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
    /// What it compares.
    pub family: Family,
    /// What is swept, from where to where.
    pub title: &'static str,
    /// Runs it.
    pub run: fn(&Workbench) -> Result<Sweep>,
}
