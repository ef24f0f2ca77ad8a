//! Verdicts on methods, made from charts.

use super::verdict::{Judgement, SURE, Verdict, WRONG_SHARE, Worse, place};
use crate::chart::{Chart, Point, Series};
use crate::report::words::{number, share};

/// What was measured of a method at one place, and judged.
struct Judged<'a> {
    chart: &'a Chart,
    point: Point,
    judgement: Judgement,
    /// Whether rays are counted; else it is how far something is off.
    counted: bool,
}

impl Judged<'_> {
    /// Its number with what it is a number of.
    fn value(&self) -> String {
        let label = &self.chart.y.label;
        match self.counted {
            true => format!("{} {label}", number(self.point.y)),
            false if self.point.y.is_nan() => format!("{label}: no number"),
            false => format!("{label}: {}", number(self.point.y)),
        }
    }
}

/// Verdicts of every method in charts of failing rays a million, and in others of how far something is off; in the order in which they appear. The
/// evidence is the first failure.
pub(super) fn geometric(counts: &[&Chart], offsets: &[&Chart], worse: Worse) -> Vec<Verdict> {
    let charts: Vec<(&Chart, bool)> =
        counts.iter().map(|chart| (*chart, true)).chain(offsets.iter().map(|chart| (*chart, false))).collect();
    let mut methods: Vec<&str> = Vec::new();
    for series in charts.iter().flat_map(|(chart, _)| &chart.series) {
        if !methods.contains(&series.name.as_str()) {
            methods.push(&series.name);
        }
    }
    let verdict = |method: &&str| {
        let mut all = Vec::new();
        for &(chart, counted) in &charts {
            let of_method = chart.series.iter().filter(|series| series.name == *method);
            // A count without a number had nothing to count; an offset without one is wrong.
            let points = of_method.flat_map(|series| &series.points).filter(|point| !(counted && point.y.is_nan()));
            let judge = if counted { Judgement::of_rays } else { Judgement::of_share };
            all.extend(points.map(|&point| Judged { chart, point, judgement: judge(point.y), counted }));
        }
        let judged: Vec<_> = all.iter().map(|judged| (judged.point.x, judged.judgement)).collect();
        Verdict::new(*method, judged, worse, first_failure(&all, worse)).lasting()
    };
    methods.iter().map(verdict).collect()
}

/// The first point on the way that is not safe, of several at one place the worst; without one how far off anything was at most.
fn first_failure(all: &[Judged], worse: Worse) -> String {
    let earlier = |a: &&Judged, b: &&Judged| {
        let (x, other) = (a.point.x, b.point.x);
        let place = if worse == Worse::Upwards { x.total_cmp(&other) } else { other.total_cmp(&x) };
        // Counts and offsets are compared by what they mean; numbers alone only within one judgement.
        place.then(b.judgement.cmp(&a.judgement)).then(b.point.y.total_cmp(&a.point.y))
    };
    let failed = all.iter().filter(|judged| judged.judgement != Judgement::Safe);
    match failed.min_by(earlier) {
        Some(first) => {
            format!("at {}: {} ({})", place(first.point.x), first.value(), first.chart.name.replace('-', " "))
        }
        None => {
            let largest = all.iter().max_by(|a, b| a.point.y.total_cmp(&b.point.y)).filter(|most| most.point.y > 0.0);
            let at_most = |most: &Judged| format!("none; {} at most {}", most.chart.y.label, number(most.point.y));
            largest.map_or("none".into(), at_most)
        }
    }
}

/// How far a mean over the truth is certainly off; NaN where it is no number.
pub(super) fn certain_bias(ratio: f64, error: f64) -> f64 {
    let beyond = (ratio - 1.0).abs() - SURE * error;
    if beyond < 0.0 { 0.0 } else { beyond }
}

/// The verdict on a way to find light, from the variance of its samples over the squared mean and from the shares that were found on every backend.
/// The evidence is the first failure.
pub(super) fn light(method: &str, variances: &[&Series], shares: &[&Series], worse: Worse) -> Verdict {
    // What gave no number comes first: it is worse than any.
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
    let error_of = |point: &Point| point.error.unwrap_or(0.0);
    let evidence_at = |x: f64| {
        let variance = at(variances, x, &|point| point.y);
        let bias = at(shares, x, &|point| certain_bias(point.y, error_of(point)));
        let error = at(shares, x, &error_of);
        let judgement = Judgement::of_light(variance, bias, error);
        let x = place(x);
        let words = match judgement {
            Judgement::Wrong => format!("at {x}: {} of the light off", share(bias)),
            Judgement::Unknown => format!("at {x}: the mean is only known to {}", share(SURE * error)),
            _ if variance.is_infinite() => format!("at {x}: less than half of the light found"),
            _ => format!("at {x}: variance of a sample {}", number(variance)),
        };
        (judgement, words)
    };
    let judged: Vec<_> = places.iter().map(|&x| (x, evidence_at(x))).collect();
    let first = judged.iter().find(|(_, (judgement, _))| *judgement != Judgement::Safe);
    let most =
        |series: &[&Series], y: &dyn Fn(&Point) -> f64| places.iter().map(|&x| at(series, x, y)).fold(0.0, f64::max);
    let evidence = match first {
        Some((_, (_, words))) => words.clone(),
        None if variances.is_empty() => {
            format!("none; at most {} of the light off", share(most(shares, &|point| (point.y - 1.0).abs())))
        }
        None => format!("none; variance of a sample at most {}", number(most(variances, &|point| point.y))),
    };
    Verdict::new(method, judged.iter().map(|(x, (judgement, _))| (*x, *judgement)), worse, evidence)
}

/// The verdict on the method of this name, or else the first one.
fn verdict_on<'a>(verdicts: &'a [Verdict], method: &str) -> Option<&'a Verdict> {
    verdicts.iter().find(|verdict| verdict.method == method).or(verdicts.first())
}

/// Where the stretch ends in which the method of this name, or else the first one, is safe from the start; where it is not, the start itself is the error.
pub(super) fn safe_until(verdicts: &[Verdict], method: &str) -> Result<String, String> {
    let Some(verdict) = verdict_on(verdicts, method) else { return Err("Nothing was tried.".into()) };
    let start = verdict.ranges.first().map_or("–".into(), |range| place(range.from));
    verdict.safe_start().map(|safe| place(safe.to)).ok_or(format!("Not safe where the range begins, at {start}."))
}

/// Advice that hangs on how far the method of this name, or else the first one, is safe from the start of the sweep: with the end of that stretch.
pub(super) fn up_to(verdicts: &[Verdict], method: &str, advice: impl Fn(String) -> String) -> String {
    safe_until(verdicts, method).map_or_else(|unsafe_start| unsafe_start, advice)
}

/// Advice that holds where the method of this name, or else the first one, is safe all the way.
pub(super) fn everywhere(verdicts: &[Verdict], method: &str, advice: &str) -> String {
    let ranges = verdict_on(verdicts, method).map_or(&[][..], |verdict| &verdict.ranges);
    let way = if matches!(ranges, [first, .., last] if first.from > last.to) { "down" } else { "up" };
    match verdict_on(verdicts, method) {
        Some(verdict) if verdict.is_safe() => advice.into(),
        _ => up_to(verdicts, method, |end| format!("Safe only {way} to {end}.")),
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
        let off = Chart { y: Axis::log("error"), ..chart("error", vec![series("b", &[(1.0, 1e-4), (1e3, 1e-3)])]) };
        let found = geometric(&[&lost, &escapes], &[&off], Worse::Upwards);
        let [a, b] = &found[..] else { panic!("{found:?}") };
        assert_eq!((a.method.as_str(), a.in_words().as_str()), ("a", "● to 10, ▲ to 100, ✖ beyond"));
        assert_eq!(a.evidence, "at 100: 70.0 rays a million (escapes)");
        assert_eq!((b.in_words().as_str(), b.evidence.as_str()), ("●", "none; error at most 0.00100"));
        assert_eq!(up_to(&found, "a", |end| format!("up to {end}")), "up to 10");
        assert_eq!(everywhere(&found, "b", "anything"), "anything");
        assert_eq!(everywhere(&found, "nobody", "anything"), "Safe only up to 10.");
        let down = geometric(&[&lost], &[], Worse::Downwards);
        assert_eq!(down[0].in_words(), "● at 1000, ▲ below");
        assert_eq!(everywhere(&down, "a", "anything"), "Safe only down to 1000.");
    }

    #[test]
    fn an_offset_without_a_number_is_wrong() {
        let off =
            Chart { y: Axis::log("error"), ..chart("error", vec![series("a", &[(1.0, 1e-4), (10.0, f64::NAN)])]) };
        let found = geometric(&[], &[&off], Worse::Upwards);
        assert_eq!(
            (found[0].in_words().as_str(), found[0].evidence.as_str()),
            ("● at 1, ✖ beyond", "at 10: error: no number (error)")
        );
        let share = series("", &[(1.0, 1.0), (2.0, f64::NAN)]);
        assert_eq!(light("way", &[], &[&share], Worse::Upwards).in_words(), "● at 1, ✖ beyond");
    }

    #[test]
    fn the_worst_is_so_by_its_judgement() {
        // A few rays are fewer than wrong, although their number is the larger one.
        let lost = chart("lost", vec![series("a", &[(1.0, 50.0)])]);
        let off = Chart { y: Axis::log("error"), ..chart("error", vec![series("a", &[(1.0, 0.5)])]) };
        let found = geometric(&[&lost], &[&off], Worse::Upwards);
        assert_eq!(found[0].evidence, "at 1: error: 0.500 (error)");
    }

    #[test]
    fn advice_hangs_on_the_start_of_the_way() {
        let lost = chart("lost", vec![series("a", &[(1.0, 5.0), (2.0, 5.0)])]);
        let off = geometric(&[&lost], &[], Worse::Upwards);
        assert_eq!(up_to(&off, "a", |end| end), "Not safe where the range begins, at 1.");
        let island = [(1.0, Judgement::Wrong), (2.0, Judgement::Safe), (3.0, Judgement::Wrong)];
        let island = [Verdict::new("a", island, Worse::Upwards, "")];
        assert_eq!(up_to(&island, "a", |end| end), "Not safe where the range begins, at 1.");
        assert_eq!(everywhere(&island, "a", "anything"), "Not safe where the range begins, at 1.");
    }

    #[test]
    fn light_of_which_too_little_is_known() {
        let point = |x, y, error| Point { x, y, error: Some(error) };
        let found = |points| Series { name: String::new(), points };
        let variance = series("", &[(1.0, 1.0), (2.0, 1.0), (3.0, 1.0)]);
        let share = found(vec![point(1.0, 1.01, 0.01), point(2.0, 1.04, 0.136), point(3.0, 0.2, 0.1)]);
        let verdict = light("way", &[&variance], &[&share], Worse::Upwards);
        assert_eq!(verdict.in_words(), "● at 1, ? to 2, ✖ beyond");
        assert_eq!(verdict.evidence, "at 2: the mean is only known to 41 %");
        let exact = light("way", &[], &[&found(vec![Point { x: 1.0, y: 1.0 + 5e-7, error: None }])], Worse::Upwards);
        assert_eq!(exact.evidence, "none; at most 5e-7 of the light off");
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
