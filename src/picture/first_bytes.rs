//! The first bytes of a file, by which its format is known, before the rest is read.

use std::io::Read;
use std::path::Path;

/// So many are enough for every format.
const MOST: u64 = 256;

/// The first bytes of a regular file: all of it if it has no more than a few.
///
/// # Errors
/// In words that can follow the file's name: it cannot be read, or is a folder, a pipe or a device.
pub(super) fn first_bytes(path: &Path) -> Result<Vec<u8>, String> {
    let about = std::fs::metadata(path).map_err(|e| e.to_string())?;
    if !about.is_file() {
        // A pipe or a device may never end.
        return Err(if about.is_dir() { "it is a folder" } else { "it is not a regular file" }.into());
    }
    let mut start = Vec::new();
    let file = std::fs::File::open(path).map_err(|e| e.to_string())?;
    file.take(MOST).read_to_end(&mut start).map_err(|e| e.to_string())?;
    Ok(start)
}
