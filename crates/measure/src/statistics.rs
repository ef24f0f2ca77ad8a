//! Tests of hypotheses. A `p` is the probability that a right program gives a result at least as far off.

use luminaire::film::{Batch, GROUPS_IN_TURN, Tile};
use luminaire::render::Tracer;
use statrs::distribution::{ContinuousCDF, StudentsT};
use statrs::function::erf::erfc;

/// A mean and its standard error.
#[derive(Debug, Clone, Copy)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
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

    /// `p` of a true mean that is only known to lie in an interval.
    pub fn p_within(self, low: f64, high: f64) -> f64 {
        let off = (self.mean - self.mean.clamp(low, high)).abs();
        // Rounding is all that is left where the samples do not vary.
        if off <= 1e-12 * high.abs() { 1.0 } else { two_sided(off / self.error) }
    }
}

/// `p` of a standard normal variable.
pub fn two_sided(z: f64) -> f64 {
    erfc(z.abs() / std::f64::consts::SQRT_2)
}

/// `p` of the smallest of `n` independent `p`s (Sidak).
pub fn sidak(smallest: f64, n: usize) -> f64 {
    -f64::exp_m1(n as f64 * f64::ln_1p(-smallest))
}

/// A rendered picture that knows how uncertain it is: mean radiance of each pixel, and the variance of that mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// From how many independent groups of samples the variance was estimated.
    pub groups: u32,
    /// Mean radiance of each pixel, linear RGB, rows from the top.
    pub mean: Vec<[f64; 3]>,
    /// Variance of that mean.
    pub variance: Vec<[f64; 3]>,
    /// Rays that were traced, of all kinds.
    pub rays: u64,
}

/// Renders samples 0 to `samples` of every pixel, in `groups` equal groups, from whose spread the variance follows: not too small, since those of
/// one sequence ([`sobol`](luminaire::sampling::sobol)) make up for each other.
pub fn render(tracer: &mut dyn Tracer, width: u32, height: u32, samples: u32, groups: u32) -> Image {
    assert!(groups >= 2 && samples.is_multiple_of(groups));
    let tile = Tile { x: 0, y: 0, width, height };
    let group = samples / groups;
    // Shorter sums than that where it can be: an invocation of the kernel takes several.
    let pieces = if group.is_multiple_of(GROUPS_IN_TURN) { GROUPS_IN_TURN } else { 1 };
    let batch = Batch { tile, samples: 0..samples, group: group / pieces };
    let traced = tracer.trace(&batch).expect("the tracer works");
    assert_eq!(traced.dropped, []);
    let pixels = tile.pixels();
    assert_eq!(traced.sums.len(), pixels * (groups * pieces) as usize);
    let n = f64::from(groups);
    let value = |pixel: usize, group: usize, channel: usize| {
        let pieces = group * pieces as usize..(group + 1) * pieces as usize;
        let sums = pieces.map(|piece| traced.sums[piece * pixels + pixel].radiance[channel]);
        sums.sum::<f64>() * n / f64::from(samples)
    };
    let estimate =
        |pixel: usize, channel: usize| Estimate::new((0..groups as usize).map(|group| value(pixel, group, channel)));
    let all: Vec<[Estimate; 3]> = (0..pixels).map(|pixel| [0, 1, 2].map(|channel| estimate(pixel, channel))).collect();
    Image {
        groups,
        mean: all.iter().map(|e| e.map(|e| e.mean)).collect(),
        variance: all.iter().map(|e| e.map(|e| e.error * e.error)).collect(),
        rays: traced.sums.iter().map(|s| u64::from(s.rays.all)).sum(),
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

/// `p` of two means being the same (z-test: the samples are many).
pub fn same_mean(a: Estimate, b: Estimate) -> f64 {
    let difference = a.mean - b.mean;
    // Rounding is all that is left where the samples do not vary.
    if difference.abs() <= 1e-12 * a.mean.abs() { 1.0 } else { two_sided(difference / a.error.hypot(b.error)) }
}
