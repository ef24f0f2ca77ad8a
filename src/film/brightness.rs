//! What counts as large and small in a picture, and relMSE by it: an error is relative to the picture, whatever the unit of its light.

use super::Film;

/// The definition of relMSE, in words: the one that everything here goes by.
pub const REL_MSE: &str = "mean of (a - b)^2 / (b^2 + (m/3)^2), m the half-power mean of b";

/// What is darker than this share of the half-power mean counts less. With a third, a picture of the usual brightness, 0.3, has the customary `b^2 + 0.01`.
const DARK: f64 = 1.0 / 3.0;

/// How bright a picture is: its half-power mean, `(mean of sqrt(max(b, 0)))^2` over pixels and channels.
///
/// It goes with the unit of the radiance, as an arithmetic mean does, but what few pixels hold hardly moves it: in a picture of 256 x 256 pixels of radiance 1 the
/// sun in one pixel (1e6) makes it 1.03, and the arithmetic mean 16. Unlike a median it is zero only where all is black.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brightness(f64);

impl Brightness {
    /// The brightness of radiances, a number a channel; those that are not finite are left out. Zero if there are none.
    pub fn of(radiances: impl IntoIterator<Item = f64>) -> Self {
        let (mut sum, mut n) = (0.0, 0u64);
        for radiance in radiances.into_iter().filter(|radiance| radiance.is_finite()) {
            sum += radiance.max(0.0).sqrt();
            n += 1;
        }
        Brightness((sum / n.max(1) as f64).powi(2))
    }

    /// Of a picture whose half-power mean is known.
    pub(super) fn from_half_power_mean(half_power_mean: f64) -> Self {
        Brightness(half_power_mean)
    }

    /// The half-power mean, in the unit of the radiances.
    pub fn half_power_mean(self) -> f64 {
        self.0
    }

    /// Whether there is no light at all: then no error is relative to anything.
    pub fn is_black(self) -> bool {
        self.0 == 0.0
    }

    /// The squared error `off^2` over the squared radiance, so that dark places count less: what relMSE is the mean of ([`REL_MSE`]). Zero
    /// where nothing is off; infinite where something is in a black picture.
    pub fn relative_square(self, off: f64, radiance: f64) -> f64 {
        if off == 0.0 { 0.0 } else { off * off / (radiance * radiance + (DARK * self.0).powi(2)) }
    }
}

impl Film {
    /// How bright the picture is, as far as it has samples.
    pub fn brightness(&self) -> Brightness {
        Brightness::of(self.measured_pixels().flatten())
    }

    /// The largest radiance of a channel; 0 for a black film.
    pub fn largest(&self) -> f64 {
        self.measured_pixels().flatten().fold(0.0, f64::max)
    }

    /// The share of black pixels among those that have samples, from 0 to 1: no sample found any light there. None if no pixel has samples.
    pub fn black_share(&self) -> Option<f64> {
        let (mut black, mut all) = (0u64, 0u64);
        for pixel in self.measured_pixels() {
            black += u64::from(pixel == [0.0; 3]);
            all += 1;
        }
        (all > 0).then(|| black as f64 / all as f64)
    }

    /// The means of the pixels that have finite samples.
    fn measured_pixels(&self) -> impl Iterator<Item = [f64; 3]> {
        let has_samples = |pixel: &usize| self.finite_samples(*pixel) > 0;
        (0..self.pixels()).filter(has_samples).map(|pixel| self.mean(pixel))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_brightness_goes_with_the_unit_and_not_with_single_pixels() {
        let picture = |unit: f64| (0..30_000).map(move |i| unit * if i == 7 { 1e6 } else { f64::from(i % 2) });
        // Half of the roots are 1; the sun adds 1000 / 30 000.
        let expected = (0.5f64 + 1000.0 / 30_000.0).powi(2);
        for unit in [1e-30, 1e-6, 1.0, 1e6] {
            let found = Brightness::of(picture(unit)).half_power_mean() / unit;
            assert!((found / expected - 1.0).abs() < 1e-3, "{unit}: {found}");
        }
        let odd = Brightness::of([4.0, f64::NAN, f64::INFINITY, 4.0, -100.0]);
        assert!((odd.half_power_mean() - (4.0f64 / 3.0).powi(2)).abs() < 1e-12);
    }

    #[test]
    fn in_a_black_picture_no_error_is_relative() {
        for black in [Brightness::of([]), Brightness::of([0.0, -1.0, f64::NAN])] {
            assert!(black.is_black());
            assert_eq!(black.relative_square(0.0, 0.0), 0.0);
            assert_eq!(black.relative_square(1e-9, 0.0), f64::INFINITY);
        }
        let ten = Brightness::of([10.0]);
        assert!((ten.relative_square(5.0, 10.0) - 25.0 / (100.0 + 100.0 / 9.0)).abs() < 1e-12);
        assert!((ten.relative_square(1e-6, 0.0) - 9e-14).abs() < 1e-25);
    }

    #[test]
    fn black_pixels_are_those_with_samples_and_no_light() {
        let mut film = Film::new(4, 1).unwrap();
        assert_eq!(film.black_share(), None);
        film.samples = vec![1, 1, 2, 0];
        film.sums[1][0] = [0.0, 0.0, 1e-30];
        assert_eq!(film.black_share(), Some(2.0 / 3.0));
        assert_eq!(film.largest(), 1e-30);
    }
}
