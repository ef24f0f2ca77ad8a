//! Closed forms and published cases on every backend.

use crate::tables::Folder;
use crate::{Effort, Texts};
use luminaire_measure::Workbench;
use luminaire_measure::closed_forms::{Row, Table, cases};
use luminaire_measure::report::table as report;
use std::error::Error;
use std::path::Path;

/// Samples for each of 256 pixels of an easy case.
const SAMPLES: u32 = 512;

/// Measures all cases; writes their chart and their tables.
pub fn measure(
    bench: &Workbench,
    effort: Effort,
    images: &Path,
    tables: &Folder,
    texts: &mut Texts,
) -> Result<(), Box<dyn Error>> {
    let samples = effort.of([SAMPLES / 16, SAMPLES, 10 * SAMPLES]);
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
    tables.save("closed-forms", &table.by_chance())?;
    tables.save("without-chance", &table.without_chance())?;
    let certain_rows = table.rows.iter().filter(|row| !row.by_chance()).count();
    texts.extend([
        ("closed-forms", by_subject(&table)),
        ("closed-forms-without-chance", without_chance(&table)),
        ("closed-forms-certain", certain_rows.to_string()),
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

/// Subject by subject: how many cases, and the `z` that is furthest off, backend by backend.
fn by_subject(table: &Table) -> String {
    let furthest = table.backends.iter().map(|backend| format!("furthest z, {backend}"));
    let mut text = report::Table::new(["subject", "cases"].map(String::from).into_iter().chain(furthest));
    let rows: Vec<&Row> = table.rows.iter().filter(|row| row.by_chance()).collect();
    for subject in rows.chunk_by(|a, b| a.case.subject == b.case.subject) {
        let mut cells = vec![subject[0].case.subject.to_owned(), subject.len().to_string()];
        for backend in 0..table.backends.len() {
            let z = subject.iter().map(|row| row.z(backend)).max_by(|a, b| a.abs().total_cmp(&b.abs()));
            cells.push(format!("{:+.1}", z.unwrap_or(0.0)));
        }
        text.rows.push(cells);
    }
    text.markdown()
}

/// The largest deviation where chance does not enter, backend by backend.
fn without_chance(table: &Table) -> String {
    let rows: Vec<&Row> = table.rows.iter().filter(|row| !row.by_chance()).collect();
    let largest = |backend: usize| rows.iter().map(|row| row.deviation(backend).abs()).fold(0.0, f64::max);
    let each = table.backends.iter().enumerate().map(|(index, backend)| format!("{backend} {:.0e}", largest(index)));
    each.collect::<Vec<_>>().join(", ")
}
