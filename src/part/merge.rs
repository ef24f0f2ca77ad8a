//! Joins parts of one render.

use super::file::{about, read};
use super::provenance::Provenance;
use crate::film::{FILM_BYTES, MEAN_BYTES};
use crate::memory::{available, gib};
use crate::picture::Development;
use crate::render::Rendered;
use crate::{Error, Result};
use std::ops::Range;
use std::path::PathBuf;

/// Beside what grows with the picture: decoded blocks of a file, and what is read of it before it is put into the film. Measured.
const FIXED: u64 = 40 << 20;

/// Refuses parts of which the memory that is free cannot hold the whole, one of them, and the channels that it is read from.
fn fits((width, height): (u32, u32), parts: usize, available: Option<u64>) -> Result<()> {
    let films = if parts > 1 { 3 } else { 2 };
    let needed = FIXED + (films * FILM_BYTES + MEAN_BYTES) * u64::from(width) * u64::from(height);
    match available.filter(|free| needed > *free) {
        None => Ok(()),
        Some(free) => Err(Error::Limit {
            what: format!("merging parts of {width} x {height} pixels"),
            needed: format!("{} of memory", gib(needed)),
            device: "this machine".into(),
            limit: format!("{}, what is free now", gib(free)),
            advice: "end what else takes memory, or merge them on another machine".into(),
        }),
    }
}

/// A part's file, and how it says that the picture is to be developed.
pub type Shown = (PathBuf, Development);

/// Joins parts, given in any order, that together hold every sample from number 0 on once. Only one of them is in memory at a time.
///
/// The provenance is that of the part with sample number 0. How each part says that the picture is to be developed is listed in the order of their
/// samples: that may be different from part to part.
///
/// # Errors
/// As [`read`]; [`Error::Usage`] if samples are missing or doubled, or parts are of different renders.
pub fn merge(paths: &[PathBuf]) -> Result<(Rendered, Provenance, Vec<Shown>)> {
    let mut parts: Vec<(Range<u32>, &PathBuf, Provenance)> = Vec::new();
    let mut first: Option<(Provenance, &PathBuf)> = None;
    for path in paths {
        let (provenance, counts) = about(path)?;
        if counts.adaptive {
            return Err(Error::Usage(format!(
                "{}: its pixels have different numbers of samples (--adaptive), which cannot be joined with others: give one render all the time it needs, with --checkpoint \
                 and --resume, or render parts with --samples",
                path.display()
            )));
        }
        let whole = |end: &u32| *end > counts.first_sample && counts.wanted_end.is_none_or(|wanted| *end >= wanted);
        let Some(end) = counts.end_sample.filter(whole) else {
            let wanted = counts.wanted_end.map_or("END".into(), |wanted| wanted.to_string());
            return Err(Error::Usage(format!(
                "{}: its render was not finished: go on with it (the command that began it, with --samples {}..{wanted} --checkpoint {} --resume \
                 -o ANOTHER.exr), then merge",
                path.display(),
                counts.first_sample,
                path.display()
            )));
        };
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
        parts.push((counts.first_sample..end, path, provenance));
    }
    parts.sort_by_key(|(range, ..)| (range.start, range.end));
    let mut next = 0;
    for (i, (range, path, _)) in parts.iter().enumerate() {
        if range.start < next {
            let (before, other, _) = &parts[i - 1];
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
    if let Some((provenance, _)) = &first {
        fits(provenance.film_size(), parts.len(), available())?;
    }
    let shown = parts.iter().map(|(_, path, provenance)| ((*path).clone(), provenance.development())).collect();
    let first = parts.first().map(|(.., provenance)| provenance.clone());
    let mut whole: Option<Rendered> = None;
    for (range, path, _) in parts {
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
    let (mut whole, provenance) = whole.zip(first).ok_or_else(|| Error::Usage("there is no part to merge".into()))?;
    whole.progress.error = whole.film.error();
    Ok((whole, provenance, shown))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_asked_for_what_merging_takes() {
        let size = (1000, 1000);
        assert!(fits(size, 2, Some(FIXED + 600_000_000)).is_ok() && fits(size, 2, None).is_ok());
        let said = fits(size, 2, Some(FIXED + 599_999_999)).unwrap_err().to_string();
        assert!(
            said.contains("1000 x 1000") && said.contains("another machine") && !said.contains("--width"),
            "{said}"
        );
        assert!(fits(size, 1, Some(FIXED + 404_000_000)).is_ok());
    }
}
