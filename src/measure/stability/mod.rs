//! The stability map: every method over the range in which it can fail, on every backend.

pub mod caustics;
pub mod glossy;
pub mod luminaire;
mod spot;

use super::Workbench;
use super::chart::Chart;
use crate::Result;

/// A sweep that was run.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// One or more charts with the same horizontal axis.
    pub charts: Vec<Chart>,
    /// What they say.
    pub findings: Findings,
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
pub const SWEEPS: &[Definition] =
    &[glossy::DEFINITION, luminaire::DISTANCE, luminaire::TILT, caustics::MIRROR, caustics::LOBE];
