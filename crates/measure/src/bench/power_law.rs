//! A power law fitted to points: with which exponent a cost grows.

use crate::chart::{Point, Series};

/// `y = factor * x^exponent`, fitted by least squares to the logarithms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    /// What `x = 1` gives.
    pub factor: f64,
    /// The exponent.
    pub exponent: f64,
    /// Its standard error, from how far the points lie off the line; none for two points.
    pub error: Option<f64>,
}

impl PowerLaw {
    /// The law of some points. Those that have no logarithm are left out; none if fewer than two different `x` are left.
    pub fn fit(points: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let usable = |&(x, y): &(f64, f64)| x > 0.0 && y > 0.0 && x.is_finite() && y.is_finite();
        let logs: Vec<(f64, f64)> = points.into_iter().filter(usable).map(|(x, y)| (x.ln(), y.ln())).collect();
        let n = logs.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
        if logs.len() < 2 || spread <= 1e-12 {
            return None;
        }
        let exponent = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
        let off: f64 = logs.iter().map(|p| (p.1 - y - exponent * (p.0 - x)).powi(2)).sum();
        let error = (logs.len() > 2).then(|| (off / (n - 2.0) / spread).sqrt());
        Some(PowerLaw { factor: (y - exponent * x).exp(), exponent, error })
    }
}

impl std::fmt::Display for PowerLaw {
    /// The exponent with its standard error: `0.52 +- 0.03`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // No `-0.00`.
        let exponent = (100.0 * self.exponent).round() / 100.0 + 0.0;
        write!(f, "{exponent:.2}")?;
        match self.error {
            Some(error) => write!(f, " +- {error:.2}"),
            None => Ok(()),
        }
    }
}

/// The names of lines with the exponents of the power laws through their points.
pub(super) fn with_exponents(series: Vec<Series>) -> Vec<Series> {
    let named = |series: Series| match fit(&series.points) {
        Some(law) => Series { name: format!("{}: exponent {law}", series.name), ..series },
        None => series,
    };
    series.into_iter().map(named).collect()
}

/// The power law through the points of a line.
pub(super) fn fit(points: &[Point]) -> Option<PowerLaw> {
    PowerLaw::fit(points.iter().map(|p| (p.x, p.y)))
}
