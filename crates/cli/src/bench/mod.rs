//! `luminaire bench`.

mod baseline;
mod options;

pub use self::options::Options;

use crate::shared::backend_name::BackendName;
use crate::shared::interrupts;
use crate::shared::outputs::Outputs;
use crate::shared::printing::{self, Notes, note, print, warn};
use crate::shared::relative_path::seen_from;
use crate::shared::units::duration;
use luminaire::files::save_text;
use luminaire::picture;
use luminaire::{Error, Result};
use luminaire_measure::Workbench;
use luminaire_measure::bench::{
    Baseline, BenchScene, Definition, Effort, Machine, Outcome, Report, SECTIONS, STANDARD, Settings, file_name, html,
    markdown, named,
};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Where the files go unless `--out` says otherwise.
const FOLDER: &str = "bench";

/// What is measured where no scene is given: diffuse surfaces under one lamp; instances; small lamps; textures and holes.
const SCENES: [&str; 4] = ["cornell", "instances", "lamps", "textures"];

/// With `--quick`, only so many of them.
const QUICK_SCENES: usize = 2;

/// Measures, writes, and compares.
pub fn run(options: &Options) -> Result<ExitCode> {
    let sections = named(&options.sections)?;
    let folder = options.out.clone().unwrap_or_else(|| FOLDER.into());
    let baseline = options.baseline.as_deref().map(Baseline::read).transpose()?;
    let mut settings = settings(options, &sections)?;
    std::fs::create_dir_all(&folder).map_err(|e| Error::write(&folder, format!("the folder cannot be made ({e})")))?;
    check_files(options, &folder, &settings)?;
    interrupts::listen(Notes { quiet: false })?;

    let start = Instant::now();
    let bench = Workbench::new(settings.effort == Effort::Long)?;
    settings.backends = backends(options, &bench)?;
    let machine = Machine::new(&bench, &settings);
    note(&format!("{} sections on {}; {}", sections.len(), machine.backends.join(", "), machine.device));
    if let Some(baseline) = &baseline {
        let nothing = Report::new(options.command(), &settings, machine.clone(), vec![]);
        baseline.warnings(&nothing).iter().for_each(|warning| warn(format_args!("--baseline: {warning}")));
    }

    let mut outcomes: Vec<Outcome> = Vec::new();
    for (number, section) in sections.iter().enumerate() {
        note(&format!("{}/{} {}: {}", number + 1, sections.len(), section.name, section.title));
        let began = Instant::now();
        let outcome = (section.run)(&bench, &settings, &mut |line| note(&format!("    {line}")));
        match &outcome {
            Ok(_) => note(&format!("    done in {}", duration(began.elapsed().as_secs_f64()))),
            Err(error) => printing::error(format_args!("the section `{}` failed: {error}", section.name)),
        }
        outcomes.push((*section, outcome));
    }
    let report = Report::new(options.command(), &settings, machine, outcomes);
    interrupts::hold_off(|| write(options, &folder, &report))?;

    let page = folder.join("index.html");
    print(&format!(
        "{} sections in {}: {}\n",
        sections.len(),
        duration(start.elapsed().as_secs_f64()),
        page.display()
    ))?;
    let failed = report.outcomes.iter().filter(|(_, outcome)| outcome.is_err()).count();
    if failed > 0 {
        printing::error(format_args!("{failed} of {} sections failed; the page has the others", sections.len()));
    }
    let mut worse = 0;
    if let (Some(baseline), Some(path)) = (&baseline, &options.baseline) {
        worse = baseline::compare(baseline, &report)?;
        if worse > 0 {
            printing::error(format_args!(
                "{worse} figures are worse than in {} by more than the noise",
                path.display()
            ));
        }
    }
    Ok(if failed + worse > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Checks that the files can be written, and that none of them is one that the run reads or, but for the page, one of somebody else's: a folder names no file.
fn check_files(options: &Options, folder: &Path, settings: &Settings) -> Result<()> {
    let mut outputs = Outputs::default();
    for name in ["index.html", "figures.csv", "points.csv", "bench.json"] {
        outputs.add_default("--out", &folder.join(name))?;
    }
    if let Some(page) = &options.page {
        outputs.add("--page", page)?;
    }
    let is_chart = |name: &str| {
        let begins = |section: &Definition| name.strip_prefix(section.name).is_some_and(|rest| rest.starts_with('-'));
        name.ends_with(".svg") && SECTIONS.iter().any(begins)
    };
    outputs.add_those_in(folder, "--out", is_chart)?;
    let scenes = settings.scenes.iter().flat_map(|scene| &scene.scene.files);
    let inputs = scenes.map(|path| ("a file of a scene", &**path));
    let baseline = options.baseline.iter().map(|path| ("the --baseline", &**path));
    let reference = options.reference.iter().map(|path| ("the --reference", &**path));
    outputs.check(inputs.chain(baseline).chain(reference))
}

/// What the options ask to measure, with the scenes loaded. The backends are left empty: they are known only when the devices are open.
fn settings(options: &Options, sections: &[Definition]) -> Result<Settings> {
    let effort = options.effort();
    let reference = options.reference.as_deref().map(picture::read).transpose()?;
    if let (Some(path), Some(picture)) = (&options.reference, &reference) {
        picture.warnings.iter().for_each(|warning| warn(format!("{}: {warning}", path.display())));
    }
    if reference.is_some() && options.scenes.len() != 1 {
        return Err(Error::Usage(format!(
            "--reference is the picture of one scene, but there are {}: give exactly one SCENE",
            options.scenes.len()
        )));
    }
    let paths = if !sections.iter().any(|section| section.scenes) {
        vec![]
    } else if options.scenes.is_empty() {
        standard_scenes(if options.quick { QUICK_SCENES } else { SCENES.len() })?
    } else {
        options.scenes.clone()
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

/// The first `count` of [`SCENES`] in the repository's folder. A usage error if one is missing.
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

/// The backends that the options name, or all that can run here. Fails if one that is named cannot.
fn backends(options: &Options, bench: &Workbench) -> Result<Vec<luminaire::backend::Backend>> {
    let there = bench.backends();
    let asked: Vec<_> = options.backend.iter().filter_map(|name| name.backend()).collect();
    if let Some(missing) = asked.iter().find(|backend| !there.contains(backend)) {
        return Err(Error::NoDevice(format!("{missing} cannot run here: {}", bench.device)));
    }
    if asked.is_empty() {
        let all = [BackendName::ComputeBvh, BackendName::RayQuery].into_iter().filter_map(BackendName::backend);
        for missing in all.filter(|backend| !there.contains(backend)) {
            note(&format!("SKIP: {missing} cannot run here: {}", bench.device));
        }
        return Ok(there);
    }
    Ok(there.into_iter().filter(|backend| asked.contains(backend)).collect())
}

/// Writes the page, the charts, and the numbers.
fn write(options: &Options, folder: &Path, report: &Report) -> Result<()> {
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
