//! Writes `docs/accuracy.md`: the prose of `template.md` beside this file, with what is measured here and now in its places.
//!
//! usage: cargo run --release --example accuracy -- [--long] [--out FILE]
//!
//! It is run from the repository's root (`make accuracy`), for the scenes. The charts go into the folder `images` beside FILE, `docs/accuracy.md`
//! unless it is said. `--long` takes about ten times as long.

mod calibration;
mod closed_forms;
mod estimators;
mod kernel;

use luminaire_measure::Workbench;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

/// The prose; `{{name}}` is where the text of that name goes.
const TEMPLATE: &str = include_str!("template.md");

/// What was measured, by the names of the places.
type Texts = BTreeMap<&'static str, String>;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut long, mut out) = (false, PathBuf::from("docs/accuracy.md"));
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--long" => long = true,
            "--out" => out = arguments.next().ok_or("--out wants a file")?.into(),
            _ => return Err(format!("`{argument}` is neither --long nor --out FILE").into()),
        }
    }
    let bench = Workbench::new(long)?;
    eprintln!("{}", bench.device);
    let images = out.parent().unwrap_or(Path::new("")).join("images");
    std::fs::create_dir_all(&images).map_err(|e| format!("cannot make the folder {}: {e}", images.display()))?;
    let mut texts = Texts::from([
        ("cores", std::thread::available_parallelism()?.to_string()),
        ("device", bench.device.clone()),
        ("setting", if long { " (`LONG=1`)" } else { "" }.into()),
    ]);
    closed_forms::measure(&bench, &images, &mut texts)?;
    calibration::measure(&bench, &images, &mut texts)?;
    kernel::measure(&bench, &mut texts)?;
    estimators::measure(&bench, &mut texts)?;
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
