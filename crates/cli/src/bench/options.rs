//! What to measure, and what to compare it with.

use crate::shared::backend_name::BackendName;
use luminaire_measure::bench::{Effort, SECTIONS, check_estimator};
use std::path::PathBuf;

/// What follows the options in `--help`.
const HELP: &str = "\
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

/// What to measure, and what to compare it with.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
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
    #[arg(long, value_name = "NAME", value_parser = backend, help_heading = "Selection")]
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

impl Options {
    /// How much is measured.
    pub fn effort(&self) -> Effort {
        if self.quick {
            Effort::Quick
        } else if self.long {
            Effort::Long
        } else {
            Effort::Standard
        }
    }

    /// The command line that makes the page again; the page shows it.
    pub fn command(&self) -> String {
        let mut words = vec!["luminaire bench".to_owned()];
        let path = |option: &str, path: &PathBuf| format!("--{option} {}", path.display());
        words.extend(self.scenes.iter().map(|scene| scene.display().to_string()));
        words.extend(self.out.iter().map(|out| path("out", out)));
        words.extend(self.page.iter().map(|page| path("page", page)));
        words.extend(self.quick.then(|| "--quick".into()));
        words.extend(self.long.then(|| "--long".into()));
        words.extend(
            self.backend.iter().filter_map(|name| name.backend()).map(|backend| format!("--backend {backend}")),
        );
        words.extend(self.estimator.iter().map(|name| format!("--estimator {name}")));
        words.extend(self.reference.iter().map(|reference| path("reference", reference)));
        words.extend(self.width.map(|width| format!("--width {width}")));
        words.extend(self.rounds.map(|rounds| format!("--rounds {rounds}")));
        words.extend(self.sections.iter().map(|section| format!("--section {section}")));
        words.join(" ")
    }
}

/// A backend by its name; not `auto`, which may be any of them.
fn backend(name: &str) -> Result<BackendName, String> {
    match <BackendName as clap::ValueEnum>::from_str(name, false) {
        Ok(BackendName::Auto) | Err(_) => Err("expected ray-query, compute-bvh or cpu".into()),
        Ok(backend) => Ok(backend),
    }
}
