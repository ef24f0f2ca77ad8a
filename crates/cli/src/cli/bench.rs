//! `luminaire bench`.

use super::progress::duration;
use super::stability::seen_from;
use super::{BackendName, BenchOptions, print, table, tell};
use luminaire::files::{check_writable, save_text};
use luminaire::picture;
use luminaire::{Error, Result};
use luminaire_measure::Workbench;
use luminaire_measure::bench::{
    Baseline, BenchScene, Definition, Effort, Machine, Outcome, Report, STANDARD, Settings, Verdict, file_name, html,
    markdown, named,
};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Where the files go unless `--out` says otherwise.
const FOLDER: &str = "bench";

/// What is measured where no scene is given: diffuse surfaces under one lamp; instances; small lamps; textures and holes.
const SCENES: [&str; 4] = ["cornell", "instances", "lamps", "textures"];

/// So many of them are enough to see that it works.
const QUICK_SCENES: usize = 2;

/// True while files are written, which an exit would leave half done beside their targets.
static WRITING: AtomicBool = AtomicBool::new(false);

/// The exit code of an interrupted run: 128 + SIGINT, as shells have it.
const INTERRUPTED: i32 = 130;

/// Measures, writes, and compares.
pub fn run(options: &BenchOptions) -> Result<ExitCode> {
    let sections = named(&options.sections)?;
    let folder = options.out.clone().unwrap_or_else(|| FOLDER.into());
    let baseline = options.baseline.as_deref().map(Baseline::read).transpose()?;
    let same =
        |path: &Path| path.canonicalize().is_ok_and(|p| folder.join("bench.json").canonicalize().is_ok_and(|q| p == q));
    if options.baseline.as_deref().is_some_and(same) {
        return Err(Error::Usage(format!(
            "--baseline is the file that this run would write into {}: give another folder by --out, or copy the file elsewhere first",
            folder.display()
        )));
    }
    let mut settings = settings(options, &sections)?;
    std::fs::create_dir_all(&folder).map_err(|e| Error::write(&folder, format!("the folder cannot be made ({e})")))?;
    check_writable(&folder.join("index.html"))?;
    options.page.as_deref().map(check_writable).transpose()?;
    listen_for_interrupts()?;

    let start = Instant::now();
    let bench = Workbench::new(settings.effort == Effort::Long)?;
    settings.backends = backends(options, &bench)?;
    let machine = Machine::new(&bench, &settings);
    tell(&format!("{} sections on {}; {}", sections.len(), machine.backends.join(", "), machine.device));
    if let Some(baseline) = &baseline {
        let nothing = Report::new(command(options), &settings, machine.clone(), vec![]);
        baseline.warnings(&nothing).iter().for_each(|warning| tell(&format!("warning: --baseline: {warning}")));
    }

    let mut outcomes: Vec<Outcome> = Vec::new();
    for (number, section) in sections.iter().enumerate() {
        tell(&format!("{}/{} {}: {}", number + 1, sections.len(), section.name, section.title));
        let began = Instant::now();
        let outcome = (section.run)(&bench, &settings, &mut |line| tell(&format!("    {line}")));
        match &outcome {
            Ok(_) => tell(&format!("    done in {}", duration(began.elapsed().as_secs_f64()))),
            Err(error) => tell(&format!("error: the section `{}` failed: {error}", section.name)),
        }
        outcomes.push((*section, outcome));
    }
    let report = Report::new(command(options), &settings, machine, outcomes);
    WRITING.store(true, Ordering::SeqCst);
    let written = write(options, &folder, &report);
    WRITING.store(false, Ordering::SeqCst);
    written?;

    let page = folder.join("index.html");
    print(&format!(
        "{} sections in {}: {}\n",
        sections.len(),
        duration(start.elapsed().as_secs_f64()),
        page.display()
    ))?;
    let failed = report.outcomes.iter().filter(|(_, outcome)| outcome.is_err()).count();
    if failed > 0 {
        tell(&format!("error: {failed} of {} sections failed; the page has the others", sections.len()));
    }
    let worse = baseline.map_or(Ok(0), |baseline| compare(&baseline, &report))?;
    if worse > 0 {
        tell(&format!(
            "error: {worse} figures are worse than in {} by more than the noise",
            display(&options.baseline)
        ));
    }
    Ok(if failed + worse > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn display(path: &Option<PathBuf>) -> String {
    path.as_ref().map_or(String::new(), |path| path.display().to_string())
}

/// Loads what is to be measured. The backends come when they are known.
fn settings(options: &BenchOptions, sections: &[Definition]) -> Result<Settings> {
    let effort = match (options.quick, options.long) {
        (true, _) => Effort::Quick,
        (_, true) => Effort::Long,
        _ => Effort::Standard,
    };
    let reference = options.reference.as_deref().map(picture::read).transpose()?;
    if reference.is_some() && options.scenes.len() != 1 {
        return Err(Error::Usage(format!(
            "--reference is the picture of one scene, but there are {}: give exactly one SCENE",
            options.scenes.len()
        )));
    }
    let paths = match (sections.iter().any(|section| section.scenes), options.scenes.is_empty()) {
        (false, _) => vec![],
        (true, false) => options.scenes.clone(),
        (true, true) => standard_scenes(if options.quick { QUICK_SCENES } else { SCENES.len() })?,
    };
    let size = match &reference {
        Some(picture) => (picture.width, Some(picture.height)),
        None => (options.width.unwrap_or(effort.width()), None),
    };
    let mut estimators = options.estimator.clone();
    if estimators.is_empty() {
        estimators = STANDARD.map(String::from).to_vec();
    }
    Ok(Settings {
        effort,
        rounds: options.rounds.map_or(effort.rounds(), |rounds| rounds as usize),
        scenes: BenchScene::load(&paths, size)?,
        backends: vec![],
        estimators,
        reference,
    })
}

/// The repository's scenes.
fn standard_scenes(count: usize) -> Result<Vec<PathBuf>> {
    let path = |name: &&str| PathBuf::from(format!("scenes/{name}/{name}.toml"));
    let paths: Vec<_> = SCENES[..count].iter().map(path).collect();
    match paths.iter().find(|path| !path.is_file()) {
        None => Ok(paths),
        Some(missing) => Err(Error::Usage(format!(
            "no SCENE is given, and the standard ones are not in this folder ({} is missing): give scene files, or run it in \
             luminaire's repository",
            missing.display()
        ))),
    }
}

/// Those that are asked for, all of which have to be there, or those that are there.
fn backends(options: &BenchOptions, bench: &Workbench) -> Result<Vec<luminaire::backend::Backend>> {
    let there = bench.backends();
    let asked: Vec<_> = options.backend.iter().filter_map(|name| name.backend()).collect();
    if let Some(missing) = asked.iter().find(|backend| !there.contains(backend)) {
        return Err(Error::NoDevice(format!("{missing} cannot run here: {}", bench.device)));
    }
    if asked.is_empty() {
        let all = [BackendName::ComputeBvh, BackendName::RayQuery].into_iter().filter_map(BackendName::backend);
        for missing in all.filter(|backend| !there.contains(backend)) {
            tell(&format!("SKIP: {missing} cannot run here: {}", bench.device));
        }
        return Ok(there);
    }
    Ok(there.into_iter().filter(|backend| asked.contains(backend)).collect())
}

/// Writes the page, the charts, and the numbers.
fn write(options: &BenchOptions, folder: &Path, report: &Report) -> Result<()> {
    for section in report.sections() {
        for chart in &section.charts {
            save_text(&folder.join(file_name(section, chart)), &chart.svg())?;
        }
    }
    save_text(&folder.join("figures.csv"), &report.figures_csv())?;
    save_text(&folder.join("points.csv"), &report.points_csv())?;
    save_text(&folder.join("bench.json"), &report.json())?;
    if let Some(page) = &options.page {
        save_text(page, &markdown(report, &seen_from(page, folder)))?;
    }
    save_text(&folder.join("index.html"), &html(report))
}

/// Prints what changed; gives how many figures got worse.
fn compare(baseline: &Baseline, report: &Report) -> Result<usize> {
    let changes = baseline.changes(report);
    let rows = Baseline::rows(&changes);
    print(&format!("\nagainst the baseline\n{}", table(2, &Baseline::summary(&changes))))?;
    if rows.len() > 1 {
        print(&format!("\nbeyond the noise\n{}", table(2, &rows)))?;
    } else if changes.iter().any(|change| change.verdict == Verdict::Same) {
        print("\nno figure differs by more than the noise\n")?;
    } else if !changes.is_empty() {
        print("\nnothing can be concluded: one of the runs has too few rounds (3 at least)\n")?;
    }
    let unmatched = baseline.unmatched(report);
    for (names, which) in unmatched.iter().zip(["the baseline", "this run"]) {
        if !names.is_empty() {
            print(&format!(
                "\nonly in {which}\n{}",
                names.iter().map(|name| format!("  {name}\n")).collect::<String>()
            ))?;
        }
    }
    if changes.is_empty() {
        return Err(Error::Usage(
            "--baseline: that run and this have no figure in common: give the same scenes and sections".into(),
        ));
    }
    Ok(changes.iter().filter(|change| change.verdict == Verdict::Worse).count())
}

/// The command that makes the page again.
fn command(options: &BenchOptions) -> String {
    let mut words = vec!["luminaire bench".to_owned()];
    let path = |option: &str, path: &PathBuf| format!("--{option} {}", path.display());
    words.extend(options.scenes.iter().map(|scene| scene.display().to_string()));
    words.extend(options.out.iter().map(|out| path("out", out)));
    words.extend(options.page.iter().map(|page| path("page", page)));
    words.extend(options.quick.then(|| "--quick".into()));
    words.extend(options.long.then(|| "--long".into()));
    words
        .extend(options.backend.iter().filter_map(|name| name.backend()).map(|backend| format!("--backend {backend}")));
    words.extend(options.estimator.iter().map(|name| format!("--estimator {name}")));
    words.extend(options.reference.iter().map(|reference| path("reference", reference)));
    words.extend(options.width.map(|width| format!("--width {width}")));
    words.extend(options.rounds.map(|rounds| format!("--rounds {rounds}")));
    words.extend(options.sections.iter().map(|section| format!("--section {section}")));
    words.join(" ")
}

/// Ctrl-C and SIGTERM end the program at once: nothing is written before everything is measured.
fn listen_for_interrupts() -> Result<()> {
    ctrlc::set_handler(|| {
        if !WRITING.load(Ordering::SeqCst) {
            tell("interrupted; nothing is written");
            std::process::exit(INTERRUPTED);
        }
    })
    .map_err(|e| Error::Usage(format!("cannot listen for Ctrl-C: {e}")))
}
