//! How the variance of a pixel follows from the spread of its blocks, which are not independent of each other.
//!
//! The samples of a pixel are one sequence ([`sobol`](crate::sampling::sobol)), in which every aligned run of `2^k` samples is spread out evenly. Be `V(n)` the
//! variance of the mean of such a run of `n`. The halves `A` and `B` of a run of `2 n` make up for each other, `E[((A - B) / 2)^2] = V(n) - V(2 n)`, and what
//! parts of one half have in common with parts of the other is the same for all of them, since the scrambling does not know which part faces which: the covariance of
//! their means is that of `A` and `B`, `2 V(2 n) - V(n)`. So if it is known how `V` falls, all else follows: which contrasts of blocks are to be expected, and the
//! variance of the mean of any range of samples.
//!
//! Two samples that follow each other, the first with an even number, are left out where there are more: they swap halves in every dimension at once, so that
//! what depends on two pairs of dimensions is often the same for both, and they differ less than two samples should.
//!
//! How `V` falls is found out from the whole picture, which has runs of four lengths in every pixel. It is taken to be `x / n + y / n^2`: what takes more numbers
//! than a pair of dimensions has (the light after bounces, rare samples) is found as by independent samples, and edges and what varies smoothly falls faster. A
//! single power does not fit both, and goes wrong by what it extrapolates.

use super::blocks::{BLOCKS, Blocks};
use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::ops::Range;

/// Lengths of runs of which the halves are compared, at most: those of two, four and eight blocks, and where the samples are on both sides of the middle of a longer
/// run, that one.
pub(super) const LEVELS: usize = 4;

/// How the variance of a pixel's mean falls with the number of its samples, `x / n + y / n^2`: the second summand's share of it with the samples that the pixel has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence(f64);

/// What contrasts of blocks tell of a picture, in sum over some of its pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Observed {
    /// From the longest runs down.
    levels: [Level; LEVELS],
    /// The variance of the mean of all samples of a pixel if both summands were 1 for a run of as many.
    whole: [f64; 2],
}

/// Contrasts of the halves of runs of one length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Level {
    square: f64,
    /// What there would be if one summand were 1 for a run of all samples.
    expected: [f64; 2],
}

impl Observed {
    /// Adds what a pixel shows: [`Spread::squares`], of any unit.
    pub(super) fn add(&mut self, squares: [f64; LEVELS], contrasts: &Contrasts) {
        for ((level, square), expected) in self.levels.iter_mut().zip(squares).zip(contrasts.levels) {
            level.square += square;
            (0..2).for_each(|i| level.expected[i] += expected[i]);
        }
        (0..2).for_each(|i| self.whole[i] += contrasts.summands[i]);
    }

    /// The two summands of the variance of a run of as many samples as a pixel has, which fit best (least squares of relative deviations); none if there is
    /// nothing to fit.
    fn fit(&self) -> Option<[f64; 2]> {
        // Of the equations `x expected[0] + y expected[1] = square`, each divided by its right side.
        let rows = self.levels.iter().filter(|level| level.square > 0.0 && level.expected[0] > 0.0);
        let rows: Vec<[f64; 2]> = rows.map(|level| level.expected.map(|expected| expected / level.square)).collect();
        let dot = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
        let sum = |i: usize| rows.iter().map(|row| row[i]).sum::<f64>();
        let alone = |i: usize| sum(i) / dot(i, i);
        let determinant = dot(0, 0) * dot(1, 1) - dot(0, 1).powi(2);
        let x = (sum(0) * dot(1, 1) - sum(1) * dot(0, 1)) / determinant;
        let y = (sum(1) * dot(0, 0) - sum(0) * dot(0, 1)) / determinant;
        match rows.len() {
            0 => None,
            // Runs of one length do not tell how the variance falls.
            1 => Some([alone(0), 0.0]),
            _ if y <= 0.0 => Some([alone(0), 0.0]),
            // Two tell it badly: half way between that and nothing.
            2 => Some([0.5 * (x.max(0.0) + alone(0)), 0.5 * if x > 0.0 { y } else { alone(1) }]),
            _ if x <= 0.0 => Some([0.0, alone(1)]),
            _ => Some([x, y]),
        }
    }

    /// The variance of a pixel's mean, averaged over the pixels that were added, in their unit.
    pub(super) fn variance(&self) -> Option<f64> {
        // Every pixel adds 1 to the first.
        self.fit().map(|[x, y]| x + y * self.whole[1] / self.whole[0])
    }

    /// How the variance falls.
    pub(super) fn convergence(&self) -> Convergence {
        self.fit().map_or(Convergence::INDEPENDENT, |[x, y]| Convergence(y / (x + y)))
    }
}

impl Convergence {
    /// Of independent samples.
    pub const INDEPENDENT: Self = Convergence(0.0);

    /// Of the second summand alone.
    const REGULAR: Self = Convergence(1.0);

    /// The exponent `a` of the variance's fall where it is now, as `n^-a`: from 1 to 2.
    pub fn exponent(self) -> f64 {
        1.0 + self.0
    }
}

/// The variance of a pixel with so many samples, over that of the mean of a run of as many.
#[derive(Debug, Clone, Copy)]
struct Variance {
    convergence: Convergence,
    samples: f64,
}

impl Variance {
    /// Of the mean of an aligned run of `2^log` samples.
    fn of_run(self, log: u32) -> f64 {
        let fewer = self.samples / f64::from(log).exp2();
        let regular = self.convergence.0;
        (1.0 - regular) * fewer + regular * fewer * fewer
    }

    /// Of two parts of such a run, one in each half of it: the covariance of their means.
    fn of_halves(self, log: u32) -> f64 {
        2.0 * self.of_run(log) - self.of_run(log - 1)
    }

    /// Of the mean of a range of samples.
    fn of_range(self, samples: &Range<u32>) -> f64 {
        let log = run_around(samples);
        if samples.len() as u64 == 1 << log {
            return self.of_run(log);
        }
        let [left, right] = halves(samples, log);
        let [a, b] = [&left, &right].map(|half| half.len() as f64);
        let variance = a * a * self.of_range(&left) + b * b * self.of_range(&right);
        (variance + 2.0 * a * b * self.of_halves(log)) / (a + b).powi(2)
    }
}

/// The logarithm of the length of the smallest aligned run that holds these samples, at least one.
fn run_around(samples: &Range<u32>) -> u32 {
    u32::BITS - (samples.start ^ (samples.end - 1)).leading_zeros()
}

/// What of the samples is in each half of the smallest run around them, of this logarithm.
fn halves(samples: &Range<u32>, log: u32) -> [Range<u32>; 2] {
    let middle = (samples.end - 1) >> (log - 1) << (log - 1);
    [samples.start..middle, middle..samples.end]
}

/// Two ranges of blocks, the halves of a run as far as it was rendered.
#[derive(Debug, Clone, PartialEq)]
struct Contrast {
    left: Range<usize>,
    right: Range<usize>,
    /// Which of [`Spread::squares`] it belongs to; none if it tells nothing of the variance.
    level: Option<usize>,
    /// Its square to be expected, over the variance of the mean of a run of as many samples as there are.
    expected: f64,
}

/// The contrasts in which the blocks of a pixel differ from each other: one fewer than there are blocks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contrasts {
    contrasts: Vec<Contrast>,
    /// The variance of the mean of all samples, over that of a run of as many.
    whole: f64,
    /// The same for each summand alone.
    summands: [f64; 2],
    /// What squares to expect, in the mean of each level, for each summand alone; 0 where there is no contrast.
    levels: [[f64; 2]; LEVELS],
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
    /// The same as `naive`, from each level of contrasts alone, the longest runs first; none if all samples of one are left out.
    pub squares: Option<[f64; LEVELS]>,
}

impl Contrasts {
    /// Those of the blocks of these samples.
    pub(super) fn new(samples: Range<u32>, convergence: Convergence) -> Self {
        let blocks = Blocks::of(samples.clone());
        let all = samples.len() as f64;
        let model = |convergence| Variance { convergence, samples: all };
        let whole = |convergence| if samples.is_empty() { 1.0 } else { model(convergence).of_range(&samples) };
        // What of a run is rendered, in halves.
        let mut found: Vec<(u32, [Range<u32>; 2])> = vec![];
        let mut left_over = vec![samples.clone()];
        while let Some(range) = left_over.pop() {
            if !range.is_empty() && blocks.place(range.start) < blocks.place(range.end - 1) {
                let log = run_around(&range);
                let both = halves(&range, log);
                left_over.extend(both.clone());
                found.push((log, both));
            }
        }
        // Neither single samples nor a little of a block tell anything, where there are others.
        let tells = |(log, [left, right]): &(u32, [Range<u32>; 2])| {
            *log > 1 && left.len().min(right.len()) as u32 * 2 >= blocks.length()
        };
        let some_tell = found.iter().any(tells);
        let tells = |contrast: &(u32, [Range<u32>; 2])| !some_tell || tells(contrast);
        // The longest runs first.
        let logs: BTreeSet<Reverse<u32>> =
            found.iter().filter(|contrast| tells(contrast)).map(|(log, _)| Reverse(*log)).collect();
        let rank = |log: u32| logs.iter().take_while(|longer| longer.0 > log).count();
        let expected = |log: u32, [left, right]: &[Range<u32>; 2], convergence| {
            let model = model(convergence);
            let [a, b] = [left, right].map(|half| half.len() as f64);
            (model.of_range(left) + model.of_range(right) - 2.0 * model.of_halves(log)) * a * b / (a + b) / all
        };
        let (mut levels, mut counts) = ([[0.0; 2]; LEVELS], [0.0; LEVELS]);
        let contrasts = found.iter().map(|contrast| {
            let (log, [left, right]) = contrast;
            let level = tells(contrast).then(|| rank(*log));
            if let Some(level) = level {
                counts[level] += 1.0;
                for (i, summand) in [Convergence::INDEPENDENT, Convergence::REGULAR].into_iter().enumerate() {
                    levels[level][i] += expected(*log, &contrast.1, summand);
                }
            }
            let places = |half: &Range<u32>| blocks.place(half.start)..blocks.place(half.end - 1) + 1;
            let expected = expected(*log, &contrast.1, convergence);
            Contrast { left: places(left), right: places(right), level, expected }
        });
        let contrasts = contrasts.collect();
        for (level, count) in levels.iter_mut().zip(counts).filter(|(_, count)| *count > 0.0) {
            level.iter_mut().for_each(|expected| *expected /= count);
        }
        let summands = [Convergence::INDEPENDENT, Convergence::REGULAR].map(whole);
        Contrasts { contrasts, whole: whole(convergence), summands, levels }
    }

    /// What blocks of so many finite samples with these sums tell; none if fewer than two have any.
    pub(super) fn spread(&self, samples: [f64; BLOCKS], sums: [f64; BLOCKS]) -> Option<Spread> {
        let of = |places: &Range<usize>| {
            let add = |values: &[f64; BLOCKS]| values[places.clone()].iter().sum::<f64>();
            (add(&samples), add(&sums))
        };
        let all: f64 = samples.iter().sum();
        let (mut naive, mut count) = (0.0, 0.0);
        let (mut variance, mut told) = (0.0, 0.0);
        let (mut squares, mut counts) = ([0.0; LEVELS], [0.0; LEVELS]);
        for Contrast { left, right, level, expected } in &self.contrasts {
            let ((a, left), (b, right)) = (of(left), of(right));
            if a == 0.0 || b == 0.0 {
                continue;
            }
            let square = (left / a - right / b).powi(2) * a * b / (a + b) / all;
            naive += square;
            count += 1.0;
            if let Some(level) = *level {
                variance += square / expected;
                told += 1.0;
                squares[level] += square;
                counts[level] += 1.0;
            }
        }
        if count == 0.0 {
            return None;
        }
        let levels = || squares.iter().zip(counts).zip(self.levels);
        let lost = levels().any(|((_, count), [expected, _])| expected > 0.0 && count == 0.0);
        let squares = (!lost).then(|| std::array::from_fn(|level| squares[level] / f64::max(counts[level], 1.0)));
        let naive = naive / count;
        let variance = if told > 0.0 { variance / told * self.whole } else { naive };
        Some(Spread { mean: sums.iter().sum::<f64>() / all, naive, variance, squares })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Sampler, uniform};

    /// Samples on both sides of a large power of two: what is around them is far longer than they are.
    const ACROSS: (u32, u32) = ((1 << 20) - 16, (1 << 20) + 12);

    #[test]
    fn independent_samples_are_those_of_the_text_book() {
        for (first, end) in [(0, 2), (0, 3), (0, 8), (0, 100), (3, 5), (13, 77), (70, 2000), ACROSS] {
            let contrasts = Contrasts::new(first..end, Convergence::INDEPENDENT);
            let blocks = Blocks::of(first..end);
            assert_eq!(contrasts.contrasts.len() + 1, blocks.count());
            assert!((contrasts.whole - 1.0).abs() < 1e-12);
            let samples: [f64; BLOCKS] = std::array::from_fn(|place| blocks.samples(place).len() as f64);
            let sums = std::array::from_fn(|place| samples[place] * (place as f64 * 1.7).sin());
            let spread = contrasts.spread(samples, sums).unwrap();
            let square = |place: usize| match samples[place] {
                0.0 => 0.0,
                n => (sums[place] - n * spread.mean).powi(2) / n,
            };
            let expected = (0..BLOCKS).map(square).sum::<f64>() / (blocks.count() - 1) as f64 / f64::from(end - first);
            assert!((spread.naive / expected - 1.0).abs() < 1e-12);
            // All contrasts tell the same but those of single samples, and of a little of a block.
            if contrasts.contrasts.iter().all(|contrast| contrast.level.is_some()) {
                assert!((spread.variance / expected - 1.0).abs() < 1e-12);
            }
        }
    }

    /// No range has more lengths than there is room for.
    #[test]
    fn any_range_has_contrasts() {
        let starts = [0, 1, 7, 8, 13, 100, (1 << 16) - 9, (1 << 20) - 100, (1 << 31) - 3, u32::MAX - 300];
        for first in starts {
            for samples in (1..300).filter(|samples| first.checked_add(*samples).is_some()) {
                let range = first..first + samples;
                let contrasts = Contrasts::new(range.clone(), Convergence(0.3));
                assert_eq!(contrasts.contrasts.len() + 1, Blocks::of(range.clone()).count());
                assert!(contrasts.whole > 0.0 && contrasts.contrasts.iter().all(|c| c.expected > 0.0), "{range:?}");
            }
        }
    }

    /// A sum of what falls as `1 / n` and what falls as `1 / n^2` is told apart, from any range of samples.
    #[test]
    fn both_summands_are_found_again() {
        for (first, end) in [(0, 16), (0, 100), (64, 128), (13, 77), (3, 40), (70, 1000), ACROSS] {
            for [x, y] in [[1.0, 0.0], [0.7, 0.3], [0.1, 2.0], [0.0, 5.0]] {
                let contrasts = Contrasts::new(first..end, Convergence::INDEPENDENT);
                let squares = contrasts.levels.map(|[independent, regular]| x * independent + y * regular);
                let mut observed = Observed::default();
                (0..3).for_each(|_| observed.add(squares.map(|square| 2.0 * square), &contrasts));
                let expected = 2.0 * (x + y * contrasts.summands[1]);
                let found = observed.variance().unwrap();
                assert!((found / expected - 1.0).abs() < 1e-9, "{first}..{end}, {x}, {y}: {found}, {contrasts:?}");
                assert!((observed.convergence().exponent() - 1.0 - y / (x + y)).abs() < 1e-9);
            }
        }
        assert_eq!(
            (Observed::default().variance(), Observed::default().convergence()),
            (None, Convergence::INDEPENDENT)
        );
    }

    /// The estimate against the truth, for integrands of which the integral is known, by the numbers that pictures are made of: of 20 000 pixels, the mean
    /// square of the error. They fall as 1 / n, n^-1.5 and faster. Ranges that are no power of two, and that do not begin at 0, too.
    #[test]
    fn the_error_of_a_sequence_is_that_of_its_integral() {
        const PIXELS: u32 = 20_000;
        // What the estimate may be over the truth, from 16 samples on, and from fewer.
        type Integrand = (&'static str, f64, fn([f64; 4]) -> f64, [(f64, f64); 2]);
        let integrands: [Integrand; 4] = [
            (
                "two pairs",
                0.25,
                |[x, _, u, _]| 0.5 * f64::from(u8::from((x < 0.5) != (u < 0.5))),
                [(0.95, 1.05), (0.95, 1.05)],
            ),
            ("half plane", 0.25, |[x, y, ..]| f64::from(u8::from(2.0 * x + y < 1.0)), [(0.8, 2.2), (0.8, 3.5)]),
            ("product", 0.25, |[x, y, ..]| x * y, [(0.65, 5.0), (0.8, 9.0)]),
            ("both", 0.5, |[x, y, u, _]| f64::from(u8::from(2.0 * x + y < 1.0)) + x * u, [(0.8, 1.8), (0.8, 3.0)]),
        ];
        let ranges = [(0, 4), (0, 8), (0, 16), (0, 64), (0, 96), (0, 100), (64, 128), (24, 88)];
        for (name, integral, f, bounds) in integrands {
            for sampler in [Sampler::Sobol, Sampler::Independent] {
                for (first, end) in ranges {
                    let blocks = Blocks::of(first..end);
                    let samples: [f64; BLOCKS] = std::array::from_fn(|place| blocks.samples(place).len() as f64);
                    let pixels: Vec<[f64; BLOCKS]> = (0..PIXELS)
                        .map(|pixel| {
                            let value = |sample| f(sampler.numbers(pixel, sample, 2, 7).map(uniform));
                            std::array::from_fn(|place| blocks.samples(place).map(value).sum())
                        })
                        .collect();
                    let contrasts = Contrasts::new(first..end, Convergence::INDEPENDENT);
                    let mut observed = Observed::default();
                    let (mut truth, mut naive) = (0.0, 0.0);
                    for sums in &pixels {
                        let spread = contrasts.spread(samples, *sums).unwrap();
                        observed.add(spread.squares.unwrap(), &contrasts);
                        truth += (spread.mean - integral).powi(2) / f64::from(PIXELS);
                        naive += spread.naive / f64::from(PIXELS);
                    }
                    let contrasts = Contrasts::new(first..end, observed.convergence());
                    let own = pixels.iter().map(|sums| contrasts.spread(samples, *sums).unwrap().variance);
                    let ratio = own.sum::<f64>() / f64::from(PIXELS) / truth;
                    println!(
                        "{name}, {sampler:?}, {first}..{end}: {ratio:.3}, by the picture {:.3}, naive {:.2}, exponent {:.2}",
                        observed.variance().unwrap() / truth,
                        naive / truth,
                        observed.convergence().exponent()
                    );
                    let (low, high) = match sampler {
                        Sampler::Sobol => bounds[usize::from(end < 16)],
                        Sampler::Independent => (0.95, 1.05),
                    };
                    assert!((low..high).contains(&ratio), "{name}, {sampler:?}, {first}..{end}: {ratio}");
                }
            }
        }
    }
}
