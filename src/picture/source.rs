//! Where the bytes of a picture are: in a file of their own, or within one of another kind, as a model.

use std::fmt::Debug;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};

/// So many of the first bytes are enough to know every format.
const MOST: u64 = 256;

/// Where the bytes of a picture are.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Source<'a> {
    /// A file.
    File(&'a Path),
    /// Bytes in memory.
    Bytes {
        /// All of them.
        bytes: &'a [u8],
        /// What the picture is called; its ending counts where the content says nothing, as that of a file does.
        name: &'a str,
    },
}

/// What decoders read.
pub(super) trait Stream: BufRead + Seek + Debug {}

impl<T: BufRead + Seek + Debug> Stream for T {}

impl<'a> Source<'a> {
    /// Its name, for the ending.
    pub(super) fn name(self) -> &'a Path {
        match self {
            Source::File(path) => path,
            Source::Bytes { name, .. } => Path::new(name),
        }
    }

    /// The first bytes, by which the format is known, before the rest is read: all of them if there are no more than a few.
    ///
    /// # Errors
    /// In words that can follow the picture's name: it cannot be read, or is a folder, a pipe or a device.
    pub(super) fn first_bytes(self) -> Result<Vec<u8>, String> {
        if let Source::File(path) = self {
            let about = std::fs::metadata(path).map_err(|e| e.to_string())?;
            if !about.is_file() {
                // A pipe or a device may never end.
                return Err(if about.is_dir() { "it is a folder" } else { "it is not a regular file" }.into());
            }
        }
        let mut start = Vec::new();
        self.open().and_then(|stream| stream.take(MOST).read_to_end(&mut start)).map_err(|e| e.to_string())?;
        Ok(start)
    }

    /// The bytes from the first one on.
    ///
    /// # Errors
    /// If a file cannot be opened.
    pub(super) fn open(self) -> io::Result<Box<dyn Stream + 'a>> {
        Ok(match self {
            Source::File(path) => Box::new(BufReader::new(File::open(path)?)),
            Source::Bytes { bytes, .. } => Box::new(Cursor::new(bytes)),
        })
    }

    /// How many bytes there are.
    ///
    /// # Errors
    /// If nothing can be learned of a file.
    pub(super) fn len(self) -> io::Result<u64> {
        match self {
            Source::File(path) => Ok(std::fs::metadata(path)?.len()),
            Source::Bytes { bytes, .. } => Ok(bytes.len() as u64),
        }
    }
}

impl<'a> From<&'a Path> for Source<'a> {
    fn from(path: &'a Path) -> Self {
        Source::File(path)
    }
}

impl<'a> From<&'a PathBuf> for Source<'a> {
    fn from(path: &'a PathBuf) -> Self {
        Source::File(path)
    }
}
