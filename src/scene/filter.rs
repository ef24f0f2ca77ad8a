//! The pixel filters, also as densities, to be sampled.

use std::f64::consts::{FRAC_2_SQRT_PI, PI, SQRT_2};

/// Intervals of equal probability in [`Filter::inverse_cdf`].
const INTERVALS: u32 = 256;

/// Pixel filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Filter {
    /// Evenly over a square.
    #[default]
    Box,
    /// Linear to zero at the radius, in x times in y.
    Tent,
    /// A Gaussian with a standard deviation of a third of the radius, cut there.
    Gaussian,
    /// The four-term Blackman-Harris window over the diameter.
    #[serde(rename = "blackman-harris")]
    BlackmanHarris,
}

impl Filter {
    /// Half the width of the filter's square in pixels, unless a scene says otherwise.
    pub fn default_radius(self) -> f32 {
        match self {
            Filter::Box => 0.5,
            Filter::Tent => 1.0,
            Filter::Gaussian | Filter::BlackmanHarris => 1.5,
        }
    }

    /// Where to look, in pixels from the pixel's centre and in one coordinate, for the light that the filter weighs: 257 positions from
    /// `-radius` to `radius`, rising, symmetric about 0. Position `i` has `i / 256` of the filter's weight below it. Both tracers
    /// take a uniform number to an offset by linear interpolation ("filter importance sampling": Ernst, Stamminger and Greiner
    /// 2006), so all samples count the same and pixels share none.
    ///
    /// `radius` is in pixels.
    pub fn inverse_cdf(self, radius: f32) -> Vec<f32> {
        let half = INTERVALS / 2;
        let inner = (1..half).map(|i| self.half_width(f64::from(i) / f64::from(half)) * f64::from(radius));
        let outwards: Vec<f32> = inner.map(|x| x as f32).chain([radius]).collect();
        outwards.iter().rev().map(|x| -x).chain([0.0]).chain(outwards.iter().copied()).collect()
    }

    /// The `x` for which [`Filter::weight_within`] is `weight`, by bisection.
    fn half_width(self, weight: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (low + high);
            if self.weight_within(middle) < weight {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Share of the filter's weight between `-x` and `x`; the radius is 1.
    fn weight_within(self, x: f64) -> f64 {
        match self {
            Filter::Box => x,
            Filter::Tent => x * (2.0 - x),
            Filter::Gaussian => erf(x * 3.0 / SQRT_2) / erf(3.0 / SQRT_2),
            Filter::BlackmanHarris => {
                let [a0, a1, a2, a3] = [0.35875, 0.48829, 0.14128, 0.01168];
                let wave = |k: f64| (k * PI * x).sin() / (k * PI);
                x + (a1 * wave(1.0) + a2 * wave(2.0) + a3 * wave(3.0)) / a0
            }
        }
    }
}

/// The error function, to rounding, for small `x >= 0`: all terms of this series (Abramowitz and Stegun, 7.1.6) are positive.
fn erf(x: f64) -> f64 {
    let (mut term, mut sum, mut odd) = (x, 0.0, 1.0);
    while sum + term != sum {
        sum += term;
        odd += 2.0;
        term *= 2.0 * x * x / odd;
    }
    FRAC_2_SQRT_PI * (-x * x).exp() * sum
}
