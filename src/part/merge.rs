//! Joins parts of one render.

use super::file::{about, read};
use super::provenance::Provenance;
use crate::render::Rendered;
use crate::{Error, Result};
use std::ops::Range;
use std::path::PathBuf;

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
