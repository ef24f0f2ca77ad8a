//! The digest of a part on disk, so that no byte of it changes unnoticed: SHA-256 of the whole file, in which the digest itself counts as zeros.

use crate::{Error, Result};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Name of the text in the head.
pub(super) const DIGEST: &str = "luminaire.digest";
/// What stands there before the digest is known: as many characters.
pub(super) const BLANK: &str = "0000000000000000000000000000000000000000000000000000000000000000";

/// The head of a file is shorter.
const MOST_HEAD: u64 = 1 << 20;

/// Puts the digest of a file that was just written into its head.
pub(super) fn seal(file: &mut File) -> std::io::Result<()> {
    let (at, _, digest) = digest(file)?.ok_or_else(|| std::io::Error::other("there is no place for its digest"))?;
    file.seek(SeekFrom::Start(at))?;
    file.write_all(digest.as_bytes())
}

/// Whether a file has a digest.
///
/// # Errors
/// [`Error::Read`] if it cannot be read, or has one and is not what it was.
pub(super) fn check(path: &Path) -> Result<bool> {
    let failed = |e: std::io::Error| Error::read(path, e);
    match digest(&mut File::open(path).map_err(failed)?).map_err(failed)? {
        None => Ok(false),
        Some((_, there, digest)) if there == digest.as_bytes() => Ok(true),
        Some(_) => Err(Error::read(
            path,
            "it is damaged: it is not what was written (its digest differs), so that its samples cannot be relied on; render them again, or take a \
             copy of the file",
        )),
    }
}

/// Where the digest stands in a file, what stands there, and what should; none if there is no place for one.
fn digest(file: &mut File) -> std::io::Result<Option<(u64, Vec<u8>, String)>> {
    let mut head = Vec::new();
    file.rewind()?;
    file.take(MOST_HEAD).read_to_end(&mut head)?;
    // An attribute: name, type, size, value.
    let before = [DIGEST.as_bytes(), b"\0string\0", &(BLANK.len() as u32).to_le_bytes()].concat();
    let Some(at) = head.windows(before.len()).position(|bytes| bytes == before).map(|at| at + before.len()) else {
        return Ok(None);
    };
    let Some(place) = head.get_mut(at..at + BLANK.len()) else { return Ok(None) };
    let there = place.to_vec();
    place.copy_from_slice(BLANK.as_bytes());
    let mut hash = Sha256::new();
    hash.update(&head);
    let mut bytes = vec![0; 1 << 20];
    loop {
        match file.read(&mut bytes)? {
            0 => break,
            length => hash.update(&bytes[..length]),
        }
    }
    let digest = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(Some((at as u64, there, digest)))
}
