//! `--checkpoint` and `--resume`: saving a render while it runs, and going on from what was saved.

use super::options::Options;
use super::outputs::is_exr;
use crate::shared::interrupts;
use crate::shared::outputs::Outputs;
use crate::shared::printing::Notes;
use luminaire::files::{self, Lock};
use luminaire::part::{self, Provenance};
use luminaire::render::Rendered;
use luminaire::scene::Scene;
use luminaire::{Error, Result};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Where a render is saved while it runs.
pub struct Checkpoint<'a> {
    path: &'a Path,
    provenance: Provenance,
    every: Duration,
    due: Instant,
    notes: Notes,
}

impl<'a> Checkpoint<'a> {
    /// The checkpoint of a render that begins now; none without `--checkpoint`.
    pub fn of(options: &'a Options, scene: &Scene, notes: Notes) -> Option<Self> {
        let every = Duration::from_secs_f64(options.checkpoint_every);
        Some(Checkpoint {
            path: options.checkpoint.as_deref()?,
            provenance: Provenance::of(scene).cropped(options.crop_of((scene.film.width, scene.film.height))),
            every,
            due: Instant::now() + every,
            notes,
        })
    }

    /// Saves the render if it is time to. A failure costs nothing but this save, and is a warning.
    pub fn update(&mut self, rendered: &Rendered) {
        if Instant::now() < self.due {
            return;
        }
        if let Err(error) = self.save(rendered) {
            self.notes.warn(format_args!("{error}; the render goes on, and the checkpoint is tried again"));
        }
        // Counted from the end, so that a slow disk does not keep the render from going on.
        self.due = Instant::now() + self.every;
    }

    /// Saves the render. An interrupt meanwhile takes effect afterwards.
    pub fn save(&self, rendered: &Rendered) -> Result<()> {
        interrupts::hold_off(|| part::save(self.path, rendered, &self.provenance))?;
        interrupts::saved();
        Ok(())
    }
}

/// The files of pictures, which are not the checkpoint.
fn pictures(options: &Options) -> Vec<&Path> {
    let paths = options.output.iter().map(PathBuf::as_path);
    #[cfg(feature = "denoise")]
    let paths = paths.chain(options.denoised.as_deref());
    paths.collect()
}

/// Declares the checkpoint as a file to write. A usage error if it is of a wrong kind, or one of the others.
pub fn declare(options: &Options, outputs: &mut Outputs) -> Result<()> {
    let Some(path) = &options.checkpoint else { return Ok(()) };
    if !is_exr(path) {
        return Err(Error::Usage(format!("--checkpoint {}: the name must end in .exr", path.display())));
    }
    outputs.add("--checkpoint", path)
}

/// Takes the locks of the files that no other job may write at the same time: the checkpoint, and parts. They are held until they are dropped.
pub fn lock(options: &Options, notes: Notes) -> Result<Vec<Lock>> {
    let parts = options.output.iter().filter(|path| options.samples.is_some() && is_exr(path));
    let mut locks = Vec::new();
    for path in parts.chain(&options.checkpoint) {
        match Lock::of(path)? {
            Some(lock) => locks.push(lock),
            None => notes.warn(format_args!(
                "{}: its file system has no locks; see to it yourself that no other job writes it",
                path.display()
            )),
        }
    }
    Ok(locks)
}

/// Refuses to begin anew where there is a checkpoint. Only after [`lock`]: another job may just have written it.
pub fn check(options: &Options) -> Result<()> {
    let Some(path) = &options.checkpoint else { return Ok(()) };
    if exists(path)? && !options.resume {
        let advice = if part::is_part(path) {
            "there is a checkpoint already: go on from it with --resume, or give another name, or remove it to start anew"
        } else {
            "there is a file already, which is no checkpoint: give another name"
        };
        return Err(Error::Usage(format!("--checkpoint {}: {advice}", path.display())));
    }
    Ok(())
}

/// What the render begins with: what the checkpoint holds, or nothing.
pub fn begin(options: &Options, scene: &Scene, notes: Notes) -> Result<Rendered> {
    let first = options.samples.as_ref().map_or(0, |samples| samples.start);
    let size = (scene.film.width, scene.film.height);
    let crop = options.crop_of(size);
    let nothing = || {
        let mut rendered = match crop {
            Some(crop) => Rendered::nothing_of_crop(crop, first),
            None => Rendered::nothing(size, first),
        }?;
        if scene.settings.transparent {
            rendered.film.count_misses();
        }
        Ok(rendered)
    };
    let Some(path) = options.checkpoint.as_deref().filter(|_| options.resume) else { return nothing() };
    pictures(options).into_iter().chain([path]).for_each(files::remove_left_over);
    if !exists(path)? {
        notes.note(&format!("{}: no checkpoint yet; starting anew", path.display()));
        return nothing();
    }
    let rendered = part::resume_crop(path, scene, crop)?;
    if rendered.film.first_sample != first {
        return Err(Error::read(
            path,
            format!(
                "it holds samples from number {} on, but those from {first} on are asked for: give the same --samples, or \
                 start anew with another name",
                rendered.film.first_sample
            ),
        ));
    }
    notes.note(&format!(
        "{}: going on from {} samples a pixel, after {:.1} s",
        path.display(),
        (10.0 * rendered.progress.spp()).round() / 10.0,
        rendered.progress.seconds
    ));
    Ok(rendered)
}

/// Whether there is a file. It is an error if that cannot be found out: a checkpoint that is unreachable for a moment must not be overwritten.
fn exists(path: &Path) -> Result<bool> {
    path.try_exists().map_err(|e| Error::read(path, e))
}
