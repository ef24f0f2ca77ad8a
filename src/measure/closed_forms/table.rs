//! The table of all cases, its probability, and its chart.

use super::{Case, Measured, measure};
use crate::Result;
use crate::backend::Backend;
use crate::measure::Workbench;
use crate::measure::chart::{Axis, Chart, Point, Series};
use crate::measure::statistics::{Estimate, sidak, two_sided};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

/// Relative rounding of a mean in single precision, which is no error of the estimate: it only matters where nearly nothing is left to chance.
const ROUNDING: f64 = 2e-6;

/// One case, measured by every backend.
#[derive(Debug, Clone)]
pub struct Row {
    /// What was measured.
    pub case: Case,
    /// Mean and standard error, backend by backend.
    pub found: Vec<Estimate>,
}

impl Row {
    /// Whether chance enters: then there is a `z`.
    pub fn by_chance(&self) -> bool {
        matches!(self.case.measured, Measured::Estimated(_))
    }

    /// Deviation over the standard error, less what shape and rounding explain.
    pub fn z(&self, backend: usize) -> f64 {
        let Estimate { mean, error } = self.found[backend];
        let off = mean - self.case.expected;
        let explained = (self.case.slack + ROUNDING) * self.case.expected.abs();
        let unexplained = (off.abs() - explained).max(0.0);
        if unexplained == 0.0 { 0.0 } else { off.signum() * unexplained / error }
    }

    /// Relative deviation, and for a function that is at most 1 the absolute one.
    pub fn deviation(&self, backend: usize) -> f64 {
        let off = self.found[backend].mean - self.case.expected;
        if matches!(self.case.measured, Measured::Reflectance(..)) { off } else { off / self.case.expected }
    }

    /// The bound of [`Row::deviation`] where chance does not enter.
    pub fn bound(&self) -> Option<f64> {
        match self.case.measured {
            Measured::Estimated(_) => None,
            Measured::Certain(_, bound) | Measured::Reflectance(_, _, bound) => Some(bound),
        }
    }
}

/// All cases on all backends.
#[derive(Debug, Clone)]
pub struct Table {
    /// Who measured: the reference first.
    pub backends: Vec<Backend>,
    /// Samples of an easy case.
    pub samples: u32,
    /// Case by case.
    pub rows: Vec<Row>,
}

/// How plausible the whole table is.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Values of `z` that were compared.
    pub count: usize,
    /// The case that is furthest off, and its backend.
    pub furthest: String,
    /// Its `z`.
    pub z: f64,
    /// Probability that the largest of so many is at least as far off (Sidak).
    pub largest: f64,
    /// Probability that the sum of all squares of `z` is at least as large (chi-square): many small errors show here.
    pub squares: f64,
    /// The largest relative standard error, of which case.
    pub blunt: (f64, String),
}

impl Table {
    /// Measures cases on every backend, with `per_pixel` samples for each of 256 pixels (and per effort); `progress` is told each case.
    ///
    /// # Errors
    /// If a backend fails.
    pub fn measure(bench: &Workbench, cases: Vec<Case>, per_pixel: u32, progress: impl Fn(&Row)) -> Result<Self> {
        let backends = bench.backends();
        let mut rows = Vec::new();
        let mut seed = 0;
        for case in cases {
            let mut found = Vec::new();
            for &backend in &backends {
                // Every value has its own random numbers: all are independent.
                seed += 1;
                found.push(measure(bench, &case, backend, seed, per_pixel)?);
            }
            rows.push(Row { case, found });
            progress(rows.last().expect("one was pushed"));
        }
        Ok(Table { backends, samples: per_pixel * super::SIDE * super::SIDE, rows })
    }

    fn values(&self) -> impl Iterator<Item = (&Row, usize)> {
        self.rows.iter().filter(|row| row.by_chance()).flat_map(|row| (0..self.backends.len()).map(move |b| (row, b)))
    }

    /// How plausible it is, were there no error but chance.
    pub fn verdict(&self) -> Verdict {
        let name = |(row, backend): &(&Row, usize)| format!("{}, {}", row.case.name, self.backends[*backend]);
        let count = self.values().count();
        let z = |(row, backend): &(&Row, usize)| row.z(*backend);
        let sharpness = |(row, backend): &(&Row, usize)| row.found[*backend].error / row.case.expected.abs();
        let furthest = self.values().max_by(|a, b| z(a).abs().total_cmp(&z(b).abs()));
        let blunt = self.values().max_by(|a, b| sharpness(a).total_cmp(&sharpness(b)));
        let squares: f64 = self.values().map(|value| z(&value).powi(2)).sum();
        let largest = furthest.map_or(0.0, |value| z(&value));
        Verdict {
            count,
            furthest: furthest.map(|value| name(&value)).unwrap_or_default(),
            z: largest,
            largest: sidak(two_sided(largest), count),
            squares: ChiSquared::new(count as f64).map_or(1.0, |distribution| distribution.sf(squares)),
            blunt: blunt.map(|value| (sharpness(&value), name(&value))).unwrap_or_default(),
        }
    }

    /// Deviations that rounding does not explain, where chance does not enter.
    pub fn beyond_rounding(&self) -> Vec<String> {
        let mut beyond = Vec::new();
        for row in &self.rows {
            let Some(bound) = row.bound() else { continue };
            for (index, backend) in self.backends.iter().enumerate() {
                let deviation = row.deviation(index);
                // Not a number is beyond, too.
                if deviation.is_nan() || deviation.abs() > bound {
                    beyond.push(format!("{}, {backend}: off by {deviation:.1e}, at most {bound:.0e}", row.case.name));
                }
            }
        }
        beyond
    }

    /// The table in Markdown, subject by subject: where chance enters, and where it does not.
    pub fn markdown(&self) -> String {
        let mut text = String::from("| case | formula | expected |");
        for backend in &self.backends {
            text += &format!(" {} | z |", name(*backend));
        }
        text += &format!("\n|---|---|---|{}\n", "---|---|".repeat(self.backends.len()));
        let mut subject = "";
        for row in self.rows.iter().filter(|row| row.by_chance()) {
            if row.case.subject != subject {
                subject = row.case.subject;
                text += &format!("| **{subject}** | | |{}\n", " | |".repeat(self.backends.len()));
            }
            let least = row.found.iter().map(|estimate| estimate.error).fold(f64::INFINITY, f64::min);
            let digits = decimals(least);
            text += &format!("| {} | {} | {:.digits$} |", row.case.name, row.case.formula, row.case.expected);
            for (index, estimate) in row.found.iter().enumerate() {
                text += &format!(" {} | {:+.1} |", with_error(*estimate), row.z(index));
            }
            text += "\n";
        }
        text
    }

    /// The table of what chance does not enter, in Markdown.
    pub fn markdown_without_chance(&self) -> String {
        let mut text = String::from("| case | formula | expected |");
        for backend in &self.backends {
            text += &format!(" {}: off by |", name(*backend));
        }
        text += &format!(" bound |\n|---|---|---|{}---|\n", "---|".repeat(self.backends.len()));
        for row in &self.rows {
            let Some(bound) = row.bound() else { continue };
            text += &format!("| {} | {} | {:.6e} |", row.case.name, row.case.formula, row.case.expected);
            (0..self.backends.len()).for_each(|index| text += &format!(" {:.0e} |", row.deviation(index).abs()));
            text += &format!(" {bound:.0e} |\n");
        }
        text
    }

    /// Every `z` in the order of the table, between the bounds of one value and of the whole family (1 in 20).
    pub fn chart(&self) -> Chart {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.by_chance()).collect();
        let point = |x: usize, y: f64| Point { x: x as f64, y, error: None };
        let mut series: Vec<Series> = self
            .backends
            .iter()
            .enumerate()
            .map(|(index, backend)| Series {
                name: name(*backend).into(),
                points: rows.iter().enumerate().map(|(x, row)| point(x + 1, row.z(index))).collect(),
            })
            .collect();
        let count = rows.len() * self.backends.len();
        // Of so many values the largest stays below this in 19 of 20 right programs.
        let one = -f64::exp_m1((-0.05f64).ln_1p() / count.max(1) as f64);
        let family = Normal::standard().inverse_cdf(1.0 - 0.5 * one);
        for (name, bound) in [("2 standard errors", 2.0), ("1 in 20 for the largest of all", family)] {
            for sign in [1.0, -1.0] {
                let name = format!("{}{name}", if sign > 0.0 { "+ " } else { "- " });
                let points = vec![point(0, sign * bound), point(rows.len() + 1, sign * bound)];
                series.push(Series { name, points });
            }
        }
        Chart {
            name: "closed-forms".into(),
            title: "Closed forms: deviation over standard error".into(),
            x: Axis::linear("case, in the order of the table"),
            y: Axis::linear("z"),
            series,
        }
    }
}

/// A backend as the columns have it.
fn name(backend: Backend) -> &'static str {
    match backend {
        Backend::Cpu => "reference (f64)",
        Backend::RayQuery => "ray query",
        Backend::ComputeBvh => "compute BVH",
    }
}

/// Decimals that show two digits of an error.
fn decimals(error: f64) -> usize {
    if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize } else { 6 }
}

/// A mean with its standard error in units of the last digit: 0.2003(12).
fn with_error(Estimate { mean, error }: Estimate) -> String {
    let digits = decimals(error);
    format!("{mean:.digits$}({:.0})", error * 10f64.powi(digits as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_in_units_of_the_last_digit() {
        assert_eq!(with_error(Estimate { mean: 0.20034, error: 0.0012 }), "0.2003(12)");
        assert_eq!(with_error(Estimate { mean: 19.98, error: 0.25 }), "19.98(25)");
        assert_eq!(with_error(Estimate { mean: 1.0, error: 0.0 }), "1.000000(0)");
    }
}
