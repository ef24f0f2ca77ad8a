//! `luminaire render`.

use super::checkpoint::{self, Checkpoint};
use super::progress::{Reporter, duration, percent};
use super::stats::{Seconds, Stats};
use super::{RenderOptions, print, tell};
use luminaire::backend::{self, Backend, Renderer, Request};
use luminaire::film::{AovSum, Aovs, Batch, Film, Tile};
use luminaire::part::Provenance;
use luminaire::render::{End, Limits, Rendered, Traced, Tracer, aovs, resume};
use luminaire::scene::{self, FilmSettings, Scene};
use luminaire::{Error, Result, files, part, picture};
use luminaire_measure::heat_map;
use std::ops::Range;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Set by the first Ctrl-C.
static STOP: AtomicBool = AtomicBool::new(false);

/// True while there may be something to write after a Ctrl-C.
static RENDERING: AtomicBool = AtomicBool::new(false);

/// True while files are written, which an exit would leave half done beside their targets.
static WRITING: AtomicBool = AtomicBool::new(false);

/// The exit code of an interrupted run: 128 + SIGINT, as shells have it.
const INTERRUPTED: u8 = 130;

/// The exit code where a device failed while it rendered.
const DEVICE_FAILED: u8 = 3;

/// Loads, renders and writes. Everything that can be checked beforehand is.
pub fn run(options: &RenderOptions) -> Result<ExitCode> {
    let say = |line: &str| {
        if !options.quiet {
            tell(line);
        }
    };
    check_combinations(options)?;
    let outputs = if options.pixel.is_some() { vec![] } else { outputs(options)? };
    listen_for_interrupts(options.quiet)?;

    let mut seconds = Seconds::default();
    let start = Instant::now();
    let mut scene = scene::load(&options.scene)?;
    seconds.load = start.elapsed().as_secs_f64();
    resize(options, &mut scene.film);
    change_estimator(options, &mut scene)?;
    scene.settings.seed = options.seed.unwrap_or(scene.settings.seed);
    scene.settings.exposure = options.exposure.unwrap_or(scene.settings.exposure);
    Film::check_size(scene.film.width, scene.film.height)?;
    let FilmSettings { width, height, .. } = scene.film;
    if let Some([x, y]) = options.pixel.filter(|[x, y]| *x >= width || *y >= height) {
        return Err(Error::Usage(format!("--pixel {x},{y} is not on the film, which has {width} x {height} pixels")));
    }
    scene.warnings.iter().for_each(|warning| say(&format!("warning: {warning}")));

    #[cfg(feature = "shaderc")]
    if options.watch {
        return super::watch::repeat(&STOP, &|| trace(options, &scene, seconds, &outputs, &say));
    }
    trace(options, &scene, seconds, &outputs, &say)
}

/// Opens the device, renders and writes.
fn trace(
    options: &RenderOptions,
    scene: &Scene,
    mut seconds: Seconds,
    outputs: &[PathBuf],
    say: &dyn Fn(&str),
) -> Result<ExitCode> {
    // Before a device is opened, which takes longer than to find a checkpoint that does not fit.
    let begun = if options.pixel.is_some() {
        Rendered::nothing((scene.film.width, scene.film.height), 0)?
    } else {
        checkpoint::begin(options, scene, say)?
    };
    let start = Instant::now();
    let request = Request { backend: options.backend.backend(), device: options.device.clone() };
    let mut opened = backend::open(scene, &request)?;
    seconds.open = start.elapsed().as_secs_f64();
    seconds.build = opened.build_seconds;
    let notice = if opened.notice { "notice: " } else { "" };
    let driver = if opened.driver.is_empty() { String::new() } else { format!(", {}", opened.driver) };
    say(&format!("{notice}{} on {}{driver}: {}", opened.backend, opened.device, opened.why));

    if let (Some(pixel), Some(sample)) = (options.pixel, options.sample) {
        return super::replay::run(scene, &mut opened, pixel, sample);
    }
    let other_limit = options.time.is_some() || options.noise.is_some();
    let scene_spp = (!other_limit).then_some(scene.settings.spp);
    let spp = options.samples.as_ref().map(|samples| samples.end).or(options.spp).or(scene_spp);
    let limits = Limits { spp, seconds: options.time, noise: options.noise };
    let mut checkpoint = Checkpoint::of(options, scene);
    let mut reporter = Reporter::new(options.quiet);
    RENDERING.store(true, Ordering::SeqCst);
    let mut watch = |rendered: &Rendered| {
        reporter.update(&rendered.progress);
        if let Some(checkpoint) = &mut checkpoint {
            checkpoint.update(rendered);
        }
    };
    let mut tracer = Losing::perhaps(opened.tracer.as_mut())?;
    let mut rendered = resume(&mut tracer, begun, limits, &mut watch, &STOP);
    reporter.finish();
    if let (Some(wanted), least) = (spp, rendered.film.first_sample + rendered.film.least_samples())
        && least > wanted
    {
        say(&format!("the checkpoint already held more samples than were asked for: {least} a pixel"));
    }
    // First of all: whatever fails after it, nothing is lost.
    WRITING.store(true, Ordering::SeqCst);
    let saved = checkpoint.filter(|_| rendered.progress.samples > 0).map(|checkpoint| checkpoint.save(&rendered));
    WRITING.store(false, Ordering::SeqCst);
    // A device that has failed would only fail again, and who interrupts does not want to wait.
    let mut layers = None;
    if wants_aovs(options) && !matches!(rendered.end, End::Failed(_) | End::Stopped) {
        let size = (rendered.film.width, rendered.film.height);
        match aovs(&mut tracer, size, rendered.film.most_samples()) {
            Ok(found) => layers = Some(found),
            Err(error) => rendered.end = End::Failed(error),
        }
    }
    seconds.render = rendered.progress.seconds;
    seconds.device = rendered.device_seconds;
    finish(options, scene, &opened, rendered, layers, saved, seconds, outputs, say)
}

/// A tracer whose device is lost after some batches: with LUMINAIRE_LOSE_DEVICE_AFTER, so that scripts can try what happens then.
struct Losing<'a> {
    tracer: &'a mut dyn Tracer,
    batches_left: Option<u64>,
}

impl<'a> Losing<'a> {
    fn perhaps(tracer: &'a mut dyn Tracer) -> Result<Self> {
        const NAME: &str = "LUMINAIRE_LOSE_DEVICE_AFTER";
        let batches_left = match std::env::var(NAME) {
            Ok(text) => {
                Some(text.parse().map_err(|_| Error::Usage(format!("{NAME}={text}: expected a number of batches")))?)
            }
            Err(_) => None,
        };
        Ok(Losing { tracer, batches_left })
    }
}

impl Tracer for Losing<'_> {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        match &mut self.batches_left {
            Some(0) => Err(Error::Vulkan {
                call: "vkQueueSubmit",
                device: "the device".into(),
                reason: "the device is lost (as LUMINAIRE_LOSE_DEVICE_AFTER asks)".into(),
            }),
            Some(left) => {
                *left -= 1;
                self.tracer.trace(batch)
            }
            None => self.tracer.trace(batch),
        }
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        self.tracer.aovs(tile, samples)
    }

    fn max_sums(&self) -> usize {
        self.tracer.max_sums()
    }

    fn batch_seconds(&self) -> f64 {
        self.tracer.batch_seconds()
    }
}

/// Writes what there is, and tells how it ended.
#[expect(clippy::too_many_arguments, reason = "each is one of the things that a render leaves")]
fn finish(
    options: &RenderOptions,
    scene: &Scene,
    opened: &Renderer,
    rendered: Rendered,
    aovs: Option<Aovs>,
    saved: Option<Result<()>>,
    mut seconds: Seconds,
    outputs: &[PathBuf],
    say: &dyn Fn(&str),
) -> Result<ExitCode> {
    if rendered.dropped > 0 {
        let replay = rendered.dropped_samples.first().map_or(
            "; the driver ended the kernel before its time: use another driver, or --backend cpu".into(),
            |first| {
                let (x, y) = (first.pixel % scene.film.width, first.pixel / scene.film.width);
                format!("; with the same options, --pixel {x},{y} --sample {} replays one", first.sample)
            },
        );
        say(&format!("warning: {} samples that were not finite, or lost, are left out{replay}", rendered.dropped));
    }
    WRITING.store(true, Ordering::SeqCst);
    let kept = matches!(saved, Some(Ok(())));
    let unfinished_part = options.samples.is_some() && !matches!(rendered.end, End::Samples);
    // Whoever finds a part may take it to be whole, so that one that is not stays in the checkpoint, if there is one.
    let written = if rendered.progress.samples == 0 || unfinished_part && saved.is_some() { &[] } else { outputs };
    let black = rendered.film.samples.iter().filter(|samples| **samples == 0).count();
    if black > 0 && !written.is_empty() {
        say(&format!("warning: {black} pixels have no sample and are black: the render ended during the first pass"));
    }
    let done = write(options, scene, opened, &rendered, aovs.as_ref(), &mut seconds, written);
    WRITING.store(false, Ordering::SeqCst);
    if done.is_err() && kept {
        say("the samples are in the checkpoint; the same command with --resume writes the pictures again");
    }
    done?;
    saved.transpose()?;
    if !options.quiet {
        print(&summary(options, &rendered, seconds, written))?;
    }
    match rendered.end {
        End::Samples | End::Time | End::Noise => Ok(ExitCode::SUCCESS),
        End::Stopped => {
            say(if rendered.progress.samples == 0 {
                "interrupted before the first sample; no picture is written"
            } else if written.is_empty() {
                "interrupted; the part is not finished and not written"
            } else {
                "interrupted; the picture holds what was done until then"
            });
            if kept {
                say("the same command with --resume goes on from the checkpoint");
            }
            Ok(ExitCode::from(INTERRUPTED))
        }
        End::Failed(error) => {
            tell(&format!("error: {error}"));
            if !written.is_empty() {
                say("the render failed; the picture holds what was done until then");
            }
            if kept {
                say(
                    "the same command with --resume goes on from the checkpoint, also on another --device or --backend",
                );
            }
            Ok(ExitCode::from(DEVICE_FAILED))
        }
    }
}

/// Whether somebody asks for what the camera sees first.
fn wants_aovs(options: &RenderOptions) -> bool {
    #[cfg(feature = "denoise")]
    if options.denoised.is_some() {
        return true;
    }
    options.aov
}

/// Writes the pictures and the figures.
fn write(
    options: &RenderOptions,
    scene: &Scene,
    opened: &Renderer,
    rendered: &Rendered,
    aovs: Option<&Aovs>,
    seconds: &mut Seconds,
    written: &[PathBuf],
) -> Result<()> {
    let start = Instant::now();
    let provenance = options.samples.as_ref().map(|_| Provenance::of(scene));
    let save = |path: &PathBuf| match (&provenance, aovs, picture::Format::of(path)?) {
        (Some(provenance), _, picture::Format::Exr) => part::save(path, rendered, provenance),
        (_, Some(aovs), picture::Format::Exr) if options.aov => rendered.film.save_with_aovs(path, aovs),
        _ => rendered.film.save(path, scene.settings.exposure),
    };
    // Every file is tried: one that cannot be written must not cost the others.
    let saved: Vec<_> = written.iter().map(save).collect();
    saved.into_iter().collect::<Result<()>>()?;
    if let (Some(path), Some(errors)) = (&options.error_map, rendered.film.error_map()) {
        let FilmSettings { width, height, .. } = scene.film;
        let [low, high] = heat_map::RELATIVE_ERRORS;
        picture::save_png(path, &heat_map::heat_map(width, height, &errors.relative, low, high))?;
    }
    #[cfg(feature = "denoise")]
    if let (Some(path), Some(aovs)) = (&options.denoised, aovs) {
        let FilmSettings { width, height, .. } = scene.film;
        let picture = luminaire::denoise::denoise(&rendered.film, aovs)?;
        picture::save_linear(path, width, height, &picture, scene.settings.exposure)?;
    }
    seconds.write = start.elapsed().as_secs_f64();
    if let Some(path) = &options.stats {
        let stats = Stats::new(scene, opened, rendered, *seconds, written);
        let text = serde_json::to_string_pretty(&stats).map_err(|e| Error::write(path, e))?;
        files::save_text(path, &(text + "\n"))?;
    }
    Ok(())
}

/// Where the files are, how long it took, and how fast it was.
fn summary(options: &RenderOptions, rendered: &Rendered, seconds: Seconds, written: &[PathBuf]) -> String {
    let progress = &rendered.progress;
    let film = &rendered.film;
    let (least, most) = (film.least_samples(), film.most_samples());
    let spp = if least == most { least.to_string() } else { format!("{least} to {most}") };
    let ended = match rendered.end {
        End::Time => ", ended by --time",
        End::Noise => ", ended by --noise",
        End::Samples | End::Stopped | End::Failed(_) => "",
    };
    let mut text = String::new();
    for path in written {
        text += &format!("{}: {} x {} pixels, {spp} samples a pixel{ended}\n", path.display(), film.width, film.height);
    }
    if let Some(path) = options.error_map.as_ref().filter(|_| progress.error.is_some()) {
        text +=
            &format!("{}: estimated relative error of every pixel, 0.1 % (black) to 100 % (white)\n", path.display());
    }
    if let Some(path) = &options.stats {
        text += &format!("{}: the figures of this run\n", path.display());
    }
    if let Some(error) = progress.error {
        text += &format!("estimated error {} (RMSE {:.3e})", percent(error.relative()), error.rmse);
        text += &match error.fireflies {
            0 => "\n".into(),
            1 => format!(
                ", without 1 pixel that is a firefly or a very small lamp (with it {})\n",
                percent(error.relative_with_fireflies())
            ),
            n => format!(
                ", without {n} pixels that are fireflies or very small lamps (with them {})\n",
                percent(error.relative_with_fireflies())
            ),
        };
    }
    if let (Some(limit), false) = (progress.limits.noise, matches!(rendered.end, End::Noise)) {
        text += &format!("--noise {limit} was not reached\n");
    }
    text += &format!(
        "load {}, build {}, render {}; {:.2} Mrays/s, {:.3} million samples/s\n",
        duration(seconds.load),
        duration(seconds.build),
        duration(seconds.render),
        progress.mrays_per_second(),
        progress.samples as f64 / progress.seconds.max(1e-9) * 1e-6
    );
    text
}

/// Refuses options that mean nothing together.
fn check_combinations(options: &RenderOptions) -> Result<()> {
    if options.device.is_some() && options.backend.backend() == Some(Backend::Cpu) {
        return Err(Error::Usage(
            "--device chooses a Vulkan device, but --backend cpu uses none: leave one of them out".into(),
        ));
    }
    checkpoint::check(options)?;
    options.estimator.check()
}

/// The pictures to write, all of them possible.
fn outputs(options: &RenderOptions) -> Result<Vec<PathBuf>> {
    let mut outputs = options.output.clone();
    if outputs.is_empty() {
        let stem = options.scene.file_stem().ok_or_else(|| Error::read(&options.scene, "it is not a file"))?;
        let mut name = stem.to_owned();
        name.push(".png");
        outputs.push(name.into());
    }
    for (i, path) in outputs.iter().enumerate() {
        if outputs[..i].contains(path) {
            return Err(Error::Usage(format!("-o {} is given twice", path.display())));
        }
        picture::check_output(path)?;
    }
    #[cfg(feature = "denoise")]
    if let Some(path) = &options.denoised {
        if outputs.contains(path) {
            return Err(Error::Usage(format!("--denoised {}: the picture itself is written there", path.display())));
        }
        picture::check_output(path)?;
    }
    if let Some(path) = &options.error_map {
        if outputs.contains(path) {
            return Err(Error::Usage(format!("--error-map {}: the picture itself is written there", path.display())));
        }
        if options.spp == Some(1) {
            return Err(Error::Usage(
                "--error-map wants at least --spp 2: one sample tells nothing of its error".into(),
            ));
        }
        if picture::Format::of(path)? != picture::Format::Png {
            return Err(Error::Usage(format!("--error-map {}: the name must end in .png", path.display())));
        }
        files::check_writable(path)?;
    }
    if let Some(path) = &options.stats {
        if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("json")) {
            return Err(Error::Usage(format!("--stats {}: the name must end in .json", path.display())));
        }
        files::check_writable(path)?;
    }
    Ok(outputs)
}

/// Puts the options in the place of the scene's film size.
fn resize(options: &RenderOptions, film: &mut FilmSettings) {
    let FilmSettings { width, height, .. } = *film;
    let scaled = |given: u32, this: u32, other: u32| {
        (f64::from(given) * f64::from(this) / f64::from(other)).round().clamp(1.0, 65536.0) as u32
    };
    (film.width, film.height) = match (options.width, options.height) {
        (None, None) => (width, height),
        (Some(w), None) => (w, scaled(w, height, width)),
        (None, Some(h)) => (scaled(h, width, height), h),
        (Some(w), Some(h)) => (w, h),
    };
}

/// Puts the options in the place of the scene's estimator and sampler.
fn change_estimator(options: &RenderOptions, scene: &mut Scene) -> Result<()> {
    // Whether the picture can only be black depends on the estimator.
    let dark = scene.dark_because();
    scene.warnings.extend(options.estimator.apply(&mut scene.integrator)?);
    scene.settings.sampler = options.estimator.sampler.unwrap_or(scene.settings.sampler);
    let now = scene.dark_because();
    if now != dark {
        scene.warnings.retain(|warning| Some(warning) != dark.as_ref());
        scene.warnings.extend(now);
    }
    Ok(())
}

/// Ctrl-C and SIGTERM: the first ends the render at the next batch, a second (or one with nothing to write yet) the process.
fn listen_for_interrupts(quiet: bool) -> Result<()> {
    ctrlc::set_handler(move || {
        if WRITING.load(Ordering::SeqCst) {
            return;
        }
        let at_once = !RENDERING.load(Ordering::SeqCst) || STOP.swap(true, Ordering::SeqCst);
        if !quiet {
            tell(if at_once {
                "interrupted; nothing is written"
            } else {
                "interrupted: finishing the batch and writing what there is; once more ends at once"
            });
        }
        if at_once {
            exit_now();
        }
    })
    .map_err(|e| Error::Usage(format!("cannot listen for Ctrl-C: {e}")))
}

/// Ends the process without the clean-up of libraries: a driver that is just being loaded does not survive that.
fn exit_now() -> ! {
    #[cfg(unix)]
    signal_hook::low_level::exit(INTERRUPTED.into());
    #[cfg(not(unix))]
    std::process::exit(INTERRUPTED.into());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Args, Command};
    use clap::Parser;

    fn options(words: &[&str]) -> RenderOptions {
        match Args::try_parse_from(["luminaire", "render", "a/b.scene.toml"].iter().chain(words)).unwrap().command {
            Command::Render(options) => options,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn one_side_keeps_the_aspect_ratio() {
        let size = |words: &[&str]| {
            let mut film = FilmSettings { width: 300, height: 200, filter: scene::Filter::Box, filter_radius: 0.5 };
            resize(&options(words), &mut film);
            (film.width, film.height)
        };
        assert_eq!(size(&[]), (300, 200));
        assert_eq!(size(&["--width", "150"]), (150, 100));
        assert_eq!(size(&["--height", "1"]), (2, 1));
        assert_eq!(size(&["--width", "1"]), (1, 1));
        assert_eq!(size(&["--width", "7", "--height", "9"]), (7, 9));
    }

    #[test]
    fn the_default_output_is_named_after_the_scene() {
        assert_eq!(outputs(&options(&[])).unwrap(), [PathBuf::from("b.scene.png")]);
    }
}
