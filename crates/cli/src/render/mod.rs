//! `luminaire render`.

mod checkpoint;
mod ending;
mod failing_tracer;
mod frame_name;
mod options;
mod outcome;
mod outputs;
mod progress;
mod replay;
mod seconds;
mod sequence;
mod stats;
mod summary;
mod tracing;
mod turn;
#[cfg(feature = "shaderc")]
mod watch;

pub use self::options::Options;

use self::checkpoint::Checkpoint;
use self::failing_tracer::FailingTracer;
use self::frame_name::FrameName;
use self::options::LARGEST_SIDE;
use self::outcome::Outcome;
use self::progress::Reporter;
use self::seconds::Seconds;
use self::sequence::Sequence;
use self::tracing::{layers, limits, note_renderer};
use crate::shared::backend_name;
use crate::shared::film_size::FilmSize;
use crate::shared::foreseen::{Foreseen, foresee_by};
use crate::shared::interrupts;
use crate::shared::outputs::Outputs;
use crate::shared::printing::Notes;
use crate::shared::tone_name::ToneName;
use crate::shared::values::Pixel;
use luminaire::backend::{self, Request};
use luminaire::film::Demand;
use luminaire::render::{Cropped, Rendered, resume};
use luminaire::scene::{Exposure, FilmSettings, Scene};
use luminaire::{Error, Result};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Loads, renders and writes. Everything that can be checked beforehand is.
pub fn run(options: &Options) -> Result<ExitCode> {
    let notes = Notes { quiet: options.quiet };
    let request = backend_name::request(options.backend, options.device.as_deref())?;
    outputs::check_layers(options)?;
    options.estimator.check()?;
    let mut outputs = Outputs::default();
    let mut pictures = vec![];
    let mut sequence = None;
    let mut locks = vec![];
    // Before locks are taken, which an interrupt would leave.
    interrupts::listen(notes)?;
    if options.pixel.is_none() {
        if let Some(frames) = options.turntable {
            sequence::check(options, frames)?;
            sequence = Some(Sequence::of(options, frames, &mut outputs)?);
        } else {
            pictures = outputs::pictures(options, &mut outputs)?;
            for path in pictures.iter().filter(|path| FrameName::is_one(path)) {
                notes.note(&format!(
                    "-o {}: one picture has no number, so this is its name; --turntable N renders several",
                    path.display()
                ));
            }
        }
        outputs::declare_others(options, &mut outputs)?;
        checkpoint::declare(options, &mut outputs)?;
        locks = checkpoint::lock(options, notes)?;
        checkpoint::check(options)?;
    }

    let mut seconds = Seconds::default();
    let start = Instant::now();
    let mut scene = match options.transparent {
        true => options.of_scene.load_cut_out(&options.scene),
        false => options.of_scene.load(&options.scene),
    }?;
    options.camera.choose(&mut scene, notes)?;
    seconds.load = start.elapsed().as_secs_f64();
    outputs.check(scene.files.iter().map(|path| ("a file of the scene", &**path)))?;
    let own_film = scene.film;
    change(&mut scene, options)?;
    let mut tracer = None;
    if let Some(sequence) = &mut sequence {
        sequence.decide(options.pivot, &mut scene, &mut tracer);
    }
    let foreseen = foresee_by(&mut scene, &own_film, tracer);
    scene.notes.iter().for_each(|note| notes.note(note));
    scene.warnings.iter().for_each(|warning| notes.warn(warning));
    foreseen.found.iter().for_each(|found| notes.note(found));

    if let Some(sequence) = &sequence {
        return sequence::run(sequence, options, &scene, &foreseen, &request, seconds, notes);
    }
    let render = || trace(options, &scene, &foreseen, &request, seconds, &pictures, notes);
    #[cfg(feature = "shaderc")]
    if options.watch {
        return watch::repeat(&interrupts::STOP, &render);
    }
    let code = render();
    drop(locks);
    code
}

/// Puts the options in the place of what the scene says. A usage error if they do not fit it.
fn change(scene: &mut Scene, options: &Options) -> Result<()> {
    FilmSize { width: options.width, height: options.height, largest: LARGEST_SIDE }.apply(&mut scene.film);
    options.estimator.apply(scene)?;
    scene.settings.seed = options.seed.unwrap_or(scene.settings.seed);
    scene.settings.exposure = options.exposure.unwrap_or(scene.settings.exposure);
    scene.settings.tone = options.tone.map_or(scene.settings.tone, ToneName::tone);
    if options.pixel.is_some() {
        // Nothing is shown.
        scene.settings.exposure = Exposure::Stops(0.0);
    }
    scene.settings.transparent = options.transparent;
    let FilmSettings { width, height, .. } = scene.film;
    // Every pixel of the whole picture has a number, also where only a part is rendered.
    if let Err(error @ Error::Usage(_)) = (Demand { width, height, ..Demand::default() }).check() {
        return Err(error);
    }
    if let Some(crop) = options.crop_of((width, height)).filter(|crop| !crop.is_inside()) {
        return Err(Error::Usage(format!(
            "--crop {crop} reaches beyond the picture, which has {width} x {height} pixels: X + W may be {width} at most, and Y + H {height}"
        )));
    }
    outputs::demand(options, &scene.film).check()?;
    outputs::check_error_map(options, limits(options, scene).spp, " (the scene says `spp = 1`)")?;
    match options.pixel {
        Some(Pixel { x, y }) if x >= width || y >= height => {
            Err(Error::Usage(format!("--pixel {x},{y} is not on the film, which has {width} x {height} pixels")))
        }
        _ => Ok(()),
    }
}

/// Opens the device, renders and writes.
fn trace(
    options: &Options,
    scene: &Scene,
    foreseen: &Foreseen,
    request: &Request,
    mut seconds: Seconds,
    pictures: &[PathBuf],
    notes: Notes,
) -> Result<ExitCode> {
    // Before a device is opened: that takes longer, and a checkpoint that does not fit ends the run anyway.
    let begun = if options.pixel.is_some() {
        Rendered::nothing((scene.film.width, scene.film.height), 0)?
    } else {
        checkpoint::begin(options, scene, notes)?
    };
    let start = Instant::now();
    let mut renderer = backend::open(scene, request)?;
    seconds.open = start.elapsed().as_secs_f64();
    seconds.build = renderer.build_seconds;
    note_renderer(&renderer, notes);
    if let (Some(pixel), Some(sample)) = (options.pixel, options.sample) {
        return replay::run(scene, &mut renderer, pixel, sample);
    }

    let limits = limits(options, scene);
    let mut checkpoint = Checkpoint::of(options, scene, notes);
    let mut reporter = Reporter::new(options.quiet);
    interrupts::render_begins();
    let mut watch = |rendered: &Rendered| {
        reporter.update(&rendered.progress);
        if let Some(checkpoint) = &mut checkpoint {
            checkpoint.update(rendered);
        }
    };
    let mut tracer = FailingTracer::new(renderer.tracer.as_mut())?;
    let crop = options.crop_of((scene.film.width, scene.film.height));
    let mut tracer = Cropped::new(&mut tracer, crop.as_ref());
    let mut rendered = resume(&mut tracer, begun, limits, &mut watch, &interrupts::STOP);
    reporter.finish();
    let (first, held) = (f64::from(rendered.film.first_sample), rendered.progress.spp());
    if let Some(wanted) = limits.spp.map(f64::from)
        && first + f64::from(rendered.film.least_samples()) > wanted
    {
        let held = summary::samples_of(&rendered.film, first + held);
        notes.note(&format!("the checkpoint already held more samples than were asked for: {held} a pixel"));
    }
    // The checkpoint comes first: whatever fails afterwards, the samples are saved.
    let checkpoint = checkpoint.filter(|_| rendered.progress.samples > 0);
    let saved = checkpoint.map(|checkpoint| checkpoint.save(&rendered));
    // Not after a failure, for the device would fail again, nor after an interrupt, which should end the run soon.
    let layers = layers(options, &mut rendered, &mut tracer);
    seconds.render = rendered.progress.seconds;
    seconds.device = rendered.device_seconds;
    let outcome = Outcome {
        options,
        scene,
        renderer: &renderer,
        rendered,
        aovs: layers,
        saved,
        foreseen,
        warnings: vec![],
        seconds,
    };
    ending::finish(outcome, pictures, notes)
}
