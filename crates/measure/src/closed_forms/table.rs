//! The table of all cases, its probability, and its chart.

use super::case::{Case, Measured};
use super::measure::measure;
use super::views::SIDE;
use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::report;
use crate::report::words::{decimals, with_error};
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
        if matches!(self.case.measured, Measured::Reflectance { .. }) { off } else { off / self.case.expected }
    }

    /// The bound of [`Row::deviation`] where chance does not enter.
    pub fn bound(&self) -> Option<f64> {
        match self.case.measured {
            Measured::Estimated(_) => None,
            Measured::Certain { bound, .. } | Measured::Reflectance { bound, .. } => Some(bound),
        }
    }

    /// The first three cells of the tables.
    fn cells(&self, expected: String) -> Vec<String> {
        vec![self.case.name.clone(), self.case.formula.into(), expected]
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
    /// The case with the largest relative standard error, and its backend.
    pub bluntest: String,
    /// That error.
    pub bluntest_error: f64,
}

impl Table {
    /// Measures cases on every backend, with `per_pixel` samples for each of 256 pixels (and per effort); `progress` gets each case when it is done.
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
        Ok(Table { backends, samples: per_pixel * SIDE * SIDE, rows })
    }

    fn values(&self) -> impl Iterator<Item = (&Row, usize)> {
        self.rows.iter().filter(|row| row.by_chance()).flat_map(|row| (0..self.backends.len()).map(move |b| (row, b)))
    }

    /// How plausible it is, were there no error but chance.
    pub fn verdict(&self) -> Verdict {
        let name = |(row, backend): &(&Row, usize)| format!("{}, {}", row.case.name, self.backends[*backend]);
        let count = self.values().count();
        let z = |(row, backend): &(&Row, usize)| row.z(*backend);
        let relative_error = |(row, backend): &(&Row, usize)| row.found[*backend].error / row.case.expected.abs();
        let furthest = self.values().max_by(|a, b| z(a).abs().total_cmp(&z(b).abs()));
        let bluntest = self.values().max_by(|a, b| relative_error(a).total_cmp(&relative_error(b)));
        let squares: f64 = self.values().map(|value| z(&value).powi(2)).sum();
        let largest = furthest.map_or(0.0, |value| z(&value));
        Verdict {
            count,
            furthest: furthest.map(|value| name(&value)).unwrap_or_default(),
            z: largest,
            largest: sidak(two_sided(largest), count),
            squares: ChiSquared::new(count as f64).map_or(1.0, |distribution| distribution.sf(squares)),
            bluntest: bluntest.map(|value| name(&value)).unwrap_or_default(),
            bluntest_error: bluntest.map_or(0.0, |value| relative_error(&value)),
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

    /// The cases where chance enters.
    pub fn by_chance(&self) -> report::table::Table {
        let backends = self.backends.iter().flat_map(|backend| [name(*backend), "z"]);
        let columns = ["subject", "case", "formula", "expected"].into_iter().chain(backends);
        let cells = |row: &Row| {
            let least = row.found.iter().map(|estimate| estimate.error).fold(f64::INFINITY, f64::min);
            let digits = decimals(least);
            let mut cells = vec![row.case.subject.to_owned()];
            cells.extend(row.cells(format!("{:.digits$}", row.case.expected)));
            for (index, estimate) in row.found.iter().enumerate() {
                cells.extend([with_error(*estimate), format!("{:+.1}", row.z(index))]);
            }
            cells
        };
        report::table::Table::new(columns).with_rows(self.rows.iter().filter(|row| row.by_chance()).map(cells))
    }

    /// The cases where it does not.
    pub fn without_chance(&self) -> report::table::Table {
        let mut columns = ["case", "formula", "expected"].map(String::from).to_vec();
        columns.extend(self.backends.iter().map(|backend| format!("{}: off by", name(*backend))));
        columns.push("bound".into());
        let cells = |row: &Row| {
            let bound = row.bound()?;
            let mut cells = row.cells(format!("{:.6e}", row.case.expected));
            cells.extend((0..self.backends.len()).map(|index| format!("{:.0e}", row.deviation(index).abs())));
            cells.push(format!("{bound:.0e}"));
            Some(cells)
        };
        report::table::Table::new(columns).with_rows(self.rows.iter().filter_map(cells))
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
