//! Writes `docs/accuracy.md`: the prose of `template.md` beside this file, with what is measured here and now in its places.
//!
//! usage: cargo run --release --example accuracy -- [--long | --quick] [--out FILE]
//!
//! It is run from the repository's root (`make accuracy`), for the scenes. FILE is `docs/accuracy.md` unless it is said. The charts go into the folder `images`
//! beside it, the long tables into a folder of FILE's name (`docs/accuracy/`). `--long` takes about ten times as long;
//! `--quick` takes so few samples that its numbers say nothing: it shows whether the page is made.

mod calibration;
mod closed_forms;
mod estimators;
mod furnaces;
mod kernel;
mod materials;
mod tables;

use luminaire_measure::Workbench;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use tables::Folder;

/// The prose; `{{name}}` is where the text of that name goes.
const TEMPLATE: &str = include_str!("template.md");

/// How long to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effort {
    Quick,
    Usual,
    Long,
}

impl Effort {
    /// What there is of each effort, in the order quick, usual, long.
    fn of<T: Copy>(self, each: [T; 3]) -> T {
        each[self as usize]
    }
}

/// What was measured, by the names of the places.
type Texts = BTreeMap<&'static str, String>;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut effort, mut out) = (Effort::Usual, PathBuf::from("docs/accuracy.md"));
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--long" => effort = Effort::Long,
            "--quick" => effort = Effort::Quick,
            "--out" => out = arguments.next().ok_or("--out wants a file")?.into(),
            _ => return Err(format!("`{argument}` is not --long, --quick or --out FILE").into()),
        }
    }
    let bench = Workbench::new(effort == Effort::Long)?;
    eprintln!("{}", bench.device);
    let images = out.parent().unwrap_or(Path::new("")).join("images");
    std::fs::create_dir_all(&images).map_err(|e| format!("cannot make the folder {}: {e}", images.display()))?;
    let tables = Folder::beside(&out).map_err(|e| format!("cannot make the folder of the tables: {e}"))?;
    let mut texts = Texts::from([
        ("tables", tables.name.clone()),
        ("cores", std::thread::available_parallelism()?.to_string()),
        ("device", bench.device.clone()),
        ("setting", effort.of([" (`--quick`)", "", " (`LONG=1`)"]).into()),
    ]);
    closed_forms::measure(&bench, effort, &images, &tables, &mut texts)?;
    furnaces::measure(&bench, effort, &tables, &mut texts)?;
    calibration::measure(&bench, effort, &images, &tables, &mut texts)?;
    kernel::measure(&bench, effort, &tables, &mut texts)?;
    estimators::measure(&bench, effort, &tables, &mut texts)?;
    materials::read(&mut texts)?;
    let page = fill(TEMPLATE, &texts)?;
    std::fs::write(&out, page).map_err(|e| format!("cannot write {}: {e}", out.display()))?;
    eprintln!("{}", out.display());
    Ok(())
}

/// The template with its places filled.
fn fill(template: &str, texts: &Texts) -> Result<String, String> {
    let mut parts = template.split("{{");
    let mut page = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").ok_or("a {{ of the template has no }}")?;
        page +=
            texts.get(name).ok_or_else(|| format!("the template asks for {{{{{name}}}}}, which nobody measures"))?;
        page += rest;
    }
    Ok(page)
}
