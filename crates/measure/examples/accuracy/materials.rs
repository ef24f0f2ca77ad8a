//! What `scripts/compare-mitsuba.py materials` found: the page shows its table, which is measured where Mitsuba is.

use crate::Texts;
use luminaire_measure::report::table::Table;
use std::error::Error;
use std::path::Path;

/// Where the script writes it, from the repository's root.
const FILE: &str = "docs/accuracy/materials-mitsuba.csv";
/// The columns of the file.
const COLUMNS: [&str; 15] = [
    "material",
    "plugin",
    "taken",
    "R",
    "G",
    "B",
    "R_error",
    "G_error",
    "B_error",
    "tests",
    "largest_z",
    "median_of_largest_z",
    "mean_z2",
    "chi_square_p",
    "p",
];

/// Reads the table.
pub fn read(texts: &mut Texts) -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(Path::new(FILE)).map_err(|e| format!("cannot read {FILE}: {e}"))?;
    let mut lines = text.lines();
    let about = lines.next().and_then(|line| line.strip_prefix("# ")).ok_or(format!("{FILE} does not say of what"))?;
    if lines.next() != Some(COLUMNS.join(",").as_str()) {
        return Err(format!("{FILE}: expected the columns {}", COLUMNS.join(",")).into());
    }
    let mut table = Table::new(["material", "Mitsuba's plugin", "taken", "R", "G", "B", "largest z", "mean z^2", "p"]);
    let mut least = (1.0, "");
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let &[material, plugin, taken, r, g, b, dr, dg, db, _, largest, median, squares, _, p] = &cells[..] else {
            return Err(format!("{FILE}: expected {} cells: {line}", COLUMNS.len()).into());
        };
        let ratio = |mean: &str, error: &str| -> Result<String, std::num::ParseFloatError> {
            Ok(format!("{mean}({:.0})", 1e5 * error.parse::<f64>()?))
        };
        let largest = format!("{largest} ({median})");
        let (r, g, b) = (ratio(r, dr)?, ratio(g, dg)?, ratio(b, db)?);
        table.rows.push([material, plugin, taken, &r, &g, &b, &largest, squares, p].map(String::from).to_vec());
        let number: f64 = p.parse()?;
        if number < least.0 {
            least = (number, material);
        }
    }
    let count = table.rows.len();
    let corrected = 1.0 - (1.0 - least.0).powi(i32::try_from(count)?);
    texts.extend([
        ("materials", table.markdown()),
        ("materials-about", about.to_owned()),
        ("materials-least", format!("{} ({}), corrected for {count} rows {corrected:.3}", least.0, least.1)),
    ]);
    Ok(())
}
