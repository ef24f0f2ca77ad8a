//! Results on stdout, notes, warnings and errors on stderr.

use luminaire::Error;
use std::borrow::Cow;
use std::fmt::Display;
use std::io::Write;

/// Prints a result on stdout. Fails if stdout cannot be written, but not if its reader closes the pipe early (`| head`).
pub fn print(text: &str) -> luminaire::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::write("standard output".as_ref(), e)),
        _ => Ok(()),
    }
}

/// Prints a line on stderr. If stderr cannot be written, nothing happens.
pub fn note(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", harmless(line));
}

/// Prints a warning on stderr.
pub fn warn(warning: impl Display) {
    note(&format!("warning: {warning}"));
}

/// Prints an error on stderr.
pub fn error(error: impl Display) {
    note(&format!("error: {error}"));
}

/// Notes and warnings of a run that may have been asked to print nothing but errors.
#[derive(Debug, Clone, Copy)]
pub struct Notes {
    /// Print none of them.
    pub quiet: bool,
}

impl Notes {
    /// Prints a line on stderr, unless the run is quiet.
    pub fn note(self, line: &str) {
        if !self.quiet {
            note(line);
        }
    }

    /// Prints a warning on stderr, unless the run is quiet.
    pub fn warn(self, warning: impl Display) {
        if !self.quiet {
            warn(warning);
        }
    }
}

/// A text with its control characters replaced: names come from files, and a terminal would carry out escape sequences in them.
fn harmless(text: &str) -> Cow<'_, str> {
    let control = |c: char| c.is_control() && c != '\n' && c != '\t';
    if text.contains(control) { Cow::Owned(text.replace(control, "\u{fffd}")) } else { Cow::Borrowed(text) }
}
