//! A scene file, and where in it something stands.

use crate::Error;
use crate::scene::load::text_file::line_and_column;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scene file being turned into a [`Scene`](crate::scene::Scene).
pub(super) struct File<'a> {
    pub path: &'a Path,
    pub text: &'a str,
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

    pub(super) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }
}
