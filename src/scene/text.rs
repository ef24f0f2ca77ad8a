//! Text files as people really save them: with a byte-order mark, Windows line ends, stray bytes.

use crate::{Error, Result};
use std::path::Path;

/// Reads a text file. A UTF-8 byte-order mark is dropped, and bytes that are not UTF-8 become U+FFFD: they sit in comments
/// and names, where they do no harm.
///
/// # Errors
/// If the file cannot be read, is UTF-16, or holds a NUL byte (then it is binary or damaged).
pub(super) fn read_text(path: &Path) -> Result<String> {
    let about = std::fs::metadata(path).map_err(|e| Error::read(path, e))?;
    if !about.is_file() {
        // A pipe or a device may never end.
        return Err(Error::read(path, if about.is_dir() { "it is a folder" } else { "it is not a regular file" }));
    }
    let bytes = std::fs::read(path).map_err(|e| Error::read(path, e))?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Error::read(path, "it is UTF-16 text; save it as UTF-8"));
    }
    let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).map(<[u8]>::to_vec).unwrap_or(bytes);
    if let Some(at) = bytes.iter().position(|b| *b == 0) {
        let line = 1 + bytes[..at].iter().filter(|b| **b == b'\n').count();
        let message = "a NUL byte, expected plain text: the file is binary, damaged, or UTF-16 (save it as UTF-8)";
        return Err(Error::Parse { path: path.to_owned(), line, column: 0, message: message.into() });
    }
    Ok(String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned()))
}

/// Line and column, both from 1, of a byte offset.
pub(super) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    (1 + before.matches('\n').count(), 1 + before[line_start..].chars().count())
}

/// How often something was met, and where first: one warning in place of one for each line.
#[derive(Debug, Default)]
pub(super) struct Tally {
    count: usize,
    first: usize,
}

impl Tally {
    /// Counts one more, on line `line`.
    pub(super) fn add(&mut self, line: usize) {
        if self.count == 0 {
            self.first = line;
        }
        self.count += 1;
    }

    /// `FILE:LINE: WHAT`, with the count, if anything was met.
    pub(super) fn warn(&self, path: &Path, what: &str, warnings: &mut Vec<String>) {
        match self.count {
            0 => {}
            1 => warnings.push(format!("{}:{}: {what}", path.display(), self.first)),
            n => warnings.push(format!("{}:{}: {what} (and {} more like it)", path.display(), self.first, n - 1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::line_and_column;

    #[test]
    fn positions_count_characters_from_one() {
        let text = "ab\n\u{e9}\u{e9}x\n";
        assert_eq!(line_and_column(text, 0), (1, 1));
        assert_eq!(line_and_column(text, 3), (2, 1));
        assert_eq!(line_and_column(text, 7), (2, 3));
        assert_eq!(line_and_column(text, 4), (2, 1), "inside a character counts as its start");
        assert_eq!(line_and_column(text, 99), (3, 1));
    }
}
