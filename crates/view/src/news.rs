//! [`News`]: what the worker sends to the window: pictures, messages, results, and its own end.

use super::develop::Developed;
use luminaire::Result;

/// What the worker sends to the window.
#[derive(Debug)]
pub enum News {
    /// An exposure in stops, which was ordered.
    Exposed(f32),
    /// A picture to show.
    Frame(Frame),
    /// A message: what was done, or could not be done.
    Said(String),
    /// A result for standard output: the name of a file, or its content.
    Done(String),
    /// The worker has ended.
    Ended(Result<()>),
}

/// A picture to show, and what the title says of it.
#[derive(Debug)]
pub struct Frame {
    /// The picture.
    pub developed: Developed,
    /// The figures for the title.
    pub figures: String,
}
