//! The same thing, measured several times.

use super::words::with_spread;
use super::{Better, Figure, spread};
use crate::chart::Point;
use crate::statistics::Estimate;

/// A value for every round.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rounds(pub Vec<f64>);

impl Rounds {
    /// Median (of an even number the mean of the two in the middle), least and most; NaN for no round.
    pub fn spread(&self) -> [f64; 3] {
        spread(&self.0)
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

    /// `1.20 (1.10 to 1.31)`; the median alone where there is nothing between.
    pub(super) fn words(&self) -> String {
        with_spread(self.spread())
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
    }
}
