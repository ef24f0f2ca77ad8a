//! Adding up very many samples: what the sum's precision does to the mean.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::report::words::{count, share};
use crate::stability::judge::everywhere;
use crate::stability::limits::{above_from, largest};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Judgement, Verdict, Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::film::{AovSum, Batch, PixelSum, Tile};
use luminaire::render::{Limits, Traced, Tracer, render};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::build::{add, empty, lamp, quad};
use luminaire::scene::{Environment, Estimator, Integrator, LightSampling};
use luminaire::{Result, render};
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// The sweep over the number of samples.
pub const DEFINITION: Definition =
    Definition { name: "samples", family: Family::Light, title: "the number of samples of a pixel, 1 to 1e6", run };

/// How luminaire adds, as a method.
const OURS: &str = "luminaire (f32 to 4, then f64)";
/// What is added up in the first chart and rendered in the third.
const CONSTANT: f32 = 0.1;
/// A mean that is further off is no longer what a double-precision sum would show in 16 bits.
const VISIBLE: f64 = 1e-4;

fn run(bench: &Workbench) -> Result<Sweep> {
    let last = if bench.long { 10_000_000 } else { 1_000_000 };
    sweep(bench, &numbers(last, if bench.long { 4 } else { 2 }), if bench.long { 1_000_000 } else { 100_000 })
}

/// 1 to `last` with `steps` in every power of ten.
fn numbers(last: u32, steps: i32) -> Vec<u32> {
    let number = |step: i32| 10f64.powf(f64::from(step) / f64::from(steps)).round() as u32;
    (0..).map(number).take_while(|n| *n <= last).collect()
}

fn sweep(bench: &Workbench, numbers: &[u32], most_rendered: u32) -> Result<Sweep> {
    let sums = |name: &str, title: &str, values: &dyn Fn(u32) -> f32| -> Result<Chart> {
        Ok(Chart {
            name: name.into(),
            title: title.into(),
            x: Axis::log("samples of a pixel"),
            y: Axis::log("relative error of the mean"),
            series: drifts(values, numbers)?,
        })
    };
    let constant = sums("constant", "The mean of n times 0.1", &|_| CONSTANT)?;
    let random = sums("random", "The mean of n radiances spread evenly over nine powers of ten", &radiance)?;
    let rendered = rendered(bench, numbers.iter().copied().filter(|n| *n <= most_rendered))?;

    let verdicts = verdicts(&constant, &random, &rendered);
    let range = stretch(numbers.iter().map(|n| f64::from(*n)), Worse::Upwards, "samples a pixel");
    let summary =
        everywhere(&verdicts, OURS, "Take as many samples as you like: they are added up in double precision.");
    let [plain, compensated, ours] = &constant.series[..] else { unreachable!("three ways to add") };
    let worst_render = rendered.series.iter().map(largest).fold(0.0, f64::max);
    let findings = Findings {
        starts: format!("The mean is more than {} off:", share(VISIBLE)),
        how: format!(
            "Each addition is rounded to the 24 bits of the sum so far. Equal summands are rounded the same way again and again, so the \
             error \
             grows with their number ({} at {} samples), and near 2^24 summands the sum stands still; a compensated sum goes the same \
             way when the sum of what was lost has become large. Random ones stay better, {} at the end.",
            share(last(plain)),
            plain.points.last().map_or(String::new(), |p| count(p.x)),
            share(last(&random.series[0])),
        ),
        mends: format!(
            "The kernel adds at most 4 samples in f32 and the film adds these sums in f64: at most {} off here, {} for random \
             radiances, and {} \
             in a real picture of a constant sky, no matter how many they are. A compensated f32 sum would cost the kernel twice the \
             registers and \
             hold less: {} off at the end.",
            share(largest(ours)),
            share(largest(&random.series[2])),
            share(worst_render),
            share(last(compensated)),
        ),
        sees: "Nothing. With a plain f32 sum long renders would grow darker or brighter by percents, evenly and without noise, so that \
        nobody notices.".into(),
    };
    Ok(Sweep { charts: vec![constant, random, rendered], range, verdicts, summary, findings })
}

/// luminaire's way first, also in the rendered pictures; then the others.
fn verdicts(constant: &Chart, random: &Chart, rendered: &Chart) -> Vec<Verdict> {
    let from = |series: &Series| match above_from(series, VISIBLE) {
        Some(x) => format!("from {} samples on, {} at the end", count(x), share(last(series))),
        None => format!("never (at most {})", share(largest(series))),
    };
    let verdict = |index: usize| {
        let [constant, random] = [constant, random].map(|chart| &chart.series[index]);
        let pictures = rendered.series.iter().filter(|_| index == 2);
        let points = [constant, random].into_iter().chain(pictures).flat_map(|series| &series.points);
        let judged = points.map(|point| (point.x, Judgement::of_share(point.y)));
        let evidence = format!("a constant {}; random radiances {}", from(constant), from(random));
        Verdict::new(constant.name.clone(), judged, Worse::Upwards, evidence)
    };
    [2, 0, 1].map(verdict).into()
}

fn last(series: &Series) -> f64 {
    series.points.last().map_or(f64::NAN, |p| p.y)
}

/// Radiance of a sample: 1e-4 to 1e5, every power of ten as often.
fn radiance(sample: u32) -> f32 {
    10f64.powf(9.0 * uniform(random4(0, sample, 0, 7)[0]) - 4.0) as f32
}

/// The error of three ways to add `values`.
fn drifts(values: &dyn Fn(u32) -> f32, numbers: &[u32]) -> Result<Vec<Series>> {
    let mut series = ["f32 sum", "compensated f32 sum", OURS].map(|name| Series { name: name.into(), points: vec![] });
    let (mut plain, mut sum, mut lost) = (0f32, 0f32, 0f32);
    let mut exact = Exact::default();
    let mut next = 0;
    for &n in numbers {
        for sample in next..n {
            let value = values(sample);
            plain += value;
            // Neumaier (1974): what the addition lost is kept beside the sum.
            let grown = sum + value;
            lost += if sum.abs() >= value.abs() { (sum - grown) + value } else { (value - grown) + sum };
            sum = grown;
            exact.add(f64::from(value));
        }
        next = n;
        let ours = film_mean(values, n)? * f64::from(n);
        let found = [f64::from(plain), f64::from(sum + lost), ours];
        for (series, found) in series.iter_mut().zip(found) {
            let y = (found / exact.total() - 1.0).abs();
            series.points.push(Point { x: f64::from(n), y, error: None });
        }
    }
    Ok(series.into())
}

/// A compensated sum in f64: what the others are held against.
#[derive(Default)]
struct Exact {
    sum: f64,
    lost: f64,
}

impl Exact {
    fn add(&mut self, value: f64) {
        let grown = self.sum + value;
        self.lost +=
            if self.sum.abs() >= value.abs() { (self.sum - grown) + value } else { (value - grown) + self.sum };
        self.sum = grown;
    }

    fn total(&self) -> f64 {
        self.sum + self.lost
    }
}

/// A tracer whose samples are given: it adds them up as the kernel does.
struct Given<'a>(&'a dyn Fn(u32) -> f32);

impl Tracer for Given<'_> {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        let group = |group: u32| {
            let sum = batch.group_samples(group).fold(0f32, |sum, sample| sum + (self.0)(sample));
            PixelSum { radiance: [f64::from(sum); 3], ..PixelSum::default() }
        };
        Ok(Traced { sums: (0..batch.groups()).map(group).collect(), ..Traced::default() })
    }

    fn aovs(&mut self, tile: Tile, _: Range<u32>) -> Result<Vec<AovSum>> {
        Ok(vec![AovSum::default(); tile.pixels()])
    }

    fn max_sums(&self) -> usize {
        1 << 20
    }

    fn batch_seconds(&self) -> f64 {
        0.25
    }
}

/// The mean of one pixel by the real loop over batches and the real film.
fn film_mean(values: &dyn Fn(u32) -> f32, samples: u32) -> Result<f64> {
    Ok(mean_of_loop(&mut Given(values), (1, 1), samples)?[0])
}

/// The mean of each pixel's red channel by the real loop.
fn mean_of_loop(tracer: &mut dyn Tracer, size: (u32, u32), samples: u32) -> Result<Vec<f64>> {
    let limits = Limits { spp: Some(samples), ..Limits::default() };
    let rendered = render(tracer, size, limits, &mut |_| {}, &AtomicBool::new(false))?;
    match rendered.end {
        render::End::Failed(error) => Err(error),
        _ => Ok((0..rendered.film.pixels()).map(|pixel| rendered.film.mean(pixel)[0]).collect()),
    }
}

/// A picture of nothing but a constant sky: its worst pixel.
fn rendered(bench: &Workbench, numbers: impl Iterator<Item = u32> + Clone) -> Result<Chart> {
    let mut scene = empty(4, 4);
    // A scene has a triangle; this one is behind the camera.
    add(&mut scene, quad(Vec3::Z, Vec3::X, Vec3::Y), lamp(Vec3::ZERO), Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::splat(CONSTANT), image: None, rotation: 0.0 });
    scene.integrator = Integrator::Path(Estimator { light_sampling: LightSampling::None, ..Estimator::default() });
    let mut series = Vec::new();
    for backend in bench.backends() {
        let mut tracer = bench.tracer(&scene, backend)?;
        let mut points = Vec::new();
        for n in numbers.clone() {
            let means = mean_of_loop(tracer.as_mut(), (4, 4), n)?;
            let y = means.iter().map(|m| (m / f64::from(CONSTANT) - 1.0).abs()).fold(0.0, f64::max);
            points.push(Point { x: f64::from(n), y, error: None });
        }
        series.push(Series { name: backend.to_string(), points });
    }
    Ok(Chart {
        name: "rendered".into(),
        title: "A real picture of a constant sky of 0.1: the worst of 16 pixels".into(),
        x: Axis::log("samples of a pixel"),
        y: Axis::log("relative error of the mean"),
        series,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No number of samples takes the mean further from the truth than the rounding of 4 additions; a plain f32 sum shows that there
    /// is something to mend.
    #[test]
    fn sums_hold() {
        let done = sweep(&Workbench::new(false).unwrap(), &[1, 100, 10_000, 1_000_000], 10_000).unwrap();
        for chart in &done.charts[..2] {
            let [plain, _, ours] = &chart.series[..] else { panic!("three ways to add") };
            assert!(largest(plain) > 1e-5, "{}: an f32 sum would do: {plain:?}", chart.name);
            assert!(largest(ours) < 4.0 * 0.5 * f64::from(f32::EPSILON), "{}: {ours:?}", chart.name);
        }
        for series in &done.charts[2].series {
            assert!(largest(series) < 4.0 * 0.5 * f64::from(f32::EPSILON), "{series:?}");
        }
    }
}
