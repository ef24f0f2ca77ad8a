//! What ends a path too early: thresholds, limits and roulette without weights, their bias against the work they save.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::report::words::{deviation, share};
use crate::stability::judge::{certain_bias, up_to};
use crate::stability::limits::above_from;
use crate::stability::rooms::{furnace, furnace_radiance, room, without_roulette};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::trial::Trial;
use crate::stability::verdict::{Judgement, SURE, Verdict, Worse, place, stretch};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::{Estimator, Extinction};

/// The sweep over thresholds and other ways to end a path.
pub const DEFINITION: Definition = Definition {
    name: "extinction",
    family: Family::Light,
    title: "the albedo threshold, 1e-1 to 1e-6, and literal extinction",
    run,
};

/// The threshold, as a method.
const THRESHOLD: &str = "threshold";
/// A closed room with an exact answer.
const FURNACE_ALBEDO: f32 = 0.8;
/// Paths of the room's truth: its brightest walls leave 0.75^48 = 1e-6 of the last bounce, its mean walls far less.
const TRUTH_BOUNCES: u32 = 48;
/// So that a threshold ends paths, and not this.
const NEVER_BOUNCES: u32 = 1000;

struct Steps {
    thresholds: Vec<f64>,
    bounces: Vec<u32>,
    size: (u32, u32),
    samples: u32,
}

fn run(bench: &Workbench) -> Result<Sweep> {
    let steps = match bench.long {
        false => Steps {
            thresholds: (1..=6).rev().map(|e| 10f64.powi(-e)).collect(),
            bounces: vec![0, 1, 2, 4, 8, 16],
            size: (8, 8),
            samples: 1024,
        },
        true => Steps {
            thresholds: (2..=12).rev().map(|e| 10f64.powf(-0.5 * f64::from(e))).collect(),
            bounces: vec![0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32],
            size: (8, 8),
            samples: 8192,
        },
    };
    sweep(bench, &steps)
}

/// A way to end paths in the room.
struct Measured {
    /// Relative to the truth.
    bias: f64,
    error: f64,
    rays: f64,
    /// Variance of a sample over the squared truth.
    variance: f64,
}

impl Measured {
    /// The bias, as far as it is certain: 0 where it is within [`SURE`] standard errors.
    fn certain_bias(&self) -> f64 {
        if self.bias.abs() > SURE * self.error { self.bias } else { 0.0 }
    }

    /// Error of a pixel after so many rays for it: bias and noise together.
    fn after(&self, rays: f64) -> f64 {
        self.certain_bias().hypot((self.variance * self.rays / rays).sqrt())
    }
}

/// The room on one backend, by way of ending.
struct Room {
    backend: Backend,
    thresholds: Vec<Measured>,
    bounces: Vec<Measured>,
    literal: Measured,
    surface: Measured,
    throughput: Measured,
}

/// All with the random numbers of the truth, so that what is cut off is measured without the noise of the rest.
fn measure(bench: &Workbench, backend: Backend, steps: &Steps) -> Result<Room> {
    let trial = |estimator: Estimator| {
        let scene = room(steps.size, estimator);
        let mut tracer = bench.tracer(&scene, backend)?;
        let rays = 2.0 * f64::from(estimator.max_bounces.unwrap_or(4).min(TRUTH_BOUNCES) + 1);
        Trial::new(tracer.as_mut(), steps.size, steps.samples, rays)
    };
    let truth = trial(Estimator { max_bounces: Some(TRUTH_BOUNCES), ..without_roulette() })?;
    let mean = truth.mean().mean;
    let against = |estimator: Estimator| -> Result<Measured> {
        let found = trial(estimator)?;
        let difference = found.less(&truth).mean();
        Ok(Measured {
            bias: difference.mean / mean,
            error: difference.error / mean,
            rays: found.rays_a_sample(),
            variance: found.variance() / (mean * mean),
        })
    };
    let threshold = |t: &f64| {
        let limits = Estimator { max_bounces: Some(NEVER_BOUNCES), ..without_roulette() };
        against(Estimator { albedo_threshold: Some(*t as f32), ..limits })
    };
    let bounces = |k: &u32| against(Estimator { max_bounces: Some(*k), ..without_roulette() });
    let roulette = |extinction| against(Estimator { extinction, ..Estimator::default() });
    Ok(Room {
        backend,
        thresholds: steps.thresholds.iter().map(threshold).collect::<Result<_>>()?,
        bounces: steps.bounces.iter().map(bounces).collect::<Result<_>>()?,
        literal: roulette(Extinction::Literal)?,
        surface: roulette(Extinction::Surface)?,
        throughput: roulette(Extinction::Throughput)?,
    })
}

/// What a threshold cuts off in the furnace: the share `a^k` of the light after the last bounce, the `k`th, that reaches it.
fn cut(threshold: f64) -> f64 {
    let a = f64::from(FURNACE_ALBEDO);
    let mut share = a;
    while share >= f64::from(threshold as f32) {
        share *= a;
    }
    share
}

fn furnaces(bench: &Workbench, steps: &Steps) -> Result<Chart> {
    let closed = steps.thresholds.iter().map(|t| Point { x: *t, y: cut(*t), error: None }).collect();
    let mut series = vec![Series { name: "closed form".into(), points: closed }];
    for backend in bench.backends() {
        let mut points = Vec::new();
        for threshold in &steps.thresholds {
            let limits = Estimator { max_bounces: Some(NEVER_BOUNCES), ..without_roulette() };
            let scene =
                furnace((8, 8), FURNACE_ALBEDO, Estimator { albedo_threshold: Some(*threshold as f32), ..limits });
            let mut tracer = bench.tracer(&scene, backend)?;
            let mean = Trial::new(tracer.as_mut(), (8, 8), 16, 64.0)?.mean();
            let truth = furnace_radiance(FURNACE_ALBEDO);
            points.push(Point { x: *threshold, y: 1.0 - mean.mean / truth, error: Some(mean.error / truth) });
        }
        series.push(Series { name: backend.to_string(), points });
    }
    Ok(Chart {
        name: "furnace".into(),
        title: format!("Light that a threshold loses in a closed room of albedo {FURNACE_ALBEDO}"),
        x: Axis::log("albedo threshold"),
        y: Axis::log("relative loss"),
        series,
    })
}

/// Bias over work: what a method loses, and what its paths cost.
fn bias_chart(room: &Room) -> Chart {
    let point = |m: &Measured| Point { x: m.rays, y: m.bias.abs(), error: Some(m.error) };
    let series = |name: &str, points: Vec<Point>| Series { name: name.into(), points };
    Chart {
        name: format!("bias-{}", room.backend),
        title: format!("A coloured room: bias against the length of paths ({})", room.backend),
        x: Axis::log("rays a sample"),
        y: Axis::log("relative bias of the picture's mean"),
        series: vec![
            series("threshold 1e-6 to 1e-1", room.thresholds.iter().rev().map(point).collect()),
            series("0, 1, 2, ... bounces at most", room.bounces.iter().map(point).collect()),
            series("literal extinction", vec![point(&room.literal)]),
            series("roulette by surface", vec![point(&room.surface)]),
            series("roulette by throughput", vec![point(&room.throughput)]),
        ],
    }
}

/// Error over time, from the measured bias and noise.
fn time_chart(steps: &Steps, room: &Room) -> Chart {
    let curve = |name: String, m: &Measured| Series {
        name,
        points: (2..=14)
            .map(|i| 10f64.powf(0.5 * f64::from(i)))
            .map(|rays| Point { x: rays, y: m.after(rays), error: None })
            .collect(),
    };
    let threshold = |index: usize| curve(format!("threshold {:.0e}", steps.thresholds[index]), &room.thresholds[index]);
    let last = steps.thresholds.len() - 1;
    let some = steps.bounces.len() / 2;
    Chart {
        name: "time".into(),
        title: format!("A coloured room: error of a pixel against work, from bias and noise ({})", room.backend),
        x: Axis::log("rays for the pixel"),
        y: Axis::log("relative error (root mean square)"),
        series: vec![
            curve("roulette by throughput".into(), &room.throughput),
            curve("roulette by surface".into(), &room.surface),
            curve("literal extinction".into(), &room.literal),
            threshold(last),
            threshold(0),
            curve(format!("{} bounces at most", steps.bounces[some]), &room.bounces[some]),
        ],
    }
}

fn sweep(bench: &Workbench, steps: &Steps) -> Result<Sweep> {
    let furnaces = furnaces(bench, steps)?;
    let rooms =
        bench.backends().into_iter().map(|backend| measure(bench, backend, steps)).collect::<Result<Vec<_>>>()?;
    let verdicts = verdicts(steps, &rooms);
    let range = stretch(steps.thresholds.iter().copied(), Worse::Upwards, "(threshold)");
    let summary = up_to(&verdicts, THRESHOLD, |end| {
        format!("Stay with re-weighted roulette; thresholds above {end} darken, literal extinction always does.")
    });
    let findings = findings(steps, &furnaces, &rooms);
    let mut charts = vec![furnaces];
    charts.extend(rooms.iter().map(bias_chart));
    charts.extend(rooms.first().map(|room| time_chart(steps, room)));
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// Each way to end paths in the coloured room over all backends, the default first.
fn verdicts(steps: &Steps, rooms: &[Room]) -> Vec<Verdict> {
    let judge = |m: &Measured| Judgement::of_light(m.variance, certain_bias(1.0 + m.bias, m.error), m.error);
    let without_range = |method: &str, of: fn(&Room) -> &Measured| {
        let (first, last) = (steps.thresholds[0], steps.thresholds[steps.thresholds.len() - 1]);
        let judged = rooms.iter().flat_map(|room| [first, last].map(|x| (x, judge(of(room)))));
        let found = of(&rooms[0]);
        Verdict::new(method, judged, Worse::Upwards, deviation(found.bias, found.error))
    };
    let at = |x: &f64, m: &Measured| format!("{} at {}", share(m.bias.abs()), place(*x));
    let over = |method: &str, places: Vec<f64>, worse: Worse, of: fn(&Room) -> &[Measured]| {
        let judged = rooms.iter().flat_map(|room| places.iter().copied().zip(of(room).iter().map(judge)));
        let found = places.iter().zip(of(&rooms[0])).map(|(x, m)| at(x, m)).collect::<Vec<_>>().join(", ");
        Verdict::new(method, judged, worse, found)
    };
    let bounces = steps.bounces.iter().map(|bounces| f64::from(*bounces)).collect();
    vec![
        without_range("roulette by throughput", |room| &room.throughput),
        without_range("roulette by surface", |room| &room.surface),
        without_range("literal extinction", |room| &room.literal),
        over(THRESHOLD, steps.thresholds.clone(), Worse::Upwards, |room| &room.thresholds),
        over("limit of bounces", bounces, Worse::Upwards, |room| &room.bounces),
    ]
}

fn findings(steps: &Steps, furnaces: &Chart, rooms: &[Room]) -> Findings {
    let reference = &rooms[0];
    let last = steps.thresholds.len() - 1;
    let sigma =
        rooms.iter().flat_map(|r| [&r.surface, &r.throughput]).map(|m| (m.bias / m.error).abs()).fold(0.0, f64::max);
    // Work for 1 % of error, where a method gets there at all.
    let one_percent = |m: &Measured| {
        let left = 1e-4 - m.certain_bias().powi(2);
        (left > 0.0).then(|| m.variance * m.rays / left)
    };
    let base = one_percent(&reference.throughput).unwrap_or(f64::NAN);
    let time = |m: &Measured| {
        one_percent(m).map_or("never gets there".to_owned(), |rays| format!("{:.2} times the rays", rays / base))
    };
    let worst = furnaces.series[1..].iter().flat_map(|s| s.points.iter().zip(&furnaces.series[0].points));
    let worst = worst.map(|(found, closed)| (found.y - closed.y).abs()).fold(0.0, f64::max);
    let below =
        above_from(&furnaces.series[0], 1e-3).map_or("never".to_owned(), |x| format!("from one of {} on", share(x)));
    Findings {
        starts: format!(
            "In a closed room literal extinction leaves 1 / (1 + albedo) of the light at once, and a threshold takes more than 0.1 % \
             {below}. Re-weighted roulette is never more than {sigma:.1} standard errors off on any backend. Of the light of the coloured \
             room is missing:",
        ),
        how: format!(
            "What is cut off is missing, always on the dark side, and no number of samples brings it back. Measured on every backend in \
             the closed room the loss is the closed \
             form's a^k to {}. To 1 % of error in a pixel of the coloured room, against roulette by throughput: by surface {}, literal \
             {}, threshold {:.0e} {}, {:.0e} {}.",
            share(worst),
            time(&reference.surface),
            time(&reference.literal),
            steps.thresholds[last],
            time(&reference.thresholds[last]),
            steps.thresholds[0],
            time(&reference.thresholds[0]),
        ),
        mends: "Roulette is re-weighted by default: the survivors stand for those that ended. Literal extinction and the threshold are \
        there to be compared (`--estimator \
                literal-extinction`, `--estimator threshold`)."
            .into(),
        sees: "A literal extinction or a coarse threshold gives a picture without more noise that is too dark, most of all where light \
        arrives by many bounces: corners, \
               under tables, white rooms. At few samples it can even look better."
            .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A threshold loses what the series says; roulette loses nothing; literal extinction loses much.
    #[test]
    fn losses_are_the_series() {
        let steps = Steps { thresholds: vec![1e-3, 1e-1], bounces: vec![0, 4], size: (4, 4), samples: 512 };
        let bench = Workbench::new(false).unwrap();
        for series in &furnaces(&bench, &steps).unwrap().series {
            for point in &series.points {
                assert!(
                    (point.y / cut(point.x) - 1.0).abs() < 1e-3,
                    "{}: {point:?}, expected {}",
                    series.name,
                    cut(point.x)
                );
            }
        }
        for backend in bench.backends() {
            let room = measure(&bench, backend, &steps).unwrap();
            for fair in [&room.surface, &room.throughput] {
                assert!(
                    fair.error < 0.1 && fair.bias.abs() < 4.0 * fair.error,
                    "{backend}: {} {}",
                    fair.bias,
                    fair.error
                );
            }
            assert!(room.literal.bias < -4.0 * room.literal.error, "{backend}: {}", room.literal.bias);
            assert!(room.thresholds[1].bias < room.thresholds[0].bias && room.bounces[0].bias < room.bounces[1].bias);
        }
    }
}
