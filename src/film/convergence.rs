//! How the variance of a pixel follows from the spread of its blocks, which are not independent of each other.
//!
//! The samples of a pixel are one sequence ([`sobol`](crate::sampling::sobol)), in which every aligned run of `2^k` samples is spread out evenly. Say that the
//! variance `V(n)` of the mean of such a run falls as `n^-a`: `a` is 1 for independent samples, and more for what varies smoothly. The halves `A` and `B` of a run of
//! `2 n` make up for each other, `E[((A - B) / 2)^2] = V(n) - V(2 n)`, and what two runs have in common follows from the smallest run that holds both: their means'
//! covariance is `2 V(2 n) - V(n)`, where that is of `2 n` samples, since in a scrambled sequence no part of one half knows which part of the other half it faces.
//! So from the powers `V` all follows: what contrast of two blocks to expect, and the variance of any range of samples.

use super::blocks::{BLOCKS, Blocks};
use std::ops::Range;

/// By what the variance of a pixel's mean falls when its samples double: `2^a` if it goes as `n^-a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence(f64);

impl Convergence {
    /// Of independent samples.
    pub const INDEPENDENT: Self = Convergence(2.0);

    /// The exponent `a`, from 1 to 3.
    pub fn exponent(self) -> f64 {
        self.0.log2()
    }

    /// From what [`Spread::halves`] has in sum over a picture.
    pub(super) fn of(halves: [f64; 3]) -> Self {
        let [top, below, _] = halves;
        if top > 0.0 { Convergence((below / top).clamp(2.0, 8.0)) } else { Self::INDEPENDENT }
    }

    /// The variance of the mean of an aligned run of `2^log` samples, over that of one sample.
    fn of_run(self, log: u32) -> f64 {
        self.0.powi(-(log as i32))
    }

    /// The covariance of the means of two parts of such a run, one in each half of it.
    fn of_halves(self, log: u32) -> f64 {
        2.0 * self.of_run(log) - self.of_run(log - 1)
    }

    /// The variance of the mean of a range of samples, over that of one sample.
    fn of_range(self, samples: &Range<u32>) -> f64 {
        let log = run_around(samples);
        match halves(samples, log) {
            None => self.of_run(log),
            Some([left, right]) => {
                let [a, b] = [&left, &right].map(|half| half.len() as f64);
                let variance = a * a * self.of_range(&left) + b * b * self.of_range(&right);
                (variance + 2.0 * a * b * self.of_halves(log)) / (a + b).powi(2)
            }
        }
    }
}

/// The logarithm of the length of the smallest aligned run that holds these samples, at least one.
fn run_around(samples: &Range<u32>) -> u32 {
    u32::BITS - (samples.start ^ (samples.end - 1)).leading_zeros()
}

/// What of the samples is in each half of the smallest run around them, of this logarithm; none if they are the whole run.
fn halves(samples: &Range<u32>, log: u32) -> Option<[Range<u32>; 2]> {
    if samples.len() as u64 == 1 << log {
        return None;
    }
    let middle = (samples.end - 1) >> (log - 1) << (log - 1);
    Some([samples.start..middle, middle..samples.end])
}

/// Two ranges of blocks, the halves of a run as far as it was rendered.
#[derive(Debug, Clone, PartialEq)]
struct Contrast {
    left: Range<usize>,
    right: Range<usize>,
    /// The logarithm of the length of the run.
    log: u32,
    /// Whether the run is complete.
    complete: bool,
    /// The square of the difference of their means, over the variance of one sample, times the weight by which it is 1 for independent samples.
    expected: f64,
}

/// The contrasts in which the blocks of a pixel differ from each other: one fewer than there are blocks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contrasts {
    contrasts: Vec<Contrast>,
    /// The variance of the mean of all samples, over that of one sample.
    whole: f64,
    /// The logarithm of the longest complete run among them; 0 if there is none.
    top: u32,
}

/// What the blocks of a pixel tell of one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    /// Mean of all samples.
    pub mean: f64,
    /// The variance of that mean if samples were independent.
    pub naive: f64,
    /// The variance of that mean.
    pub variance: f64,
    /// The mean square of half the difference between the halves of the complete runs: those of the longest ones, of runs half as long, and of a quarter.
    /// Zero where there are none.
    pub halves: [f64; 3],
}

impl Contrasts {
    /// Those of these blocks.
    pub(super) fn new(samples: Range<u32>, convergence: Convergence) -> Self {
        let blocks = Blocks::of(samples.clone());
        let mut contrasts = vec![];
        let mut left_over = vec![samples.clone()];
        while let Some(range) = left_over.pop() {
            if range.is_empty() || blocks.place(range.start) == blocks.place(range.end - 1) {
                continue;
            }
            let log = run_around(&range);
            let middle = (range.end - 1) >> (log - 1) << (log - 1);
            let [left, right] = [range.start..middle, middle..range.end];
            let [a, b] = [&left, &right].map(|half| half.len() as f64);
            let variance =
                convergence.of_range(&left) + convergence.of_range(&right) - 2.0 * convergence.of_halves(log);
            let places = |half: &Range<u32>| blocks.place(half.start)..blocks.place(half.end - 1) + 1;
            contrasts.push(Contrast {
                left: places(&left),
                right: places(&right),
                log,
                complete: range.len() as u64 == 1 << log,
                expected: variance * a * b / (a + b),
            });
            left_over.extend([left, right]);
        }
        let top = contrasts.iter().filter(|contrast| contrast.complete).map(|contrast| contrast.log).max().unwrap_or(0);
        let whole = if samples.is_empty() { 0.0 } else { convergence.of_range(&samples) };
        Contrasts { contrasts, whole, top }
    }

    /// What blocks of so many finite samples with these sums tell; none if fewer than two have any.
    pub(super) fn spread(&self, samples: [f64; BLOCKS], sums: [f64; BLOCKS]) -> Option<Spread> {
        let of = |places: &Range<usize>| {
            let add = |values: &[f64; BLOCKS]| values[places.clone()].iter().sum::<f64>();
            (add(&samples), add(&sums))
        };
        let (mut naive, mut variance, mut count) = (0.0, 0.0, 0.0);
        let (mut halves, mut counts) = ([0.0; 3], [0.0; 3]);
        for Contrast { left, right, log, complete, expected } in &self.contrasts {
            let ((a, left), (b, right)) = (of(left), of(right));
            if a == 0.0 || b == 0.0 {
                continue;
            }
            let square = (left / a - right / b).powi(2);
            let weighted = square * a * b / (a + b);
            count += 1.0;
            naive += weighted;
            variance += weighted / expected;
            let below = (self.top.saturating_sub(*log)) as usize;
            if *complete && below < 3 {
                halves[below] += square / 4.0;
                counts[below] += 1.0;
            }
        }
        if count == 0.0 {
            return None;
        }
        let all: f64 = samples.iter().sum();
        for (half, count) in halves.iter_mut().zip(counts) {
            *half /= f64::max(count, 1.0);
        }
        Some(Spread {
            mean: sums.iter().sum::<f64>() / all,
            naive: naive / (count * all),
            variance: variance / count * self.whole,
            halves,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_samples_are_those_of_the_text_book() {
        for (first, end) in [(0, 2), (0, 3), (0, 8), (0, 100), (3, 5), (13, 77), (70, 2000)] {
            let contrasts = Contrasts::new(first..end, Convergence::INDEPENDENT);
            assert_eq!(contrasts.contrasts.len() + 1, Blocks::of(first..end).count());
            assert!((contrasts.whole * f64::from(end - first) - 1.0).abs() < 1e-12);
            for contrast in &contrasts.contrasts {
                assert!((contrast.expected - 1.0).abs() < 1e-12, "{first}..{end}: {contrast:?}");
            }
            let blocks = Blocks::of(first..end);
            let samples: [f64; BLOCKS] = std::array::from_fn(|place| blocks.samples(place).len() as f64);
            let sums = std::array::from_fn(|place| samples[place] * (place as f64 * 1.7).sin());
            let spread = contrasts.spread(samples, sums).unwrap();
            let square = |place: usize| {
                if samples[place] > 0.0 {
                    (sums[place] - samples[place] * spread.mean).powi(2) / samples[place]
                } else {
                    0.0
                }
            };
            let expected = (0..BLOCKS).map(square).sum::<f64>() / (blocks.count() - 1) as f64 / f64::from(end - first);
            assert!((spread.naive / expected - 1.0).abs() < 1e-12 && (spread.variance / expected - 1.0).abs() < 1e-12);
        }
    }
}
