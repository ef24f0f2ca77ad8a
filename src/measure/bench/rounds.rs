//! The same thing, measured several times.

use super::{Better, Figure};
use crate::measure::chart::Point;
use crate::measure::statistics::Estimate;

/// A value for every round.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rounds(pub Vec<f64>);

impl Rounds {
    /// Median (of an even number the mean of the two in the middle), least and most; NaN for no round.
    pub fn spread(&self) -> [f64; 3] {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => [f64::NAN; 3],
            n => [0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted[0], sorted[n - 1]],
        }
    }

    /// The median.
    pub fn median(&self) -> f64 {
        self.spread()[0]
    }

    /// Every value changed.
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Rounds {
        Rounds(self.0.iter().copied().map(change).collect())
    }

    /// Round by round, this over the other.
    pub fn over(&self, other: &Rounds) -> Rounds {
        Rounds(self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect())
    }

    /// A point of a chart: the median, with the standard error of the mean.
    pub(super) fn point(&self, x: f64) -> Point {
        let error = (self.0.len() > 1).then(|| Estimate::new(self.0.iter().copied()).error);
        Point { x, y: self.median(), error }
    }

    /// What a later run is compared with.
    pub(super) fn figure(&self, name: String, unit: &str, better: Better) -> Figure {
        let [median, least, most] = self.spread();
        Figure { name, unit: unit.into(), median, least, most, rounds: self.0.len(), better }
    }

    /// `1.20 (1.10 to 1.31)`; the median alone for one round.
    pub(super) fn words(&self) -> String {
        let [median, least, most] = self.spread();
        match self.0.len() {
            0 => "-".into(),
            1 => digits(median),
            _ => format!("{} ({} to {})", digits(median), digits(least), digits(most)),
        }
    }
}

/// Three digits; an exponent where there would be many zeros.
pub(super) fn digits(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => "-".into(),
        0.0 => "0".into(),
        size if !(1e-3..1e5).contains(&size) => format!("{value:.1e}"),
        size => format!("{value:.*}", (2 - size.log10().floor() as i32).clamp(0, 5) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_words() {
        assert_eq!(Rounds(vec![3.0, 1.0, 2.0]).spread(), [2.0, 1.0, 3.0]);
        assert_eq!(Rounds(vec![4.0, 1.0]).median(), 2.5);
        assert!(Rounds::default().median().is_nan());
        assert_eq!(Rounds(vec![2.0, 6.0]).over(&Rounds(vec![1.0, 2.0])).0, [2.0, 3.0]);
        assert_eq!(Rounds(vec![1.5, 1.25, 12.0]).words(), "1.50 (1.25 to 12.0)");
        assert_eq!([0.0, 0.001234, 1234.4, 3.2e6, f64::NAN].map(digits), ["0", "0.00123", "1234", "3.2e6", "-"]);
    }
}
