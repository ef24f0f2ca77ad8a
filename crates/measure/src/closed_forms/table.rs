//! The table of all cases, its probability, and its chart.

use super::{Case, Measured, measure};
use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::statistics::{Estimate, sidak, two_sided};
use luminaire::Result;
use luminaire::backend::Backend;
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
        // A mean that is no number is not explained.
        if off.abs() <= explained { 0.0 } else { off.signum() * (off.abs() - explained) / error }
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

    /// Every `z`, sorted, over what is expected of a normal variable of that rank: without any error but chance the points lie on the diagonal.
    /// With the bounds of one value (1 in 22) and of the whole family (1 in 20).
    pub fn chart(&self) -> Chart {
        let normal = Normal::standard();
        let point = |x: f64, y: f64| Point { x, y, error: None };
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.by_chance()).collect();
        let rank = |i: usize| normal.inverse_cdf((i as f64 + 0.5) / rows.len() as f64);
        let end = rank(0).abs();
        let mut series = vec![Series { name: "chance alone".into(), points: vec![point(-end, -end), point(end, end)] }];
        for (index, backend) in self.backends.iter().enumerate() {
            let mut all: Vec<f64> = rows.iter().map(|row| row.z(index)).collect();
            all.sort_by(f64::total_cmp);
            let points = all.into_iter().enumerate().map(|(i, z)| point(rank(i), z)).collect();
            series.push(Series { name: name(*backend).into(), points });
        }
        let count = rows.len() * self.backends.len();
        // Of so many values the largest stays below this in 19 of 20 right programs.
        let one = -f64::exp_m1(f64::ln_1p(-0.05) / count.max(1) as f64);
        let family = normal.inverse_cdf(1.0 - 0.5 * one);
        for (bound, meaning) in [(2.0, ""), (family, ": any beyond, 1 in 20")] {
            for bound in [bound, -bound] {
                let points = vec![point(-end, bound), point(end, bound)];
                series.push(Series { name: format!("{bound:+.1}{meaning}"), points });
            }
        }
        Chart {
            name: "closed-forms".into(),
            title: "Closed forms: deviation over standard error".into(),
            x: Axis::linear("z of the same rank that chance alone is expected to give"),
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
