//! Arguments and the manner of speaking: results on stdout, everything else on stderr.

pub mod bench;
mod checkpoint;
pub mod compare;
pub mod completions;
pub mod devices;
mod estimator;
pub mod inspect;
mod inspect_tables;
pub mod man;
pub mod merge;
mod progress;
pub mod render;
mod replay;
pub mod stability;
mod stats;
pub mod view;
#[cfg(feature = "shaderc")]
mod watch;

use luminaire::Error;
use luminaire::backend::Backend;
use luminaire_measure::bench::{SECTIONS, check_estimator};
use std::borrow::Cow;
use std::io::Write;
use std::path::PathBuf;

/// Exit codes, as `--help` tells them.
const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    failure: a file, a scene, a device; `error:` on stderr says what and what to do
  2    wrong usage: an option, or options that do not go together
  3    the device failed while it rendered; what had been rendered until then is written, and with --checkpoint, --resume goes on
  130  interrupted (Ctrl-C or SIGTERM); what had been rendered until then is written";

const EXAMPLES: &str = "\
Examples:
  luminaire render scenes/cornell/cornell.toml
  luminaire render model.obj -o model.png -o model.exr --spp 256
  luminaire render model.obj -o model.png --checkpoint model.checkpoint.exr --resume
  luminaire view model.obj
  luminaire compare model.exr reference.exr
  luminaire inspect model.obj
  luminaire devices
  luminaire stability --list
  luminaire bench --quick

";

const RENDER_EXAMPLES: &str = "\
Examples:
  luminaire render scenes/cornell/cornell.toml
      cornell.png in the current folder, with what the scene file says
  luminaire render model.obj -o out/model.png -o out/model.exr --width 1920 --spp 256
      two files of one render; the height follows from the scene's aspect ratio
  luminaire render model.obj --time 30 --backend compute-bvh --stats run.json
      as many samples as 30 seconds allow, and the figures of the run
  luminaire render model.obj --noise 0.02 --time 600 --error-map noise.png
      until the estimated error is 2 %, but no longer than ten minutes; and where it is how large
  luminaire render model.obj --spp 4096 -o model.exr --checkpoint model.checkpoint.exr --resume
      goes on where it was, however it ended; the same command again after Ctrl-C, a crash or a power cut
  luminaire render model.obj --samples 1024..2048 -o part-1.exr
      one part of four, on one machine of four; `luminaire merge part-*.exr -o model.exr` joins them

";

const MERGE_HELP: &str = "\
Examples:
  luminaire merge part-*.exr -o picture.png -o picture.exr
      the picture of a render that was divided by --samples 0..64, 64..128, ...

The parts must be of the same scene, size, seed, estimator and version, and hold every sample from number 0 on once. The picture is the one of a single
render, but for rounding (1e-6 of each number at most).

Exit codes:
  0  merged
  1  a file cannot be read or written
  2  wrong usage: samples are missing or doubled, a part is not finished, or of another render";

const VIEW_EXAMPLES: &str = "\
Examples:
  luminaire view scenes/cornell/cornell.toml
      a window of the size that the scene file says
  luminaire view model.obj --width 1280 --height 720 --backend compute-bvh
      another size, and our own BVH to begin with
  luminaire view scenes/cornell/cornell.toml --spp 256
      the picture stops at 256 samples a pixel; C prints the camera, and writes it to cornell-camera-1.toml

Files go to the current folder: <SCENE>-view-1.png, -2, ...; none is ever replaced.";

/// Exit codes of `luminaire view`.
const VIEW_EXIT_CODES: &str = "\
Exit codes:
  0    the window was closed
  1    failure: a file, a scene, a device, no display; `error:` on stderr says what and what to do
  2    wrong usage: an option, or options that do not go together";

const COMPARE_EXAMPLES: &str = "\
Examples:
  luminaire compare cornell.exr reference.exr
      how far they are apart: RMSE, relMSE, bias, FLIP, and the worst pixels
  luminaire compare cornell.exr reference.exr --heatmap error.png
      and a picture of where
  luminaire compare cornell.exr reference.exr --max-relmse 0.01 --max-bias 0.005 && echo good enough
      as a test: relMSE at most 0.01, and no channel's mean off by more than 0.5 %

Exit codes:
  0  compared; every limit that was given is kept
  1  a limit is exceeded, pixels of IMAGE are not finite, or a file cannot be read or written
  2  wrong usage: an option, or pictures of different sizes";

const STABILITY_HELP: &str = "\
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

const BENCH_HELP: &str = "\
Examples:
  luminaire bench
      the standard scenes on every backend, in some minutes: bench/index.html
  luminaire bench model.toml --quick --backend compute-bvh --estimator default --estimator cosine
      two estimators on one scene and one backend, in seconds
  luminaire bench --out after --baseline before/bench.json
      the same again, and what has changed by more than the noise

DIR gets index.html, which needs no other file; figures.csv (every measured number with its spread), points.csv (the points of the charts), bench.json (everything)
and the charts as SVG.

A figure has become worse if its rounds all lie on the worse side of the baseline's, and the two ranges lie further apart than 5 % and than either of them is
wide (1.5 times that with 4 rounds, 3 times with 3); with fewer than 3 rounds nothing is concluded.

Exit codes:
  0    measured; no figure is worse than in the baseline
  1    a figure is worse than in the baseline, a section failed (the others are written), or a file or device is missing
  2    wrong usage
  130  interrupted; nothing is written";

const DEVICES_HELP: &str = "\
Examples:
  luminaire devices
      every device, what it offers, and the backend that `luminaire render` would take there
  luminaire render model.obj --device llvmpipe
      renders on the one whose name contains this

Exit codes:
  0  at least one device is usable
  1  none is; what to install is told
  2  wrong usage";

const INSPECT_HELP: &str = "\
Examples:
  luminaire inspect scenes/textures/textures.toml
      objects, materials, textures and luminaires, what the kernel will model, the memory that this takes, and every warning
  luminaire inspect model.obj
      the camera and the light that were found for it, too

Exit codes:
  0  the scene can be loaded, with or without warnings
  1  it cannot: a file is missing or wrong; `error:` on stderr says where and what to do
  2  wrong usage";

const COMPLETIONS_HELP: &str = "\
Examples:
  luminaire completions bash > ~/.local/share/bash-completion/completions/luminaire
      for yourself; for everyone: /usr/share/bash-completion/completions/luminaire
  luminaire completions zsh > ~/.zfunc/_luminaire
      with `fpath=(~/.zfunc $fpath)` before `compinit` in ~/.zshrc
  luminaire completions fish > ~/.config/fish/completions/luminaire.fish

Exit codes:
  0  printed
  1  standard output cannot be written
  2  wrong usage: there is no script for this shell";

const MAN_HELP: &str = "\
Examples:
  luminaire man | man -l -
      reads the manual page
  luminaire man ~/.local/share/man/man1
      installs all of them for yourself: then `man luminaire-render`

Exit codes:
  0  printed or written
  1  a page cannot be written
  2  wrong usage";

/// A path tracer on Vulkan: ray queries or a compute-shader BVH, with a double-precision reference.
#[derive(Debug, clap::Parser)]
#[command(version, about, after_help = format!("{EXAMPLES}{EXIT_CODES}"), subcommand_required = true)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// Render a scene to PNG, EXR or HDR files.
    Render(RenderOptions),
    /// Join the parts of a render that --samples wrote.
    Merge(MergeOptions),
    /// Show a scene in a window: the camera moves, and the picture gets better while it rests.
    View(ViewOptions),
    /// Tell how far a picture is from a reference, and whether that is within limits.
    Compare(CompareOptions),
    /// List every Vulkan device, what it offers, and which backend it would run and why.
    #[command(after_help = DEVICES_HELP)]
    Devices,
    /// Show what was loaded from a scene, and every warning.
    Inspect(InspectOptions),
    /// Run methods over the ranges in which they can fail, on every backend here: charts, numbers, and a page.
    Stability(StabilityOptions),
    /// Measure speed against accuracy: scenes, backends and estimators side by side, as a page, charts and numbers.
    Bench(BenchOptions),
    /// Print a script with which a shell completes subcommands, options and their values.
    Completions(CompletionsOptions),
    /// Print the manual page, or write one page for each subcommand to a folder.
    Man(ManOptions),
}

/// For which shell.
#[derive(Debug, clap::Args)]
#[command(after_help = COMPLETIONS_HELP)]
pub struct CompletionsOptions {
    /// The shell that will read the script.
    pub shell: clap_complete::Shell,
}

/// Where to.
#[derive(Debug, clap::Args)]
#[command(after_help = MAN_HELP)]
pub struct ManOptions {
    /// The folder for luminaire.1, luminaire-render.1 and so on; it is made if it is missing [default: only luminaire.1, to standard output].
    #[arg(value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// What to join.
#[derive(Debug, clap::Args)]
#[command(after_help = MERGE_HELP)]
pub struct MergeOptions {
    /// Files of `luminaire render --samples`, in any order.
    #[arg(required = true, value_name = "PART")]
    pub parts: Vec<PathBuf>,
    /// A file to write; .png, .exr or .hdr says the format. May be given several times.
    #[arg(short, long, required = true, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Exposure of a PNG in stops [default: that of the parts].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: Option<f32>,
}

/// What to measure, and what to compare it with.
#[derive(Debug, clap::Args)]
#[command(after_help = BENCH_HELP)]
pub struct BenchOptions {
    /// Scene files [default: cornell, instances, lamps and textures in the folder scenes; the first two with --quick].
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// The folder for the page and its numbers; it is made if it is missing [default: bench].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// The page in Markdown, too, with the charts as links into the folder.
    #[arg(long, value_name = "FILE.md")]
    pub page: Option<PathBuf>,
    /// Compare with the bench.json of an earlier run; exit code 1 if a figure is worse by more than the noise.
    #[arg(long, value_name = "FILE.json")]
    pub baseline: Option<PathBuf>,

    /// Small pictures and little time: to see that it works.
    #[arg(long, conflicts_with = "long", help_heading = "Effort")]
    pub quick: bool,
    /// Larger pictures and ten times the time.
    #[arg(long, help_heading = "Effort")]
    pub long: bool,
    /// Width of the pictures in pixels; the height follows from the scene's aspect ratio [default: 128; 64 with --quick, 256 with --long].
    #[arg(long, value_name = "PIXELS", conflicts_with = "reference", value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Effort")]
    pub width: Option<u32>,
    /// How often everything is measured [default: 5; 3 with --quick].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "Effort")]
    pub rounds: Option<u32>,

    /// Only this backend; may be given several times [default: all that are here].
    #[arg(long, value_name = "NAME", value_parser = bench_backend, help_heading = "Selection")]
    pub backend: Vec<BackendName>,
    /// Only this estimator; may be given several times: `own` (the scene's) or a name of `luminaire render --estimator`, and perhaps `+independent` for
    /// independent random numbers [default: default, default+independent, cosine, no-light-sampling, own].
    #[arg(long, value_name = "NAME", value_parser = check_estimator, help_heading = "Selection")]
    pub estimator: Vec<String>,
    /// Only this section; may be given several times [default: all].
    #[arg(long = "section", value_name = "NAME", value_parser = clap::builder::PossibleValuesParser::new(SECTIONS.iter().map(|section| section.name)), help_heading = "Selection")]
    pub sections: Vec<String>,
    /// The picture that the only SCENE converges to, for example an EXR of many samples; the pictures take its size [default: it is
    /// rendered].
    #[arg(long, value_name = "FILE", help_heading = "Selection")]
    pub reference: Option<PathBuf>,
}

fn bench_backend(name: &str) -> Result<BackendName, String> {
    match <BackendName as clap::ValueEnum>::from_str(name, false) {
        Ok(BackendName::Auto) | Err(_) => Err("expected ray-query, compute-bvh or cpu".into()),
        Ok(backend) => Ok(backend),
    }
}

/// Which sweeps to run, and where their files go.
#[derive(Debug, clap::Args)]
#[command(after_help = STABILITY_HELP)]
pub struct StabilityOptions {
    /// Names of sweeps, as `--list` tells them [default: all].
    #[arg(value_name = "SWEEP")]
    pub sweeps: Vec<String>,
    /// The folder for <SWEEP>.csv and <SWEEP>-<CHART>.svg; it is made if it is missing [default: stability].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// The page that shows and explains the charts, in Markdown [default: README.md in the folder].
    #[arg(long, value_name = "FILE")]
    pub page: Option<PathBuf>,
    /// Finer steps and more samples: about ten times as long.
    #[arg(long)]
    pub long: bool,
    /// List the sweeps, and run none.
    #[arg(long)]
    pub list: bool,
}

/// What to inspect.
#[derive(Debug, clap::Args)]
#[command(after_help = INSPECT_HELP)]
pub struct InspectOptions {
    /// A scene file (.toml) or any OBJ file.
    pub scene: PathBuf,
}

/// What to compare, and within which limits.
#[derive(Debug, clap::Args)]
#[command(after_help = COMPARE_EXAMPLES)]
pub struct CompareOptions {
    /// The picture: EXR, PFM, HDR, PNG and most others.
    pub image: PathBuf,
    /// What is right, or held to be.
    pub reference: PathBuf,

    /// Fail above this root-mean-square error, in units of the pictures.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    pub max_rmse: Option<f64>,
    /// Fail above this relMSE, the mean of (a - b)^2 / (b^2 + 0.01).
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    pub max_relmse: Option<f64>,
    /// Fail if the mean of a channel is off by more than this part of the reference's; 0.01 is 1 %.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    pub max_bias: Option<f64>,
    /// Fail above this mean FLIP, from 0 (they look the same) to 1.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = limit, help_heading = "Limits")]
    pub max_flip: Option<f64>,

    /// Take FLIP as the pictures look in a PNG of this exposure [default: over all exposures that show something; 0 if a picture holds
    /// whole numbers].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: Option<f32>,
    /// How many of the worst pixels to list.
    #[arg(long, value_name = "N", default_value_t = 5, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(..=100_000), help_heading = "Output")]
    pub worst: u32,
    /// Write a picture of the relative error of every pixel, with its scale.
    #[arg(long, value_name = "FILE.png", help_heading = "Output")]
    pub heatmap: Option<PathBuf>,
    /// Write the figures to a JSON file.
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    pub stats: Option<PathBuf>,
}

/// Options that mean nothing where nothing is rendered.
const REPLAY_CONFLICTS: [&str; 9] =
    ["output", "error_map", "aov", "stats", "spp", "time", "noise", "samples", "checkpoint"];

/// What to render, and how.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{RENDER_EXAMPLES}{EXIT_CODES}"))]
pub struct RenderOptions {
    /// A scene file (.toml) or any OBJ file.
    pub scene: PathBuf,

    /// A file to write; .png, .exr or .hdr says the format. May be given several times [default: <SCENE>.png here].
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Vec<PathBuf>,
    /// Exposure of a PNG in stops: radiance times 2^STOPS [default: the scene's].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops, help_heading = "Output")]
    pub exposure: Option<f32>,
    /// Write a heat map of the estimated relative error of every pixel.
    #[arg(long, value_name = "FILE.png", help_heading = "Output")]
    pub error_map: Option<PathBuf>,
    /// Give EXR files the layers albedo, N (normal) and Z (depth) of what the camera sees first, and the number of samples: for denoisers
    /// and compositing.
    #[arg(long, conflicts_with = "samples", help_heading = "Output")]
    pub aov: bool,
    /// Write a denoised picture, too. It has a bias that the estimated error does not know.
    #[cfg(feature = "denoise")]
    #[arg(long, value_name = "FILE", conflicts_with = "samples", help_heading = "Output")]
    pub denoised: Option<PathBuf>,
    /// Write the figures of the run to a JSON file.
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    pub stats: Option<PathBuf>,
    /// Say nothing but errors.
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,

    /// Samples a pixel [default: the scene's, unless there is --time or --noise].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Quality")]
    pub spp: Option<u32>,
    /// Stop rendering after so many seconds; with --spp, whichever comes first.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds, help_heading = "Quality")]
    pub time: Option<f64>,
    /// Stop when the estimated relative error (the root of relMSE) is below E, for example 0.02; with --spp and --time, whichever
    /// comes first.
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = noise, help_heading = "Quality")]
    pub noise: Option<f64>,
    /// Render only samples number A to B - 1 of every pixel, as a part that `luminaire merge` joins with others; wants -o PART.exr.
    #[arg(long, value_name = "A..B", value_parser = checkpoint::range, conflicts_with_all = ["spp", "time", "noise"], help_heading = "Quality")]
    pub samples: Option<std::ops::Range<u32>>,
    /// Width in pixels [default: the scene's, or from --height at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Quality")]
    pub width: Option<u32>,
    /// Height in pixels [default: the scene's, or from --width at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Quality")]
    pub height: Option<u32>,
    /// Seed of the random numbers: the same seed gives the same picture [default: the scene's].
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Quality")]
    pub seed: Option<u32>,
    #[command(flatten)]
    pub estimator: estimator::EstimatorOptions,

    /// Save the render there while it runs, when it ends, and on Ctrl-C or SIGTERM: an EXR file of the picture so far, and of all that
    /// --resume needs.
    #[arg(long, value_name = "FILE.exr", help_heading = "Long renders")]
    pub checkpoint: Option<PathBuf>,
    /// Seconds between two checkpoints.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = seconds, requires = "checkpoint", help_heading = "Long renders")]
    pub checkpoint_every: f64,
    /// Go on from the checkpoint, on any backend or device; if there is none yet, start. Also gives a finished render more samples.
    #[arg(long, requires = "checkpoint", help_heading = "Long renders")]
    pub resume: bool,

    /// Trace one sample of one pixel again and print its path, instead of rendering; with --sample.
    #[arg(long, value_name = "X,Y", value_parser = pixel, requires = "sample", conflicts_with_all = REPLAY_CONFLICTS, help_heading = "Replay")]
    pub pixel: Option<[u32; 2]>,
    /// The number of the sample that --pixel traces.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..i64::from(u32::MAX)), requires = "pixel", help_heading = "Replay")]
    pub sample: Option<u32>,

    /// Render again whenever a shader changes (the sources are in LUMINAIRE_SHADERS, or where the program was built).
    #[cfg(feature = "shaderc")]
    #[arg(long, help_heading = "Device")]
    pub watch: bool,
    /// What traces the rays.
    #[arg(long, value_name = "NAME", default_value = "auto", help_heading = "Device")]
    pub backend: BackendName,
    /// A Vulkan device: its index in `luminaire devices`, or a part of its name [default: the best].
    #[arg(long, value_name = "INDEX|NAME", help_heading = "Device")]
    pub device: Option<String>,
}

/// What to look at, and how.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("Keys and mouse:\n{}\n\n{VIEW_EXAMPLES}\n\n{VIEW_EXIT_CODES}", indented(luminaire_view::HELP)))]
pub struct ViewOptions {
    /// A scene file (.toml) or any OBJ file.
    pub scene: PathBuf,

    /// Width of the window in pixels [default: the scene's, or from --height at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(16..=16384), help_heading = "Window")]
    pub width: Option<u32>,
    /// Height of the window in pixels [default: the scene's, or from --width at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(16..=16384), help_heading = "Window")]
    pub height: Option<u32>,
    /// Exposure in stops to begin with: radiance times 2^STOPS [default: the scene's].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops, help_heading = "Window")]
    pub exposure: Option<f32>,

    /// Leave the picture as it is after so many samples a pixel [default: it gets better without end].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Quality")]
    pub spp: Option<u32>,
    /// Seed of the random numbers: the same seed gives the same picture [default: the scene's].
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Quality")]
    pub seed: Option<u32>,
    #[command(flatten)]
    pub estimator: estimator::EstimatorOptions,

    /// What traces the rays to begin with.
    #[arg(long, value_name = "NAME", default_value = "auto", help_heading = "Device")]
    pub backend: BackendName,
    /// The Vulkan device that traces: its index in `luminaire devices`, or a part of its name [default: the best]. The window is filled by the
    /// best one that can.
    #[arg(long, value_name = "INDEX|NAME", help_heading = "Device")]
    pub device: Option<String>,
}

/// Each line of a text two spaces further to the right.
fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}").trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

/// `--backend`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum BackendName {
    /// The fastest on the best device; the CPU where there is no Vulkan.
    Auto,
    /// Vulkan ray queries over acceleration structures.
    RayQuery,
    /// A compute shader's own traversal of a BVH.
    ComputeBvh,
    /// The double-precision reference.
    Cpu,
}

impl BackendName {
    /// The backend that is asked for; none: `auto`.
    fn backend(self) -> Option<Backend> {
        match self {
            BackendName::Auto => None,
            BackendName::RayQuery => Some(Backend::RayQuery),
            BackendName::ComputeBvh => Some(Backend::ComputeBvh),
            BackendName::Cpu => Some(Backend::Cpu),
        }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        // More than a thousand years, no clock counts.
        Ok(seconds) if seconds > 0.0 && seconds < 3.2e10 => Ok(seconds),
        _ => Err("expected a number of seconds above 0, for example 30 or 0.5".into()),
    }
}

fn noise(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(noise) if noise > 0.0 && noise.is_finite() => Ok(noise),
        _ => Err("expected a relative error above 0, for example 0.02 for 2 %".into()),
    }
}

fn pixel(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.trim().parse::<u32>().ok();
    match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
        Some((Some(x), Some(y))) => Ok([x, y]),
        _ => Err("expected column and row of a pixel, counted from 0 at the upper left, for example 12,40".into()),
    }
}

fn limit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(limit) if limit >= 0.0 && limit.is_finite() => Ok(limit),
        _ => Err("expected a number from 0, for example 0.01".into()),
    }
}

fn stops(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(stops) if stops.abs() <= 64.0 => Ok(stops),
        _ => Err("expected a number of stops from -64 to 64, for example 1.5".into()),
    }
}

/// Says a line on stderr. A stderr that nobody reads is no reason to fail.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", harmless(line));
}

/// Prints a result on stdout. A reader that closes the pipe early (`| head`) is content with less.
fn print(text: &str) -> luminaire::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::write("standard output".as_ref(), e)),
        _ => Ok(()),
    }
}

/// A text without control characters: names come from files, and a terminal would obey.
fn harmless(text: &str) -> Cow<'_, str> {
    let control = |c: char| c.is_control() && c != '\n' && c != '\t';
    if text.contains(control) { Cow::Owned(text.replace(control, "\u{fffd}")) } else { Cow::Borrowed(text) }
}

/// Rows with their columns aligned, each line indented by `indent` spaces.
fn table(indent: usize, rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|r| r.get(c)).map(|cell| cell.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        format!("{:indent$}{}", "", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, Parser};

    #[test]
    fn the_definition_is_sound() {
        Args::command().debug_assert();
    }

    #[test]
    fn numbers_are_checked() {
        let render = |options: &[&str]| {
            Args::try_parse_from(["luminaire", "render", "a.obj"].iter().chain(options)).map_err(|e| e.exit_code())
        };
        for bad in [
            ["--spp", "0"],
            ["--spp", "-1"],
            ["--spp", "4294967296"],
            ["--time", "0"],
            ["--time", "nan"],
            ["--time", "inf"],
            ["--noise", "0"],
            ["--noise", "nan"],
            ["--pixel", "1"],
            ["--pixel", "1,-1"],
            ["--width", "0"],
            ["--height", "65537"],
            ["--seed", "-1"],
            ["--exposure", "nan"],
            ["--integrator", "path"],
            ["--estimator", "photon"],
            ["--light-sampling", "some"],
            ["--area-sampling", "some"],
            ["--directions", "some"],
            ["--extinction", "some"],
            ["--albedo-threshold", "1.5"],
            ["--sampler", "some"],
            ["--backend", "gpu"],
            ["--max-bounces", "1000001"],
        ] {
            assert_eq!(render(&bad).unwrap_err(), 2, "{bad:?}");
        }
        for good in [["--spp", "4294967295"], ["--time", "0.5"], ["--exposure", "-2"], ["--max-bounces", "0"]] {
            assert!(render(&good).is_ok(), "{good:?}");
        }
    }

    #[test]
    fn columns_are_aligned() {
        let rows = vec![vec!["a".into(), "b".into()], vec!["long".into(), "c".into()]];
        assert_eq!(table(2, &rows), "  a     b\n  long  c\n");
    }
}
