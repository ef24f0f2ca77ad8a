//! A scene file, and where in it something stands.

use crate::scene::load::text_file::{line_and_column, read_bytes};
use crate::{Error, Result};
use ::toml::Spanned;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scene file being turned into a [`Scene`](crate::scene::Scene).
pub(super) struct File<'a> {
    pub path: &'a Path,
    pub text: &'a str,
}

/// The text of a scene file.
pub(super) fn read_text(path: &Path) -> Result<String> {
    let bytes = read_bytes(path)?;
    let text = std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes)).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        Error::Parse { path: path.to_owned(), line, column: 0, message: "a scene file has to be UTF-8 text".into() }
    })?;
    Ok(text.to_owned())
}

impl File<'_> {
    /// An error at a place of the scene file.
    pub(super) fn error(&self, span: Range<usize>, message: impl Into<String>) -> Error {
        let (line, column) = line_and_column(self.text, span.start);
        Error::Parse { path: self.path.to_owned(), line, column, message: message.into() }
    }

    /// A warning about the scene file.
    pub(super) fn warning(&self, message: &str) -> String {
        format!("{}: {message}", self.path.display())
    }

    /// A file that the scene file names.
    pub(super) fn beside(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    /// The file of a key that needs one; `what` it names.
    ///
    /// # Errors
    /// If the name is empty.
    pub(super) fn named(&self, name: &Spanned<String>, what: &str) -> Result<PathBuf> {
        if name.get_ref().trim().is_empty() {
            return Err(self.error(name.span(), format!("an empty name, expected the name of {what}")));
        }
        Ok(self.beside(name.get_ref()))
    }

    pub(super) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }
}
