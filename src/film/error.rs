//! The error bar: how far a picture is from the truth, estimated from the spread of the blocks of its samples.
//!
//! The variance of a pixel's mean follows from the means of its [`Blocks`](super::Blocks), and from how fast errors fall in this picture ([`Convergence`]). Eight
//! numbers estimate a variance badly, and where the light comes in rare bright samples they estimate too little (all of them may have missed it), so a pixel's error
//! is that of its 3 x 3 neighbourhood. Pixels that stand out of theirs by what few blocks hold, *fireflies*, are counted apart: by itself one looks like a
//! small bright object.

use super::Film;
use super::brightness::Brightness;
use super::convergence::{Contrasts, Convergence, Observed};
use super::error_estimate::ErrorEstimate;
use super::pixel_error::{PixelError, relative_squares};
use std::collections::BTreeMap;

/// The truth of 95 % of all values is within so many standard errors: the normal distribution's. Student's t for the 63 contrasts of 9 pixels would be 2.0, but averaged over
/// pixels that differ, the errors are a little large for most of them.
pub const INTERVAL_95: f64 = 1.96;

/// What a promise about the error allows at most for chance, where few pixels hold the error.
const MOST_CARE: f64 = 1.25;

/// So many pixels are worked on at a time, ...
const BAND_PIXELS: usize = 1 << 15;
/// ... but so many rows at least: those above and below are worked out once more.
const LEAST_ROWS: usize = 16;

/// The estimated error of every pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    /// Standard error of the mean of each pixel and channel, rows from the top. The truth is within
    /// [`INTERVAL_95`] times that in 19 of 20 pixels.
    pub standard_error: Vec<[f32; 3]>,
    /// The same relative to the radiance, and to the picture's brightness where it is dark, as [`REL_MSE`](super::REL_MSE) has it: the root mean
    /// square of the channels. NaN where no error can be told: in pixels with too few samples, and everywhere if `total` is none.
    pub relative: Vec<f32>,
    /// Whether the pixel is a firefly, whose error is estimated from its own blocks alone, or has too few finite samples for an estimate.
    pub firefly: Vec<bool>,
    /// The picture as a whole; none if it is black but for its fireflies: what has found no light tells nothing of the light.
    pub total: Option<ErrorEstimate>,
    /// How fast the error falls, which the estimates rest on.
    pub convergence: Convergence,
}

impl Film {
    /// Variance of the mean of a pixel, by channel, from its own samples alone, in a picture that converges as [`ErrorMap::convergence`] says; none if fewer than
    /// two blocks have any.
    pub fn variance(&self, pixel: usize, convergence: Convergence) -> Option<[f64; 3]> {
        let blocks = self.blocks(pixel);
        let contrasts = Contrasts::new(blocks.range(), convergence);
        self.measured(pixel, &contrasts).map(|[r, g, b, _]| [r, g, b].map(|channel| channel.variance))
    }

    /// The estimated error of the picture; none if no pixel has samples in two blocks, or the picture is black but for its fireflies.
    pub fn error(&self) -> Option<ErrorEstimate> {
        self.estimate(|_, _| {})?.0
    }

    /// The estimated squared relative error of every pixel from its own samples alone, fireflies among them; none where [`Film::error`] has none.
    pub(crate) fn own_errors(&self) -> Option<Vec<f64>> {
        let mut errors = Vec::new();
        let square =
            |pixel: &PixelError, brightness| relative_squares(brightness, pixel.own_variance, pixel.radiance) / 3.0;
        let (total, _) = self.estimate(|pixel, brightness| errors.push(square(pixel, brightness)))?;
        total.map(|_| errors)
    }

    /// The estimated error of every pixel; none if no pixel has samples in two blocks.
    pub fn error_map(&self) -> Option<ErrorMap> {
        let (mut standard_error, mut relative, mut firefly) = (Vec::new(), Vec::new(), Vec::new());
        standard_error.reserve_exact(self.pixels());
        relative.reserve_exact(self.pixels());
        firefly.reserve_exact(self.pixels());
        let (total, convergence) = self.estimate(|pixel, brightness| {
            standard_error.push(pixel.variance.map(|variance| variance.sqrt() as f32));
            relative.push(match pixel.known && !brightness.is_black() {
                true => (relative_squares(brightness, pixel.variance, pixel.radiance) / 3.0).sqrt() as f32,
                false => f32::NAN,
            });
            firefly.push(pixel.firefly);
        })?;
        Some(ErrorMap { standard_error, relative, firefly, total, convergence })
    }

    /// Estimates the error of the picture, and gives that of every pixel to `take`, in their order, with the brightness that it is relative to. None
    /// if no pixel has samples in two blocks; within, none if the picture is black but for its fireflies.
    ///
    /// A band of rows at a time: what is worked out on the way takes ten times the memory of the result. Twice over: how bright the picture is without its
    /// fireflies, and how fast its error falls, have to be known first.
    fn estimate(&self, mut take: impl FnMut(&PixelError, Brightness)) -> Option<(Option<ErrorEstimate>, Convergence)> {
        // What is small is so for this picture, whatever the unit of its light.
        let with_fireflies = Brightness::of((0..self.pixels()).flat_map(|pixel| self.mean(pixel))).half_power_mean();
        let (mut unknown, mut relative, mut absolute) = (0u64, Observed::default(), Observed::default());
        let contrasts = self.contrasts(Convergence::INDEPENDENT);
        let plausible = |(samples, pixel): (&u32, PixelError)| {
            unknown += u64::from(!pixel.known);
            if pixel.firefly {
                return None;
            }
            if let Some([absolute_squares, relative_squares]) = pixel.squares {
                absolute.add(absolute_squares, &contrasts[samples]);
                relative.add(relative_squares, &contrasts[samples]);
            }
            Some(pixel.radiance)
        };
        let pixels = self.samples.iter().zip(self.bands(with_fireflies, &contrasts));
        let brightness = Brightness::of(pixels.filter_map(plausible).flatten());
        let convergence = relative.convergence();
        let all = self.pixels() as u64;
        if unknown == all {
            return None;
        }

        let (mut square, mut relative_square, mut left_out, mut counted) = (0.0, 0.0, 0.0, 0u64);
        let (mut naive, mut fourth_power) = (0.0, 0.0);
        for pixel in self.bands(with_fireflies, &self.contrasts(convergence)) {
            take(&pixel, brightness);
            if pixel.firefly {
                left_out += relative_squares(brightness, pixel.own_variance, pixel.expected);
            } else {
                counted += 1;
                square += pixel.own_variance.iter().sum::<f64>();
                let relative = relative_squares(brightness, pixel.own_variance, pixel.radiance);
                relative_square += relative;
                fourth_power += relative * relative;
                naive += relative_squares(brightness, pixel.naive_variance, pixel.radiance);
            }
        }
        let fireflies = all - counted - unknown;
        // As if the error were spread evenly over so many pixels: their squared errors, each with one degree of freedom, make up the true one.
        let even_pixels =
            if fourth_power > 0.0 { relative_square * relative_square / fourth_power } else { f64::INFINITY };
        let care = (2.0 / even_pixels).sqrt().exp().min(MOST_CARE);
        let total = (!brightness.is_black()).then(|| ErrorEstimate {
            // What is bright converges in its own way.
            rmse: (absolute.variance().unwrap_or(square / counted as f64) / 3.0).sqrt(),
            rel_mse: relative_square / (3 * counted) as f64,
            careful_rel_mse: care * (relative_square * naive).sqrt() / (3 * counted) as f64,
            fireflies,
            unknown,
            rel_mse_with_fireflies: (relative_square + left_out) / (3 * (all - unknown)) as f64,
        });
        Some((total, convergence))
    }

    /// The contrasts of the blocks of pixels with so many samples, for every number of samples that a pixel has.
    fn contrasts(&self, convergence: Convergence) -> BTreeMap<u32, Contrasts> {
        let mut contrasts = BTreeMap::new();
        for samples in self.samples.chunk_by(|a, b| a == b).map(|samples| samples[0]) {
            let new = || Contrasts::new(self.first_sample..self.first_sample + samples, convergence);
            contrasts.entry(samples).or_insert_with(new);
        }
        contrasts
    }

    /// The errors of all pixels of a picture of this half-power mean.
    fn bands(&self, half_power_mean: f64, contrasts: &BTreeMap<u32, Contrasts>) -> impl Iterator<Item = PixelError> {
        let height = self.height as usize;
        let rows = (BAND_PIXELS / (self.width as usize).max(1)).max(LEAST_ROWS);
        (0..height)
            .step_by(rows)
            .flat_map(move |top| self.band(top, (top + rows).min(height), half_power_mean, contrasts))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{BLOCKS, Batch, PixelSum, Tile};
    use crate::sampling::{random4, uniform};

    const SIZE: u32 = 64;

    /// Grey pixels of a given radiance whose samples are spread evenly over it times 1 - `spread` to 1 + `spread`.
    fn film(samples: u32, spread: f64, radiance: impl Fn(u32, u32) -> f64) -> Film {
        let mut film = Film::new(SIZE, SIZE).unwrap();
        let tile = Tile { x: 0, y: 0, width: SIZE, height: SIZE };
        for sample in 0..samples {
            let value = |pixel: u32| {
                let random = uniform(random4(pixel, sample, 0, 0)[0]);
                radiance(pixel % SIZE, pixel / SIZE) * (1.0 + spread * (2.0 * random - 1.0))
            };
            let sums: Vec<_> =
                (0..SIZE * SIZE).map(|i| PixelSum { radiance: [value(i); 3], ..Default::default() }).collect();
            film.add(&Batch { tile, samples: sample..sample + 1, group: 1 }, &sums);
        }
        film
    }

    #[test]
    fn the_error_of_even_noise_is_that_of_its_distribution() {
        // 54 samples: six blocks of eight and one of six.
        let (samples, spread) = (54, 0.5);
        let error = film(samples, spread, |_, _| 3.0).error_map().unwrap();
        let total = error.total.unwrap();
        let expected = 3.0 * spread / 3f64.sqrt() / f64::from(samples).sqrt();
        // The half-power mean of an even picture is its radiance.
        let over = (9.0f64 + 1.0).sqrt();
        // From 4096 pixels of six contrasts the variance would be right to 0.9 %; how it falls has to be found out as well, by which it varies by 2 %.
        assert!((total.rmse / expected - 1.0).abs() < 0.03, "{total:?} {expected}");
        assert!((total.relative() / (expected / over) - 1.0).abs() < 0.03, "{total:?} {expected}");
        assert_eq!((total.fireflies, total.unknown), (0, 0));
        let mean: f64 = error.standard_error.iter().map(|e| f64::from(e[1]).powi(2)).sum::<f64>() / 4096.0;
        assert!((mean.sqrt() / expected - 1.0).abs() < 0.03);
        let relative = error.relative.iter().map(|e| f64::from(e * e)).sum::<f64>() / 4096.0;
        assert!((relative.sqrt() * over / expected - 1.0).abs() < 0.03);
    }

    #[test]
    fn a_promise_is_more_careful_where_few_pixels_hold_the_error() {
        let care = |film: &Film| {
            let total = film.error().unwrap();
            total.careful_rel_mse / total.rel_mse
        };
        let even = care(&film(64, 0.5, |_, _| 3.0));
        assert!((1.0..1.1).contains(&even), "{even}");
        // Noise in five pixels, which are not so much brighter that they would be fireflies.
        let noisy = |pixel: usize| pixel % 800 == 7;
        let mut few = film(64, 0.01, |_, _| 3.0);
        for pixel in (0..few.pixels()).filter(|pixel| noisy(*pixel)) {
            let sums = &mut few.sums[pixel];
            (0..BLOCKS)
                .for_each(|block| sums[block] = sums[block].map(|sum| sum * if block % 2 == 0 { 1.5 } else { 0.5 }));
        }
        let few = care(&few);
        assert!((1.2..2.0).contains(&few), "{few}");
    }

    #[test]
    fn bands_do_not_show() {
        let wide = film(16, 0.5, |x, y| if (x * y) % 97 == 3 { 50.0 } else { 1.0 + f64::from(x % 3) });
        let contrasts = wide.contrasts(Convergence::INDEPENDENT);
        let whole = wide.band(0, SIZE as usize, 1.0, &contrasts);
        for (top, bottom) in [(0, 1), (0, 16), (16, 32), (1, 2), (31, 64), (63, 64)] {
            let band = wide.band(top, bottom, 1.0, &contrasts);
            let expected = &whole[top * SIZE as usize..bottom * SIZE as usize];
            assert_eq!(band.len(), expected.len());
            for (found, expected) in band.iter().zip(expected) {
                assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn bright_and_dark_areas_keep_their_own_error() {
        let radiance = |x: u32, _| if x < 32 { 0.001 } else { 1000.0 };
        let error = film(16, 0.5, radiance).error_map().unwrap();
        let total = error.total.unwrap();
        // Away from the border each side has its own.
        assert!(error.standard_error[5][0] < 1e-3 && error.standard_error[60][0] > 10.0);
        let relative = 0.5 / 3f64.sqrt() / 4.0;
        assert!((total.relative() / (relative / 2f64.sqrt()) - 1.0).abs() < 0.03, "{total:?}");
        assert_eq!(total.fireflies, 0);
    }

    #[test]
    fn a_firefly_is_told_apart_and_a_lamp_is_not() {
        let mut film = film(16, 0.5, |x, y| if (x, y) == (40, 40) { 500.0 } else { 1.0 });
        let before = film.error().unwrap();
        assert_eq!(before.fireflies, 0, "a lamp of one pixel, in all blocks");
        let at = 20 * SIZE as usize + 20;
        film.sums[at][2][0] += 5000.0;
        let after = film.error_map().unwrap();
        let total = after.total.unwrap();
        assert_eq!((total.fireflies, total.is_mostly_fireflies()), (1, true));
        assert!(after.firefly[at] && after.standard_error[at][0] > 100.0 && after.relative[at] > 1.0);
        assert_eq!(after.standard_error[at + 1][0], {
            let variance = |j| film.variance(j, after.convergence).unwrap()[0];
            let others = film.around(at + 1).filter(|j| *j != at).map(variance);
            (others.sum::<f64>() / 8.0).sqrt() as f32
        });
        assert!((total.relative() / before.relative() - 1.0).abs() < 0.01);
    }

    /// Beside a lamp the neighbours' mean is the lamp's: a bright sample in a dark pixel there is a firefly by what most neighbours show.
    #[test]
    fn a_firefly_beside_a_lamp_is_told_apart() {
        let mut film = film(64, 0.1, |x, y| if y == 20 && (21..23).contains(&x) { 70.0 } else { 1.0 });
        assert_eq!(film.error().unwrap().fireflies, 0);
        // Two of its eight neighbours are the lamp.
        let at = 21 * SIZE as usize + 21;
        film.sums[at][2] = film.sums[at][2].map(|sum| sum + 64.0 * 9.0);
        let errors = film.error_map().unwrap();
        assert!(errors.firefly[at]);
        assert_eq!(errors.total.unwrap().fireflies, 1);
    }

    /// The same film in another unit of light: the same errors, the same fireflies. Powers of two change no digit.
    #[test]
    fn the_unit_of_light_does_not_show() {
        let mut film = film(16, 1.0, |x, y| match (x / 16, y / 16) {
            (0, _) => 0.0,
            (1, 0) => 1e-4,
            (3, 3) => 300.0,
            _ => 0.02 * f64::from(1 + x % 5),
        });
        for (pixel, radiance) in [(700, 10.0), (1300, 20.0), (2100, 1e4), (3010, 1.0), (3016, 1e-6)] {
            film.sums[pixel][1] = [4.0 * radiance; 3];
        }
        let expected = film.error_map().unwrap();
        let fireflies = expected.firefly.iter().filter(|firefly| **firefly).count();
        assert_eq!(fireflies, 4, "the fifth is not worth a word beside the rest");
        for unit in [1e-6f64, 1e6, 1e-30].map(|unit| unit.log2().round().exp2()) {
            let mut scaled = film.clone();
            scaled.sums.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|sum| *sum *= unit);
            let mut found = scaled.error_map().unwrap();
            let total = found.total.as_mut().unwrap();
            total.rmse /= unit;
            assert_eq!(found.total, expected.total, "in units of {unit}");
            assert_eq!((&found.firefly, &found.relative), (&expected.firefly, &expected.relative), "{unit}");
        }
    }

    #[test]
    fn nothing_is_told_from_one_sample_and_no_error_from_noiseless_samples() {
        assert_eq!(film(1, 0.5, |_, _| 1.0).error(), None);
        // One pixel that has lost all its samples does not take the others' error away.
        let mut lost = film(8, 0.5, |_, _| 1.0);
        (0..BLOCKS).for_each(|block| assert_eq!(lost.dropped.insert((77, block), 1), None));
        let errors = lost.error_map().unwrap();
        let total = errors.total.unwrap();
        assert!(errors.firefly[77] && errors.relative[77].is_nan() && total.rmse > 0.0);
        assert_eq!((total.fireflies, total.unknown), (0, 1));
        assert!(errors.standard_error.iter().flatten().all(|e| e.is_finite()));
        let error = film(8, 0.0, |x, _| f64::from(x)).error().unwrap();
        let nothing = ErrorEstimate {
            rmse: 0.0,
            rel_mse: 0.0,
            careful_rel_mse: 0.0,
            fireflies: 0,
            unknown: 0,
            rel_mse_with_fireflies: 0.0,
        };
        assert_eq!(error, nothing);
    }

    #[test]
    fn a_black_picture_has_no_estimate() {
        let mut black = film(16, 0.5, |_, _| 0.0);
        let errors = black.error_map().unwrap();
        assert_eq!((errors.total, black.error()), (None, None));
        assert!(
            errors.relative.iter().all(|e| e.is_nan()) && errors.standard_error.iter().flatten().all(|e| *e == 0.0)
        );
        // One sample of all has found light: that is no picture yet.
        black.sums[500][2] = [1e-5; 3];
        let errors = black.error_map().unwrap();
        assert!(errors.total.is_none() && errors.firefly[500]);
        // A lamp in the black, in all blocks: what is seen is known.
        black.sums[500] = [[1e-5; 3]; BLOCKS];
        assert_eq!(black.error().map(|error| (error.rel_mse, error.fireflies)), Some((0.0, 0)));
    }
}
