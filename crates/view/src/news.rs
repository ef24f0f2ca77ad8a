//! What the worker has for the window.

use super::develop::Developed;
use luminaire::Result;

/// What the worker sends to the window.
#[derive(Debug)]
pub enum News {
    /// Something to see.
    Frame(Frame),
    /// A sentence about what was done, or could not be.
    Said(String),
    /// A result: a file, or its content, for standard output.
    Done(String),
    /// The worker has ended.
    Ended(Result<()>),
}

/// Something to see, and about it.
#[derive(Debug)]
pub struct Frame {
    /// The picture.
    pub developed: Developed,
    /// For the title.
    pub figures: String,
}
