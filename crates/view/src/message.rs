//! [`Message`]: a line of text over the picture that goes after three seconds.

use std::time::{Duration, Instant};

/// How long a message stays in the window.
const STAY: Duration = Duration::from_secs(3);

/// A line over the picture.
#[derive(Debug)]
pub struct Message {
    /// The line.
    pub text: String,
    /// When it is removed.
    pub until: Instant,
}

impl Message {
    /// Shows the first line of a text from now on.
    pub fn new(text: &str) -> Self {
        Message { text: text.lines().next().unwrap_or_default().to_owned(), until: Instant::now() + STAY }
    }
}
