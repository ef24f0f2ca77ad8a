//! Tests of hypotheses. A `p` is the probability that a right program gives a result at least as far off.

pub use luminaire_measure::statistics::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Tests fail below this `p`. Seeds are fixed, so a test that passes keeps passing; a right program would fail a test once in
/// ten thousand choices of the seed.
pub const SIGNIFICANCE: f64 = 1e-4;

/// How far the mean of samples that all agree may be off, relative to it.
const ROUNDING: f64 = 1e-5;

/// What tests claim of an estimate.
pub trait Claims {
    /// Fails unless the true mean may be `expected` (two-sided z-test), and the test is sharp: the standard error is at most `resolution`
    /// times the expectation.
    fn assert_is(self, expected: f64, resolution: f64);

    /// The same for a true mean that is only known to lie in an interval.
    fn assert_within(self, low: f64, high: f64, resolution: f64);
}

impl Claims for Estimate {
    fn assert_is(self, expected: f64, resolution: f64) {
        self.assert_within(expected, expected, resolution);
    }

    fn assert_within(self, low: f64, high: f64, resolution: f64) {
        let Estimate { mean, error } = self;
        assert!(error <= resolution * low, "{mean} +- {error} is not sharp enough about [{low}, {high}]");
        // Single precision rounds what has no noise.
        let p = self.p_within(low * (1.0 - ROUNDING), high * (1.0 + ROUNDING));
        assert!(p >= SIGNIFICANCE, "{mean} +- {error}, expected [{low}, {high}]: p = {p:.1e}");
    }
}

/// Fails if the smallest of several independent `p`s is too small for their number (Sidak), and says which.
pub fn assert_plausible(tests: &[(String, f64)]) {
    assert!(tests.iter().all(|(_, p)| !p.is_nan()), "{tests:?}");
    let (name, smallest) = tests.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("some tests");
    let p = sidak(*smallest, tests.len());
    println!("{} tests, the least plausible is {name}: p = {smallest:.1e}, among so many {p:.1e}", tests.len());
    assert!(p >= SIGNIFICANCE, "{name}: p = {smallest:.1e}, among {} tests {p:.1e}", tests.len());
}

/// Counts points in 20 x 20 cells of the unit square.
pub fn count_in_square(points: impl Iterator<Item = (f64, f64)>) -> Vec<u32> {
    let mut counts = vec![0; 400];
    for (x, y) in points {
        assert!((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y), "({x}, {y})");
        counts[((x * 20.0) as usize).min(19) * 20 + ((y * 20.0) as usize).min(19)] += 1;
    }
    counts
}

/// `p` of counts against equal expectations (Pearson).
pub fn chi_square(counts: &[u32]) -> f64 {
    let expected = counts.iter().sum::<u32>() as f64 / counts.len() as f64;
    assert!(expected >= 10.0, "too few samples for a chi-square test");
    let sum: f64 = counts.iter().map(|c| (f64::from(*c) - expected).powi(2) / expected).sum();
    ChiSquared::new(counts.len() as f64 - 1.0).expect("more than one bin").sf(sum)
}

/// `p` of counts against expected counts (Pearson). Cells that expect fewer than ten are put together.
pub fn chi_square_against(counts: &[u32], expected: &[f64]) -> f64 {
    assert_eq!(counts.len(), expected.len());
    let (mut sum, mut cells, mut few) = (0.0, 0.0, (0.0, 0.0));
    let mut cell = |count: f64, expected: f64| {
        sum += (count - expected).powi(2) / expected;
        cells += 1.0;
    };
    for (count, expected) in counts.iter().map(|count| f64::from(*count)).zip(expected) {
        if *expected < 10.0 {
            few = (few.0 + count, few.1 + expected);
        } else {
            cell(count, *expected);
        }
    }
    if few.1 >= 10.0 {
        cell(few.0, few.1);
    } else {
        assert!(few.0 <= few.1 + 30.0, "{} samples where {} are expected", few.0, few.1);
    }
    assert!(cells >= 2.0, "too few samples for a chi-square test");
    ChiSquared::new(cells - 1.0).expect("more than one cell").sf(sum)
}
