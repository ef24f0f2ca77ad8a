//! The section about error over time as sentences, charts and tables: which estimator on which backend has the smallest error after so many seconds.

use super::contenders::words;
use super::measured::{Measured, measure};
use super::pareto::{Candidate, LEAST_GAIN, front};
use super::trial::{Rung, STEP, Trial};
use crate::Workbench;
use crate::bench::definition::{Definition, Progress};
use crate::bench::figure::{Better, Figure};
use crate::bench::figure_name::FigureName;
use crate::bench::rounds::Rounds;
use crate::bench::section::Section;
use crate::bench::settings::Settings;
use crate::chart::{Axis, Chart, FRONT, Point, Series};
use crate::report::table::Table;
use crate::report::words::number;
use luminaire::Result;
use luminaire::film::REL_MSE;

/// The section of errors over time and samples.
pub(in crate::bench) const DEFINITION: Definition =
    Definition { name: "convergence", title: "Error over time, by estimator and backend", scenes: true, run };

/// Number of the longest renders that have figures beyond seconds and relMSE: two runs that differ by one step still have one in common.
const COMPARED_RUNGS: usize = 2;

fn run(bench: &Workbench, settings: &Settings, progress: Progress) -> Result<Section> {
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
        "relMSE, the {REL_MSE} (over pixels and channels; b is the reference), is averaged over the rounds, with two standard errors as bars; the \
         reference's own estimated error is taken off. Lower and further left is better. The dashed line is the Pareto front: nothing else has an \
         error as small in the same time ({:.0} % count as a difference). Over samples the backend does not matter, as all draw the same numbers; one that \
         got furthest stands for all. relMSE times seconds is what an error costs: half of it is twice as fast. For independent \
         samples it is the same at all numbers of samples, for Sobol points it falls; the table has the longest renders.",
        100.0 * LEAST_GAIN
    );
    let mut text = vec![text, explained];
    let mut all = Vec::new();
    for (number, scene) in settings.scenes.iter().enumerate() {
        progress(&format!("{}/{} {}", number + 1, settings.scenes.len(), scene.name));
        all.push(measure(bench, settings, scene, progress)?);
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
    let cost = |trial: &Trial| trial.rungs.last().map_or(f64::NAN, |rung| rung.costs().median());
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
    let near = own_error.map_or(0, |own| places.iter().filter(|place| place.at.error < 2.0 * own).count());
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
    same.flat_map(|(a, b)| {
        a.rungs.iter().zip(&b.rungs).map(|(a, b)| (a.relmse.estimate().mean / b.relmse.estimate().mean - 1.0).abs())
    })
    .filter(|off| off.is_finite())
    .reduce(f64::max)
}

/// A render as a point of the chart.
struct Place {
    trial: usize,
    spp: u32,
    /// Its seconds and its relMSE.
    at: Candidate,
}

/// All renders.
fn places(trials: &[Trial]) -> Vec<Place> {
    let all = trials.iter().enumerate().flat_map(|(i, trial)| trial.rungs.iter().map(move |rung| (i, rung)));
    let at = |rung: &Rung| Candidate { cost: rung.seconds.median(), error: rung.relmse.estimate().mean };
    all.map(|(trial, rung)| Place { trial, spp: rung.spp, at: at(rung) }).collect()
}

/// Those on the Pareto front, the fastest first.
fn on_front(places: &[Place]) -> impl Iterator<Item = &Place> {
    let points: Vec<_> = places.iter().map(|place| place.at).collect();
    front(&points).into_iter().map(|i| &places[i])
}

fn charts(measured: &Measured) -> [Chart; 2] {
    let Measured { name, trials, .. } = measured;
    let point = |rung: &Rung, x: f64| {
        let relmse = rung.relmse.estimate();
        Point { x, y: relmse.mean, error: Some(relmse.error).filter(|error| error.is_finite()) }
    };
    let over_seconds = |trial: &Trial| Series {
        name: trial.name(),
        points: trial.rungs.iter().map(|rung| point(rung, rung.seconds.median())).collect(),
    };
    let mut series: Vec<Series> = trials.iter().map(over_seconds).collect();
    let places = places(trials);
    let front = on_front(&places).map(|place| Point { x: place.at.cost, y: place.at.error, error: None });
    series.push(Series { name: FRONT.into(), points: front.collect() });
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
        let relmse = rung.relmse.estimate();
        let bars = if relmse.error.is_finite() { format!(" +- {}", number(2.0 * relmse.error)) } else { String::new() };
        rows.push(vec![
            measured.name.clone(),
            trial.backend.to_string(),
            trial.estimator.clone(),
            rung.spp.to_string(),
            rung.seconds.spread().to_string(),
            number(relmse.mean) + &bars,
            rung.costs().spread().to_string(),
            trial.exponent().map_or("-".into(), |exponent| format!("{exponent:.2}")),
            format!("{} ({})", number(trial.first_ready_seconds), number(trial.ready_seconds.median())),
        ]);
    }
    Table::new(columns).with_rows(rows)
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
        let counts = rung.counts;
        let same = |t: &&Trial| Some(t.backend) == first && t.estimator == trial.estimator;
        // Round by round, at the largest number of samples that both have.
        let other = measured.trials.iter().find(same);
        let shared = other.and_then(|other| trial.rungs.iter().zip(&other.rungs).next_back());
        let ratio = shared.map_or(Rounds::default(), |(own, other)| other.seconds.over(&own.seconds));
        let busy = if rung.has_device_seconds() {
            format!("{:.0} %", 100.0 * rung.device_seconds.over(&rung.seconds).median())
        } else {
            "-".into()
        };
        rows.push(vec![
            measured.name.clone(),
            trial.backend.to_string(),
            trial.estimator.clone(),
            number(rung.rates(1e-6 * counts.samples).median()),
            rung.rates(1e-6 * counts.rays).spread().to_string(),
            ratio.spread().to_string(),
            busy,
            number(counts.bounce_rays_a_sample()),
            number(counts.shadow_rays_a_sample()),
        ]);
    }
    Table::new(columns).with_rows(rows)
}

/// The longest render of every trial.
fn longest(all: &[Measured]) -> impl Iterator<Item = (&Measured, &Trial, &Rung)> {
    let trials = all.iter().flat_map(|measured| measured.trials.iter().map(move |trial| (measured, trial)));
    trials.filter_map(|(measured, trial)| Some((measured, trial, trial.rungs.last()?)))
}

fn figures(measured: &Measured) -> Vec<Figure> {
    let mut figures = Vec::new();
    for trial in &measured.trials {
        let of = format!("{}/{}/{}", measured.name, trial.backend, trial.estimator);
        let mut add = |of: &str, quantity: &str, unit: &str, better: Better, values: &[f64]| {
            let name = FigureName { section: DEFINITION.name, of, quantity };
            figures.extend(Figure::of(name.to_string(), unit, better, values));
        };
        for (number, rung) in trial.rungs.iter().enumerate() {
            let at = format!("{of}/{}-spp", rung.spp);
            add(&at, "seconds", "s", Better::Lower, &rung.seconds.0);
            if rung.has_device_seconds() {
                add(&at, "device-seconds", "s", Better::Lower, &rung.device_seconds.0);
            }
            add(&at, "relmse", "", Better::Lower, &rung.relmse.0);
            if number + COMPARED_RUNGS >= trial.rungs.len() {
                let counts = rung.counts;
                let mega = |count: f64| rung.rates(count * 1e-6).0;
                add(&at, "relmse-seconds", "s", Better::Lower, &rung.costs().0);
                add(&at, "samples-per-second", "Msamples/s", Better::Higher, &mega(counts.samples));
                add(&at, "rays-per-second", "Mrays/s", Better::Higher, &mega(counts.rays));
                add(&at, "bounce-rays-per-sample", "", Better::Lower, &[counts.bounce_rays_a_sample()]);
                add(&at, "shadow-rays-per-sample", "", Better::Lower, &[counts.shadow_rays_a_sample()]);
            }
        }
        add(&of, "ready-seconds", "s", Better::Lower, &trial.ready_seconds.0);
        add(&of, "first-ready-seconds", "s", Better::Lower, &[trial.first_ready_seconds]);
    }
    figures
}
