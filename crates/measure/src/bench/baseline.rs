//! A run compared with an earlier one: ratios, and which of them are more than noise.

use super::figure::{Better, Figure};
use super::figure_name::FigureName;
use super::record::{Machine, Record, Run, SceneRecord};
use super::report::Report;
use crate::report::words::number;
use luminaire::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Two runs of the same program differ by more than their rounds do (where memory lies, how warm the machine is): ranges that are closer
/// than this part of each other are no difference.
pub const MARGIN: f64 = 0.05;

/// From fewer rounds nothing is concluded.
const LEAST_ROUNDS: usize = 3;

/// An earlier run.
#[derive(Debug, Clone)]
pub struct Baseline {
    run: Run,
    machine: Machine,
    figures: Vec<Figure>,
}

/// What became of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It got worse by more than the noise.
    Worse,
    /// It got better by more than the noise.
    Better,
    /// The difference is within the noise.
    Same,
    /// There are too few rounds for a verdict, or a value is not above zero.
    Unknown,
}

/// A figure of both runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// As it was.
    pub before: Figure,
    /// As it is.
    pub now: Figure,
    /// Whether that is a difference.
    pub verdict: Verdict,
}

impl Change {
    /// The median now over the one before.
    pub fn ratio(&self) -> f64 {
        self.now.median / self.before.median
    }
}

/// How far apart two ranges of rounds have to lie, in widths of the wider one (of logarithms). Under a normal distribution of the
/// logarithms, three rounds against three lie so far apart by chance in one of about 5000 figures, more of them more rarely.
fn widths_apart(rounds: usize) -> f64 {
    match rounds {
        ..=3 => 3.0,
        4 => 1.5,
        _ => 1.0,
    }
}

/// The rule: a figure is worse if the whole range of its rounds lies on the worse side of the whole range before, and the distance between
/// the two ranges is more than [`MARGIN`] and more than the wider range itself (with fewer than 5 rounds, more than that). Widths and
/// distances are of logarithms: ratios.
fn judge(before: &Figure, now: &Figure) -> Verdict {
    let values = [before.least, before.most, now.least, now.most];
    let rounds = before.rounds.min(now.rounds);
    if before == now && rounds >= LEAST_ROUNDS {
        return Verdict::Same;
    }
    if rounds < LEAST_ROUNDS || values.iter().any(|value| *value <= 0.0 || !value.is_finite()) {
        return Verdict::Unknown;
    }
    let [before_least, before_most, least, most] = values.map(f64::ln);
    let needed = (1.0 + MARGIN).ln().max(widths_apart(rounds) * (before_most - before_least).max(most - least));
    let (above, below) = (least - before_most > needed, before_least - most > needed);
    match (above, below, now.better) {
        (true, _, Better::Lower) | (_, true, Better::Higher) => Verdict::Worse,
        (true, _, Better::Higher) | (_, true, Better::Lower) => Verdict::Better,
        _ => Verdict::Same,
    }
}

impl Baseline {
    /// Reads the JSON of an earlier run.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no such file, or it is none.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|e| Error::read(path, e))?;
        let record: Record = serde_json::from_str(&text).map_err(|e| {
            Error::read(path, format!("it is not the bench.json of an earlier `luminaire bench` ({e})"))
        })?;
        let figures = record.sections.into_iter().flat_map(|section| section.figures).collect();
        Ok(Baseline { run: record.run, machine: record.machine, figures })
    }

    /// Why the ratios may not be of the program alone: another device, other settings.
    pub fn warnings(&self, report: &Report) -> Vec<String> {
        let mut warnings = Vec::new();
        let mut check = |what: &str, before: String, now: String, means: &str| {
            if before != now {
                warnings.push(format!("{what} was {before} and is {now}: {means}"));
            }
        };
        let (was, is) = (&self.machine, &report.machine);
        let devices = "the ratios compare devices, not programs";
        check("the device", was.device.clone(), is.device.clone(), devices);
        let cores = |m: &Machine| format!("{} ({} threads)", m.processor, m.threads);
        check("the processor", cores(was), cores(is), devices);
        let other = "figures under the same name may be of different work";
        check("relMSE", self.run.relmse.clone(), report.run.relmse.clone(), "the figures of relMSE are not compared");
        check("the effort", format!("{:?}", self.run.effort), format!("{:?}", report.run.effort), other);
        for scene in &report.run.scenes {
            if let Some(before) = self.run.scenes.iter().find(|before| before.name == scene.name) {
                let words = |s: &SceneRecord| format!("{} triangles in {} x {} pixels", s.triangles, s.width, s.height);
                check(&scene.name, words(before), words(scene), other);
            }
        }
        warnings
    }

    /// Whether a figure of the two runs is of the same quantity: relMSE is so only by the same definition.
    fn is_comparable(&self, figure: &Figure, report: &Report) -> bool {
        self.run.relmse == report.run.relmse || !FigureName::parse(&figure.name).quantity.starts_with("relmse")
    }

    /// The figures that both runs have and that mean the same in both, in the order of the run now.
    pub fn changes(&self, report: &Report) -> Vec<Change> {
        let comparable = self.figures.iter().filter(|figure| self.is_comparable(figure, report));
        let before: BTreeMap<&str, &Figure> = comparable.map(|figure| (&figure.name[..], figure)).collect();
        let both = report.figures().filter_map(|now| before.get(&now.name[..]).map(|before| (*before, now)));
        both.map(|(before, now)| Change { before: before.clone(), now: now.clone(), verdict: judge(before, now) })
            .collect()
    }

    /// The names that only the earlier run has, and those that only this one has.
    pub fn unmatched(&self, report: &Report) -> [Vec<String>; 2] {
        let before: BTreeSet<&str> = self.figures.iter().map(|figure| &figure.name[..]).collect();
        let now: BTreeSet<&str> = report.figures().map(|figure| &figure.name[..]).collect();
        [&before - &now, &now - &before].map(|names| names.into_iter().map(String::from).collect())
    }

    /// What differs by more than the noise as rows of a table under a heading, the worst first.
    pub fn rows(changes: &[Change]) -> Vec<Vec<String>> {
        let mut rows = vec![["verdict", "figure", "before", "now", "unit", "ratio"].map(String::from).to_vec()];
        let mut differing: Vec<&Change> =
            changes.iter().filter(|c| matches!(c.verdict, Verdict::Worse | Verdict::Better)).collect();
        differing.sort_by(|a, b| a.verdict.cmp(&b.verdict).then(b.ratio().ln().abs().total_cmp(&a.ratio().ln().abs())));
        rows.extend(differing.into_iter().map(|change| {
            vec![
                if change.verdict == Verdict::Worse { "WORSE" } else { "better" }.into(),
                change.now.name.clone(),
                change.before.spread().to_string(),
                change.now.spread().to_string(),
                change.now.unit.clone(),
                number(change.ratio()),
            ]
        }));
        rows
    }

    /// A row for every kind of figure (section and quantity), under a heading: how many there are, and the geometric mean of their ratios.
    pub fn summary(changes: &[Change]) -> Vec<Vec<String>> {
        let mut kinds: BTreeMap<(&str, &str), Vec<&Change>> = BTreeMap::new();
        for change in changes {
            let FigureName { section, quantity, .. } = FigureName::parse(&change.now.name);
            kinds.entry((section, quantity)).or_default().push(change);
        }
        let head =
            ["section", "quantity", "better", "figures", "worse", "better", "too few rounds", "ratio, geometric mean"];
        let mut rows = vec![head.map(String::from).to_vec()];
        for ((section, quantity), changes) in kinds {
            let count = |verdict| changes.iter().filter(|change| change.verdict == verdict).count().to_string();
            let logs: Vec<f64> =
                changes.iter().map(|change| change.ratio().ln()).filter(|log| log.is_finite()).collect();
            rows.push(vec![
                section.into(),
                quantity.into(),
                if changes[0].now.better == Better::Higher { "higher" } else { "lower" }.into(),
                changes.len().to_string(),
                count(Verdict::Worse),
                count(Verdict::Better),
                count(Verdict::Unknown),
                number((logs.iter().sum::<f64>() / logs.len() as f64).exp()),
            ]);
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::sampling::{random4, uniform};

    fn figure(better: Better, values: &[f64]) -> Figure {
        Figure::of("a/b".into(), "s", better, values).unwrap()
    }

    fn verdict(better: Better, before: &[f64], now: &[f64]) -> Verdict {
        judge(&figure(better, before), &figure(better, now))
    }

    #[test]
    fn only_what_is_more_than_noise_is_a_difference() {
        use Better::{Higher, Lower};
        let steady = [1.0, 1.01, 1.0, 1.02, 1.0];
        let times = |factor: f64, values: &[f64]| -> Vec<f64> { values.iter().map(|v| factor * v).collect() };
        assert_eq!(verdict(Lower, &steady, &times(1.5, &steady)), Verdict::Worse);
        assert_eq!(verdict(Higher, &steady, &times(1.5, &steady)), Verdict::Better);
        assert_eq!(verdict(Higher, &steady, &times(0.7, &steady)), Verdict::Worse);
        assert_eq!(verdict(Lower, &steady, &times(0.7, &steady)), Verdict::Better);
        assert_eq!(verdict(Lower, &steady, &steady), Verdict::Same);
        // The ranges are apart, but by less than the margin.
        assert_eq!(verdict(Lower, &[1.0; 5], &[1.04; 5]), Verdict::Same);
        assert_eq!(verdict(Lower, &[1.0; 5], &[1.06; 5]), Verdict::Worse);
        // Noisy rounds: half as slow again is nothing.
        let noisy = [1.0, 1.2, 1.4, 1.1, 1.3];
        assert_eq!(verdict(Lower, &noisy, &times(1.5, &noisy)), Verdict::Same);
        assert_eq!(verdict(Lower, &noisy, &times(2.5, &noisy)), Verdict::Worse);
        // One slow round among the new ones hides nothing but what it is wide.
        assert_eq!(verdict(Lower, &steady, &[1.5, 1.5, 1.5, 1.5, 5.0]), Verdict::Same);
        assert_eq!(verdict(Lower, &[1.0, 1.0], &[9.0, 9.0]), Verdict::Unknown);
        assert_eq!(verdict(Lower, &[0.0; 3], &[9.0; 3]), Verdict::Unknown);
        assert_eq!(verdict(Lower, &[-1.0; 3], &[-1.0; 3]), Verdict::Same);
    }

    /// Two runs whose times have one distribution hardly ever differ by more than the noise, whatever its width.
    #[test]
    fn noise_is_hardly_ever_a_regression() {
        const RUNS: u32 = 40_000;
        for (rounds, allowed) in [(3, 4e-4), (4, 2e-4), (5, 1e-4)] {
            let mut wrong = 0;
            for run in 0..RUNS {
                let values = |which: u32| -> Vec<f64> {
                    (0..rounds)
                        .map(|round| {
                            // The sum of eight is nearly normal; deviations of 25 %, beside which the margin is nothing.
                            let [a, b] = [0, 1].map(|i| random4(run, round, which, i).map(uniform).iter().sum::<f64>());
                            (0.3 * (a + b - 4.0)).exp()
                        })
                        .collect()
                };
                wrong += u32::from(verdict(Better::Lower, &values(0), &values(1)) == Verdict::Worse);
            }
            let share = f64::from(wrong) / f64::from(RUNS);
            assert!(share <= allowed, "{rounds} rounds: {share}");
        }
    }
}
