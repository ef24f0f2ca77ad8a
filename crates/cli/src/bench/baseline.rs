//! What has changed since the baseline.

use crate::shared::printing::print;
use crate::shared::table::table;
use luminaire::{Error, Result};
use luminaire_measure::bench::{Baseline, Report, Verdict};

/// Prints what changed; returns how many figures got worse.
pub fn compare(baseline: &Baseline, report: &Report) -> Result<usize> {
    let changes = baseline.changes(report);
    let rows = Baseline::rows(&changes);
    print(&format!("\nagainst the baseline\n{}", table(2, &Baseline::summary(&changes))))?;
    if rows.len() > 1 {
        print(&format!("\nbeyond the noise\n{}", table(2, &rows)))?;
    } else if changes.iter().any(|change| change.verdict == Verdict::Same) {
        print("\nno figure differs by more than the noise\n")?;
    } else if !changes.is_empty() {
        print("\nnothing can be concluded: one of the runs has too few rounds (3 at least)\n")?;
    }
    let unmatched = baseline.unmatched(report);
    for (names, which) in unmatched.iter().zip(["the baseline", "this run"]) {
        if !names.is_empty() {
            print(&format!(
                "\nonly in {which}\n{}",
                names.iter().map(|name| format!("  {name}\n")).collect::<String>()
            ))?;
        }
    }
    if changes.is_empty() {
        return Err(Error::Usage(
            "--baseline: that run and this have no figure in common: give the same scenes and sections".into(),
        ));
    }
    Ok(changes.iter().filter(|change| change.verdict == Verdict::Worse).count())
}
