//! `--turntable`: a picture for each step of a turn of the camera, of which those that are finished are kept.

use super::checkpoint;
use super::ending;
use super::failing_tracer::FailingTracer;
use super::frame_name::FrameName;
use super::options::Options;
use super::outcome::Outcome;
use super::outputs::{save_stats, write_frame};
use super::progress::Reporter;
use super::seconds::Seconds;
use super::stats::Stats;
use super::summary::samples_of;
use super::tracing::{layers, limits, note_renderer};
use super::turn::{PivotName, Turn};
use crate::shared::error_line::error_line;
use crate::shared::exit_codes::{DEVICE_FAILED, INTERRUPTED};
use crate::shared::foreseen::Foreseen;
use crate::shared::interrupts;
use crate::shared::outputs::Outputs;
use crate::shared::printing::{self, Notes, print};
use crate::shared::units::duration;
use luminaire::backend::{self, Request};
use luminaire::part::Provenance;
use luminaire::picture::{self, Format};
use luminaire::reference::Reference;
use luminaire::render::{Cropped, End, Rendered, resume};
use luminaire::scene::{Pivot, Scene, Sensor};
use luminaire::{Error, Result, files};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// The frames of a turn that are to be there in the end.
pub struct Sequence {
    /// Frames of the whole turn.
    turn: u32,
    /// About what the camera turns.
    pivot: Pivot,
    /// Those of this run, with their files.
    frames: Vec<(u32, Vec<PathBuf>)>,
}

/// What `--stats` writes of a sequence.
#[derive(Debug, Serialize)]
struct SequenceStats {
    version: &'static str,
    scene: String,
    /// Frames of the whole turn.
    turntable: u32,
    /// About what the camera turns: "target"; "camera": on the spot.
    pivot: &'static str,
    /// "frames": all are there; "interrupted"; "failed".
    end: &'static str,
    frames: Vec<FrameStats>,
}

/// A frame that is there.
#[derive(Debug, Serialize)]
struct FrameStats {
    frame: u32,
    /// Whether it was there before.
    kept: bool,
    outputs: Vec<String>,
    /// As `--stats` of one picture has them; none if it was kept.
    figures: Option<serde_json::Value>,
}

impl FrameStats {
    fn new(frame: u32, files: &[PathBuf], figures: Option<serde_json::Value>) -> Self {
        let outputs = files.iter().map(|path| path.display().to_string()).collect();
        FrameStats { frame, kept: figures.is_none(), outputs, figures }
    }
}

/// Refuses what does not go together with a sequence of so many frames.
pub fn check(options: &Options, turn: u32) -> Result<()> {
    let finished = "every frame that is finished is kept by the same command: leave it out";
    let whole = "frames are shared by --frames A..B, each rendered whole: leave it out";
    let one = "it is of one picture: render that alone";
    let refused = [
        ("--checkpoint", options.checkpoint.is_some(), finished),
        ("--samples", options.samples.is_some(), whole),
        ("--error-map", options.error_map.is_some(), one),
        #[cfg(feature = "denoise")]
        ("--denoised", options.denoised.is_some(), one),
        #[cfg(feature = "shaderc")]
        ("--watch", options.watch, one),
    ];
    if let Some((option, _, why)) = refused.into_iter().find(|(_, given, _)| *given) {
        return Err(Error::Usage(format!("{option} does not go together with --turntable: {why}")));
    }
    match &options.frames {
        Some(frames) if frames.end > turn => Err(Error::Usage(format!(
            "--frames {}..{}: the turn has the frames 0 to {}, by --turntable {turn}",
            frames.start,
            frames.end,
            turn - 1
        ))),
        _ => Ok(()),
    }
}

impl Sequence {
    /// The frames that are asked for, with their files, which are declared. A usage error if a name has no place for a number, or is one of the others.
    pub fn of(options: &Options, turn: u32, outputs: &mut Outputs) -> Result<Self> {
        let mut names = options.output.iter().map(|path| FrameName::of(path)).collect::<Result<Vec<_>>>()?;
        let by_default = names.is_empty();
        if by_default {
            let stem = options.scene.file_stem().ok_or_else(|| Error::read(&options.scene, "it is not a file"))?;
            let mut name = stem.to_owned();
            name.push(".png");
            names.push(FrameName::plain(name.as_ref()));
        }
        let mut frames = vec![];
        for frame in options.frames.clone().unwrap_or(0..turn) {
            let files: Vec<_> = names.iter().map(|name| name.file(frame)).collect();
            for path in &files {
                Format::of(path)?;
                if by_default { outputs.add_default("-o", path) } else { outputs.add("-o", path) }?;
            }
            frames.push((frame, files));
        }
        Ok(Sequence { turn, pivot: Pivot::Target, frames })
    }

    /// Decides about what the camera turns, which the scene's notes and warnings tell; with a tracer, which is made and left there if one is needed.
    pub fn decide(&mut self, wanted: PivotName, scene: &mut Scene, tracer: &mut Option<Reference>) {
        if self.turn == 1 {
            return;
        }
        let turn = Turn::of(scene, wanted, tracer);
        self.pivot = turn.pivot;
        let frames: Vec<u32> = self.frames.iter().map(|(frame, _)| *frame).collect();
        let warning = turn.warning(&frames, self.turn);
        scene.warnings.extend(warning.map(|warning| format!("{}: {warning}", scene.path.display())));
        scene.notes.extend(turn.note);
    }

    /// The camera of a frame.
    fn sensor(&self, scene: &Scene, frame: u32) -> Sensor {
        scene.sensor.turned(f64::from(frame) / f64::from(self.turn), self.pivot)
    }
}

/// By what the file of a frame is known again: a digest of everything that it depends on.
struct Marks<'a> {
    sequence: &'a Sequence,
    options: &'a Options,
    scene: &'a Scene,
    foreseen: &'a Foreseen,
    /// Of the first camera.
    provenance: Provenance,
}

impl Marks<'_> {
    fn of(&self, frame: u32, format: Format) -> String {
        let turn = self.sequence.turn;
        let sensor = self.sequence.sensor(self.scene, frame);
        let limits = limits(self.options, self.scene);
        let shown = match format {
            Format::Png => format!("{:?}", self.foreseen.development),
            Format::Exr => format!("layers {}", self.options.aov),
            Format::Hdr => String::new(),
        };
        let digest = self.provenance.digest(&format!("{turn} {frame} {sensor:?} {limits:?} {shown}"));
        format!("frame {frame} of {turn}: {digest}")
    }

    /// Whether all files of a frame are there and whole, as this render would write them.
    fn are_on(&self, frame: u32, files: &[PathBuf]) -> bool {
        files.iter().all(|path| {
            let mark = Format::of(path).ok().map(|format| self.of(frame, format));
            mark.is_some() && picture::mark(path) == mark && picture::read(path).is_ok()
        })
    }
}

/// Renders the frames that are not there yet. The acceleration structures and what else does not change are made once.
pub fn run(
    sequence: &Sequence,
    options: &Options,
    scene: &Scene,
    foreseen: &Foreseen,
    request: &Request,
    mut seconds: Seconds,
    notes: Notes,
) -> Result<ExitCode> {
    let crop = options.crop_of((scene.film.width, scene.film.height));
    let provenance = Provenance::of(scene).cropped(crop);
    let marks = Marks { sequence, options, scene, foreseen, provenance };
    let (kept, missing): (Vec<_>, Vec<_>) =
        sequence.frames.iter().partition(|(frame, files)| marks.are_on(*frame, files));
    if !kept.is_empty() {
        notes.note(&format!("{} of {} are there already, and kept", kept.len(), frames(sequence.frames.len())));
    }
    let mut there: Vec<FrameStats> = kept.iter().map(|(frame, files)| FrameStats::new(*frame, files, None)).collect();
    let mut end = End::Samples;
    if let Some((first, _)) = missing.first() {
        let mut framed = scene.clone();
        framed.sensor = sequence.sensor(scene, *first);
        let start = Instant::now();
        let mut renderer = backend::open(&framed, request)?;
        (seconds.open, seconds.build) = (start.elapsed().as_secs_f64(), renderer.build_seconds);
        note_renderer(&renderer, notes);
        let mut reporter = Reporter::of_frames(options.quiet, missing.len());
        let mut with_warnings = 0;
        interrupts::render_begins();
        for (frame, files) in &missing {
            framed.sensor = sequence.sensor(scene, *frame);
            files.iter().for_each(|path| files::remove_left_over(path));
            if let Err(error) = renderer.tracer.look(&framed.sensor, &framed.film) {
                end = End::Failed(error);
                break;
            }
            let mut tracer = FailingTracer::new(renderer.tracer.as_mut())?;
            let mut tracer = Cropped::new(&mut tracer, crop.as_ref());
            let nothing = checkpoint::begin(options, scene, notes)?;
            let mut watch = |rendered: &Rendered| reporter.update(&rendered.progress);
            let mut rendered = resume(&mut tracer, nothing, limits(options, scene), &mut watch, &interrupts::STOP);
            let aovs = layers(options, &mut rendered, &mut tracer);
            reporter.finish();
            if matches!(rendered.end, End::Stopped | End::Failed(_)) {
                end = rendered.end;
                break;
            }
            (seconds.render, seconds.device) = (rendered.progress.seconds, rendered.device_seconds);
            reporter.next_frame(seconds.render);
            let mut outcome = Outcome {
                options,
                scene: &framed,
                renderer: &renderer,
                rendered,
                aovs,
                saved: None,
                foreseen,
                warnings: vec![],
                seconds,
            };
            outcome.warnings = ending::warnings(&outcome, files);
            with_warnings += usize::from(!outcome.warnings.is_empty());
            if with_warnings == 1 {
                outcome.warnings.iter().for_each(|warning| notes.warn(format_args!("frame {frame}: {warning}")));
            }
            let start = Instant::now();
            interrupts::hold_off(|| write_frame(&outcome, files, |format| marks.of(*frame, format)))?;
            interrupts::written(
                "interrupted; the frames that are finished stay: the same command goes on with the others",
            );
            outcome.seconds.write = start.elapsed().as_secs_f64();
            if !notes.quiet {
                print(&written(&outcome, files))?;
            }
            let figures = serde_json::to_value(Stats::new(&outcome, files));
            there.push(FrameStats::new(*frame, files, Some(figures.map_err(|e| Error::write(&files[0], e))?)));
            // Only the first frame waited for these.
            (seconds.load, seconds.open, seconds.build) = (0.0, 0.0, 0.0);
        }
        reporter.finish();
        if with_warnings > 1 {
            notes.warn(format_args!("{with_warnings} frames have such warnings; --stats FILE.json lists them"));
        }
    }
    there.sort_by_key(|frame| frame.frame);
    finish(sequence, options, scene, there, end, notes)
}

/// Writes the figures, says how many frames there are, and returns the exit code.
fn finish(
    sequence: &Sequence,
    options: &Options,
    scene: &Scene,
    there: Vec<FrameStats>,
    end: End,
    notes: Notes,
) -> Result<ExitCode> {
    let count = there.len();
    let kept = there.iter().filter(|frame| frame.kept).count();
    let mut text = format!("{}: {} rendered, {kept} kept\n", frames(sequence.frames.len()), count - kept);
    if let Some(path) = &options.stats {
        let figures = SequenceStats {
            version: env!("CARGO_PKG_VERSION"),
            scene: scene.path.display().to_string(),
            turntable: sequence.turn,
            pivot: match sequence.pivot {
                Pivot::Target => "target",
                Pivot::Position => "camera",
            },
            end: match end {
                End::Stopped => "interrupted",
                End::Failed(_) => "failed",
                _ => "frames",
            },
            frames: there,
        };
        interrupts::hold_off(|| save_stats(path, &figures))?;
        text += &format!("{}: the figures of this run\n", path.display());
    }
    if !notes.quiet {
        print(&text)?;
    }
    let again =
        format!("{count} of {} are finished: the same command goes on with the others", frames(sequence.frames.len()));
    match end {
        End::Stopped => {
            notes.note(&format!("interrupted; {again}"));
            Ok(ExitCode::from(INTERRUPTED))
        }
        End::Failed(error) => {
            printing::error(error);
            notes.note(&format!("{again}, also on another --device or --backend"));
            Ok(ExitCode::from(DEVICE_FAILED))
        }
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// What is said of a frame that is written.
fn written(outcome: &Outcome, files: &[PathBuf]) -> String {
    let film = &outcome.rendered.film;
    let names: Vec<_> = files.iter().map(|path: &PathBuf| Path::display(path).to_string()).collect();
    format!(
        "{}: {} x {} pixels, {} samples a pixel, {}; {}",
        names.join(", "),
        film.width,
        film.height,
        samples_of(film, outcome.rendered.progress.spp()),
        duration(outcome.seconds.render),
        error_line(film, outcome.rendered.progress.error, outcome.foreseen.lacks_light)
    )
}

/// A number of frames in words.
fn frames(count: usize) -> String {
    if count == 1 { "1 frame".into() } else { format!("{count} frames") }
}
