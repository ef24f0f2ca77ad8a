//! The error bar: how far a picture is from the truth, estimated from the spread of the independent parts of its samples.
//!
//! The variance of a pixel's mean follows from the means of its [`PARTS`](crate::sampling::PARTS) parts. Four numbers estimate a variance
//! badly, and where the light comes in rare bright samples they estimate too little (all of them may have missed it), so a pixel's error
//! is that of its 3 x 3 neighbourhood. Pixels that stand out of theirs by what few parts hold, *fireflies*, are counted apart: by itself one looks like a
//! small bright object.

use super::Film;
use super::brightness::Brightness;
use super::error_estimate::ErrorEstimate;
use rayon::prelude::*;

/// The truth of 95 % of all values is within so many standard errors: Student's t for 27 degrees of freedom, 3 of each of 9 pixels.
pub const INTERVAL_95: f64 = 2.052;

/// A pixel is a firefly if at most two of its four parts hold its radiance (the variance of the mean is the mean's square if one of them does,
/// a third of it if two do, a ninth if three do) ...
const FIREFLY_VARIANCE: f64 = 1.0 / 6.0;
/// ... and that is so many times its neighbours',
const FIREFLY_CONTRAST: f64 = 5.0;
/// or this part of the picture's half-power mean where they are darker.
const FIREFLY_FLOOR: f64 = 1e-3;

/// A standard error of this part of the picture's half-power mean is none; it keeps weights finite where nothing varies.
const TINY: f64 = 1e-15;

/// The estimated error of every pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    /// Standard error of the mean of each pixel and channel, rows from the top. The truth is within
    /// [`INTERVAL_95`] times that in 19 of 20 pixels.
    pub standard_error: Vec<[f32; 3]>,
    /// The same relative to the radiance, and to the picture's brightness where it is dark, as [`REL_MSE`](super::REL_MSE) has it: the root mean
    /// square of the channels. NaN where no error can be told: in pixels with too few samples, and everywhere if `total` is none.
    pub relative: Vec<f32>,
    /// Whether the pixel is a firefly, whose error is estimated from its own parts alone, or has too few finite samples for an estimate.
    pub firefly: Vec<bool>,
    /// The picture as a whole; none if it is black but for its fireflies: what has found no light tells nothing of the light.
    pub total: Option<ErrorEstimate>,
}

impl Film {
    /// Variance of the mean of a pixel, by channel, from its own samples alone; none if fewer than two parts have any.
    pub fn variance(&self, pixel: usize) -> Option<[f64; 3]> {
        self.measured(pixel).map(|[r, g, b, _]| [r, g, b].map(|channel| channel.variance))
    }

    /// The estimated error of the picture; none if no pixel has samples in two parts, or the picture is black but for its fireflies.
    pub fn error(&self) -> Option<ErrorEstimate> {
        self.error_map()?.total
    }

    /// The estimated error of every pixel; none if no pixel has samples in two parts.
    pub fn error_map(&self) -> Option<ErrorMap> {
        // The fourth "channel" is the mean of the others, by which fireflies are recognised.
        let measured: Vec<Option<[Measured; 4]>> =
            (0..self.pixels()).into_par_iter().map(|pixel| self.measured(pixel)).collect();
        if measured.iter().all(Option::is_none) {
            return None;
        }
        // A pixel without samples in two parts (because they were not finite, or the render has just begun) has no estimate, and is left out
        // like a firefly.
        let unknown = |pixel: usize| {
            let [r, g, b] = self.mean(pixel);
            [r, g, b, (r + g + b) / 3.0].map(|mean| Measured { mean, variance: 0.0 })
        };
        let own: Vec<[Measured; 4]> =
            measured.iter().enumerate().map(|(pixel, measured)| measured.unwrap_or_else(|| unknown(pixel))).collect();
        // What is small is so for this picture, whatever the unit of its light.
        let half_power_mean = Brightness::of(own.iter().flat_map(colours).map(|m| m.mean)).half_power_mean();
        let tiny = (TINY * half_power_mean).powi(2).max(f64::MIN_POSITIVE);
        let map = |f: &(dyn Fn(usize) -> [f64; 4] + Sync)| -> Vec<[f64; 4]> {
            (0..own.len()).into_par_iter().map(f).collect()
        };
        let pooled = map(&|pixel| mean_variance(self.around(pixel).map(|j| &own[j])));
        // What the others say about a pixel: their mean, in which noisy ones count for less.
        let expected = map(&|pixel| {
            [0, 1, 2, 3].map(|c| {
                let (mut sum, mut weights) = (0.0, 0.0);
                for j in self.around(pixel).filter(|j| *j != pixel) {
                    let weight = 1.0 / (own[j][c].variance + pooled[j][c] + tiny);
                    sum += weight * own[j][c].mean;
                    weights += weight;
                }
                if weights > 0.0 { sum / weights } else { own[pixel][c].mean }
            })
        });
        let firefly: Vec<bool> = (own.iter().zip(&expected).zip(&measured))
            .map(|(([.., grey], [.., expected]), measured)| {
                measured.is_none()
                    || grey.variance > FIREFLY_VARIANCE * grey.mean * grey.mean
                        && grey.mean > FIREFLY_CONTRAST * (expected + FIREFLY_FLOOR * half_power_mean)
            })
            .collect();

        let plausible =
            |pixel: usize| -> [f64; 3] { std::array::from_fn(|c| own[pixel][c].plausible(expected[pixel][c])) };
        let brightness = Brightness::of((0..own.len()).filter(|pixel| !firefly[*pixel]).flat_map(&plausible));
        let known = !brightness.is_black();
        let relative = |variance: f64, radiance: f64| brightness.relative_square(variance.sqrt(), radiance);

        let (mut square, mut relative_square, mut left_out, mut counted) = (0.0, 0.0, 0.0, 0u64);
        let mut errors = ErrorMap {
            standard_error: Vec::with_capacity(own.len()),
            relative: Vec::with_capacity(own.len()),
            firefly,
            total: None,
        };
        for (pixel, own_here) in own.iter().enumerate() {
            let alone = errors.firefly[pixel];
            let variance = if alone {
                own_here.map(|m| m.variance)
            } else {
                mean_variance(self.around(pixel).filter(|j| !errors.firefly[*j]).map(|j| &own[j]))
            };
            let radiance = plausible(pixel);
            errors.standard_error.push(std::array::from_fn(|c| variance[c].sqrt() as f32));
            let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(of).sum::<f64>();
            errors.relative.push(match known && measured[pixel].is_some() {
                true => (sum(&|c| relative(variance[c], radiance[c])) / 3.0).sqrt() as f32,
                false => f32::NAN,
            });
            if alone {
                left_out += sum(&|c| relative(own_here[c].variance, expected[pixel][c]));
            } else {
                counted += 1;
                square += sum(&|c| own_here[c].variance);
                relative_square += sum(&|c| relative(own_here[c].variance, radiance[c]));
            }
        }
        let all = own.len() as u64;
        let unknown = measured.iter().filter(|measured| measured.is_none()).count() as u64;
        errors.total = known.then(|| ErrorEstimate {
            rmse: (square / (3 * counted) as f64).sqrt(),
            rel_mse: relative_square / (3 * counted) as f64,
            fireflies: all - counted - unknown,
            unknown,
            rel_mse_with_fireflies: (relative_square + left_out) / (3 * (all - unknown)) as f64,
        });
        Some(errors)
    }

    /// Mean and variance of a pixel: red, green, blue, and their mean.
    fn measured(&self, pixel: usize) -> Option<[Measured; 4]> {
        let samples = self.part_samples(pixel).map(f64::from);
        let parts = samples.iter().filter(|n| **n > 0.0).count();
        if parts < 2 {
            return None;
        }
        let all: f64 = samples.iter().sum();
        // Weighted by the numbers of samples: without bias if the variance of a part's mean goes as one over its samples.
        let scale = 1.0 / ((parts as f64 - 1.0) * all);
        let sums = self.sums[pixel].map(|[r, g, b]| [r, g, b, (r + g + b) / 3.0]);
        Some([0, 1, 2, 3].map(|c| {
            let mean = sums.iter().map(|sum| sum[c]).sum::<f64>() / all;
            let filled = samples.iter().zip(&sums).filter(|(n, _)| **n > 0.0);
            let spread: f64 = filled.map(|(n, sum)| (sum[c] - n * mean).powi(2) / n).sum();
            Measured { mean, variance: scale * spread }
        }))
    }

    /// The pixels of the 3 x 3 neighbourhood, itself among them; fewer at the edges.
    fn around(&self, pixel: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.width as usize, self.height as usize);
        let (x, y) = (pixel % width, pixel / width);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        (y.saturating_sub(1)..=(y + 1).min(height - 1)).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }
}

/// Mean of a pixel in one channel, and the variance of that mean.
#[derive(Debug, Clone, Copy)]
struct Measured {
    mean: f64,
    variance: f64,
}

impl Measured {
    /// The radiance as far as it is known: the pixel's own where it is sure of it, towards its neighbours' where it is not (James and
    /// Stein's shrinking). An error measured against the pixel's own radiance would be too small wherever that is too large by chance.
    fn plausible(self, expected: f64) -> f64 {
        let off = self.mean - expected;
        let sure = if off == 0.0 { 0.0 } else { (1.0 - self.variance / (off * off)).max(0.0) };
        // What is no firefly is not taken to be more than three times too bright.
        (expected + sure * off).max(self.mean / 3.0)
    }
}

/// Red, green and blue of a pixel, without their mean.
fn colours([r, g, b, _]: &[Measured; 4]) -> [Measured; 3] {
    [*r, *g, *b]
}

/// Mean of the variances of some pixels, by channel.
fn mean_variance<'a>(pixels: impl Iterator<Item = &'a [Measured; 4]>) -> [f64; 4] {
    let (mut sum, mut n) = ([0.0; 4], 0.0);
    for pixel in pixels {
        (0..4).for_each(|c| sum[c] += pixel[c].variance);
        n += 1.0;
    }
    sum.map(|sum| sum / n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Batch, PixelSum, Tile};
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
        // 18 samples: parts of unequal size.
        let (samples, spread) = (18, 0.5);
        let error = film(samples, spread, |_, _| 3.0).error_map().unwrap();
        let total = error.total.unwrap();
        let expected = 3.0 * spread / 3f64.sqrt() / f64::from(samples).sqrt();
        // The half-power mean of an even picture is its radiance.
        let over = (9.0f64 + 0.09).sqrt();
        // 4096 pixels of three degrees of freedom: 1.3 % of the variance, and three times that is allowed.
        assert!((total.rmse / expected - 1.0).abs() < 0.02, "{total:?} {expected}");
        assert!((total.relative() / (expected / over) - 1.0).abs() < 0.02);
        assert_eq!((total.fireflies, total.unknown), (0, 0));
        let mean: f64 = error.standard_error.iter().map(|e| f64::from(e[1]).powi(2)).sum::<f64>() / 4096.0;
        assert!((mean.sqrt() / expected - 1.0).abs() < 0.02);
        let relative = error.relative.iter().map(|e| f64::from(e * e)).sum::<f64>() / 4096.0;
        assert!((relative.sqrt() * over / expected - 1.0).abs() < 0.02);
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
        assert_eq!(before.fireflies, 0, "a lamp of one pixel, in all parts");
        let at = 20 * SIZE as usize + 20;
        film.sums[at][2][0] += 5000.0;
        let after = film.error_map().unwrap();
        let total = after.total.unwrap();
        assert_eq!((total.fireflies, total.is_mostly_fireflies()), (1, true));
        assert!(after.firefly[at] && after.standard_error[at][0] > 100.0 && after.relative[at] > 1.0);
        assert_eq!(after.standard_error[at + 1][0], {
            let others = film.around(at + 1).filter(|j| *j != at).map(|j| film.measured(j).unwrap()[0].variance);
            (others.sum::<f64>() / 8.0).sqrt() as f32
        });
        assert!((total.relative() / before.relative() - 1.0).abs() < 0.01);
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
    fn nothing_is_told_from_one_part_and_no_error_from_noiseless_samples() {
        assert_eq!(film(1, 0.5, |_, _| 1.0).error(), None);
        // One pixel that has lost all its samples does not take the others' error away.
        let mut lost = film(8, 0.5, |_, _| 1.0);
        (0..4).for_each(|part| assert_eq!(lost.dropped.insert((77, part), 2), None));
        let errors = lost.error_map().unwrap();
        let total = errors.total.unwrap();
        assert!(errors.firefly[77] && errors.relative[77].is_nan() && total.rmse > 0.0);
        assert_eq!((total.fireflies, total.unknown), (0, 1));
        assert!(errors.standard_error.iter().flatten().all(|e| e.is_finite()));
        let error = film(8, 0.0, |x, _| f64::from(x)).error().unwrap();
        let nothing = ErrorEstimate { rmse: 0.0, rel_mse: 0.0, fireflies: 0, unknown: 0, rel_mse_with_fireflies: 0.0 };
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
        // A lamp in the black, in all parts: what is seen is known.
        black.sums[500] = [[1e-5; 3]; 4];
        assert_eq!(black.error().map(|error| (error.rel_mse, error.fireflies)), Some((0.0, 0)));
    }
}
