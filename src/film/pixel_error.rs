//! What the blocks of a pixel's samples, and of those around it, tell of its error.

use super::Film;
use super::blocks::BLOCKS;
use super::brightness::Brightness;
use super::convergence::{Contrasts, LEVELS, Spread};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// A pixel is a firefly if few of its blocks hold its radiance: at most three of seven or eight, two of four to six (the variance of the mean, if they were
/// independent, is the mean's square if one of them does; with three of eight and of seven 0.24 and 0.22 of that, with four of eight 0.14, with three of six 0.2) ...
const FIREFLY_VARIANCE: f64 = 0.2;
/// ... and that is so many times its neighbours', by the lower of their mean and their median: beside a lamp the mean is the lamp's, and would hide a bright sample
/// among dark pixels,
const FIREFLY_CONTRAST: f64 = 5.0;
/// or this part of the picture's half-power mean where they are darker.
const FIREFLY_FLOOR: f64 = 1e-3;

/// A pixel's neighbours count by this power of the variance around them, where they say what radiance it should have. By -1 they would have the least variance if they
/// had one radiance; but where it varies, or their variances are badly known, that is mostly too dark, since the dark ones have the least variance. Of -0.6 to -1 this
/// one gave the best estimates in the ten scenes of `docs/accuracy.md`.
const NEIGHBOURS_POWER: f64 = -0.75;

/// A standard error of this part of the picture's half-power mean is none; it keeps weights finite where nothing varies.
const TINY: f64 = 1e-15;

impl Film {
    /// The errors of the rows from `top` to before `bottom` of a picture of this half-power mean.
    pub(super) fn band(
        &self,
        top: usize,
        bottom: usize,
        half_power_mean: f64,
        contrasts: &BTreeMap<u32, Contrasts>,
    ) -> Vec<PixelError> {
        // What is known of a pixel follows from its neighbours, and what is known of those from theirs.
        let rows = |more: usize| {
            let rows = top.saturating_sub(more)..(bottom + more).min(self.height as usize);
            rows.start * self.width as usize..rows.end * self.width as usize
        };
        let brightness = Brightness::from_half_power_mean(half_power_mean);
        let tiny = (TINY * half_power_mean).powi(2).max(f64::MIN_POSITIVE);
        // The fourth "channel" is the mean of the others, by which fireflies are recognised.
        let own = Rows::new(rows(3), |pixel| match self.measured(pixel, &contrasts[&self.samples[pixel]]) {
            Some(channels) => Own { channels, known: true },
            // A pixel without samples in two blocks (because they were not finite, or the render has just begun) has no estimate, and is left out
            // like a firefly.
            None => {
                let [r, g, b] = self.mean(pixel);
                let channels =
                    [r, g, b, (r + g + b) / 3.0].map(|mean| Spread { mean, naive: 0.0, variance: 0.0, squares: None });
                Own { channels, known: false }
            }
        });
        let pooled = Rows::new(rows(2), |pixel| mean_variance(self.around(pixel).map(|j| &own.at(j).channels)));
        // By which fireflies are told: the mean of the others, in which noisy ones count for less.
        let expected = Rows::new(rows(1), |pixel| {
            [0, 1, 2, 3].map(|c| {
                let others = self.around(pixel).filter(|j| *j != pixel).map(|j| {
                    let Spread { mean, variance, .. } = own.at(j).channels[c];
                    (mean, 1.0 / (variance + pooled.at(j)[c] + tiny))
                });
                weighted_mean(others).unwrap_or(own.at(pixel).channels[c].mean)
            })
        });
        let firefly = Rows::new(rows(1), |pixel| {
            let (Own { channels: [.., grey], known }, [.., expected]) = (own.at(pixel), expected.at(pixel));
            let stands_out = |usual: f64| grey.mean > FIREFLY_CONTRAST * (usual + FIREFLY_FLOOR * half_power_mean);
            let others = || self.around(pixel).filter(|j| *j != pixel).map(|j| own.at(j).channels[3].mean);
            !known
                || grey.naive > FIREFLY_VARIANCE * grey.mean * grey.mean
                    && (stands_out(*expected) || median(others().collect()).is_some_and(stands_out))
        });
        // By which the others count, whatever the unit of the light.
        let unit = (half_power_mean * half_power_mean).max(f64::MIN_POSITIVE);
        let certainty = Rows::new(rows(1), |pixel| {
            pooled.at(pixel).map(|variance| ((variance + tiny) / unit).powf(NEIGHBOURS_POWER))
        });
        let pixels = Rows::new(rows(0), |pixel| {
            let Own { channels, known } = own.at(pixel);
            // What the others say about a pixel, without fireflies; where all of them are, as above.
            let expected: [f64; 4] = std::array::from_fn(|c| {
                let others = self.around(pixel).filter(|j| *j != pixel && !firefly.at(*j));
                weighted_mean(others.map(|j| (own.at(j).channels[c].mean, certainty.at(j)[c])))
                    .unwrap_or(expected.at(pixel)[c])
            });
            let alone = *firefly.at(pixel);
            let variance = if alone {
                channels.map(|m| m.variance)
            } else {
                mean_variance(self.around(pixel).filter(|j| !firefly.at(*j)).map(|j| &own.at(j).channels))
            };
            let radiance = std::array::from_fn(|c| plausible(&channels[c], expected[c]));
            // In sum over the channels; absolute, and relative to the radiance.
            let [red, green, blue] = [0, 1, 2].map(|c| channels[c].squares);
            let squares = red.zip(green).zip(blue).map(|((red, green), blue)| {
                let level = |level: usize| [red[level], green[level], blue[level]];
                let absolute = std::array::from_fn(|i| level(i).into_iter().sum());
                [absolute, std::array::from_fn(|i| relative_squares(brightness, level(i), radiance))]
            });
            PixelError {
                variance: colours(variance),
                own_variance: colours(channels.map(|m| m.variance)),
                naive_variance: colours(channels.map(|m| m.naive)),
                radiance,
                squares,
                expected: colours(expected),
                firefly: alone,
                known: *known,
            }
        });
        pixels.values
    }

    /// Mean and variance of a pixel: red, green, blue, and their mean.
    pub(super) fn measured(&self, pixel: usize, contrasts: &Contrasts) -> Option<[Spread; 4]> {
        let samples = self.block_samples(pixel).map(f64::from);
        let [red, green, blue] = [0, 1, 2].map(|c| self.sums[pixel].map(|sum| sum[c]));
        let grey = std::array::from_fn(|block: usize| (red[block] + green[block] + blue[block]) / 3.0);
        let [r, g, b, grey] = [red, green, blue, grey].map(|sums: [f64; BLOCKS]| contrasts.spread(samples, sums));
        Some([r?, g?, b?, grey?])
    }

    /// The pixels of the 3 x 3 neighbourhood, itself among them; fewer at the edges.
    pub(super) fn around(&self, pixel: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.width as usize, self.height as usize);
        let (x, y) = (pixel % width, pixel / width);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        (y.saturating_sub(1)..=(y + 1).min(height - 1)).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }
}

/// A pixel's mean and variance, from its own samples.
struct Own {
    /// Red, green, blue, and their mean.
    channels: [Spread; 4],
    /// Whether the variance could be measured.
    known: bool,
}

/// What is found out about a pixel.
#[derive(Debug, PartialEq)]
pub(super) struct PixelError {
    /// Of the mean, by channel, from the neighbourhood too.
    pub(super) variance: [f64; 3],
    /// From its own samples alone.
    pub(super) own_variance: [f64; 3],
    /// The same if samples were independent.
    pub(super) naive_variance: [f64; 3],
    /// As far as it is known ([`plausible`]).
    pub(super) radiance: [f64; 3],
    /// The radiance that its neighbours lead to expect.
    pub(super) expected: [f64; 3],
    /// [`Spread::squares`] in sum over the channels, and the same relative to the radiance.
    pub(super) squares: Option<[[f64; LEVELS]; 2]>,
    pub(super) firefly: bool,
    /// Whether its variance could be measured.
    pub(super) known: bool,
}

/// A value for every pixel of some rows of a film.
struct Rows<T> {
    /// Indices of the pixels.
    pixels: Range<usize>,
    values: Vec<T>,
}

impl<T: Send> Rows<T> {
    /// The values that `of` has for the pixels of these indices.
    fn new(pixels: Range<usize>, of: impl Fn(usize) -> T + Send + Sync) -> Self {
        Rows { values: pixels.clone().into_par_iter().map(of).collect(), pixels }
    }

    /// The value of a pixel of these rows.
    fn at(&self, pixel: usize) -> &T {
        &self.values[pixel - self.pixels.start]
    }
}

/// The radiance as far as it is known: the pixel's own where it is sure of it, towards its neighbours' where it is not (James and
/// Stein's shrinking). An error measured against the pixel's own radiance would be too small wherever that is too large by chance.
fn plausible(own: &Spread, expected: f64) -> f64 {
    let off = own.mean - expected;
    let sure = if off == 0.0 { 0.0 } else { (1.0 - own.variance / (off * off)).max(0.0) };
    // What is no firefly is not taken to be more than three times too bright.
    (expected + sure * off).max(own.mean / 3.0)
}

/// The mean of some values, each with its weight; none if nothing weighs anything.
fn weighted_mean(values: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (value, weight) in values {
        sum += weight * value;
        weights += weight;
    }
    (weights > 0.0).then(|| sum / weights)
}

/// The median of some values, the mean of the middle two where they are even in number; none if there are none.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let lower = values.len().checked_sub(1)? / 2;
    Some(0.5 * (values[lower] + values[values.len() / 2]))
}

/// The three that are colours of four.
fn colours([r, g, b, _]: [f64; 4]) -> [f64; 3] {
    [r, g, b]
}

/// The variances relative to the squared radiances, added up over the channels.
pub(super) fn relative_squares(brightness: Brightness, variance: [f64; 3], radiance: [f64; 3]) -> f64 {
    variance
        .iter()
        .zip(radiance)
        .map(|(variance, radiance)| brightness.relative_square(variance.sqrt(), radiance))
        .sum()
}

/// Mean of the variances of some pixels, by channel.
fn mean_variance<'a>(pixels: impl Iterator<Item = &'a [Spread; 4]>) -> [f64; 4] {
    let (mut sum, mut n) = ([0.0; 4], 0.0);
    for pixel in pixels {
        (0..4).for_each(|c| sum[c] += pixel[c].variance);
        n += 1.0;
    }
    sum.map(|sum| sum / n)
}
