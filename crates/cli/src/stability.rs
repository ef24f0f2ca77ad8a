//! `luminaire stability`.

use crate::shared::exit_codes::INTERRUPTED;
use crate::shared::interrupts;
use crate::shared::outputs::Outputs;
use crate::shared::printing::{self, Notes, note, print};
use crate::shared::relative_path::seen_from;
use crate::shared::table::table;
use crate::shared::units::duration;
use luminaire::files::save_text;
use luminaire::{Error, Result};
use luminaire_measure::Workbench;
use luminaire_measure::stability::{Definition, Head, Outcome, SWEEPS, Sweep, named, page};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire stability --list
  luminaire stability samples albedo
  luminaire stability --out docs/stability --page docs/stability.md

Without a Vulkan device the reference runs alone.

Exit codes:
  0    measured
  1    a sweep failed (the others are written), or a file cannot be written
  2    wrong usage: there is no such sweep
  130  interrupted; the sweeps that are done are written, the page is not";

/// Which sweeps to run, and where their files go.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// Names of sweeps, as `--list` shows them [default: all].
    #[arg(value_name = "SWEEP")]
    sweeps: Vec<String>,
    /// The folder for <SWEEP>.csv and <SWEEP>-<CHART>.svg; it is made if it is missing [default: stability].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// The page that shows and explains the charts, in Markdown [default: README.md in the folder].
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Finer steps and more samples: about ten times as long.
    #[arg(long)]
    long: bool,
    /// List the sweeps, and run none.
    #[arg(long)]
    list: bool,
}

/// What an interrupt says once a sweep is done.
const SOME: &str = "interrupted; the sweeps that are done are written, the page is not";

/// Where the files go unless `--out` says otherwise.
const FOLDER: &str = "stability";

/// Runs the sweeps and writes what they found. One that fails does not stop the others.
pub fn run(options: &Options) -> Result<ExitCode> {
    if options.list {
        let rows: Vec<_> = SWEEPS.iter().map(|sweep| vec![sweep.name.into(), sweep.title.into()]).collect();
        print(&table(0, &rows))?;
        return Ok(ExitCode::SUCCESS);
    }
    let sweeps = named(&options.sweeps)?;
    let folder = options.out.clone().unwrap_or_else(|| FOLDER.into());
    let file = options.page.clone().unwrap_or_else(|| folder.join("README.md"));
    std::fs::create_dir_all(&folder).map_err(|e| Error::write(&folder, format!("the folder cannot be made ({e})")))?;
    check_files(options, &folder, &file, &sweeps)?;
    interrupts::listen(Notes { quiet: false })?;

    let start = Instant::now();
    let bench = Workbench::new(options.long)?;
    let backends: Vec<_> = bench.backends().iter().map(ToString::to_string).collect();
    let missing = ["compute-bvh", "ray-query"].into_iter().filter(|name| !backends.iter().any(|there| there == name));
    let missing: Vec<_> = missing.collect();
    let mut ran = backends.join(", ");
    if !missing.is_empty() {
        ran += &format!(" (not here: {})", missing.join(", "));
    }
    note(&format!("{} sweeps on {ran}; {}", sweeps.len(), bench.device));

    let mut outcomes: Vec<Outcome> = Vec::new();
    for (number, sweep) in sweeps.iter().enumerate() {
        note(&format!("{}/{} {}: {}", number + 1, sweeps.len(), sweep.name, sweep.title));
        let began = Instant::now();
        let save = |done: Sweep| interrupts::hold_off(|| write(&folder, sweep, &done)).map(|()| done);
        let outcome = (sweep.run)(&bench).and_then(save);
        match &outcome {
            Ok(_) => {
                interrupts::written(SOME);
                note(&format!("    done in {}", duration(began.elapsed().as_secs_f64())));
            }
            Err(error) => printing::error(format_args!("the sweep `{}` failed: {error}", sweep.name)),
        }
        // While the files of the sweep were written, an interrupt had to wait.
        if interrupts::STOP.load(Ordering::SeqCst) {
            note(SOME);
            return Ok(ExitCode::from(INTERRUPTED));
        }
        outcomes.push((*sweep, outcome));
    }
    let head = Head {
        command: command(options),
        device: bench.device.clone(),
        backends: ran,
        folder: seen_from(&file, &folder),
    };
    interrupts::hold_off(|| save_text(&file, &page(&head, &outcomes)))?;

    let failed = outcomes.iter().filter(|(_, outcome)| outcome.is_err()).count();
    print(&format!("{} sweeps in {}: {}\n", sweeps.len(), duration(start.elapsed().as_secs_f64()), file.display()))?;
    if failed > 0 {
        printing::error(format_args!("{failed} of {} sweeps failed; the page has the others", sweeps.len()));
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}

/// Checks that the files can be written, and that those that nobody has named replace none of somebody else's: a folder names no file.
fn check_files(options: &Options, folder: &Path, page: &Path, sweeps: &[Definition]) -> Result<()> {
    let mut outputs = Outputs::default();
    match &options.page {
        Some(page) => outputs.add("--page", page)?,
        None => outputs.add_default("--page", page)?,
    }
    for sweep in sweeps {
        outputs.add_default("--out", &folder.join(format!("{}.csv", sweep.name)))?;
    }
    let is_chart = |name: &str| {
        let begins = |sweep: &Definition| name.strip_prefix(sweep.name).is_some_and(|rest| rest.starts_with('-'));
        name.ends_with(".svg") && sweeps.iter().any(begins)
    };
    outputs.add_those_in(folder, "--out", is_chart)?;
    outputs.check([])
}

/// Writes the charts of a sweep, and its numbers.
fn write(folder: &Path, sweep: &Definition, done: &Sweep) -> Result<()> {
    save_text(&folder.join(format!("{}.csv", sweep.name)), &done.csv())?;
    done.charts
        .iter()
        .try_for_each(|chart| save_text(&folder.join(format!("{}-{}.svg", sweep.name, chart.name)), &chart.svg()))
}

/// The command line that makes the page again; the page shows it.
fn command(options: &Options) -> String {
    let mut words = vec!["luminaire stability".to_owned()];
    words.extend(options.sweeps.iter().cloned());
    words.extend(options.out.iter().map(|path| format!("--out {}", path.display())));
    words.extend(options.page.iter().map(|path| format!("--page {}", path.display())));
    words.extend(options.long.then(|| "--long".to_owned()));
    words.join(" ")
}
