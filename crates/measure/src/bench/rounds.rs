//! The values of a measurement that was repeated in rounds, with their median and spread.

use crate::chart::Point;
use crate::report::words::number;
use crate::statistics::Estimate;
use std::fmt;

/// Rounds in short.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// The value in the middle; of an even number, the mean of the two in the middle.
    pub median: f64,
    /// The least value.
    pub least: f64,
    /// The largest value.
    pub most: f64,
}

impl fmt::Display for Spread {
    /// `1.20 (1.10 to 1.31)`; the number alone where there is only one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Spread { median, least, most } = *self;
        match least == most {
            true => f.write_str(&number(median)),
            false => write!(f, "{} ({} to {})", number(median), number(least), number(most)),
        }
    }
}

/// A value for every round.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rounds(pub Vec<f64>);

impl Rounds {
    /// Median, least and most; NaN for no round.
    pub fn spread(&self) -> Spread {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let [least, .., most] = sorted[..] else {
            let only = sorted.first().copied().unwrap_or(f64::NAN);
            return Spread { median: only, least: only, most: only };
        };
        let median = 0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]);
        Spread { median, least, most }
    }

    /// The median; NaN for no round.
    pub fn median(&self) -> f64 {
        self.spread().median
    }

    /// Mean over the rounds and its standard error, which is NaN for one round.
    pub fn estimate(&self) -> Estimate {
        Estimate::new(self.0.iter().copied())
    }

    /// Every value changed.
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Rounds {
        Rounds(self.0.iter().copied().map(change).collect())
    }

    /// Round by round, this over the other.
    pub fn over(&self, other: &Rounds) -> Rounds {
        Rounds(self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect())
    }

    /// Round by round, this times the other.
    pub fn times(&self, other: &Rounds) -> Rounds {
        Rounds(self.0.iter().zip(&other.0).map(|(a, b)| a * b).collect())
    }

    /// A point of a chart: the median, with the standard error of the mean.
    pub(super) fn point(&self, x: f64) -> Point {
        let error = (self.0.len() > 1).then(|| self.estimate().error);
        Point { x, y: self.median(), error }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_words() {
        let rounds = |values: &[f64]| Rounds(values.to_vec());
        assert_eq!(rounds(&[3.0, 1.0, 2.0]).spread(), Spread { median: 2.0, least: 1.0, most: 3.0 });
        assert_eq!(rounds(&[4.0, 1.0]).median(), 2.5);
        assert!(Rounds::default().median().is_nan());
        assert_eq!(rounds(&[2.0, 6.0]).over(&rounds(&[1.0, 2.0])).0, [2.0, 3.0]);
        assert_eq!(rounds(&[2.0, 6.0]).times(&rounds(&[1.0, 2.0])).0, [2.0, 12.0]);
        assert_eq!(rounds(&[1.5, 1.25, 12.0]).spread().to_string(), "1.50 (1.25 to 12.0)");
        assert_eq!(rounds(&[2.0; 3]).spread().to_string(), "2.00");
        assert_eq!(Rounds::default().spread().to_string(), "- (- to -)");
    }
}
