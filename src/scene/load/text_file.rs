//! Text files as people really save them: with a byte-order mark, Windows line ends, stray bytes.

use crate::memory::{available, gib};
use crate::{Error, Result};
use std::borrow::Cow;
use std::path::Path;

/// Most bytes of a text file: below this no count of anything in it can leave 32 bits.
const MOST_BYTES: u64 = u32::MAX as u64;
/// Memory that reading takes, for each byte of the file. Measured on OBJs of 10 million triangles: 1.6 with texture coordinates and
/// normals, 2.5 with neither, 4.3 with neither and smooth normals to make.
const MEMORY: u64 = 5;

/// The bytes of a regular file.
///
/// # Errors
/// If it cannot be read, is none (a pipe or a device may never end), or is larger than what the memory that is free can take.
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    let about = std::fs::metadata(path).map_err(|e| Error::read(path, e))?;
    if !about.is_file() {
        return Err(Error::read(path, if about.is_dir() { "it is a folder" } else { "it is not a regular file" }));
    }
    check_size(about.len(), available()).map_err(|reason| Error::read(path, reason))?;
    std::fs::read(path).map_err(|e| Error::read(path, e))
}

/// Says why a file of so many bytes is too large.
fn check_size(bytes: u64, available: Option<u64>) -> std::result::Result<(), String> {
    if bytes > MOST_BYTES {
        return Err(format!("it has {}, and at most 4 GiB are read: split it into several meshes", gib(bytes)));
    }
    match available {
        Some(free) if MEMORY * bytes > free => Err(format!(
            "it has {}, and reading it takes about {} of memory, of which {} are free: use a smaller mesh, or split it",
            gib(bytes),
            gib(MEMORY * bytes),
            gib(free)
        )),
        _ => Ok(()),
    }
}

/// A word from a file for a message, not too long.
pub(super) fn shortened(word: &str) -> Cow<'_, str> {
    const MOST: usize = 80;
    match word.char_indices().nth(MOST) {
        None => Cow::Borrowed(word),
        Some((end, _)) => Cow::Owned(format!("{}... ({} bytes)", &word[..end], word.len())),
    }
}

/// Reads a text file. A UTF-8 byte-order mark is dropped, and bytes that are not UTF-8 become U+FFFD: they sit in comments
/// and names, where they do no harm. Lines may end as they do on any system, the first Macintoshes (a carriage return) included.
/// NUL bytes at the end, which some programs write, are left out with a warning.
///
/// # Errors
/// As for [`read_bytes`], and if the file is UTF-16, or holds a NUL byte before its last character (then it is binary or damaged).
pub(super) fn read_text(path: &Path, warnings: &mut Vec<String>) -> Result<String> {
    let mut bytes = read_bytes(path)?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Error::read(path, "it is UTF-16 text; save it as UTF-8"));
    }
    if bytes.starts_with(&[0xef, 0xbb, 0xbf]) {
        bytes.drain(..3);
    }
    let kept = without_nuls_at_the_end(&bytes).len();
    // A file of nothing else is damaged.
    if kept > 0 && kept < bytes.len() {
        let count = bytes[kept..].iter().filter(|byte| **byte == 0).count();
        warnings.push(format!(
            "{}: {count} NUL byte(s) at its end are ignored; if what wrote or copied it did not mean them, the end of the file is missing",
            path.display()
        ));
        bytes.truncate(kept);
    }
    if bytes.contains(&0) {
        let line = 1 + bytes.iter().take_while(|b| **b != 0).filter(|b| **b == b'\n').count();
        let message = "a NUL byte, expected plain text: the file is binary, damaged, or UTF-16 (save it as UTF-8)";
        return Err(Error::Parse { path: path.to_owned(), line, column: 0, message: message.into() });
    }
    end_lines(&mut bytes);
    Ok(String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned()))
}

/// The bytes before the NUL bytes at the end, between and behind which there may be blanks and line ends.
fn without_nuls_at_the_end(bytes: &[u8]) -> &[u8] {
    let text = bytes.iter().rposition(|byte| *byte != 0 && !byte.is_ascii_whitespace()).map_or(0, |last| last + 1);
    let first = bytes[text..].iter().position(|byte| *byte == 0);
    &bytes[..first.map_or(bytes.len(), |first| text + first)]
}

/// Makes a line feed of every carriage return that has none behind it.
fn end_lines(bytes: &mut [u8]) {
    for index in 0..bytes.len() {
        if bytes[index] == b'\r' && bytes.get(index + 1) != Some(&b'\n') {
            bytes[index] = b'\n';
        }
    }
}

/// A number as programs write it. What is not finite has many names: `nan`, `-nan(ind)`, and those of Microsoft's C library, `-1.#IND00`, `1.#QNAN`,
/// `1.#INF`.
pub(super) fn parse_number(word: &str) -> Option<f64> {
    if let Ok(number) = word.parse() {
        return Some(number);
    }
    let (sign, name) = match word.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    };
    let name = name.to_ascii_lowercase();
    if let Some((digits, kind)) = name.split_once(".#") {
        if !digits.bytes().all(|digit| digit.is_ascii_digit()) {
            return None;
        }
        // Printed with few digits the names are rounded as if they were numbers: 1.#J is an infinity.
        let infinite = ["inf", "in", "io", "j"].iter().any(|start| kind.trim_end_matches('0') == *start);
        return Some(if infinite { sign * f64::INFINITY } else { f64::NAN });
    }
    let of_nan = name.strip_prefix("nan").is_some_and(|rest| rest.starts_with('(') && rest.ends_with(')'));
    (of_nan || name == "qnan" || name == "snan").then_some(f64::NAN)
}

/// Lines with their number, where a backslash at the end joins the next one.
pub(super) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().zip(1..);
    std::iter::from_fn(move || {
        let (line, number) = lines.next()?;
        let line = line.trim();
        let Some(head) = line.strip_suffix('\\').filter(|head| !head.starts_with('#')) else {
            return Some((number, Cow::Borrowed(line)));
        };
        let mut joined = head.to_owned();
        for (line, _) in lines.by_ref() {
            joined.push(' ');
            match line.trim().strip_suffix('\\') {
                Some(head) => joined.push_str(head),
                None => {
                    joined.push_str(line.trim());
                    break;
                }
            }
        }
        // A line of nothing but a backslash leaves a blank in front.
        Some((number, Cow::Owned(joined.trim().to_owned())))
    })
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
    use super::{check_size, end_lines, line_and_column, parse_number, shortened};

    #[test]
    fn numbers_that_are_none_have_many_names() {
        for word in [
            "nan",
            "-nan",
            "NaN",
            "nan(ind)",
            "-nan(ind)",
            "nan(snan)",
            "-1.#IND00",
            "1.#QNAN",
            "1.#SNAN",
            "1.#IND",
            "+1.#QNAN0",
        ] {
            assert!(parse_number(word).is_some_and(f64::is_nan), "{word}");
        }
        for (word, value) in
            [("1.#INF", f64::INFINITY), ("-1.#INF00", f64::NEG_INFINITY), ("1.#J", f64::INFINITY), ("2.5", 2.5)]
        {
            assert_eq!(parse_number(word), Some(value), "{word}");
        }
        for word in ["", "x", "1,5", "1.5.#INF", "3.1+e2", "nano", "#INF"] {
            assert_eq!(parse_number(word), None, "{word}");
        }
    }

    #[test]
    fn every_system_s_line_ends_are_lines() {
        let mut text = *b"a\rb\r\nc\n\rd\r";
        end_lines(&mut text);
        assert_eq!(&text, b"a\nb\r\nc\n\nd\n");
    }

    #[test]
    fn files_that_memory_cannot_hold_are_refused() {
        assert!(check_size(1 << 30, Some(8 << 30)).is_ok() && check_size(1 << 30, None).is_ok());
        let error = check_size(2 << 30, Some(8 << 30)).unwrap_err();
        assert!(["2048.0 MiB", "10.0 GiB", "8192.0 MiB are free"].iter().all(|part| error.contains(part)), "{error}");
        assert!(check_size(5 << 30, None).unwrap_err().contains("at most 4 GiB"));
    }

    #[test]
    fn long_words_are_cut_between_characters() {
        assert_eq!(shortened("ab"), "ab");
        let word = "\u{e9}".repeat(100);
        assert_eq!(shortened(&word), format!("{}... (200 bytes)", "\u{e9}".repeat(80)));
    }

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
