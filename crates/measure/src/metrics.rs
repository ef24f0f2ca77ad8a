//! How far a picture is from a reference, in numbers.

use luminaire::film::Brightness;
use luminaire::picture::Picture;
use luminaire::{Error, Result};

/// Where the standard error of a bias comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorSource {
    /// Both pictures say how uncertain their pixels are.
    Pictures,
    /// From how much the differences vary over the pixels, as if these were independent samples of one difference. It is too large where the
    /// pictures differ in earnest, here in one direction and there in the other.
    Spread,
}

/// The difference of two means over a channel.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Bias {
    /// Mean of the picture less mean of the reference.
    pub difference: f64,
    /// Standard error of `difference`; NaN where it would have to be estimated from one pixel.
    pub error: f64,
    /// `difference` as a part of the reference's mean; 0 where nothing differs, infinite where the reference is black.
    pub ratio: f64,
}

/// A pixel that differs much.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct WorstPixel {
    /// Column, from 0 at the left.
    pub x: u32,
    /// Row, from 0 at the top.
    pub y: u32,
    /// The picture's pixel.
    pub image: [f32; 3],
    /// The reference's.
    pub reference: [f32; 3],
    /// Its part of the sum of which relMSE is the mean: near 1, this pixel alone (a firefly) makes relMSE what it is.
    pub share: f64,
}

/// Pixels that are not finite.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct NonFinite {
    /// How many there are.
    pub count: u64,
    /// Column and row of the first one, row by row from the top.
    pub first: Option<(u32, u32)>,
}

/// A picture compared with a reference. All means are over the pixels that are finite in both (NaN if there are none), and over the channels where
/// there is one number only.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// Pixels that are finite in both pictures.
    pub pixels: u64,
    /// Root of the mean squared difference, in units of the pictures.
    pub rmse: f64,
    /// relMSE, as [`REL_MSE`](luminaire::film::REL_MSE) defines it: whatever the unit of the radiance. Infinite where the reference is black and the picture
    /// is not.
    pub relmse: f64,
    /// The half-power mean of the reference, by which relMSE measures what is dark; 0 if it is black.
    pub half_power_mean: f64,
    /// Bias of red, green and blue.
    pub bias: [Bias; 3],
    /// Where the standard errors in `bias` come from.
    pub error_source: ErrorSource,
    /// The RMSE that the standard errors of the pixels lead to expect of two pictures of the same thing, where both pictures have them.
    pub expected_rmse: Option<f64>,
    /// The worst pixels by relative squared error, worst first.
    pub worst: Vec<WorstPixel>,
    /// What is not finite in the picture.
    pub image_non_finite: NonFinite,
    /// What is not finite in the reference.
    pub reference_non_finite: NonFinite,
}

/// Compares two pictures, and lists at most `worst` pixels that differ.
///
/// # Errors
/// [`Error::Usage`] if the pictures do not have the same size.
pub fn compare(image: &Picture, reference: &Picture, worst: usize) -> Result<Comparison> {
    if (image.width, image.height) != (reference.width, reference.height) {
        return Err(Error::Usage(format!(
            "the pictures differ in size, {} x {} and {} x {} pixels: only pictures of one size can be compared",
            image.width, image.height, reference.width, reference.height
        )));
    }
    let pairs = || image.rgb.iter().zip(&reference.rgb).enumerate().filter(|(_, (a, b))| finite(a) && finite(b));
    let pixels = pairs().count();
    let n = pixels as f64;
    let brightness = brightness(reference);
    let (mut squares, mut relative) = ([0.0; 3], 0.0);
    let (mut differences, mut means) = ([0.0; 3], [0.0; 3]);
    let mut worst_pixels: Vec<(f64, usize)> = Vec::with_capacity(worst.min(pixels) + 1);
    for (i, (a, b)) in pairs() {
        for channel in 0..3 {
            let d = f64::from(a[channel]) - f64::from(b[channel]);
            squares[channel] += d * d;
            differences[channel] += d;
            means[channel] += f64::from(b[channel]) / n;
        }
        let here = relative_squares(a, b, brightness);
        relative += here;
        let place = worst_pixels.partition_point(|(square, _)| *square >= here);
        if here > 0.0 && place < worst {
            worst_pixels.insert(place, (here, i));
            worst_pixels.truncate(worst);
        }
    }

    let variance = variances(image, reference, pairs().map(|(i, _)| i));
    let bias = [0, 1, 2].map(|channel| {
        let difference = differences[channel] / n;
        let spread = (squares[channel] / n - difference * difference).max(0.0) / (n - 1.0);
        let error = variance.map_or(spread, |sums| sums[channel] / n / n).sqrt();
        let ratio = if difference == 0.0 { 0.0 } else { difference / means[channel].abs() };
        Bias { difference, error, ratio }
    });
    let width = image.width as usize;
    let infinite = pairs().filter(|(_, (a, b))| relative_squares(a, b, brightness).is_infinite()).count();
    let worst = worst_pixels.iter().map(|&(square, i)| WorstPixel {
        x: (i % width) as u32,
        y: (i / width) as u32,
        image: image.rgb[i],
        reference: reference.rgb[i],
        // In a black reference everything is infinitely wrong alike.
        share: if relative.is_finite() { square / relative } else { 1.0 / infinite as f64 },
    });
    Ok(Comparison {
        pixels: pixels as u64,
        rmse: (squares.iter().sum::<f64>() / (3.0 * n)).sqrt(),
        relmse: relative / (3.0 * n),
        half_power_mean: brightness.half_power_mean(),
        bias,
        error_source: if variance.is_some() { ErrorSource::Pictures } else { ErrorSource::Spread },
        expected_rmse: variance.map(|sums| (sums.iter().sum::<f64>() / (3.0 * n)).sqrt()),
        worst: worst.collect(),
        image_non_finite: non_finite(image),
        reference_non_finite: non_finite(reference),
    })
}

/// How far each pixel is off relative to the reference: the root of the mean over its channels of what relMSE is the mean of
/// ([`REL_MSE`](luminaire::film::REL_MSE)). NaN where either is not finite.
///
/// # Panics
/// If the pictures do not have the same number of pixels.
pub fn relative_errors(image: &Picture, reference: &Picture) -> Vec<f32> {
    assert_eq!(image.rgb.len(), reference.rgb.len());
    let (brightness, pairs) = (brightness(reference), image.rgb.iter().zip(&reference.rgb));
    let relative = |a, b| (relative_squares(a, b, brightness) / 3.0).sqrt() as f32;
    pairs.map(|(a, b)| if finite(a) && finite(b) { relative(a, b) } else { f32::NAN }).collect()
}

/// Whether a pixel is a number in all channels.
pub fn finite(pixel: &[f32; 3]) -> bool {
    pixel.iter().all(|v| v.is_finite())
}

/// How bright a picture is, by its finite pixels.
pub fn brightness(picture: &Picture) -> Brightness {
    Brightness::of(picture.rgb.iter().filter(|pixel| finite(pixel)).flatten().map(|v| f64::from(*v)))
}

/// The sum over the channels.
fn relative_squares(a: &[f32; 3], b: &[f32; 3], brightness: Brightness) -> f64 {
    let channels = a.iter().zip(b).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    channels.map(|(a, b)| brightness.relative_square(a - b, b)).sum()
}

/// The sum of the variances of both pictures over some pixels, by channel; none unless all of them are known.
fn variances(image: &Picture, reference: &Picture, pixels: impl Iterator<Item = usize>) -> Option<[f64; 3]> {
    let (a, b) = (image.error.as_ref()?, reference.error.as_ref()?);
    let mut sums = [0.0; 3];
    for i in pixels {
        for channel in 0..3 {
            sums[channel] += f64::from(a[i][channel]).powi(2) + f64::from(b[i][channel]).powi(2);
        }
    }
    sums.iter().all(|sum| sum.is_finite()).then_some(sums)
}

fn non_finite(picture: &Picture) -> NonFinite {
    let mut odd = picture.rgb.iter().enumerate().filter(|(_, pixel)| !finite(pixel)).map(|(i, _)| i);
    let first = odd.next();
    let place = |i: usize| ((i % picture.width as usize) as u32, (i / picture.width as usize) as u32);
    NonFinite { count: first.is_some() as u64 + odd.count() as u64, first: first.map(place) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, rgb: &[[f32; 3]]) -> Picture {
        Picture {
            width,
            height: rgb.len() as u32 / width,
            rgb: rgb.into(),
            error: None,
            clamped: false,
            warnings: vec![],
        }
    }

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-6 * expected.abs().max(1e-3), "{found} for {expected}");
    }

    /// Worked out by hand: the differences are 0.1 and 0; 1 and -1 (green), 0 and 2 (blue).
    #[test]
    fn numbers_by_hand() {
        let reference = picture(2, &[[0.0, 1.0, 3.0], [1.0, 3.0, 0.0]]);
        let image = picture(2, &[[0.1, 2.0, 3.0], [1.0, 2.0, 2.0]]);
        let found = compare(&image, &reference, 5).unwrap();
        assert_eq!(found.pixels, 2);
        near(found.rmse, ((0.01 + 1.0 + 1.0 + 4.0) / 6.0f64).sqrt());
        // The reference's roots are 1, 1 and twice the root of 3.
        let m = ((2.0 + 2.0 * 3f64.sqrt()) / 6.0).powi(2);
        near(found.half_power_mean, m);
        let dark = m * m / 9.0;
        let (first, second) = (0.01 / dark + 1.0 / (1.0 + dark), 1.0 / (9.0 + dark) + 4.0 / dark);
        near(found.relmse, (first + second) / 6.0);
        near(found.bias[0].difference, 0.05);
        near(found.bias[0].ratio, 0.1);
        // Of 0.1 and 0: standard deviation 0.0707 with n - 1, over root of 2.
        near(found.bias[0].error, 0.05);
        near(found.bias[1].difference, 0.0);
        near(found.bias[1].ratio, 0.0);
        near(found.bias[1].error, 1.0);
        near(found.bias[2].difference, 1.0);
        near(found.bias[2].ratio, 1.0 / 1.5);
        assert_eq!((found.error_source, found.expected_rmse), (ErrorSource::Spread, None));
        assert_eq!(found.worst.len(), 2);
        assert_eq!((found.worst[0].x, found.worst[0].y, found.worst[0].image), (1, 0, [1.0, 2.0, 2.0]));
        near(found.worst[0].share, second / (first + second));
        near(found.worst[1].share, first / (first + second));
        assert_eq!(compare(&image, &reference, 1).unwrap().worst, found.worst[..1]);
        let errors = relative_errors(&image, &reference);
        near(errors.iter().map(|e| f64::from(e * e)).sum::<f64>() / 2.0, found.relmse);
    }

    #[test]
    fn the_same_picture_has_no_error() {
        let black = picture(1, &[[0.0; 3], [0.0; 3]]);
        let found = compare(&black, &black, 5).unwrap();
        assert_eq!((found.rmse, found.relmse, &found.worst[..]), (0.0, 0.0, &[][..]));
        assert_eq!(found.bias, [Bias { difference: 0.0, error: 0.0, ratio: 0.0 }; 3]);
        let lit = picture(1, &[[0.0; 3], [1.0, 0.0, 0.0]]);
        let found = compare(&lit, &black, 5).unwrap();
        assert_eq!((found.bias[0].ratio, found.relmse), (f64::INFINITY, f64::INFINITY));
        assert_eq!((found.half_power_mean, found.worst.len(), found.worst[0].share), (0.0, 1, 1.0));
        assert_eq!(relative_errors(&lit, &black), [0.0, f32::INFINITY]);
    }

    #[test]
    fn the_unit_of_light_does_not_show() {
        let pictures = |unit: f32| {
            let scaled = |rgb: [f32; 3]| rgb.map(|v| v * unit);
            let reference = picture(2, &[[0.0, 1.0, 3.0], [1.0, 3.0, 0.0]].map(scaled));
            (picture(2, &[[0.1, 2.0, 3.0], [1.0, 2.0, 2.0]].map(scaled)), reference)
        };
        let (image, reference) = pictures(1.0);
        let expected = compare(&image, &reference, 5).unwrap();
        for unit in [1e-6, 1e6, 1e-30] {
            let (image, reference) = pictures(unit);
            let found = compare(&image, &reference, 5).unwrap();
            near(found.relmse, expected.relmse);
            near(found.rmse / f64::from(unit), expected.rmse);
            near(found.worst[0].share, expected.worst[0].share);
        }
    }

    #[test]
    fn errors_of_the_pixels_are_used_where_both_pictures_have_them() {
        let mut image = picture(2, &[[1.0; 3], [2.0; 3]]);
        let mut reference = picture(2, &[[1.1; 3], [2.0; 3]]);
        image.error = Some(vec![[0.3; 3], [0.0, 0.4, 0.4]]);
        assert_eq!(compare(&image, &reference, 0).unwrap().error_source, ErrorSource::Spread);
        reference.error = Some(vec![[0.4; 3], [0.0, 0.3, f32::INFINITY]]);
        assert_eq!(compare(&image, &reference, 0).unwrap().error_source, ErrorSource::Spread);
        reference.error = Some(vec![[0.4; 3], [0.0, 0.3, 0.3]]);
        let found = compare(&image, &reference, 0).unwrap();
        assert_eq!(found.error_source, ErrorSource::Pictures);
        // Variances 0.25 and 0 in red, 0.25 twice in the others.
        near(found.bias[0].error, 0.25);
        near(found.bias[1].error, 0.125f64.sqrt());
        near(found.expected_rmse.unwrap(), (1.25f64 / 6.0).sqrt());
    }

    #[test]
    fn what_is_not_finite_is_counted_and_left_out() {
        let image = picture(3, &[[1.0; 3], [f32::NAN, 0.0, 0.0], [2.0; 3], [1.0; 3], [f32::INFINITY; 3], [1.0; 3]]);
        let reference = picture(3, &[[1.0; 3], [9.0; 3], [2.0, f32::NAN, 2.0], [1.0; 3], [9.0; 3], [3.0; 3]]);
        let found = compare(&image, &reference, 5).unwrap();
        assert_eq!(found.pixels, 3);
        assert_eq!(found.image_non_finite, NonFinite { count: 2, first: Some((1, 0)) });
        assert_eq!(found.reference_non_finite, NonFinite { count: 1, first: Some((2, 0)) });
        near(found.rmse, (4.0f64 / 3.0).sqrt());
        assert_eq!(found.worst.len(), 1);
        assert!(relative_errors(&image, &reference)[1].is_nan());
    }

    #[test]
    fn pictures_of_different_sizes_are_an_error() {
        let (wide, high) = (picture(2, &[[1.0; 3]; 2]), picture(1, &[[1.0; 3]; 2]));
        let error = compare(&wide, &high, 5).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("2 x 1 and 1 x 2"), "{error}");
        let odd = compare(&picture(2, &[[f32::NAN; 3]; 2]), &wide, 5).unwrap();
        assert!(odd.pixels == 0 && odd.rmse.is_nan());
    }
}
