//! `luminaire scene`.

use crate::shared::outputs::Outputs;
use crate::shared::printing::{note, print, warn};
use crate::shared::scene_options::SceneOptions;
use luminaire::{Error, Result, files, scene};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire scene model.obj > model.toml
      what `luminaire render model.obj` shows, as a scene file: every key with its meaning, and every material with its numbers
  luminaire scene parts/house.obj --up z --sky sunset.hdr -o scenes/house.toml
      with a choice of one's own; files are named as seen from scenes/
  luminaire scene model.obj -o model.toml && luminaire render model.toml
      the same picture, to the last bit

What goes to standard output names files as seen from the current folder.

Exit codes:
  0  written
  1  the model cannot be loaded, or the file not be written; `error:` on stderr says where and what to do
  2  wrong usage: not an OBJ file, or the file to be written is there already";

/// What to write down.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// An OBJ file.
    model: PathBuf,
    /// The scene file to write, ending in .toml [default: standard output].
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Replace the file that is there.
    #[arg(long, requires = "output")]
    overwrite: bool,
    #[command(flatten)]
    of_scene: SceneOptions,
}

/// Writes the scene file of a bare model.
pub fn run(options: &Options) -> Result<ExitCode> {
    let mut outputs = Outputs::default();
    if let Some(path) = &options.output {
        if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
            return Err(Error::Usage(format!("-o {}: the name of a scene file must end in .toml", path.display())));
        }
        // It may have been changed by hand since.
        if path.exists() && !options.overwrite {
            return Err(Error::Usage(format!(
                "-o {}: there is a file of this name: give another one, or --overwrite to replace it",
                path.display()
            )));
        }
        outputs.add("-o", path)?;
    }
    let folder = options.output.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    let scene::SceneFile { text, scene } = scene::scene_file(&options.model, &options.of_scene.choices(), folder)?;
    outputs.check(scene.files.iter().map(|path| ("a file of the model", &**path)))?;
    scene.warnings.iter().for_each(warn);
    match &options.output {
        None => print(&text)?,
        Some(path) => {
            files::save_text(path, &text)?;
            note(&format!("{}: written", path.display()));
        }
    }
    Ok(ExitCode::SUCCESS)
}
