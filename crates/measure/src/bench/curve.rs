//! Error over time: which estimator on which backend has the smallest error after so many seconds.

use super::contenders::{contenders, reference, words};
use super::pareto::LEAST_GAIN;
use super::trial::{Reference, Rung, STEP, Trial, ready};
use super::words::{number, with_spread};
use super::{BenchScene, Better, Definition, Figure, Section, Settings, Table, Tell, front, spread};
use crate::Workbench;
use crate::chart::{Axis, Chart, FRONT, Point, Series};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::Scene;

/// The section of errors over time and samples.
pub(super) const DEFINITION: Definition =
    Definition { name: "convergence", title: "Error over time, by estimator and backend", scenes: true, run };

/// The seed of the reference is the scene's with these bits changed; the rounds' are the next after the scene's.
const REFERENCE_SEED: u32 = 0x5eed_0000;
/// Figures beyond seconds and relMSE are of so many of the longest renders: two runs that differ by one step still have one in common.
const COMPARED_RUNGS: usize = 2;

/// A scene with all that was measured on it.
struct Measured {
    name: String,
    trials: Vec<Trial>,
    /// The reference's own relMSE, where it is known.
    own_error: Option<f64>,
    notes: Vec<String>,
}

fn run(bench: &Workbench, settings: &Settings, tell: Tell) -> Result<Section> {
    let text = format!(
        "Every estimator on every backend renders every scene with 1, {STEP}, {}, ... samples a pixel, each picture from its first sample on, as long \
         as it seems to fit into {} s. That is done in {} rounds with other random numbers; in a round each of them takes its turn, so that what else the \
         machine does meets all alike. Times are medians with least and most. Building and shader compilation are not in them: the column `ready` has \
         the seconds from a loaded scene to its first samples, the first time of all (with compilation, unless the driver has kept the shaders of an \
         earlier run) and later.",
        STEP * STEP,
        settings.effort.budget_seconds(),
        settings.rounds
    );
    let explained = format!(
        "relMSE is the mean over pixels and channels of (a - b)^2 / (b^2 + 0.01), averaged over the rounds, with two standard errors as bars; the \
         reference's own estimated error is taken off. Lower and further left is better. The dashed line is the Pareto front: nothing else has an \
         error as small in the same time ({:.0} % count as a difference). Over samples the backend does not matter, as all draw the same numbers; one that \
         got furthest stands for all. relMSE times seconds is what an error costs: half of it is twice as fast. For independent \
         samples it is the same at all numbers of samples, for Sobol points it falls; the table has the longest renders.",
        100.0 * LEAST_GAIN
    );
    let mut text = vec![text, explained];
    let mut all = Vec::new();
    for (number, scene) in settings.scenes.iter().enumerate() {
        tell(&format!("{}/{} {}", number + 1, settings.scenes.len(), scene.name));
        all.push(measure(bench, settings, scene, tell)?);
    }
    let ran = |name: &&String| all.iter().any(|of| of.trials.iter().any(|trial| trial.estimator == **name));
    let estimators: Vec<_> = settings.estimators.iter().filter(ran).map(|name| words(name)).collect();
    text.push(format!("The estimators. {}.", estimators.join(". ")));
    text.extend(all.iter().map(findings));
    Ok(Section {
        name: DEFINITION.name,
        title: DEFINITION.title.into(),
        text,
        tables: vec![error_table(&all), rate_table(&all)],
        charts: all.iter().flat_map(charts).collect(),
        figures: all.iter().flat_map(figures).collect(),
    })
}

fn measure(bench: &Workbench, settings: &Settings, of: &BenchScene, tell: Tell) -> Result<Measured> {
    let mut scene = of.scene.clone();
    let seed = scene.settings.seed;
    let (contenders, mut notes) = contenders(&scene, &settings.estimators);
    let mut trials: Vec<Trial> = settings
        .backends
        .iter()
        .flat_map(|backend| contenders.iter().map(|contender| Trial::new(&contender.name, *backend)))
        .collect();
    tell("    shaders are compiled");
    for (trial, contender) in trials.iter_mut().zip(contenders.iter().cycle()) {
        scene.integrator = contender.integrator;
        scene.settings.sampler = contender.sampler;
        trial.first_ready_seconds = ready(bench, &scene, trial.backend)?.1;
    }
    (scene.integrator, scene.settings) = (of.scene.integrator, of.scene.settings);
    let held_against = hold_against(bench, settings, &mut scene, tell)?;
    let own_error = held_against.own_error;
    let known = own_error
        .map_or("whose own error is not known".into(), |error| format!("whose own relMSE is about {}", number(error)));
    notes.insert(0, format!("The reference is {}, {known}.", held_against.words));
    for round in 0..settings.rounds {
        tell(&format!("    round {} of {}", round + 1, settings.rounds));
        for (trial, contender) in trials.iter_mut().zip(contenders.iter().cycle()) {
            scene.integrator = contender.integrator;
            scene.settings.sampler = contender.sampler;
            scene.settings.seed = seed.wrapping_add(1 + round as u32);
            let truth = (&held_against.picture, own_error.unwrap_or(0.0));
            trial.round(bench, &scene, truth, settings.effort.budget_seconds())?;
        }
    }
    Ok(Measured { name: of.name.clone(), trials, own_error, notes })
}

/// The reference that was given, or one that the fastest backend renders.
fn hold_against(bench: &Workbench, settings: &Settings, scene: &mut Scene, tell: Tell) -> Result<Reference> {
    if let Some(picture) = &settings.reference {
        return Ok(Reference::given(picture));
    }
    let contender = reference(scene);
    let own = (scene.integrator, scene.settings);
    scene.integrator = contender.integrator;
    scene.settings.sampler = contender.sampler;
    scene.settings.seed ^= REFERENCE_SEED;
    let fastest = fastest(bench, settings, scene)?;
    tell(&format!("    reference on {fastest}, about {} s", settings.effort.reference_seconds()));
    let rendered = Reference::rendered(bench, scene, &contender, fastest, settings.effort.reference_seconds());
    (scene.integrator, scene.settings) = own;
    rendered
}

/// The backend on which a few samples take the least time.
fn fastest(bench: &Workbench, settings: &Settings, scene: &Scene) -> Result<Backend> {
    let mut best = (settings.backends[0], f64::INFINITY);
    for &backend in settings.backends.iter().filter(|_| settings.backends.len() > 1) {
        let seconds = Reference::pace(bench, scene, backend)?;
        if seconds < best.1 {
            best = (backend, seconds);
        }
    }
    Ok(best.0)
}

/// What the measurements of a scene say, in sentences.
fn findings(measured: &Measured) -> String {
    let Measured { name, trials, own_error, notes } = measured;
    let mut words = notes.clone();
    let places = places(trials);
    let mut runs: Vec<(usize, Vec<String>)> = Vec::new();
    for place in on_front(&places) {
        match runs.last_mut() {
            Some((trial, samples)) if *trial == place.trial => samples.push(place.spp.to_string()),
            _ => runs.push((place.trial, vec![place.spp.to_string()])),
        }
    }
    let runs: Vec<String> = runs
        .iter()
        .map(|(trial, samples)| {
            let plural = if *samples == ["1"] { "" } else { "s" };
            format!("{} with {} sample{plural}", trials[*trial].name(), samples.join(", "))
        })
        .collect();
    words.push(format!("On the Pareto front, from the fastest to the most exact, are {}.", runs.join("; ")));
    let cost = |trial: &Trial| trial.rungs.last().map_or(f64::NAN, |rung| spread(&rung.costs())[0]);
    let mut order: Vec<&Trial> = trials.iter().filter(|t| cost(t) > 0.0).collect();
    order.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    if let [best, .., last] = order[..] {
        words.push(format!(
            "relMSE times seconds at the longest renders is least for {} ({}), and {} times that for {}.",
            best.name(),
            number(cost(best)),
            number(cost(last) / cost(best)),
            last.name()
        ));
    }
    let agree = agreement(trials);
    if let Some(off) = agree {
        words.push(format!(
            "All backends draw the same random numbers; at equal samples their relMSE differs by at most {} %.",
            number(100.0 * off)
        ));
    }
    let near = own_error.map_or(0, |own| places.iter().filter(|place| place.at.1 < 2.0 * own).count());
    if near > 0 {
        words.push(format!(
            "{near} of {} points are less than twice the reference's own error, and uncertain.",
            places.len()
        ));
    }
    let dropped: u64 = trials.iter().map(|trial| trial.dropped).sum();
    if dropped > 0 {
        words.push(format!("{dropped} samples were not finite, and are left out."));
    }
    let biased: Vec<_> = trials.iter().map(|t| &t.estimator[..]).filter(|e| is_biased(e)).collect();
    if let Some(estimator) = biased.first() {
        words.push(format!("`{estimator}` has a bias, at which its error ends falling."));
    }
    format!("{name}: {}", words.join(" "))
}

fn is_biased(estimator: &str) -> bool {
    ["literal-extinction", "threshold"].iter().any(|name| estimator.starts_with(name))
}

/// By how much relMSE differs between backends at the same estimator and samples, at most; none for one backend.
fn agreement(trials: &[Trial]) -> Option<f64> {
    let pairs = trials.iter().enumerate().flat_map(|(i, a)| trials[..i].iter().map(move |b| (a, b)));
    let same = pairs.filter(|(a, b)| a.estimator == b.estimator);
    same.flat_map(|(a, b)| a.rungs.iter().zip(&b.rungs).map(|(a, b)| (a.error().0 / b.error().0 - 1.0).abs()))
        .filter(|off| off.is_finite())
        .reduce(f64::max)
}

/// A render as a point of the chart.
struct Place {
    trial: usize,
    spp: u32,
    /// Seconds and relMSE.
    at: (f64, f64),
}

/// All renders.
fn places(trials: &[Trial]) -> Vec<Place> {
    let all = trials.iter().enumerate().flat_map(|(i, trial)| trial.rungs.iter().map(move |rung| (i, rung)));
    all.map(|(trial, rung)| Place { trial, spp: rung.spp, at: (rung.median_seconds(), rung.error().0) }).collect()
}

/// Those on the Pareto front, the fastest first.
fn on_front(places: &[Place]) -> impl Iterator<Item = &Place> {
    let points: Vec<_> = places.iter().map(|place| place.at).collect();
    front(&points).into_iter().map(|i| &places[i])
}

fn charts(measured: &Measured) -> [Chart; 2] {
    let Measured { name, trials, .. } = measured;
    let point = |rung: &Rung, x: f64| {
        let (y, error) = rung.error();
        Point { x, y, error: Some(error).filter(|error| error.is_finite()) }
    };
    let over_seconds = |trial: &Trial| Series {
        name: trial.name(),
        points: trial.rungs.iter().map(|rung| point(rung, rung.median_seconds())).collect(),
    };
    let mut series: Vec<Series> = trials.iter().map(over_seconds).collect();
    let front = on_front(&places(trials)).map(|place| Point { x: place.at.0, y: place.at.1, error: None }).collect();
    series.push(Series { name: FRONT.into(), points: front });
    // The error at a number of samples does not depend on the backend: the one that got furthest stands for all.
    let mut furthest: Vec<&Trial> = Vec::new();
    for trial in trials {
        match furthest.iter_mut().find(|other| other.estimator == trial.estimator) {
            Some(other) if other.rungs.len() < trial.rungs.len() => *other = trial,
            Some(_) => {}
            None => furthest.push(trial),
        }
    }
    let over_samples = furthest.into_iter().map(|trial| Series {
        name: trial.estimator.clone(),
        points: trial.rungs.iter().map(|rung| point(rung, f64::from(rung.spp))).collect(),
    });
    let chart = |kind: &str, x: &str, series: Vec<Series>| Chart {
        name: format!("{name}-{kind}"),
        title: format!("{name}: error over {kind}"),
        x: Axis::log(x),
        y: Axis::log("relMSE"),
        series,
    };
    [chart("seconds", "seconds", series), chart("samples", "samples a pixel", over_samples.collect())]
}

fn error_table(all: &[Measured]) -> Table {
    let columns = [
        "scene",
        "backend",
        "estimator",
        "samples",
        "seconds",
        "relMSE",
        "relMSE x seconds",
        "exponent of the samples",
        "ready, s: first (later)",
    ];
    let mut rows = Vec::new();
    for (measured, trial, rung) in longest(all) {
        let (error, deviation) = rung.error();
        let bars = if deviation.is_finite() { format!(" +- {}", number(2.0 * deviation)) } else { String::new() };
        rows.push(vec![
            measured.name.clone(),
            trial.backend.to_string(),
            trial.estimator.clone(),
            rung.spp.to_string(),
            with_spread(spread(&rung.seconds)),
            number(error) + &bars,
            with_spread(spread(&rung.costs())),
            trial.exponent().map_or("-".into(), |exponent| format!("{exponent:.2}")),
            format!("{} ({})", number(trial.first_ready_seconds), number(spread(&trial.ready_seconds)[0])),
        ]);
    }
    Table { columns: columns.map(String::from).to_vec(), rows }
}

fn rate_table(all: &[Measured]) -> Table {
    let first = all.iter().flat_map(|m| &m.trials).map(|t| t.backend).next();
    let ratio_to = first.map_or(String::new(), |first| format!("Mrays/s over {first}'s"));
    let columns = [
        "scene",
        "backend",
        "estimator",
        "Msamples/s",
        "Mrays/s",
        &ratio_to,
        "device busy",
        "bounce rays a sample",
        "shadow rays a sample",
    ];
    let mut rows = Vec::new();
    for (measured, trial, rung) in longest(all) {
        let [samples, rays, shadow] = rung.counts;
        let same = |t: &&Trial| Some(t.backend) == first && t.estimator == trial.estimator;
        // Round by round, at the largest number of samples that both have.
        let ratio = measured.trials.iter().find(same).map_or([f64::NAN; 3], |other| {
            let shared = trial.rungs.iter().zip(&other.rungs).next_back();
            let pairs = shared.map_or(vec![], |(a, b)| a.seconds.iter().zip(&b.seconds).map(|(a, b)| b / a).collect());
            spread(&pairs)
        });
        let busy: Vec<_> = rung.device_seconds.iter().zip(&rung.seconds).map(|(device, wall)| device / wall).collect();
        let busy = if rung.device_seconds.iter().any(|s| *s > 0.0) {
            format!("{:.0} %", 100.0 * spread(&busy)[0])
        } else {
            "-".into()
        };
        rows.push(vec![
            measured.name.clone(),
            trial.backend.to_string(),
            trial.estimator.clone(),
            number(spread(&rung.rates(samples))[0] * 1e-6),
            with_spread(spread(&rung.rates(rays)).map(|rate| rate * 1e-6)),
            with_spread(ratio),
            busy,
            number((rays - shadow) / samples - 1.0),
            number(shadow / samples),
        ]);
    }
    Table { columns: columns.map(String::from).to_vec(), rows }
}

/// The longest render of every trial.
fn longest(all: &[Measured]) -> impl Iterator<Item = (&Measured, &Trial, &Rung)> {
    let trials = all.iter().flat_map(|measured| measured.trials.iter().map(move |trial| (measured, trial)));
    trials.filter_map(|(measured, trial)| Some((measured, trial, trial.rungs.last()?)))
}

fn figures(measured: &Measured) -> Vec<Figure> {
    let mut figures = Vec::new();
    for trial in &measured.trials {
        let of = format!("{}/{}/{}/{}", DEFINITION.name, measured.name, trial.backend, trial.estimator);
        let mut add = |part: String, unit: &str, better: Better, values: &[f64]| {
            figures.extend(Figure::of(format!("{of}/{part}"), unit, better, values));
        };
        for (number, rung) in trial.rungs.iter().enumerate() {
            let name = |quantity: &str| format!("{}-spp/{quantity}", rung.spp);
            add(name("seconds"), "s", Better::Lower, &rung.seconds);
            if rung.device_seconds.iter().any(|seconds| *seconds > 0.0) {
                add(name("device-seconds"), "s", Better::Lower, &rung.device_seconds);
            }
            add(name("relmse"), "", Better::Lower, &rung.relmse);
            if number + COMPARED_RUNGS >= trial.rungs.len() {
                let [samples, rays, shadow] = rung.counts;
                let mega = |count: f64| rung.rates(count * 1e-6);
                add(name("relmse-seconds"), "s", Better::Lower, &rung.costs());
                add(name("samples-per-second"), "Msamples/s", Better::Higher, &mega(samples));
                add(name("rays-per-second"), "Mrays/s", Better::Higher, &mega(rays));
                add(name("bounce-rays-per-sample"), "", Better::Lower, &[(rays - shadow) / samples - 1.0]);
                add(name("shadow-rays-per-sample"), "", Better::Lower, &[shadow / samples]);
            }
        }
        add("ready-seconds".into(), "s", Better::Lower, &trial.ready_seconds);
        add("first-ready-seconds".into(), "s", Better::Lower, &[trial.first_ready_seconds]);
    }
    figures
}
