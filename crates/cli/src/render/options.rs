//! What to render, and how.

use super::turn::PivotName;
use crate::shared::backend_name::BackendName;
use crate::shared::camera::CameraOption;
use crate::shared::counts::{pixels, samples, seed};
use crate::shared::estimator::EstimatorOptions;
use crate::shared::exit_codes::EXIT_CODES;
use crate::shared::scene_options::SceneOptions;
use crate::shared::tone_name::{ToneName, exposure};
use crate::shared::values::{Pixel, Rectangle, frames, noise, pixel, range, rectangle, seconds, turntable};
use luminaire::picture::Crop;
use luminaire::scene::Exposure;
use std::ops::Range;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  luminaire render scenes/cornell/cornell.toml
      cornell.png in the current folder, with what the scene file says
  luminaire render model.obj -o out/model.png -o out/model.exr --width 1920 --spp 256
      two files of one render; the height follows from the scene's aspect ratio
  luminaire render model.obj --exposure auto --tone agx
      as bright as its surfaces want it, and with soft highlights, as film has them
  luminaire render model.obj --sky sunset.hdr --up z --ground off
      a bare model in a light of one's own, turned from z up, on nothing; `luminaire scene` writes all that it gets
  luminaire render model.obj --time 30 --backend compute-bvh --stats run.json
      as many samples as 30 seconds allow, and the figures of the run
  luminaire render model.obj --noise 0.02 --time 600 --error-map noise.png
      until the estimated error is 2 %, but no longer than ten minutes; and where it is how large
  luminaire render model.obj --spp 4096 -o model.exr --checkpoint model.checkpoint.exr --resume
      goes on where it was, however it ended; the same command again after Ctrl-C, a crash or a power cut
  luminaire render house.toml --camera garden -o garden.png
      one of the scene's cameras; --camera house-camera-1.toml is one that the window wrote
  luminaire render house.toml --crop 800,600,200,100 --spp 4096 -o corner.png
      a piece of 200 x 100 pixels of the picture, as the whole picture would have it
  luminaire render chair.obj --transparent --view left -o chair.png
      to be put over another picture; without a ground, seen from the left
  luminaire render model.obj --samples 1024..2048 -o part-1.exr
      one part of four, on one machine of four; `luminaire merge part-*.exr -o model.exr` joins them
  luminaire render model.obj --turntable 120 -o frame-%04d.png
      a turn around the model: frame-0000.png to frame-0119.png; the same command again keeps those that are finished

";

/// The largest side of a picture in pixels.
pub const LARGEST_SIDE: u32 = 65536;

/// Options that mean nothing where nothing is rendered.
const REPLAY_CONFLICTS: [&str; 10] = [
    "output",
    "crop",
    "transparent",
    "error_map",
    "aov",
    "stats",
    "checkpoint",
    "checkpoint_every",
    "resume",
    "turntable",
];

/// What to render, and how.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{EXAMPLES}{EXIT_CODES}"))]
pub struct Options {
    /// A scene file (.toml) or any OBJ file, which then gets a camera, and a sky and a ground if nothing in it emits.
    pub scene: PathBuf,

    #[command(flatten)]
    pub camera: CameraOption,
    /// Render only these pixels: the left column and the upper row, counted from 0 at the upper left of the picture, width and height. They are those of the whole
    /// picture to the last bit (but the layers `error` along the border), in a picture of W x H pixels; an EXR knows its place in the whole (data window).
    #[arg(long, value_name = "X,Y,W,H", allow_negative_numbers = true, value_parser = rectangle, help_heading = "Framing")]
    pub crop: Option<Rectangle>,
    /// Hide the sky from the camera and give the picture alpha: the share of a pixel's samples that met something, glass included. The sky still lights the scene, and is
    /// seen in mirrors and through glass. A PNG has straight alpha, an EXR the channel A and colours multiplied by it; an HDR has none.
    #[arg(long, help_heading = "Framing")]
    pub transparent: bool,

    /// A file to write; .png, .exr or .hdr says the format. May be given several times [default: <SCENE>.png here].
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Vec<PathBuf>,
    /// Exposure of a PNG in stops: radiance times 2^STOPS; `auto` finds one from the scene, the same at every size and on every backend
    /// [default: the scene's].
    #[arg(long, value_name = "STOPS|auto", allow_negative_numbers = true, value_parser = exposure, help_heading = "Output")]
    pub exposure: Option<Exposure>,
    /// Tone curve of a PNG, after the exposure [default: the scene's].
    #[arg(long, value_name = "NAME", help_heading = "Output")]
    pub tone: Option<ToneName>,
    /// Write a heat map of the estimated relative error of every pixel.
    #[arg(long, value_name = "FILE.png", help_heading = "Output")]
    pub error_map: Option<PathBuf>,
    /// Give EXR files the layers albedo, N (normal) and Z (depth) of what the camera sees first, and the number of samples: for denoisers
    /// and compositing.
    #[arg(long, conflicts_with = "samples", help_heading = "Output")]
    pub aov: bool,
    /// Write a denoised picture, too. It has a bias that the estimated error does not know.
    #[cfg(feature = "denoise")]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["samples", "transparent"], help_heading = "Output")]
    pub denoised: Option<PathBuf>,
    /// Write the figures of the run to a JSON file.
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    pub stats: Option<PathBuf>,
    /// Say nothing but errors.
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,

    /// Samples a pixel [default: the scene's, unless there is --time or --noise].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = samples, help_heading = "Quality")]
    pub spp: Option<u32>,
    /// Stop rendering after so many seconds; with --spp, whichever comes first.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds, help_heading = "Quality")]
    pub time: Option<f64>,
    /// Stop when the estimated relative error (the root of relMSE) is below E, for example 0.02 for 2 %; with --spp and --time, whichever
    /// comes first. The true error is then at most 1.1 E in 92 of 100 renders or more. It goes by the error without fireflies (pixels whose light only two or three of up to eight blocks of their samples found); where
    /// those hold most of the error, a warning says how large it is with them. A picture that is still black after 1024 samples a pixel ends, too.
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = noise, help_heading = "Quality")]
    pub noise: Option<f64>,
    /// With --noise: give parts of the picture different numbers of samples, more where its error is larger: to the same --noise with fewer of them where the noise is
    /// uneven; where that would not save enough, all get as many. --spp is then at most that of a pixel in the mean. `merge` takes no such files.
    #[arg(long, requires = "noise", help_heading = "Quality")]
    pub adaptive: bool,
    /// Render only samples number A to B - 1 of every pixel, as a part that `luminaire merge` joins with others; wants -o PART.exr.
    #[arg(long, value_name = "A..B", allow_negative_numbers = true, value_parser = range, conflicts_with_all = ["spp", "time", "noise"], help_heading = "Quality")]
    pub samples: Option<Range<u32>>,
    /// Width in pixels [default: the scene's, or from --height at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels::<1, LARGEST_SIDE>, help_heading = "Quality")]
    pub width: Option<u32>,
    /// Height in pixels [default: the scene's, or from --width at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels::<1, LARGEST_SIDE>, help_heading = "Quality")]
    pub height: Option<u32>,
    /// Seed of the random numbers: the same seed gives the same picture [default: the scene's].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = seed, help_heading = "Quality")]
    pub seed: Option<u32>,
    #[command(flatten)]
    pub estimator: EstimatorOptions,
    #[command(flatten)]
    pub of_scene: SceneOptions,

    /// Save the render there while it runs, when it ends, and on Ctrl-C or SIGTERM: an EXR file of the picture so far, and of all that
    /// --resume needs.
    #[arg(long, value_name = "FILE.exr", help_heading = "Long renders")]
    pub checkpoint: Option<PathBuf>,
    /// Seconds between two checkpoints.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, allow_negative_numbers = true, value_parser = seconds, requires = "checkpoint", help_heading = "Long renders")]
    pub checkpoint_every: f64,
    /// Go on from the checkpoint, on any backend or device; if there is none yet, start. Also gives a finished render more samples.
    #[arg(long, requires = "checkpoint", help_heading = "Long renders")]
    pub resume: bool,

    /// Render N pictures of the camera turning once about the vertical axis through its target, or on the spot where it stands in a room, counter-clockwise as
    /// seen from above; the first one is the scene's own. Vertical is y, or z where that is the camera's `up`. -o frame-%04d.png says where their numbers stand. Pictures that are finished are kept by the same command.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = turntable, help_heading = "Sequences")]
    pub turntable: Option<u32>,
    /// About what the camera of --turntable turns.
    #[arg(long, value_name = "NAME", default_value = "auto", requires = "turntable", help_heading = "Sequences")]
    pub pivot: PivotName,
    /// Render only frames A to B - 1 of the turn, as one of several machines.
    #[arg(long, value_name = "A..B", allow_negative_numbers = true, value_parser = frames, requires = "turntable", help_heading = "Sequences")]
    pub frames: Option<Range<u32>>,

    /// Trace one sample of one pixel again and print its path, instead of rendering; with --sample. What ends a render (--spp, --samples, ...) changes
    /// nothing about it.
    #[arg(long, value_name = "X,Y", allow_negative_numbers = true, value_parser = pixel, requires = "sample", conflicts_with_all = REPLAY_CONFLICTS, help_heading = "Replay")]
    pub pixel: Option<Pixel>,
    /// The number of the sample that --pixel traces.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(..i64::from(u32::MAX)), requires = "pixel", help_heading = "Replay")]
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

impl Options {
    /// Which part of a picture of this size is rendered, if not all of it.
    pub fn crop_of(&self, whole: (u32, u32)) -> Option<Crop> {
        self.crop.map(|Rectangle { x, y, width, height }| Crop { x, y, width, height, whole })
    }

    /// Whether a file will hold what the camera sees first.
    pub fn wants_aovs(&self) -> bool {
        #[cfg(feature = "denoise")]
        if self.denoised.is_some() {
            return true;
        }
        self.aov
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Args;

    #[test]
    fn numbers_are_checked() {
        let render = |options: &[&str]| {
            let render = Options::augment_args(clap::Command::new("render"));
            render.try_get_matches_from(["render", "a.obj"].iter().chain(options)).map_err(|e| e.exit_code())
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
            ["--noise", "1.01"],
            ["--noise", "2"],
            ["--noise", "inf"],
            ["--adaptive", "--quiet"],
            ["--pixel", "1"],
            ["--pixel", "1,-1"],
            ["--width", "0"],
            ["--height", "65537"],
            ["--seed", "-1"],
            ["--exposure", "nan"],
            ["--exposure", "automatic"],
            ["--tone", "filmic"],
            ["--integrator", "path"],
            ["--estimator", "photon"],
            ["--light-sampling", "some"],
            ["--area-sampling", "some"],
            ["--light-choice", "some"],
            ["--directions", "some"],
            ["--extinction", "some"],
            ["--albedo-threshold", "1.5"],
            ["--sampler", "some"],
            ["--backend", "gpu"],
            ["--turntable", "0"],
            ["--turntable", "10001"],
            ["--pivot", "camera"],
            ["--crop", "--aov"],
            ["--frames", "0..1"],
            ["--max-bounces", "1000001"],
        ] {
            assert_eq!(render(&bad).unwrap_err(), 2, "{bad:?}");
        }
        for good in [
            ["--spp", "4294967295"],
            ["--time", "0.5"],
            ["--exposure", "-2"],
            ["--exposure", "auto"],
            ["--tone", "agx"],
            ["--turntable", "120"],
            ["--noise", "1"],
            ["--max-bounces", "0"],
        ] {
            assert!(render(&good).is_ok(), "{good:?}");
        }
    }
}
