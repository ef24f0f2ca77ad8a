//! Writes and reads one part of a render, or goes on from it.

use super::digest::{self, BLANK, DIGEST};
use super::provenance::Provenance;
use crate::film::{BLOCKS, Film, SampleId};
use crate::picture::{self, Attribute, Crop, Values};
use crate::render::{DROPPED_NAMED, LEAST_FOR_NOISE, Rendered, Shares, is_a_pass};
use crate::scene::Scene;
use crate::{Error, Result};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Names of the texts in the head.
const PROVENANCE: &str = "luminaire.provenance";
const COUNTS: &str = "luminaire.counts";

/// The picture, its error, its alpha, the numbers of samples, of those that met nothing, and the shares, the sums in halves, what is left out.
const MOST_CHANNELS: usize = 3 + 3 + 1 + 3 + 6 * BLOCKS + BLOCKS;

/// The channel of the samples that met nothing.
const MISSED: &str = "missed";
/// The channel of the shares of the pixels.
const SHARES: &str = "share";
const HALVES: [&str; 2] = ["high", "low"];
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// What is counted besides the samples of the pixels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Counts {
    /// Number of every pixel's first sample.
    pub first_sample: u32,
    /// Number after that of the last sample; none where a pass was not finished, so that some pixels have more than others.
    pub end_sample: Option<u32>,
    /// Where the samples were to end, if that was said.
    pub wanted_end: Option<u32>,
    rays: u64,
    shadow_rays: u64,
    dropped: u64,
    /// Pixel and sample of some that were not finite.
    dropped_samples: Vec<[u32; 2]>,
    seconds: f64,
    device_seconds: f64,
    noise_aim: u32,
    /// Whether tiles have different shares of the samples.
    pub adaptive: bool,
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
        adaptive: rendered.shares.is_some(),
    };
    let mut channels = vec![("samples".to_owned(), Values::Integer(film.samples.clone()))];
    if let Some(missed) = &film.missed {
        channels.push((MISSED.to_owned(), Values::Integer(missed.clone())));
    }
    if let Some(shares) = &rendered.shares {
        let shares = (0..film.pixels()).map(|pixel| shares.samples_of_pixel(pixel, 1)).collect();
        channels.push((SHARES.to_owned(), Values::Integer(shares)));
    }
    for block in 0..BLOCKS {
        for (c, channel) in CHANNELS.into_iter().enumerate() {
            for (half, shift) in HALVES.into_iter().zip([32, 0]) {
                let bits = film.sums.iter().map(|sums| (sums[block][c].to_bits() >> shift) as u32).collect();
                channels.push((format!("sum.{block}.{channel}.{half}"), Values::Integer(bits)));
            }
        }
        if !film.dropped.is_empty() {
            let dropped = |pixel| film.dropped.get(&(pixel, block)).copied().unwrap_or(0);
            channels.push((format!("dropped.{block}"), Values::Integer((0..film.pixels()).map(dropped).collect())));
        }
    }
    let json = |value: serde_json::Result<String>| value.map_err(|e| Error::write(path, e));
    let (provenance, counts) = (json(serde_json::to_string(provenance))?, json(serde_json::to_string(&counts))?);
    let about = vec![
        (PROVENANCE, Attribute::Text(&provenance)),
        (COUNTS, Attribute::Text(&counts)),
        (DIGEST, Attribute::Text(BLANK)),
    ];
    film.save_exr(path, channels, about, digest::seal)
}

/// Whether a file is a part or a checkpoint, by its head.
pub fn is_part(path: &Path) -> bool {
    path.is_file() && picture::read_texts(path).is_ok_and(|texts| texts.contains_key(PROVENANCE))
}

/// Reads the head of a file, after all of it has been checked against its digest.
pub(super) fn about(path: &Path) -> Result<(Provenance, Counts)> {
    // A name that leads to something endless would never be read to its end.
    if std::fs::metadata(path).is_ok_and(|about| !about.is_file()) {
        return Err(Error::read(path, "it is not a file"));
    }
    let whole = digest::check(path)?;
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
    let provenance = text(PROVENANCE)?;
    if !whole {
        return Err(Error::read(
            path,
            "it has no digest by which damage could be seen: it was written by an older build of this program, which has to finish it, or it is damaged",
        ));
    }
    let provenance = serde_json::from_str(provenance).map_err(damaged)?;
    Ok((provenance, serde_json::from_str(text(COUNTS)?).map_err(damaged)?))
}

/// Reads what [`save`] wrote.
///
/// # Errors
/// [`Error::Read`] if there is no such file, or it is something else, or damaged; [`Error::Limit`] if the film does not fit into memory.
pub fn read(path: &Path) -> Result<(Rendered, Provenance)> {
    let (provenance, counts) = about(path)?;
    Ok((sums(path, &provenance, counts)?, provenance))
}

/// Reads what is behind the head of a file.
fn sums(path: &Path, provenance: &Provenance, counts: Counts) -> Result<Rendered> {
    let damaged = |what: &str| Error::read(path, format!("it is damaged: {what}"));
    let size = provenance.film_size();
    if provenance.crop.is_some_and(|crop| !crop.is_inside() || crop.whole != (provenance.width, provenance.height)) {
        return Err(damaged("its part of the picture is not in the picture"));
    }
    Film::check_size(size.0, size.1)?;
    let mut channels = picture::read_channels(path, MOST_CHANNELS, size).map_err(|e| Error::read(path, e))?;
    let mut rendered = Rendered::nothing(size, counts.first_sample)?;
    let film = &mut rendered.film;
    film.crop = provenance.crop;
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
    let is_even = in_order && end.is_some_and(|end| is_a_pass(counts.first_sample + least..end));
    let shares = match counts.adaptive {
        false => None,
        true => {
            let shares = take(SHARES).ok_or_else(|| damaged(&format!("there is no channel `{SHARES}`")))?;
            let shares = Shares::of_pixels(size, &shares);
            Some(shares.ok_or_else(|| damaged("its shares of the samples are impossible"))?)
        }
    };
    let is_fine = match &shares {
        None => is_even,
        Some(shares) => counts.first_sample == 0 && shares.allow(&film.samples, counts.noise_aim),
    };
    if !is_fine {
        return Err(damaged("its numbers of samples are impossible"));
    }
    for block in 0..BLOCKS {
        for (c, channel) in CHANNELS.into_iter().enumerate() {
            for (half, shift) in HALVES.into_iter().zip([32, 0]) {
                let name = format!("sum.{block}.{channel}.{half}");
                let bits = take(&name).ok_or_else(|| damaged(&format!("there is no channel `{name}`")))?;
                for (sums, bits) in film.sums.iter_mut().zip(bits) {
                    sums[block][c] = f64::from_bits(sums[block][c].to_bits() | u64::from(bits) << shift);
                }
            }
        }
        for (pixel, count) in take(&format!("dropped.{block}")).into_iter().flatten().enumerate() {
            if count > film.block_samples(pixel)[block] {
                return Err(damaged("more samples are left out than there are"));
            }
            if count > 0 {
                film.dropped.insert((pixel, block), count);
            }
        }
    }
    if provenance.transparent {
        let missed = take(MISSED).ok_or_else(|| damaged("there is no channel `missed`"))?;
        if (0..film.pixels()).any(|pixel| missed[pixel] > film.finite_samples(pixel)) {
            return Err(damaged("more samples met nothing than there are"));
        }
        film.missed = Some(missed);
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
    rendered.shares = shares;
    let progress = &mut rendered.progress;
    progress.samples = rendered.film.samples.iter().map(|n| u64::from(*n)).sum();
    (progress.rays, progress.shadow_rays, progress.seconds) = (counts.rays, counts.shadow_rays, counts.seconds);
    Ok(rendered)
}

/// Reads a file to go on with the render of `scene` from it.
///
/// # Errors
/// As [`read`], and [`Error::Read`] if it is of another render, with all differences.
pub fn resume(path: &Path, scene: &Scene) -> Result<Rendered> {
    resume_crop(path, scene, None)
}

/// Reads a file to go on with the render of a part of the picture of `scene`; without `crop`, of all of it.
///
/// # Errors
/// As [`resume`].
pub fn resume_crop(path: &Path, scene: &Scene, crop: Option<Crop>) -> Result<Rendered> {
    let (there, counts) = about(path)?;
    let differences = there.differences(&Provenance::of(scene).cropped(crop));
    if !differences.is_empty() {
        return Err(Error::read(
            path,
            format!(
                "it is of another render, which differs in {}: use what that render used, or start anew with another name",
                differences.join(", ")
            ),
        ));
    }
    sums(path, &there, counts)
}
