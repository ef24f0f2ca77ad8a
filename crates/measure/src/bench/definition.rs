//! A part of the benchmark that can be run.

use super::section::Section;
use super::settings::Settings;
use crate::Workbench;
use luminaire::Result;

/// Gets a line about every step of a part of the benchmark.
pub type Progress<'a> = &'a mut dyn FnMut(&str);

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
    pub run: fn(&Workbench, &Settings, Progress) -> Result<Section>,
}

/// A part with what became of it.
pub type Outcome = (Definition, Result<Section>);
