//! The stability map as a page of Markdown.

use super::{Definition, Sweep};
use crate::report::markdown::image;
use crate::report::table::Table;
use crate::report::words::{capital, one_line};
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

/// The page: a table of all sweeps, then each with its charts and its four answers. A sweep that failed says why.
pub fn page(head: &Head, outcomes: &[Outcome]) -> String {
    let mut text = format!(
        "# Where methods fail\n\n\
         Every method over the range in which it can fail, side by side on every backend; sentences and charts are of one run.\n\n\
         - Command: `{}`\n- Device: {}\n- Ran on: {}\n\n\
         Bars are two standard errors each way. Ratios of times are of things that ran side by side.\n\n",
        head.command, head.device, head.backends
    );
    let row = |(sweep, outcome): &Outcome| {
        let (starts, mends) = match outcome {
            Ok(sweep) => (one_line(&sweep.findings.starts), one_line(&sweep.findings.mends)),
            Err(error) => (format!("the sweep failed: {}", one_line(&error.to_string())), String::new()),
        };
        vec![format!("[{name}](#{name})", name = sweep.name), starts, mends]
    };
    let columns = ["sweep", "who fails, from where", "what luminaire does"];
    text += &Table::new(columns).with_rows(outcomes.iter().map(row)).markdown();
    for (sweep, outcome) in outcomes {
        text += &format!("\n## <a id=\"{}\"></a>{}\n\n", sweep.name, capital(sweep.title));
        match outcome {
            Ok(done) => text += &body(head, sweep.name, done),
            Err(error) => text += &format!("The sweep failed: {error}\n"),
        }
    }
    text
}

fn body(head: &Head, name: &str, sweep: &Sweep) -> String {
    let mut text = String::new();
    for chart in &sweep.charts {
        text += &image(&chart.title, &head.folder, &format!("{name}-{}.svg", chart.name));
    }
    let findings = &sweep.findings;
    for (question, answer) in [
        ("Where it starts to fail.", &findings.starts),
        ("How it fails.", &findings.how),
        ("What luminaire does.", &findings.mends),
        ("What you see.", &findings.sees),
    ] {
        text += &format!("**{question}** {}\n\n", capital(answer.trim()));
    }
    text + &format!("The numbers: [{name}.csv](<{}/{name}.csv>)\n", head.folder)
}
