//! A mark in a picture's file, by which whoever wrote it knows what it is of.

use super::Format;
use super::openexr::read_texts;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// The name under which the mark stands in the file's head.
pub(crate) const MARK: &str = "luminaire.mark";

/// A mark stands in so many bytes of an HDR file.
const MOST_HEAD: u64 = 1 << 10;

/// The mark that a file was written with ([`Film::save_marked`](crate::Film::save_marked)). None if it has none or cannot be read.
pub fn mark(path: &Path) -> Option<String> {
    if !path.is_file() {
        return None;
    }
    match Format::of(path).ok()? {
        Format::Exr => read_texts(path).ok()?.remove(MARK),
        Format::Png => {
            let reader = png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
            let mut texts = reader.info().uncompressed_latin1_text.iter();
            texts.find(|text| text.keyword == MARK).map(|text| text.text.clone())
        }
        Format::Hdr => {
            let mut head = Vec::new();
            File::open(path).ok()?.take(MOST_HEAD).read_to_end(&mut head).ok()?;
            let head = String::from_utf8_lossy(&head);
            let mut lines = head.lines().take_while(|line| !line.is_empty());
            lines.find_map(|line| line.strip_prefix("# ")?.strip_prefix(MARK)?.strip_prefix(": ").map(str::to_owned))
        }
    }
}

/// An HDR file with a mark: a comment behind its first line.
pub(super) fn marked_hdr(bytes: &[u8], mark: &str) -> Vec<u8> {
    let first = bytes.iter().position(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    [&bytes[..first], format!("# {MARK}: {mark}\n").as_bytes(), &bytes[first..]].concat()
}
