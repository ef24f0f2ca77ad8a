//! A part of a render on disk, from which it can go on, or which can be added to others: an OpenEXR file.
//!
//! The file shows the picture so far (`R`, `G`, `B`, and `error.R`, `error.G`, `error.B`), and beside it, to the last bit, holds what the
//! film holds: for every independent part `p` of a pixel's samples and every channel `c` the `f64` sum of the radiance, as its two halves
//! `sum.p.c.high` and `sum.p.c.low`; the number of samples, `samples`; and, if there are any, the number of samples that were not finite,
//! `dropped.p`. Two texts in the head, both JSON, say what was rendered ([`Provenance`]) and what else was counted.

use crate::film::{Film, SampleId};
use crate::picture::{self, Attribute, Values};
use crate::render::{DROPPED_NAMED, LEAST_FOR_NOISE, Rendered, is_a_pass};
use crate::sampling::PARTS;
use crate::scene::Scene;
use crate::{Error, Result};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Names of the texts in the head.
const PROVENANCE: &str = "luminaire.provenance";
const COUNTS: &str = "luminaire.counts";

/// The picture, its error, the number of samples, the sums in halves, what is left out.
const MOST_CHANNELS: usize = 3 + 3 + 1 + 6 * PARTS as usize + PARTS as usize;

const HALVES: [&str; 2] = ["high", "low"];
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// What was rendered: everything on which the samples depend. Two files of the same provenance hold samples of the same picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The program's version.
    pub version: String,
    /// The scene file as it was named. Another name for the same scene makes no difference.
    pub scene: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Where the random numbers come from.
    pub sampler: String,
    /// The estimator with its parameters.
    pub integrator: String,
    /// Digests of the rest of the scene, by name.
    pub digests: BTreeMap<String, String>,
    /// Exposure of a PNG in stops. Another one makes no difference.
    pub exposure: f32,
}

impl Provenance {
    /// That of a render of `scene`.
    pub fn of(scene: &Scene) -> Self {
        let digests = [
            ("geometry", geometry(scene)),
            (
                "materials",
                digest(|hash| {
                    write(hash, &scene.materials);
                    scene.textures.iter().for_each(|texture| {
                        write(hash, &(texture.width, texture.height, texture.clamp));
                        hash.update(bytemuck::cast_slice(&texture.texels));
                    });
                }),
            ),
            (
                "luminaires",
                digest(|hash| {
                    write(hash, &scene.luminaires);
                    if let Some(environment) = &scene.environment {
                        write(hash, &(environment.radiance, environment.rotation));
                        if let Some(image) = &environment.image {
                            write(hash, &(image.width, image.height));
                            image.texels.iter().for_each(|texel| floats(hash, &texel.to_array()));
                        }
                    }
                }),
            ),
            ("camera", digest(|hash| write(hash, &scene.sensor))),
            ("pixel filter", digest(|hash| write(hash, &(scene.film.filter, scene.film.filter_radius)))),
        ];
        Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: scene.path.display().to_string(),
            width: scene.film.width,
            height: scene.film.height,
            seed: scene.settings.seed,
            sampler: format!("{:?}", scene.settings.sampler),
            integrator: format!("{:?}", scene.integrator),
            digests: digests.map(|(name, value)| (name.to_owned(), value)).into(),
            exposure: scene.settings.exposure,
        }
    }

    /// In what a render differs from another, of which this is the provenance; empty if their samples belong to one picture.
    pub fn differences(&self, other: &Provenance) -> Vec<String> {
        let mut found = Vec::new();
        let mut compare = |what: &str, own: &dyn std::fmt::Display, others: &dyn std::fmt::Display| {
            let (own, others) = (own.to_string(), others.to_string());
            if own != others {
                found.push(format!("{what} ({own} there, {others} here)"));
            }
        };
        compare("version", &self.version, &other.version);
        let size = |p: &Provenance| format!("{} x {}", p.width, p.height);
        compare("size", &size(self), &size(other));
        compare("seed", &self.seed, &other.seed);
        compare("sampler", &self.sampler, &other.sampler);
        compare("integrator", &self.integrator, &other.integrator);
        let names = self.digests.keys().chain(other.digests.keys().filter(|name| !self.digests.contains_key(*name)));
        found.extend(names.filter(|name| self.digests.get(*name) != other.digests.get(*name)).cloned());
        found
    }
}

/// The digest of whatever `feed` feeds, as hexadecimal digits.
fn digest(feed: impl FnOnce(&mut Sha256)) -> String {
    let mut hash = Sha256::new();
    feed(&mut hash);
    hash.finalize().iter().take(16).map(|byte| format!("{byte:02x}")).collect()
}

/// Feeds a value as Rust shows it, with every digit of its numbers.
fn write(hash: &mut Sha256, value: &impl Debug) {
    hash.update(format!("{value:?}\n"));
}

fn floats(hash: &mut Sha256, values: &[f32]) {
    values.iter().for_each(|value| hash.update(value.to_le_bytes()));
}

fn geometry(scene: &Scene) -> String {
    digest(|hash| {
        for mesh in &scene.meshes {
            write(hash, &(mesh.positions.len(), mesh.normals.len(), mesh.uvs.len(), mesh.triangles.len()));
            mesh.positions.iter().chain(&mesh.normals).for_each(|v| floats(hash, &v.to_array()));
            mesh.uvs.iter().for_each(|v| floats(hash, &v.to_array()));
            for triangle in &mesh.triangles {
                triangle.vertices.iter().chain([&triangle.material]).for_each(|i| hash.update(i.to_le_bytes()));
            }
        }
        for object in &scene.objects {
            write(hash, &(object.mesh, object.object_to_world, object.material));
        }
    })
}

/// What is counted besides the samples of the pixels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Counts {
    /// Number of every pixel's first sample.
    first_sample: u32,
    /// Number after that of the last sample; none where a pass was not finished, so that some pixels have more than others.
    end_sample: Option<u32>,
    /// Where the samples were to end, if that was said.
    wanted_end: Option<u32>,
    rays: u64,
    shadow_rays: u64,
    dropped: u64,
    /// Pixel and sample of some that were not finite.
    dropped_samples: Vec<[u32; 2]>,
    seconds: f64,
    device_seconds: f64,
    noise_aim: u32,
}

/// Writes what was rendered so far.
///
/// # Errors
/// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub fn save(path: &Path, rendered: &Rendered, provenance: &Provenance) -> Result<()> {
    let Rendered { film, progress, .. } = rendered;
    let (least, most) = (film.least_samples(), film.most_samples());
    let counts = Counts {
        first_sample: film.first_sample,
        end_sample: (least == most).then_some(film.first_sample + most),
        wanted_end: progress.limits.spp,
        rays: progress.rays,
        shadow_rays: progress.shadow_rays,
        dropped: rendered.dropped,
        dropped_samples: rendered.dropped_samples.iter().map(|id| [id.pixel, id.sample]).collect(),
        seconds: progress.seconds,
        device_seconds: rendered.device_seconds,
        noise_aim: rendered.noise_aim,
    };
    let mut channels = vec![("samples".to_owned(), Values::Integer(film.samples.clone()))];
    for part in 0..PARTS as usize {
        for (c, channel) in CHANNELS.into_iter().enumerate() {
            for (half, shift) in HALVES.into_iter().zip([32, 0]) {
                let bits = film.sums.iter().map(|sums| (sums[part][c].to_bits() >> shift) as u32).collect();
                channels.push((format!("sum.{part}.{channel}.{half}"), Values::Integer(bits)));
            }
        }
        if !film.dropped.is_empty() {
            let dropped = |pixel| film.dropped.get(&(pixel, part)).copied().unwrap_or(0);
            channels.push((format!("dropped.{part}"), Values::Integer((0..film.pixels()).map(dropped).collect())));
        }
    }
    let json = |value: serde_json::Result<String>| value.map_err(|e| Error::write(path, e));
    let (provenance, counts) = (json(serde_json::to_string(provenance))?, json(serde_json::to_string(&counts))?);
    let about = vec![(PROVENANCE, Attribute::Text(&provenance)), (COUNTS, Attribute::Text(&counts))];
    film.save_exr(path, channels, about)
}

/// Reads the head of a file.
fn about(path: &Path) -> Result<(Provenance, Counts)> {
    // A name that leads to something endless would never be read to its end.
    if std::fs::metadata(path).is_ok_and(|about| !about.is_file()) {
        return Err(Error::read(path, "it is not a file"));
    }
    let texts = picture::read_texts(path).map_err(|e| Error::read(path, e))?;
    let text = |name: &str| {
        texts.get(name).ok_or_else(|| {
            Error::read(
                path,
                "it is a picture, but not a part of a render: `luminaire render` writes those with --samples or \
                 --checkpoint",
            )
        })
    };
    let damaged = |e: serde_json::Error| Error::read(path, format!("it is damaged ({e})"));
    let provenance = serde_json::from_str(text(PROVENANCE)?).map_err(damaged)?;
    Ok((provenance, serde_json::from_str(text(COUNTS)?).map_err(damaged)?))
}

/// Reads what [`save`] wrote.
///
/// # Errors
/// [`Error::Read`] if there is no such file, or it is something else, or damaged; [`Error::Limit`] if the film does not fit into memory.
pub fn read(path: &Path) -> Result<(Rendered, Provenance)> {
    let (provenance, counts) = about(path)?;
    let damaged = |what: &str| Error::read(path, format!("it is damaged: {what}"));
    Film::check_size(provenance.width, provenance.height)?;
    let size = (provenance.width, provenance.height);
    let mut channels = picture::read_channels(path, MOST_CHANNELS, size).map_err(|e| Error::read(path, e))?;
    let mut rendered = Rendered::nothing(size, counts.first_sample)?;
    let film = &mut rendered.film;
    let mut take = |name: &str| channels.take_integers(name);
    film.samples = take("samples").ok_or_else(|| damaged("there is no channel `samples`"))?;
    let most = film.most_samples();
    let unfinished = film.samples.iter().position(|n| *n < most).unwrap_or(film.pixels());
    let least = film.least_samples();
    // A pass goes over the film from the top, and all pixels had equally many samples before it.
    let in_order = film.samples[..unfinished].iter().all(|n| *n == most)
        && film.samples[unfinished..].iter().all(|n| *n == least)
        && counts.end_sample == (least == most).then_some(most.wrapping_add(counts.first_sample));
    let end = counts.first_sample.checked_add(most);
    if !in_order || end.is_none_or(|end| !is_a_pass(counts.first_sample + least..end)) {
        return Err(damaged("its numbers of samples are impossible"));
    }
    for part in 0..PARTS as usize {
        for (c, channel) in CHANNELS.into_iter().enumerate() {
            for (half, shift) in HALVES.into_iter().zip([32, 0]) {
                let name = format!("sum.{part}.{channel}.{half}");
                let bits = take(&name).ok_or_else(|| damaged(&format!("there is no channel `{name}`")))?;
                for (sums, bits) in film.sums.iter_mut().zip(bits) {
                    sums[part][c] = f64::from_bits(sums[part][c].to_bits() | u64::from(bits) << shift);
                }
            }
        }
        for (pixel, count) in take(&format!("dropped.{part}")).into_iter().flatten().enumerate() {
            if count > film.part_samples(pixel)[part] {
                return Err(damaged("more samples are left out than there are"));
            }
            if count > 0 {
                film.dropped.insert((pixel, part), count);
            }
        }
    }
    if !film.sums.as_flattened().as_flattened().iter().all(|sum| sum.is_finite()) {
        return Err(damaged("a sum is not finite"));
    }
    if !(counts.seconds >= 0.0 && counts.device_seconds >= 0.0) {
        return Err(damaged("its times are impossible"));
    }
    let id = |&[pixel, sample]: &[u32; 2]| SampleId { pixel, sample };
    rendered.dropped = counts.dropped;
    rendered.dropped_samples = counts.dropped_samples.iter().take(DROPPED_NAMED).map(id).collect();
    rendered.device_seconds = counts.device_seconds;
    // Where the limit of the noise is looked at next is at most twice as far as there are samples.
    rendered.noise_aim = counts.noise_aim.clamp(LEAST_FOR_NOISE, most.saturating_mul(2).max(LEAST_FOR_NOISE));
    let progress = &mut rendered.progress;
    progress.samples = rendered.film.samples.iter().map(|n| u64::from(*n)).sum();
    (progress.rays, progress.shadow_rays, progress.seconds) = (counts.rays, counts.shadow_rays, counts.seconds);
    Ok((rendered, provenance))
}

/// Reads a file to go on with the render of `scene` from it.
///
/// # Errors
/// As [`read`], and [`Error::Read`] if it is of another render, with all differences.
pub fn resume(path: &Path, scene: &Scene) -> Result<Rendered> {
    let (there, _) = about(path)?;
    let differences = there.differences(&Provenance::of(scene));
    if !differences.is_empty() {
        return Err(Error::read(
            path,
            format!(
                "it is of another render, which differs in {}: use what that render used, or start anew with another name",
                differences.join(", ")
            ),
        ));
    }
    Ok(read(path)?.0)
}

/// Joins parts, given in any order, that together hold every sample from number 0 on once. Only one of them is in memory at a time.
///
/// # Errors
/// As [`read`]; [`Error::Usage`] if samples are missing or doubled, or parts are of different renders.
pub fn merge(paths: &[PathBuf]) -> Result<(Rendered, Provenance)> {
    let mut parts: Vec<(Range<u32>, &PathBuf)> = Vec::new();
    let mut first: Option<(Provenance, &PathBuf)> = None;
    for path in paths {
        let (provenance, counts) = about(path)?;
        let whole = |end: &u32| *end > counts.first_sample && counts.wanted_end.is_none_or(|wanted| *end >= wanted);
        let Some(end) = counts.end_sample.filter(whole) else {
            return Err(Error::Usage(format!(
                "{}: its render was not finished: go on with it (--checkpoint {} --resume -o ANOTHER.exr), then merge",
                path.display(),
                path.display()
            )));
        };
        parts.push((counts.first_sample..end, path));
        let (one, other) = first.get_or_insert_with(|| (provenance.clone(), path));
        let differences = one.differences(&provenance);
        if !differences.is_empty() {
            return Err(Error::Usage(format!(
                "{} and {} are parts of different renders, which differ in {}",
                other.display(),
                path.display(),
                differences.join(", ").replace(" there", " in the first").replace(" here", " in the second")
            )));
        }
    }
    parts.sort_by_key(|(range, _)| (range.start, range.end));
    let mut next = 0;
    for (i, (range, path)) in parts.iter().enumerate() {
        if range.start < next {
            let (before, other) = &parts[i - 1];
            return Err(Error::Usage(format!(
                "samples {}..{} are in both {} ({}..{}) and {} ({}..{}): leave one of them out",
                range.start,
                next.min(range.end),
                other.display(),
                before.start,
                before.end,
                path.display(),
                range.start,
                range.end
            )));
        }
        if range.start > next {
            return Err(Error::Usage(format!(
                "samples {next}..{} are in none of the parts: render them with --samples {next}..{}",
                range.start, range.start
            )));
        }
        next = range.end;
    }
    let mut whole: Option<Rendered> = None;
    for (range, path) in parts {
        let (part, _) = read(path)?;
        // The file may have changed since its head was read.
        if part.film.first_sample != range.start || part.film.samples.iter().any(|n| *n != range.end - range.start) {
            return Err(Error::read(path, "it changed while it was read"));
        }
        match &mut whole {
            None => whole = Some(part),
            Some(whole) => whole.append(&part),
        }
    }
    let (mut whole, (provenance, _)) =
        whole.zip(first).ok_or_else(|| Error::Usage("there is no part to merge".into()))?;
    whole.progress.error = whole.film.error();
    Ok((whole, provenance))
}
