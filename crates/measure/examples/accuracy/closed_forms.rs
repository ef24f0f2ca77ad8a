//! Closed forms and published cases on every backend.

use crate::Texts;
use luminaire_measure::Workbench;
use luminaire_measure::closed_forms::{Table, cases};
use std::error::Error;
use std::path::Path;

/// Samples for each of 256 pixels of an easy case.
const SAMPLES: u32 = 512;

/// Measures all cases; writes their chart.
pub fn measure(bench: &Workbench, images: &Path, texts: &mut Texts) -> Result<(), Box<dyn Error>> {
    let samples = if bench.long { 10 * SAMPLES } else { SAMPLES };
    let table = Table::measure(bench, cases(), samples, |row| eprintln!("{}: {}", row.case.subject, row.case.name))?;
    let verdict = table.verdict();
    let chart = table.chart();
    let file = images.join(format!("{}.svg", chart.name));
    std::fs::write(&file, chart.svg()).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    let beyond = table.beyond_rounding();
    let certain = match beyond.len() {
        0 => "None is beyond its bound.".to_owned(),
        _ => format!("**Beyond the bound:** {}.", beyond.join("; ")),
    };
    texts.extend([
        ("closed-forms", table.markdown()),
        ("closed-forms-without-chance", table.markdown_without_chance()),
        ("closed-forms-beyond", certain),
        ("closed-forms-cases", table.rows.len().to_string()),
        ("closed-forms-samples", table.samples.to_string()),
        ("closed-forms-count", verdict.count.to_string()),
        ("closed-forms-furthest", format!("z = {:.1} ({})", verdict.z, verdict.furthest)),
        ("closed-forms-largest", format!("{:.2}", verdict.largest)),
        ("closed-forms-squares", format!("{:.2}", verdict.squares)),
        ("closed-forms-blunt", format!("{:.1} % ({})", 100.0 * verdict.bluntest_error, verdict.bluntest)),
    ]);
    Ok(())
}
