//! Tests of hypotheses. A `p` is the probability that a right program gives a result at least as far off.

use luminaire::film::{Batch, Tile};
use luminaire::render::Tracer;
use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};
use statrs::function::erf::erfc;

/// Tests fail below this `p`. Seeds are fixed, so a test that passes keeps passing; a right program would fail a test once in
/// ten thousand choices of the seed.
pub const SIGNIFICANCE: f64 = 1e-4;

/// A mean and its standard error.
#[derive(Debug, Clone, Copy)]
pub struct Estimate {
    pub mean: f64,
    pub error: f64,
}

impl Estimate {
    /// From independent samples.
    pub fn new(samples: impl Iterator<Item = f64>) -> Self {
        let (mut n, mut mean, mut squares) = (0.0, 0.0, 0.0);
        for x in samples {
            n += 1.0;
            let d = x - mean;
            mean += d / n;
            squares += d * (x - mean);
        }
        Estimate { mean, error: (squares / (n - 1.0) / n).sqrt() }
    }

    /// Fails unless the true mean may be `expected` (two-sided z-test), and the test is sharp: the standard error is at most `resolution`
    /// times the expectation.
    pub fn assert_is(self, expected: f64, resolution: f64) {
        self.assert_within(expected, expected, resolution);
    }

    /// `p` of a true mean that is only known to lie in an interval.
    pub fn p_within(self, low: f64, high: f64) -> f64 {
        let off = (self.mean - self.mean.clamp(low, high)).abs();
        // Rounding is all that is left where the samples do not vary.
        if off <= 1e-12 * high.abs() { 1.0 } else { two_sided(off / self.error) }
    }

    /// The same for a true mean that is only known to lie in an interval.
    pub fn assert_within(self, low: f64, high: f64, resolution: f64) {
        let Estimate { mean, error } = self;
        assert!(error <= resolution * low, "{mean} +- {error} is not sharp enough about [{low}, {high}]");
        let p = self.p_within(low, high);
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

/// `p` of a standard normal variable.
pub fn two_sided(z: f64) -> f64 {
    erfc(z.abs() / std::f64::consts::SQRT_2)
}

/// `p` of the smallest of `n` independent `p`s (Sidak).
pub fn sidak(smallest: f64, n: usize) -> f64 {
    -f64::exp_m1(n as f64 * f64::ln_1p(-smallest))
}

/// `p` of counts against equal expectations (Pearson).
pub fn chi_square(counts: &[u32]) -> f64 {
    let expected = counts.iter().sum::<u32>() as f64 / counts.len() as f64;
    assert!(expected >= 10.0, "too few samples for a chi-square test");
    let sum: f64 = counts.iter().map(|c| (f64::from(*c) - expected).powi(2) / expected).sum();
    ChiSquared::new(counts.len() as f64 - 1.0).expect("more than one bin").sf(sum)
}

/// A rendered picture that knows how uncertain it is: mean radiance of each pixel, and the variance of that mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    pub groups: u32,
    pub mean: Vec<[f64; 3]>,
    pub variance: Vec<[f64; 3]>,
    pub rays: u64,
}

/// Renders samples 0 to `samples` of every pixel, in `groups` equal groups, from whose spread the variance follows.
pub fn render(tracer: &mut dyn Tracer, width: u32, height: u32, samples: u32, groups: u32) -> Image {
    assert!(groups >= 2 && samples.is_multiple_of(groups));
    let tile = Tile { x: 0, y: 0, width, height };
    let traced = tracer.trace(&Batch { tile, samples: 0..samples, group: samples / groups }).expect("the tracer works");
    assert_eq!(traced.non_finite, 0);
    let pixels = tile.pixels();
    assert_eq!(traced.sums.len(), pixels * groups as usize);
    let n = f64::from(groups);
    let value = |pixel: usize, group: usize, channel: usize| {
        traced.sums[group * pixels + pixel].radiance[channel] * n / f64::from(samples)
    };
    let estimate =
        |pixel: usize, channel: usize| Estimate::new((0..groups as usize).map(|group| value(pixel, group, channel)));
    let all: Vec<[Estimate; 3]> = (0..pixels).map(|pixel| [0, 1, 2].map(|channel| estimate(pixel, channel))).collect();
    Image {
        groups,
        mean: all.iter().map(|e| e.map(|e| e.mean)).collect(),
        variance: all.iter().map(|e| e.map(|e| e.error * e.error)).collect(),
        rays: traced.sums.iter().map(|s| u64::from(s.rays)).sum(),
    }
}

/// `p` of the most different pixel and channel of two pictures that were rendered with different seeds (Welch's t-test, which a
/// z-test becomes when the variance is estimated from few groups; Sidak over all pixels and channels).
pub fn compare(a: &Image, b: &Image) -> f64 {
    assert_eq!(a.mean.len(), b.mean.len());
    let mut smallest = 1.0f64;
    for pixel in 0..a.mean.len() {
        for channel in 0..3 {
            let (va, vb) = (a.variance[pixel][channel], b.variance[pixel][channel]);
            let difference = (a.mean[pixel][channel] - b.mean[pixel][channel]).abs();
            // Rounding is all that is left where the samples do not vary.
            if difference <= 1e-5 * a.mean[pixel][channel] {
                continue;
            }
            let freedom = (va + vb).powi(2)
                / (va * va / f64::from(a.groups - 1) + vb * vb / f64::from(b.groups - 1)).max(f64::MIN_POSITIVE);
            let t = difference / (va + vb).sqrt();
            let p = match StudentsT::new(0.0, 1.0, freedom) {
                Ok(student) => 2.0 * student.sf(t),
                Err(_) => 0.0, // Both without variance, and different.
            };
            smallest = smallest.min(p);
        }
    }
    sidak(smallest, 3 * a.mean.len())
}

/// Mean radiance over the whole picture and all channels.
pub fn total(image: &Image) -> Estimate {
    let n = 3.0 * image.mean.len() as f64;
    let mean = image.mean.iter().flatten().sum::<f64>() / n;
    let variance = image.variance.iter().flatten().sum::<f64>();
    // Channels share their samples: at worst they vary as one.
    Estimate { mean, error: (3.0 * variance).sqrt() / n }
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

/// `p` of two means being the same (z-test: the samples are many).
pub fn same_mean(a: Estimate, b: Estimate) -> f64 {
    let difference = a.mean - b.mean;
    // Rounding is all that is left where the samples do not vary.
    if difference.abs() <= 1e-12 * a.mean.abs() { 1.0 } else { two_sided(difference / a.error.hypot(b.error)) }
}
