//! Verdicts on methods, made from charts.

use super::verdict::{Judgement, SURE, Verdict, WRONG_SHARE, Worse, place};
use crate::chart::{Chart, Point, Series};
use crate::report::words::share;

/// Verdicts of every method in charts of failing rays a million, and in others of how far something is off; in the order in which they appear. The
/// evidence is the first failure.
pub(super) fn geometric(counts: &[&Chart], offsets: &[&Chart], worse: Worse) -> Vec<Verdict> {
    let rays: fn(f64) -> Judgement = Judgement::of_rays;
    let off: fn(f64) -> Judgement = Judgement::of_share;
    let charts: Vec<_> =
        counts.iter().map(|chart| (*chart, rays)).chain(offsets.iter().map(|chart| (*chart, off))).collect();
    let mut methods: Vec<&str> = Vec::new();
    for series in charts.iter().flat_map(|(chart, _)| &chart.series) {
        if !methods.contains(&series.name.as_str()) {
            methods.push(&series.name);
        }
    }
    let verdict = |method: &&str| {
        let mut all = Vec::new();
        for (chart, judge) in &charts {
            let of_method = chart.series.iter().filter(|series| series.name == *method);
            // Without a number there was nothing to count.
            let points = of_method.flat_map(|series| &series.points).filter(|point| !point.y.is_nan());
            all.extend(points.map(|point| (*chart, *point, judge(point.y))));
        }
        let judged: Vec<_> = all.iter().map(|(_, point, judgement)| (point.x, *judgement)).collect();
        Verdict::new(*method, judged, worse, first_failure(&all, worse)).lasting()
    };
    methods.iter().map(verdict).collect()
}

/// The first point on the way that is not safe, of several at one place the worst; without one how far off anything was at most.
fn first_failure(all: &[(&Chart, Point, Judgement)], worse: Worse) -> String {
    let earlier = |a: &Point, b: &Point| {
        let place = if worse == Worse::Upwards { a.x.total_cmp(&b.x) } else { b.x.total_cmp(&a.x) };
        place.then(b.y.total_cmp(&a.y))
    };
    let value = |chart: &Chart, point: &Point| format!("{} {}", place(point.y), chart.y.label);
    let failed = all.iter().filter(|(_, _, judgement)| *judgement != Judgement::Safe);
    match failed.min_by(|a, b| earlier(&a.1, &b.1)) {
        Some((chart, point, _)) => {
            format!("at {}: {} ({})", place(point.x), value(chart, point), chart.name.replace('-', " "))
        }
        None => {
            let largest = all.iter().max_by(|a, b| a.1.y.total_cmp(&b.1.y)).filter(|(_, point, _)| point.y > 0.0);
            largest.map_or("none".into(), |(chart, point, _)| format!("none; at most {}", value(chart, point)))
        }
    }
}

/// How far a mean over the truth is certainly off.
pub(super) fn certain_bias(ratio: f64, error: f64) -> f64 {
    ((ratio - 1.0).abs() - SURE * error).max(0.0)
}

/// The verdict on a way to find light, from the variance of its samples over the squared mean and from the shares that were found on every backend.
/// The evidence is the first failure.
pub(super) fn light(method: &str, variances: &[&Series], shares: &[&Series], worse: Worse) -> Verdict {
    // A variance without a number comes first: it is worse than any.
    let order = |y: f64| if y.is_nan() { f64::INFINITY } else { y };
    let at = |series: &[&Series], x: f64, y: &dyn Fn(&Point) -> f64| {
        let points = series.iter().flat_map(|series| &series.points).filter(|point| point.x == x);
        points.map(|point| order(y(point))).fold(0.0, f64::max)
    };
    let mut places: Vec<f64> =
        variances.iter().chain(shares).flat_map(|series| series.points.iter().map(|point| point.x)).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    if worse == Worse::Downwards {
        places.reverse();
    }
    let judged = places.iter().map(|&x| {
        let variance = at(variances, x, &|point| point.y);
        let bias = at(shares, x, &|point| certain_bias(point.y, point.error.unwrap_or(0.0)));
        (x, variance, bias, Judgement::of_light(variance, bias))
    });
    let judged: Vec<_> = judged.collect();
    let largest = judged.iter().map(|(_, variance, ..)| *variance).fold(0.0, f64::max);
    let evidence = match judged.iter().find(|(.., judgement)| *judgement != Judgement::Safe) {
        None => format!("none; variance of a sample at most {}", place(largest)),
        Some((x, _, bias, Judgement::Wrong)) => format!("at {}: {} of the light off", place(*x), share(*bias)),
        Some((x, variance, ..)) if variance.is_infinite() => {
            format!("at {}: less than half of the light found", place(*x))
        }
        Some((x, variance, ..)) => format!("at {}: variance of a sample {}", place(*x), place(*variance)),
    };
    Verdict::new(method, judged.iter().map(|(x, .., judgement)| (*x, *judgement)), worse, evidence)
}

/// Advice that hangs on where the method of this name, or else the first one, is safe: with the end of that stretch.
pub(super) fn up_to(verdicts: &[Verdict], method: &str, advice: impl Fn(String) -> String) -> String {
    let verdict = verdicts.iter().find(|verdict| verdict.method == method).or(verdicts.first());
    verdict.and_then(Verdict::safe).map_or("Nothing of this range is safe.".into(), |safe| advice(place(safe.to)))
}

/// Advice that holds where the method of this name, or else the first one, is safe all the way.
pub(super) fn everywhere(verdicts: &[Verdict], method: &str, advice: &str) -> String {
    let verdict = verdicts.iter().find(|verdict| verdict.method == method).or(verdicts.first());
    match verdict {
        Some(verdict) if verdict.is_safe() => advice.into(),
        _ => up_to(verdicts, method, |end| format!("Safe only up to {end}.")),
    }
}

/// The first place at which a series is off by more than what is safe.
pub(super) fn off_from(series: &Series) -> Option<f64> {
    series.points.iter().find(|point| point.y > WRONG_SHARE).map(|point| point.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::Axis;

    fn series(name: &str, points: &[(f64, f64)]) -> Series {
        let point = |&(x, y): &(f64, f64)| Point { x, y, error: Some(1e-4) };
        Series { name: name.into(), points: points.iter().map(point).collect() }
    }

    fn chart(name: &str, series: Vec<Series>) -> Chart {
        Chart { name: name.into(), title: String::new(), x: Axis::log("size"), y: Axis::log("rays a million"), series }
    }

    #[test]
    fn the_worst_of_all_charts_counts() {
        let lost = chart(
            "lost-turned",
            vec![
                series("a", &[(1.0, 0.0), (10.0, 0.0), (100.0, 50.0), (1e3, 0.0)]),
                series("b", &[(1.0, 0.0), (10.0, f64::NAN), (100.0, 0.0), (1e3, 0.0)]),
            ],
        );
        let escapes = chart("escapes", vec![series("a", &[(100.0, 70.0), (1e3, 2e5)])]);
        let off = chart("error", vec![series("b", &[(1.0, 1e-4), (1e3, 1e-3)])]);
        let found = geometric(&[&lost, &escapes], &[&off], Worse::Upwards);
        let [a, b] = &found[..] else { panic!("{found:?}") };
        assert_eq!((a.method.as_str(), a.in_words().as_str()), ("a", "● to 10, ▲ to 100, ✖ beyond"));
        assert_eq!(a.evidence, "at 100: 70 rays a million (escapes)");
        assert_eq!((b.in_words().as_str(), b.evidence.as_str()), ("●", "none; at most 1e-3 rays a million"));
        assert_eq!(up_to(&found, "a", |end| format!("up to {end}")), "up to 10");
        assert_eq!(everywhere(&found, "b", "anything"), "anything");
        assert_eq!(everywhere(&found, "nobody", "anything"), "Safe only up to 10.");
        let down = geometric(&[&lost], &[], Worse::Downwards);
        assert_eq!(down[0].in_words(), "● at 1000, ▲ below");
    }

    #[test]
    fn light_is_noisy_before_it_is_biased() {
        let variance = series("", &[(1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (4.0, 500.0), (5.0, f64::NAN)]);
        let shares = [
            series("cpu", &[(1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (4.0, 0.6), (5.0, 0.0)]),
            series("gpu", &[(1.0, 1.0), (2.0, 1.0012), (3.0, 0.7), (4.0, 0.6), (5.0, 0.0)]),
        ];
        let verdict = light("way", &[&variance], &[&shares[0], &shares[1]], Worse::Upwards);
        // At 2 it is off by four times what is known, but by no more than what is safe beyond three of them.
        assert_eq!(verdict.in_words(), "● to 2, ✖ to 3, ▲ beyond");
        assert_eq!(verdict.evidence, "at 3: 30 % of the light off");
        let unknown = light("way", &[&variance], &[], Worse::Downwards);
        assert_eq!(unknown.evidence, "at 5: less than half of the light found");
        assert_eq!(light("way", &[], &[&shares[0]], Worse::Upwards).in_words(), "● to 3, ✖ beyond");
    }
}
