//! A section: the part of the benchmark's page that holds its charts. A chart is added to the `charts` of the section it belongs to.

use super::figure::Figure;
use crate::chart::Chart;
use crate::report::table::Table;

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
