//! Albedos near one in a closed room: what ends a path decides about bias, noise and time.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::report::words::{count, deviation, share};
use crate::stability::judge::{certain_bias, up_to};
use crate::stability::rooms::{furnace, furnace_radiance, without_roulette};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::trial::Trial;
use crate::stability::verdict::{Judgement, SURE, Verdict, Worse, place, stretch};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::reference::path::LONGEST_PATH;
use luminaire::reference::scatter::SURE_THROUGHPUT;
use luminaire::scene::{Estimator, Extinction};

/// The sweep over the albedo of a closed room.
pub const DEFINITION: Definition = Definition {
    name: "albedo",
    family: Family::Light,
    title: "albedo of a closed room, 0.5 to 0.9997, and beyond the longest path",
    run,
};

/// Limits of the terminations that cut.
const THRESHOLD: f32 = 1e-4;
const BOUNCES: u32 = 16;
/// Picture of the room: small, because it looks the same everywhere.
const SIZE: (u32, u32) = (8, 2);

struct Steps {
    /// One minus the albedo.
    absorbed: Vec<f64>,
    /// The same up to where most paths would be longer than the longest, where only roulette by throughput runs.
    beyond: Vec<f64>,
    /// Rays of one point.
    rays: f64,
}

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(
        bench,
        &match bench.long {
            false => {
                Steps { absorbed: vec![0.5, 0.1, 1e-2, 1e-3, 3e-4], beyond: vec![3e-4, 1e-4, 3e-5, 1e-5], rays: 1e6 }
            }
            true => Steps {
                absorbed: vec![0.5, 0.3, 0.1, 0.03, 1e-2, 3e-3, 1e-3, 3e-4],
                beyond: vec![1e-3, 3e-4, 2e-4, 1e-4, 7e-5, 5e-5, 3e-5, 1e-5],
                rays: 8e6,
            },
        },
    )
}

/// What ends a path, with the rays that a path has by it when `absorbed` is one minus the albedo.
struct Termination {
    name: &'static str,
    estimator: Estimator,
    rays: fn(absorbed: f64) -> f64,
}

impl Termination {
    /// Whether all paths are the same, so that two of a pixel are enough.
    fn is_even(&self) -> bool {
        self.estimator.extinction == Extinction::Off
    }
}

fn terminations() -> [Termination; 5] {
    let roulette = |extinction| Estimator { extinction, ..Estimator::default() };
    let until_absorbed: fn(f64) -> f64 = |absorbed| 1.0 / absorbed;
    [
        Termination {
            name: "roulette by throughput",
            estimator: roulette(Extinction::Throughput),
            // It begins where the throughput has fallen so far; in dark rooms, a surface later.
            rays: |absorbed| (1.0 - SURE_THROUGHPUT.ln()) / absorbed,
        },
        Termination { name: "roulette by surface", estimator: roulette(Extinction::Surface), rays: until_absorbed },
        Termination { name: "literal extinction", estimator: roulette(Extinction::Literal), rays: until_absorbed },
        Termination {
            name: "threshold 1e-4",
            estimator: Estimator { albedo_threshold: Some(THRESHOLD), ..without_roulette() },
            rays: |absorbed| f64::from(THRESHOLD).ln() / f64::ln_1p(-absorbed),
        },
        Termination {
            name: "16 bounces at most",
            estimator: Estimator { max_bounces: Some(BOUNCES), ..without_roulette() },
            rays: |_| f64::from(BOUNCES + 2),
        },
    ]
}

/// A measured termination at one albedo.
struct Measured {
    /// 1 / (1 - albedo), the radiance as well.
    x: f64,
    ratio: f64,
    error: f64,
    rays: f64,
    /// Variance of a sample over the squared truth, times the rays it costs.
    noise: f64,
}

impl Measured {
    fn albedo(&self) -> f64 {
        1.0 - 1.0 / self.x
    }

    fn judgement(&self) -> (f64, Judgement) {
        (self.albedo(), Judgement::of_light(self.noise / self.rays, certain_bias(self.ratio, self.error), self.error))
    }
}

/// Each termination over all backends, the default first, which is also judged beyond.
fn verdicts(all: &[(Backend, Vec<Vec<Measured>>)], beyond: &[Measured]) -> Vec<Verdict> {
    let of = |(index, termination): (usize, Termination)| {
        let measured = || all.iter().flat_map(move |(_, of)| &of[index]);
        let judged: Vec<_> = measured().map(Measured::judgement).collect();
        let last = judged.iter().map(|(albedo, _)| *albedo).fold(0.0, f64::max);
        let beyond = || beyond.iter().filter(|m| index == 0 && m.albedo() > last);
        let judged = judged.into_iter().chain(beyond().map(Measured::judgement));
        Verdict::new(termination.name, judged, Worse::Upwards, evidence(measured().chain(beyond())))
    };
    terminations().into_iter().enumerate().map(of).collect()
}

/// From which albedo on a termination is certainly more than 1 % off, and by how much at the largest.
fn evidence<'a>(measured: impl Iterator<Item = &'a Measured> + Clone) -> String {
    let off = measured.clone().filter(|m| (m.ratio - 1.0).abs() > 0.01 + SURE * m.error).map(Measured::albedo);
    let from =
        off.reduce(f64::min).map_or("never for certain".into(), |albedo| format!("from albedo {} on", place(albedo)));
    let farthest = |a: &&Measured, b: &&Measured| {
        a.albedo().total_cmp(&b.albedo()).then((a.ratio - 1.0).abs().total_cmp(&(b.ratio - 1.0).abs()))
    };
    measured
        .max_by(farthest)
        .map_or(from.clone(), |m| format!("{from}; {} at {}", deviation(m.ratio - 1.0, m.error), place(m.albedo())))
}

fn measure(
    bench: &Workbench,
    backend: Backend,
    estimator: Estimator,
    absorbed: f64,
    rays: [f64; 2],
) -> Result<Measured> {
    let albedo = (1.0 - absorbed) as f32;
    let [all, each] = rays;
    let mut scene = furnace(SIZE, albedo, estimator);
    scene.settings.seed = 17;
    let mut tracer = bench.tracer(&scene, backend)?;
    let samples = (all / each / 16.0).clamp(2.0, 8192.0) as u32;
    let group = (samples / 8).clamp(1, 8);
    let trial = Trial::grouped(tracer.as_mut(), SIZE, (samples / group, group), each)?;
    let (mean, truth) = (trial.mean(), furnace_radiance(albedo));
    let rays = trial.rays_a_sample();
    Ok(Measured {
        x: truth,
        ratio: mean.mean / truth,
        error: mean.error / truth,
        rays,
        noise: trial.variance() / (truth * truth) * rays,
    })
}

fn series(name: &str, measured: &[Measured], point: impl Fn(&Measured) -> Point) -> Series {
    Series { name: name.into(), points: measured.iter().map(point).collect() }
}

fn sweep(bench: &Workbench, steps: &Steps) -> Result<Sweep> {
    let x = || Axis::log("1 / (1 - albedo), the radiance in the room");
    let chart = |name: &str, title: String, y: Axis| Chart { name: name.into(), title, x: x(), y, series: vec![] };
    let plain = |y: fn(&Measured) -> f64| move |m: &Measured| Point { x: m.x, y: y(m), error: None };
    let ratio = |m: &Measured| Point { x: m.x, y: m.ratio, error: Some(m.error) };

    let mut charts = Vec::new();
    let mut length = chart("length", "How long paths are".into(), Axis::log("rays a sample"));
    let mut noise = chart(
        "noise",
        "Noise against work: half of it is twice as fast".into(),
        Axis::log("relative variance of a sample x its rays"),
    );
    // By backend, then by termination.
    let mut all = Vec::new();
    for backend in bench.backends() {
        let mut bias = chart(
            &format!("bias-{backend}"),
            format!("Mean over truth, by what ends a path ({backend})"),
            Axis::linear("mean / truth"),
        );
        let mut of_backend = Vec::new();
        for termination in terminations() {
            let points: Result<Vec<Measured>> = steps
                .absorbed
                .iter()
                .map(|a| {
                    let all = if termination.is_even() { 0.0 } else { steps.rays };
                    measure(bench, backend, termination.estimator, *a, [all, (termination.rays)(*a)])
                })
                .collect();
            let points = points?;
            bias.series.push(series(termination.name, &points, ratio));
            // These follow from the random numbers, which are the same for all backends.
            if backend == Backend::Cpu {
                length.series.push(series(termination.name, &points, plain(|m| m.rays)));
                noise.series.push(series(termination.name, &points, plain(|m| m.noise)));
            }
            of_backend.push(points);
        }
        all.push((backend, of_backend));
        charts.push(bias);
    }
    charts.extend([length, noise]);

    let mut cap = chart(
        "cap",
        format!("Paths that would be longer than {LONGEST_PATH} bounces are lost"),
        Axis::linear("mean / truth"),
    );
    let mut beyond = Vec::new();
    for backend in bench.backends() {
        let estimator = Estimator::default();
        let each = f64::from(LONGEST_PATH);
        let points: Result<Vec<Measured>> = (steps.beyond.iter())
            .map(|a| measure(bench, backend, estimator, *a, [2.0 * steps.rays, each.min(1.0 / a)]))
            .collect();
        let points = points?;
        cap.series.push(series(&backend.to_string(), &points, ratio));
        beyond.extend(points);
    }
    charts.push(cap);
    let verdicts = verdicts(&all, &beyond);
    let measured = all.iter().flat_map(|(_, of)| of.iter().flatten()).chain(&beyond);
    let range = stretch(measured.map(Measured::albedo), Worse::Upwards, "(albedo)");
    let summary = up_to(&verdicts, "", |end| {
        format!("Keep albedos at {end} or below, and do without limits of bounces in bright rooms.")
    });
    Ok(Sweep { charts, range, verdicts, summary, findings: findings(&all, &beyond) })
}

fn findings(all: &[(Backend, Vec<Vec<Measured>>)], beyond: &[Measured]) -> Findings {
    // Roulette against the truth, in standard errors.
    let sigma = all.iter().flat_map(|(_, of)| of[..2].iter().flatten()).map(|m| ((m.ratio - 1.0) / m.error).abs());
    let sigma = sigma.fold(0.0, f64::max);
    let reference = &all[0].1;
    let rays = |termination: usize| reference[termination].last().map_or(String::new(), |m| count(m.rays));
    let top = reference[0].last().map_or(0.0, |m| 1.0 - 1.0 / m.x);
    // What f32 makes of a product of as many factors as the longest paths have: all paths are the same there.
    let ends = all.iter().filter_map(|(_, of)| of[3].last()).map(|m| m.ratio);
    let rounding = ends.map(|ratio| (ratio - all[0].1[3].last().map_or(ratio, |m| m.ratio)).abs()).fold(0.0, f64::max);
    let rounding = match all.len() {
        1 => String::new(),
        _ => format!(", and in f32 the product of so many factors is {} off", share(rounding)),
    };
    let lowest = beyond.iter().min_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let lowest = lowest.map_or(String::new(), |m| format!("{} of the light at {:.5}", share(m.ratio), m.albedo()));
    Findings {
        starts: format!("More than 1 % off (roulette is never more than {sigma:.1} standard errors off):"),
        how: format!(
            "In a closed room light meets 1 / (1 - albedo) surfaces in the mean. A limit of k bounces leaves 1 - a^(k+2) of the light; \
             literal \
             extinction counts every loss twice and leaves 1 / (1 + a); a threshold t leaves 1 - t, but its paths are {} rays long at \
             albedo \
             {top:.4} where roulette needs {}{rounding}. No weight grows, and a path that would meet more than {LONGEST_PATH} surfaces is lost: \
             counted, and named when the render ends. Up to 0.999 that is less than one path in a million; beyond, what is left is too dark: {lowest}.",
            rays(3),
            rays(0),
        ),
        mends: format!(
            "Roulette by throughput is the default: no bias, and paths as long as the light lives ({} rays at {top:.4}). A path \
             ends after {LONGEST_PATH} bounces, even in a room that absorbs nothing. Limits and thresholds are off unless asked for.",
            rays(0),
        ),
        sees: "With the default noise and time that grow with 1 / (1 - albedo) and a right picture. With a limit of bounces or the \
             literal extinction a \
             picture that is too dark and looks converged. Above albedo 0.9997 a warning that counts the lost samples, and too little light; real \
             matter stays below 0.99."
            .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roulette has no bias, up to four standard errors; the others have the bias that the slides' arithmetic says.
    #[test]
    fn what_ends_a_path_has_its_bias() {
        let steps = Steps { absorbed: vec![0.5, 0.01], beyond: vec![1e-3], rays: 2e5 };
        let done = sweep(&Workbench::new(false).unwrap(), &steps).unwrap();
        let charts = done.charts.iter().filter(|chart| chart.name.starts_with("bias-"));
        for chart in charts {
            let [throughput, surface, literal, threshold, bounces] = &chart.series[..] else { panic!("{chart:?}") };
            for i in 0..2 {
                let a = f64::from((1.0 - steps.absorbed[i]) as f32);
                let bounded = |series: &Series, truth: f64, slack: f64| {
                    let Point { y, error, .. } = series.points[i];
                    let error = error.unwrap();
                    assert!(error < 0.1, "not sharp enough: {series:?}");
                    assert!((y - truth).abs() <= 4.0 * error + slack, "{}: {series:?}, expected {truth}", chart.name);
                };
                bounded(throughput, 1.0, 0.0);
                bounded(surface, 1.0, 0.0);
                bounded(literal, 1.0 / (1.0 + a), 0.0);
                bounded(threshold, 1.0, f64::from(THRESHOLD));
                bounded(bounces, 1.0 - a.powi(BOUNCES as i32 + 2), 1e-4);
            }
        }
    }
}
