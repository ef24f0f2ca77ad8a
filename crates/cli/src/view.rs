//! `luminaire view`.

use crate::shared::backend_name::{self, BackendName};
use crate::shared::camera::CameraOption;
use crate::shared::counts::{pixels, samples, seed};
use crate::shared::estimator::EstimatorOptions;
use crate::shared::film_size::FilmSize;
use crate::shared::foreseen::foresee;
use crate::shared::printing::{Notes, note, warn};
use crate::shared::scene_options::SceneOptions;
use crate::shared::tone_name::{ToneName, exposure};
use luminaire::Result;
use luminaire::film::Film;
use luminaire::scene::Exposure;
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  luminaire view scenes/cornell/cornell.toml
      a window of the size that the scene file says
  luminaire view model.obj --width 1280 --height 720 --backend compute-bvh
      another size, and our own BVH to begin with
  luminaire view model.obj --exposure auto --tone agx
      as bright as its surfaces want it, and with soft highlights; X finds the exposure anew, T changes the curve
  luminaire view scenes/cornell/cornell.toml --spp 256
      the picture stops at 256 samples a pixel; C prints the camera, and writes it to cornell-camera-1.toml
  luminaire view scenes/cornell/cornell.toml --camera cornell-camera-1.toml
      begins with the camera, the exposure and the tone curve that C wrote; `luminaire render` takes it, too

Files go to the current folder: <SCENE>-view-1.png, -2, ...; none is ever replaced.";

const EXIT_CODES: &str = "\
Exit codes:
  0    the window was closed
  1    failure: a file, a scene, a device, no display; `error:` on stderr says what and what to do
  2    wrong usage: an option, or options that do not go together";

/// The largest side of a window in pixels.
const LARGEST_SIDE: u32 = 16384;

/// What to look at, and how.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("Keys and mouse:\n{}\n\n{EXAMPLES}\n\n{EXIT_CODES}", indented(luminaire_view::HELP)))]
pub struct Options {
    /// A scene file (.toml) or any OBJ file.
    scene: PathBuf,

    #[command(flatten)]
    camera: CameraOption,

    /// Width of the window in pixels [default: the scene's, or from --height at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels::<16, LARGEST_SIDE>, help_heading = "Window")]
    width: Option<u32>,
    /// Height of the window in pixels [default: the scene's, or from --width at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels::<16, LARGEST_SIDE>, help_heading = "Window")]
    height: Option<u32>,
    /// Exposure in stops to begin with: radiance times 2^STOPS; `auto` finds one from the scene [default: the scene's].
    #[arg(long, value_name = "STOPS|auto", allow_negative_numbers = true, value_parser = exposure, help_heading = "Window")]
    exposure: Option<Exposure>,
    /// Tone curve to begin with [default: the scene's].
    #[arg(long, value_name = "NAME", help_heading = "Window")]
    tone: Option<ToneName>,

    /// Leave the picture as it is after so many samples a pixel [default: it gets better without end].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = samples, help_heading = "Quality")]
    spp: Option<u32>,
    /// Seed of the random numbers: the same seed gives the same picture [default: the scene's].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = seed, help_heading = "Quality")]
    seed: Option<u32>,
    #[command(flatten)]
    estimator: EstimatorOptions,
    #[command(flatten)]
    of_scene: SceneOptions,

    /// What traces the rays to begin with.
    #[arg(long, value_name = "NAME", default_value = "auto", help_heading = "Device")]
    backend: BackendName,
    /// The Vulkan device that traces: its index in `luminaire devices`, or a part of its name [default: the best]. The window is filled by the
    /// best one that can.
    #[arg(long, value_name = "INDEX|NAME", help_heading = "Device")]
    device: Option<String>,
}

/// Each line of a text two spaces further to the right.
fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}").trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

/// Loads a scene and shows it until the window is closed.
pub fn run(options: &Options) -> Result<ExitCode> {
    let request = backend_name::request(options.backend, options.device.as_deref())?;
    options.estimator.check()?;
    let mut scene = options.of_scene.load(&options.scene)?;
    options.camera.choose(&mut scene, Notes { quiet: false })?;
    let own_film = scene.film;
    FilmSize { width: options.width, height: options.height, largest: LARGEST_SIDE }.apply(&mut scene.film);
    Film::check_size(scene.film.width, scene.film.height)?;
    options.estimator.apply(&mut scene)?;
    scene.settings.seed = options.seed.unwrap_or(scene.settings.seed);
    scene.settings.exposure = options.exposure.unwrap_or(scene.settings.exposure);
    scene.settings.tone = options.tone.map_or(scene.settings.tone, ToneName::tone);
    let foreseen = foresee(&mut scene, &own_film);
    scene.notes.iter().for_each(|chosen| note(chosen));
    scene.warnings.iter().for_each(warn);
    foreseen.found.iter().for_each(|found| note(found));
    luminaire_view::run(luminaire_view::Options { scene, request, spp: options.spp.unwrap_or(u32::MAX) })?;
    Ok(ExitCode::SUCCESS)
}
