//! A run of the benchmark: where it ran, what it found, as JSON and as CSV.

use super::definition::Outcome;
use super::figure::Figure;
use super::figure_name::FigureName;
use super::record::{Machine, Run};
use super::section::Section;
use super::settings::Settings;
use crate::chart::CSV_HEADER;
use serde::Serialize;

/// A run with all that it found.
#[derive(Debug)]
pub struct Report {
    pub(super) run: Run,
    /// Where it took place.
    pub machine: Machine,
    /// What it found.
    pub outcomes: Vec<Outcome>,
    /// The most memory that the process has held, in bytes, where the system has it.
    pub peak_bytes: Option<u64>,
}

impl Report {
    /// Gathers a run. `command` makes it again.
    pub fn new(command: String, settings: &Settings, machine: Machine, outcomes: Vec<Outcome>) -> Self {
        Report { run: Run::new(command, settings), machine, outcomes, peak_bytes: peak_bytes() }
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
            let FigureName { section, of, quantity } = FigureName::parse(name);
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

/// The most memory that this process has held, in bytes. Only Linux has it in a file.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * peak.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}
