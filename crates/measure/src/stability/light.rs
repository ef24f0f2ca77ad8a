//! What the sweeps over light have in common: many samples of one spot, and integrals to hold them against.

use super::judge::certain_bias;
use super::verdict::SURE;
use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::report::words::share;
use crate::statistics::Estimate;
use glam::{DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::scene::build::{empty, pinhole};
use luminaire::scene::{Estimator, Extinction, Integrator, LightSampling, Scene};

/// Pixels in a row and a column, all of which see the same spot.
const SIDE: u32 = 16;
/// Samples of a pixel in one batch: far below what a driver takes for a hang.
const BATCH: u32 = 512;
/// Degrees: so narrow that even a lamp whose edge is seen looks the same from everywhere in it.
const FIELD_OF_VIEW: f32 = 1e-5;

/// A scene, still without objects, whose camera looks from `eye` at the origin.
pub(super) fn looking_from(eye: Vec3) -> Scene {
    let mut scene = empty(SIDE, SIDE);
    scene.sensor = pinhole(eye, Vec3::ZERO, eye.any_orthonormal_vector(), FIELD_OF_VIEW);
    scene
}

/// An estimator whose paths end after so many bounces, and not by chance: what is compared is how light is found.
pub(super) fn without_roulette(light_sampling: LightSampling, bounces: u32) -> Estimator {
    Estimator { light_sampling, extinction: Extinction::Off, max_bounces: Some(bounces), ..Estimator::default() }
}

/// Many samples of one spot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    /// Radiance.
    pub mean: Estimate,
    /// Variance of one sample.
    pub variance: f64,
    /// The largest sample.
    pub largest: f64,
    /// Samples that were infinite or no numbers; they count as 0.
    pub non_finite: u32,
    /// How many there were.
    pub count: u64,
}

impl Spot {
    /// Traces at least so many samples of what the camera of a scene by [`looking_from`] sees.
    pub(super) fn new(
        bench: &Workbench,
        backend: Backend,
        scene: &Scene,
        estimator: Estimator,
        samples: u32,
    ) -> Result<Self> {
        let scene = Scene { integrator: Integrator::Path(estimator), ..scene.clone() };
        let mut tracer = bench.tracer(&scene, backend)?;
        let tile = Tile { x: 0, y: 0, width: SIDE, height: SIDE };
        let per_pixel = samples.div_ceil(SIDE * SIDE).max(2);
        let (mut count, mut mean, mut squares, mut largest, mut non_finite) = (0u64, 0.0, 0.0, 0.0f64, 0);
        for first in (0..per_pixel).step_by(BATCH as usize) {
            let batch = Batch { tile, samples: first..per_pixel.min(first + BATCH), group: 1 };
            let traced = tracer.trace(&batch)?;
            non_finite += traced.sums.iter().map(|sum| sum.dropped).sum::<u32>();
            for sum in &traced.sums {
                let sample = sum.radiance[1];
                count += 1;
                let off = sample - mean;
                mean += off / count as f64;
                squares += off * (sample - mean);
                largest = largest.max(sample);
            }
        }
        let variance = squares / (count - 1) as f64;
        let mean = Estimate { mean, error: (variance / count as f64).sqrt() };
        Ok(Spot { mean, variance, largest, non_finite, count })
    }

    /// The share that was found of what there is.
    pub(super) fn share(&self, x: f64, truth: f64) -> Point {
        self.share_of(x, truth, 0.0)
    }

    /// The share that was found of `truth`, of light beside which there is `other`.
    pub(super) fn share_of(&self, x: f64, truth: f64, other: f64) -> Point {
        // Where nothing was found, how much was missed is not known from the samples.
        let error = (self.variance > 0.0).then_some(self.mean.error / truth);
        Point { x, y: (self.mean.mean - other) / truth, error }
    }

    /// Variance of a sample over the squared truth: as many samples a pixel needs for noise of 100 %. None where less than half of it was
    /// found: such samples know nothing of what they missed.
    pub(super) fn noise(&self, x: f64, truth: f64) -> Point {
        self.noise_of(x, truth, 0.0)
    }

    /// The same of `truth`, of light beside which there is `other`.
    pub(super) fn noise_of(&self, x: f64, truth: f64, other: f64) -> Point {
        let y = if self.mean.mean - other > 0.5 * truth { self.variance / (truth * truth) } else { f64::NAN };
        Point { x, y, error: None }
    }

    /// The largest sample over the truth. None where nothing was found.
    pub(super) fn firefly(&self, x: f64, truth: f64) -> Point {
        Point { x, y: if self.largest > 0.0 { self.largest / truth } else { f64::NAN }, error: None }
    }
}

/// Axes that several sweeps share.
pub(super) fn noise_axis() -> Axis {
    Axis::log("variance of a sample / mean²")
}

/// Samples of all sweeps, and those that were no numbers.
#[derive(Debug, Default)]
pub(super) struct Tally {
    samples: u64,
    non_finite: u64,
}

impl Tally {
    pub(super) fn add(&mut self, spot: &Spot) {
        self.samples += spot.count;
        self.non_finite += u64::from(spot.non_finite);
    }

    /// As a sentence.
    pub(super) fn sentence(&self) -> String {
        match self.non_finite {
            0 => format!("None of {:.1e} samples was infinite or not a number.", self.samples as f64),
            n => format!("{n} of {:.1e} samples were infinite or not numbers.", self.samples as f64),
        }
    }
}

/// Series without points, in the order of the legend.
pub(super) fn series<S: ToString>(names: impl IntoIterator<Item = S>) -> Vec<Series> {
    names.into_iter().map(|name| Series { name: name.to_string(), points: Vec::new() }).collect()
}

/// A chart of these series.
pub(super) fn chart(name: &str, title: &str, x: &str, y: Axis, series: Vec<Series>) -> Chart {
    Chart { name: name.into(), title: title.into(), x: Axis::log(x), y, series }
}

/// Farthest that a series of shares is certainly from 1 where `x` is in a range; 0 where that may be chance.
pub(super) fn off(series: &Series, range: std::ops::RangeInclusive<f64>) -> f64 {
    let beyond = |p: &Point| certain_bias(p.y, p.error.unwrap_or(0.0));
    series.points.iter().filter(|p| range.contains(&p.x)).map(beyond).fold(0.0, f64::max)
}

/// How far means are [`off`], in words that follow "the light is".
pub(super) fn within(off: f64) -> String {
    match off {
        0.0 => format!("within {SURE} standard errors"),
        _ => format!("off by {} more than {SURE} standard errors", share(off)),
    }
}

/// Points and weights of an integral from 0 to 1 over what peaks at `peak`, about one over `sharpness` wide: the midpoint rule after
/// a substitution by the hyperbolic sine, which puts as many points into the peak as into its sides.
fn graded(peak: f64, sharpness: f64) -> Vec<(f64, f64)> {
    const POINTS: u32 = 400;
    let side = |length: f64, sign: f64| {
        let k = (length * sharpness).max(1e-3).asinh();
        (0..POINTS).map(move |i| {
            let t = (f64::from(i) + 0.5) / f64::from(POINTS);
            let weight = length * k * (k * t).cosh() / k.sinh() / f64::from(POINTS);
            (peak + sign * length * (k * t).sinh() / k.sinh(), weight)
        })
    };
    side(peak, -1.0).chain(side(1.0 - peak, 1.0)).collect()
}

/// Integral over the area of a parallelogram of what peaks at `(u, v)`, in shares of its edges, with a width of one over `sharpness`.
pub(super) fn over_parallelogram(
    [corner, a, b]: [DVec3; 3],
    [u, v]: [f64; 2],
    sharpness: f64,
    integrand: impl Fn(DVec3) -> f64,
) -> f64 {
    let along = graded(v, sharpness * b.length());
    let row = |(u, weight): (f64, f64)| {
        let sum: f64 = along.iter().map(|(v, w)| w * integrand(corner + u * a + v * b)).sum();
        weight * sum
    };
    a.cross(b).length() * graded(u, sharpness * a.length()).into_iter().map(row).sum::<f64>()
}

/// Irradiance at the origin, on a surface whose normal is +y, from a triangle of radiance 1 that is above it (Lambert 1760: half the sum
/// of the angles of the edges, each times the cosine of its plane).
pub(super) fn irradiance_of_triangle(corners: [Vec3; 3]) -> f64 {
    let seen = corners.map(|c| c.as_dvec3().normalize());
    let edge = |i: usize| {
        let (a, b) = (seen[i], seen[(i + 1) % 3]);
        let across = a.cross(b);
        // The angle by its sine: small ones keep their digits.
        across.length().atan2(a.dot(b)) * across.normalize_or_zero().y
    };
    (0.5 * (0..3).map(edge).sum::<f64>()).abs()
}

/// The same of a mesh, all of it above the surface and nothing behind another.
pub(super) fn irradiance_of_mesh(mesh: &luminaire::scene::Mesh) -> f64 {
    mesh.triangles.iter().map(|t| irradiance_of_triangle(t.vertices.map(|v| mesh.positions[v as usize]))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::scene::build::quad;
    use std::f64::consts::PI;

    #[test]
    fn integrals() {
        // A peak of width 1e-3 at a place of its own: pi / 1e6, less what is beyond the edges.
        let square = [DVec3::ZERO, DVec3::X, DVec3::Z];
        let peak = |p: DVec3| (-1e6 * ((p.x - 0.3).powi(2) + (p.z - 0.6).powi(2))).exp();
        let found = over_parallelogram(square, [0.3, 0.6], 1e3, peak);
        assert!((found / (PI * 1e-6) - 1.0).abs() < 1e-3, "{found}");
        let area = over_parallelogram([DVec3::ONE, 2.0 * DVec3::X, 3.0 * DVec3::Y], [0.5, 0.1], 50.0, |_| 1.0);
        assert!((area / 6.0 - 1.0).abs() < 1e-3, "{area}");
        // Far away: area over the squared distance; as a ceiling: the form factor of a parallel square straight above, 4 times that of a
        // quarter, which is 1 / 2 pi * 2 * x / sqrt(1 + x^2) * atan(x / sqrt(1 + x^2)) with x = 1.
        let far = quad(Vec3::new(-0.5, 100.0, -0.5), Vec3::X, Vec3::Z);
        assert!((irradiance_of_mesh(&far) * 1e4 - 1.0).abs() < 2e-4);
        let ceiling = quad(Vec3::new(-1.0, 1.0, -1.0), Vec3::X * 2.0, Vec3::Z * 2.0);
        let x = 1.0 / 2f64.sqrt();
        let expected = PI * 4.0 / (2.0 * PI) * 2.0 * x * x.atan();
        assert!((irradiance_of_mesh(&ceiling) / expected - 1.0).abs() < 1e-9);
    }
}
