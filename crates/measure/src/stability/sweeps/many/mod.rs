//! Very many luminaires, instances and bounces: what they cost, and what they do to the error.

mod scenes;
mod timing;

use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::report::table::Table;
use crate::report::words::{capital, count, share};
use crate::stability::judge::{light, up_to};
use crate::stability::limits::largest;
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::trial::Trial;
use crate::stability::verdict::{Verdict, Worse, stretch};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::render::Tracer;
use luminaire::scene::{LightChoice, LightSampling};
use scenes::{SIZE, city, crowd, film, long_paths};
use timing::compare;

/// The sweep over numbers of things.
pub const DEFINITION: Definition = Definition {
    name: "many",
    family: Family::Light,
    title: "luminaires, instances and bounces, 1 to 1e5 of each",
    run,
};

struct Steps {
    numbers: Vec<u32>,
    /// Seconds of one timing, of which there are several for each number.
    seconds: f64,
    /// Samples a pixel from which the noise is estimated.
    samples: u32,
}

/// The default, as a method, and what it is held against.
const BOTH: &str = "both, weighted";
const DIRECT: &str = "direct light alone";
const POWER: &str = "both, lamps by their power";
/// How these find the light of many lamps.
const WAYS: [(&str, LightSampling, LightChoice); 3] = [
    (BOTH, LightSampling::Mis, LightChoice::Auto),
    (DIRECT, LightSampling::Direct, LightChoice::Auto),
    (POWER, LightSampling::Mis, LightChoice::Power),
];
/// Paths of many bounces in a closed room, as a method.
const LONG_PATHS: &str = "long paths";

fn run(bench: &Workbench) -> Result<Sweep> {
    let steps = match bench.long {
        false => Steps { numbers: vec![1, 10, 100, 1000, 10_000, 100_000], seconds: 0.03, samples: 512 },
        true => Steps {
            numbers: (0..=20).map(|i| 10f64.powf(0.25 * f64::from(i)).round() as u32).collect(),
            seconds: 0.15,
            samples: 8192,
        },
    };
    sweep(bench, &steps)
}

/// The series of one backend over the numbers.
struct Lines {
    time: Series,
    bytes: Series,
}

fn lines(backend: Backend) -> Lines {
    let empty = || Series { name: backend.to_string(), points: vec![] };
    Lines { time: empty(), bytes: empty() }
}

fn sweep(bench: &Workbench, steps: &Steps) -> Result<Sweep> {
    let chart = |name: &str, title: &str, x: &str, y: Axis| Chart {
        name: name.into(),
        title: title.into(),
        x: Axis::log(x),
        y,
        series: vec![],
    };
    let ratio = || Axis::log("time a ray / that with one");
    let mut light_time = chart("luminaires-time", "Time a ray under many lamps", "lamps", ratio());
    let mut object_time = chart("instances-time", "Time a ray among many spheres", "instances", ratio());
    let mut bounce_time = chart("bounces-time", "Time a ray on long paths", "bounces", ratio());
    let mut memory =
        chart("memory", "Memory of the device", "lamps or instances", Axis::log("bytes, without those of one"));
    let mut noise = chart(
        "noise",
        "A street of lamps: noise of its direct light",
        "lamps",
        Axis::log("relative standard deviation of a sample"),
    );
    let mut drift = chart(
        "bounces-error",
        "A closed room whose paths have n bounces",
        "bounces",
        Axis::log("relative error of the mean"),
    );

    for backend in bench.backends() {
        let one = |y: f64, n: u32| Point { x: f64::from(n), y, error: None };
        let (mut lights, mut objects, mut bounces) = (lines(backend), lines(backend), lines(backend));
        let series = |name: String| Series { name, points: vec![] };
        let mut noises = WAYS.map(|(name, ..)| series(format!("{name} ({backend})")));
        let mut errors = series(backend.to_string());
        let smallest = (city(1, LightSampling::Mis, LightChoice::Auto), crowd(1), long_paths(1).0);
        let mut least: [Option<f64>; 2] = [None; 2];
        for &n in &steps.numbers {
            let scene = city(n, LightSampling::Mis, LightChoice::Auto);
            let mut compared = compare(bench, backend, (&smallest.0, &scene), [3.0; 2], steps.seconds)?;
            lights.time.points.push(one(compared.ratio, n));
            let mut add_bytes = |bytes: Option<f64>, which: usize, line: &mut Series| {
                if let Some(bytes) = bytes {
                    let base = *least[which].get_or_insert(bytes);
                    line.points.extend((n > 1).then(|| one(bytes - base, n)));
                }
            };
            add_bytes(compared.bytes, 0, &mut lights.bytes);
            let deviation = |tracer: &mut dyn Tracer| -> Result<Point> {
                let trial = Trial::new(tracer, SIZE, steps.samples, 3.0)?;
                Ok(one(trial.variance().sqrt() / trial.mean().mean, n))
            };
            noises[0].points.push(deviation(compared.tracer.as_mut())?);
            for (noise, (_, sampling, choice)) in noises.iter_mut().zip(WAYS).skip(1) {
                let mut tracer = bench.tracer(&city(n, sampling, choice), backend)?;
                noise.points.push(deviation(tracer.as_mut())?);
            }

            let compared = compare(bench, backend, (&smallest.1, &crowd(n)), [3.0; 2], steps.seconds)?;
            objects.time.points.push(one(compared.ratio, n));
            add_bytes(compared.bytes, 1, &mut objects.bytes);

            let (scene, truth) = long_paths(n);
            let rays = [3.0, f64::from(n) + 2.0];
            let mut compared = compare(bench, backend, (&smallest.2, &scene), rays, steps.seconds)?;
            bounces.time.points.push(one(compared.ratio, n));
            // The reference needs no more: without rounding all of its paths are the same.
            let samples = if rays[1] > 1e4 { 1 } else { 4 };
            let mean = Trial::new(compared.tracer.as_mut(), film(&scene), samples, rays[1])?.mean().mean;
            errors.points.push(one((mean / truth - 1.0).abs(), n));
        }
        light_time.series.push(lights.time);
        object_time.series.push(objects.time);
        bounce_time.series.push(bounces.time);
        if backend != Backend::Cpu {
            lights.bytes.name = format!("lamps ({backend})");
            objects.bytes.name = format!("instances ({backend})");
            memory.series.extend([lights.bytes, objects.bytes]);
        }
        noise.series.extend(noises);
        drift.series.push(errors);
    }
    let verdicts = verdicts(&noise, &drift);
    let range = stretch(steps.numbers.iter().map(|n| f64::from(*n)), Worse::Upwards, "things");
    let wrong = becomes_wrong(&verdicts);
    let all = verdicts.iter().any(|verdict| verdict.method == BOTH && verdict.is_safe());
    let summary = match all {
        true => {
            let most = count(f64::from(steps.numbers.last().copied().unwrap_or(0)));
            format!("Up to {most} lamps of equal power a sample varies by little more than its mean; {wrong}.")
        }
        false => up_to(&verdicts, BOTH, |end| {
            format!("{}; beyond {end} lamps of equal power noise is large.", capital(&wrong))
        }),
    };
    let findings = findings(steps, &wrong, [&light_time, &object_time, &bounce_time, &memory, &noise, &drift]);
    let mut charts = vec![light_time, object_time, bounce_time, memory, noise, drift];
    charts.retain(|chart| !chart.series.is_empty());
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// The ways to find the light of many lamps, by its noise, the default first; and long paths, by how far their mean drifts.
fn verdicts(noise: &Chart, drift: &Chart) -> Vec<Verdict> {
    let squared = |series: &Series| Series {
        points: series.points.iter().map(|p| Point { y: p.y * p.y, ..*p }).collect(),
        ..series.clone()
    };
    let share = |series: &Series| Series {
        points: series.points.iter().map(|p| Point { y: 1.0 + p.y, ..*p }).collect(),
        ..series.clone()
    };
    let drift: Vec<Series> = drift.series.iter().map(share).collect();
    let noisy = |method: &str| {
        let variances: Vec<_> = noise.series.iter().filter(|s| s.name.starts_with(method)).map(squared).collect();
        light(method, &variances.iter().collect::<Vec<_>>(), &[], Worse::Upwards)
    };
    let long_paths = light(LONG_PATHS, &[], &drift.iter().collect::<Vec<_>>(), Worse::Upwards);
    WAYS.map(|(method, ..)| noisy(method)).into_iter().chain([long_paths]).collect()
}

/// What the verdicts say of wrong pictures.
fn becomes_wrong(verdicts: &[Verdict]) -> String {
    let wrong: Vec<_> = verdicts.iter().filter(|verdict| verdict.has_wrong()).map(|v| v.method.as_str()).collect();
    if wrong.is_empty() { "nothing becomes wrong".into() } else { format!("wrong somewhere: {}", wrong.join(", ")) }
}

fn findings(steps: &Steps, wrong: &str, [lights, objects, bounces, memory, noise, drift]: [&Chart; 6]) -> Findings {
    let last = |series: &Series| series.points.last().map_or(f64::NAN, |p| p.y);
    let most = count(f64::from(steps.numbers.last().copied().unwrap_or(0)));
    // Without a GPU there is only the reference.
    let of_last = noise.series.len() - WAYS.len();
    let (both, direct, power) = (&noise.series[of_last], &noise.series[of_last + 1], &noise.series[of_last + 2]);
    // One lamp leaves no choice; the first number that does is what the others are held against.
    let few = steps.numbers.get(1).copied().unwrap_or(1);
    let first = |series: &Series| series.points.get(1).map_or(f64::NAN, |p| p.y);
    let bytes = |what: &str, backend: &str| {
        let name = format!("{what} ({backend})");
        let line = memory.series.iter().find(|series| series.name == name);
        line.map_or("–".into(), |s| format!("{:.0}", last(s) / f64::from(*steps.numbers.last().unwrap_or(&1))))
    };
    let row = |index: usize| {
        let name = &drift.series[index].name;
        let [lights, objects, bounces] = [lights, objects, bounces].map(|chart| last(&chart.series[index]));
        let (lamp, instance) = (bytes("lamps", name), bytes("instances", name));
        let error = share(last(&drift.series[index]));
        let [lights, objects, bounces] = [lights, objects, bounces].map(|times| format!("{times:.1}"));
        vec![name.clone(), lights, objects, bounces, lamp, instance, error]
    };
    let columns = [
        "backend".into(),
        format!("{most} lamps: times"),
        format!("{most} instances"),
        format!("{most} bounces"),
        "bytes a lamp".into(),
        "bytes an instance".into(),
        format!("error of the mean at {most} bounces"),
    ];
    let table = Table::new(columns).with_rows((0..drift.series.len()).map(row)).markdown();
    Findings {
        starts: format!(
            "Noise: the deviation of a sample grows from {:.2} with {few} lamps to {:.1} with {most}, with direct light alone from {:.2} to {:.1}, \
             with lamps chosen by their power from {:.2} to {:.1}. A ray takes, against one thing alone, and a thing takes in memory:\n\n\
             {table}\nThe noise of lamps (their light is held against no truth here), and the error of long paths:",
            first(both),
            last(both),
            first(direct),
            last(direct),
            first(power),
            last(power),
        ),
        how: format!(
            "Chosen by its power, a lamp's distance does not count: of {most} lamps a point on the floor is lit by a few, which are hardly ever chosen. \
             Trees make the time grow with the \
             logarithm of the number, and then with what no longer fits the caches. Memory grows in proportion. Paths of more than 32768 bounces are lost \
             ([albedo](#albedo)), which is all of the light at last ({} off); shorter ones multiply as many rounded numbers as they have bounces.",
            share(drift.series.iter().map(largest).fold(0.0, f64::max)),
        ),
        mends: "A tree over the lamps chooses by what may arrive of each at this place, which costs more with the logarithm of their number. A direction \
                from the surface finds near lamps that the choice misses, and multiple importance sampling keeps the better of both. What a device cannot hold is refused \
                by name and size before the render."
            .into(),
        sees: format!(
            "To look alike, {most} lamps need {:.0} times the samples of {few}; with `--light-choice power` {:.0} times as many again. \
             Time and memory grow gently; by the verdicts {wrong}.",
            (last(both) / first(both)).powi(2),
            (last(power) / last(both)).powi(2),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::scene::Scene;

    /// However noisy the lamps are, an error of long paths is wrong, and is said to be.
    #[test]
    fn long_paths_have_a_verdict_of_their_own() {
        let line = |name: &str, points: &[(f64, f64)]| Series {
            name: name.into(),
            points: points.iter().map(|&(x, y)| Point { x, y, error: None }).collect(),
        };
        let chart = |series| Chart {
            name: "c".into(),
            title: String::new(),
            x: Axis::log("things"),
            y: Axis::log("y"),
            series,
        };
        let lamps = WAYS.map(|(name, ..)| line(&format!("{name} (cpu)"), &[(1.0, 1.0), (10.0, 50.0)]));
        let noise = chart(lamps.into());
        let judged = |drift: f64| verdicts(&noise, &chart(vec![line("cpu", &[(1.0, 1e-7), (10.0, drift)])]));
        let words = |verdicts: &[Verdict]| verdicts.iter().map(Verdict::in_words).collect::<Vec<_>>();
        assert_eq!(
            words(&judged(0.01)),
            ["● at 1, ▲ beyond", "● at 1, ▲ beyond", "● at 1, ▲ beyond", "● at 1, ✖ beyond"]
        );
        assert_eq!(becomes_wrong(&judged(0.01)), "wrong somewhere: long paths");
        assert_eq!(words(&judged(1e-6))[3], "●");
        assert_eq!(becomes_wrong(&judged(1e-6)), "nothing becomes wrong");
    }

    /// Many lamps do not change what is right, long paths lose next to nothing, and choosing both ways is never noisier.
    #[test]
    fn many_things_stay_right() {
        let bench = Workbench::new(false).unwrap();
        for backend in bench.backends() {
            let mean = |scene: &Scene, samples: u32, rays: f64| {
                let mut tracer = bench.tracer(scene, backend).unwrap();
                Trial::new(tracer.as_mut(), film(scene), samples, rays).unwrap()
            };
            let lamps = WAYS.map(|(_, sampling, choice)| mean(&city(100, sampling, choice), 1024, 3.0));
            let [both, others @ ..] = lamps.each_ref().map(Trial::mean);
            for other in others {
                assert!(both.error < 0.05 * both.mean && other.error < 0.05 * both.mean, "{both:?} {other:?}");
                assert!((both.mean - other.mean).abs() < 4.0 * both.error.hypot(other.error), "{both:?} {other:?}");
            }
            assert!(lamps[0].variance() < lamps[1].variance() && lamps[0].variance() < 0.5 * lamps[2].variance());
            for n in [1, 1000] {
                let (scene, truth) = long_paths(n);
                let found = mean(&scene, 1, f64::from(n)).mean().mean;
                assert!((found / truth - 1.0).abs() < 1e-5, "{backend}, {n} bounces: {found} instead of {truth}");
            }
            // Half of the white light, and half of that, by spheres that see little of each other.
            let crowded = mean(&crowd(1000), 4, 3.0).mean().mean;
            assert!((0.3..0.9).contains(&crowded), "{backend}: {crowded}");
        }
    }
}
