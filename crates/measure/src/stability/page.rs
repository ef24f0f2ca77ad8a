//! The stability map as a page of Markdown.

use super::geometry::{COMPUTE_BVH, RAY_QUERY, REFERENCE};
use super::sweep::{Definition, Family, Sweep};
use super::verdict::{EVEN, Judgement, KNOWN, NOISY_VARIANCE, SURE, Verdict, WRONG_RAYS, WRONG_SHARE};
use crate::report::markdown::image;
use crate::report::table::Table;
use crate::report::words::{capital, count, one_line};
use luminaire::Result;

/// What stands above the sweeps.
#[derive(Debug, Clone)]
pub struct Head {
    /// How to make the page again.
    pub command: String,
    /// Device and driver, or what is missing.
    pub device: String,
    /// What ran, in words.
    pub backends: String,
    /// The folder of the charts as seen from the page, without a slash at its end.
    pub folder: String,
}

/// A sweep with what became of it.
pub type Outcome = (Definition, Result<Sweep>);

/// The page: a table for each family of sweeps with a line for each sweep, then each sweep with its verdicts, charts and four answers. A sweep that
/// failed says why.
pub fn page(head: &Head, outcomes: &[Outcome]) -> String {
    let [safe, noisy] = [Judgement::Safe, Judgement::Noisy].map(Judgement::symbol);
    let mut text = format!(
        "# Where methods fail\n\n\
         Every method is driven over the range in which it can fail, on every backend. This page says from where on it fails, and what to do about it.\n\n\
         {}\n\
         `{safe} to 1e5, {noisy} beyond`: safe at every place that was tried up to 1e5, noisy at the next one. A – was not tried, or is what the others are held against.\n\n",
        legend().markdown()
    );
    for family in [Family::Geometry, Family::Light] {
        text += &summary(family, outcomes);
    }
    text += &format!(
        "## How it was measured\n\n\
         - Command: `{}`\n- Device: {}\n- Ran on: {}\n- All sentences, tables and charts are of this one run. Bars are two standard errors each way. Ratios of times are of things that ran side by side.\n\
         - Light is called noisy where the variance of a sample is more than {NOISY_VARIANCE} times the squared mean, or less than half of the light was found; and wrong where its mean is off by more than \
         {:.1} % beyond {SURE} standard errors. It is not known where {SURE} standard errors are more than {:.0} % of the light and no such bias is proved.\n\
         - Two errors are charted that no verdict goes by: that of a hit along its ray in edges, because a ray at a small angle to the surface is off along the surface, where nothing is seen \
         of it; and how far hits slide along slivers, because that is seen in textures alone.\n\
         - The rays of the geometric sweeps are aimed at edges, corners and rims, which next to no ray of a picture meets. What failed once counts as failing further on.\n",
        head.command,
        head.device,
        head.backends,
        100.0 * WRONG_SHARE,
        100.0 * KNOWN
    );
    for (sweep, outcome) in outcomes {
        text += &format!("\n## <a id=\"{}\"></a>{}\n\n", sweep.name, capital(sweep.title));
        match outcome {
            Ok(done) => text += &body(head, sweep.name, done),
            Err(error) => text += &format!("The sweep failed: {error}\n"),
        }
    }
    text
}

/// What the symbols say.
fn legend() -> Table {
    let row = |judgement: Judgement, name: &str, geometry: String, light: String| {
        vec![format!("{} {name}", judgement.symbol()), geometry, light]
    };
    let samples = count(NOISY_VARIANCE / EVEN.powi(2));
    Table::new(["", "geometry: rays aimed at the hardest places", "light"]).with_rows([
        row(Judgement::Safe, "safe", "none goes wrong".into(), "right, and even".into()),
        row(
            Judgement::Noisy,
            "noisy",
            "some go wrong: single pixels, dotted edges".into(),
            format!(
                "right in the mean, but bright dots: {:.0} % of noise take more than {samples} samples a pixel",
                100.0 * EVEN
            ),
        ),
        row(
            Judgement::Unknown,
            "not known",
            "–".into(),
            format!(
                "no bias is proved, but one of {:.0} % of the light would not be seen in these samples",
                100.0 * KNOWN
            ),
        ),
        row(
            Judgement::Wrong,
            "wrong",
            format!(
                "more than {:.0} % go wrong, or hits are more than {:.1} % of the size off",
                100.0 * WRONG_RAYS / 1e6,
                100.0 * WRONG_SHARE
            ),
            format!("more than {:.1} % of the light is missing or too much, however many samples", 100.0 * WRONG_SHARE),
        ),
    ])
}

/// The table of a family, without one if none of its sweeps is there.
fn summary(family: Family, outcomes: &[Outcome]) -> String {
    let (title, methods): (_, &[&str]) = match family {
        Family::Geometry => ("Geometry, by backend", &["cpu", "compute BVH", "ray query"]),
        Family::Light => ("Light, by estimator", &["default", "others"]),
    };
    let columns = [&["sweep", "range"], methods, &["in one sentence"]].concat();
    let row = |(definition, outcome): &Outcome| -> Vec<String> {
        let name = format!("[{name}](#{name})", name = definition.name);
        let rest = match outcome {
            Ok(sweep) => {
                let verdicts = cells(family, &sweep.verdicts);
                [sweep.range.clone()].into_iter().chain(verdicts).chain([sweep.summary.clone()]).collect()
            }
            Err(error) => {
                let empty = std::iter::repeat_n(String::new(), columns.len() - 2);
                empty.chain([format!("the sweep failed: {}", one_line(&error.to_string()))]).collect::<Vec<_>>()
            }
        };
        [name].into_iter().chain(rest).collect()
    };
    let rows: Vec<_> = outcomes.iter().filter(|(definition, _)| definition.family == family).map(row).collect();
    if rows.is_empty() {
        return String::new();
    }
    format!("## {title}\n\n{}\n\n", Table::new(columns.iter().copied()).with_rows(rows).markdown())
}

/// What the table of a family says of the methods of a sweep that a user can choose.
fn cells(family: Family, verdicts: &[Verdict]) -> Vec<String> {
    match family {
        Family::Geometry => {
            let of = |method: &str| verdicts.iter().find(|verdict| verdict.method == method);
            [REFERENCE, COMPUTE_BVH, RAY_QUERY].map(|method| of(method).map_or("–".into(), Verdict::in_words)).into()
        }
        Family::Light => {
            let (default, others) = verdicts.split_at(verdicts.len().min(1));
            let named = |verdict: &Verdict| format!("{}: {}", verdict.method, verdict.in_words());
            let others: Vec<_> = others.iter().map(named).collect();
            let default = default.first().map_or("–".into(), Verdict::in_words);
            vec![default, if others.is_empty() { "–".into() } else { others.join("; ") }]
        }
    }
}

fn body(head: &Head, name: &str, sweep: &Sweep) -> String {
    let findings = &sweep.findings;
    let mut text =
        format!("**{}**\n\n**Where it starts to fail.** {}\n\n", sweep.summary, capital(findings.starts.trim()));
    text = text.replace(".** \n", ".**\n");
    if !sweep.verdicts.is_empty() {
        let row = |verdict: &Verdict| vec![verdict.method.clone(), verdict.in_words(), one_line(&verdict.evidence)];
        let table = Table::new(["method", "verdict", "the numbers"]).with_rows(sweep.verdicts.iter().map(row));
        text += &table.markdown();
        text += "\n";
    }
    for (question, answer) in
        [("How it fails.", &findings.how), ("What luminaire does.", &findings.mends), ("What you see.", &findings.sees)]
    {
        text += &format!("**{question}** {}\n\n", capital(answer.trim()));
    }
    for chart in &sweep.charts {
        text += &image(&chart.title, &head.folder, &format!("{name}-{}.svg", chart.name));
    }
    text + &format!("The numbers: [{name}.csv](<{}/{name}.csv>)\n", head.folder)
}
