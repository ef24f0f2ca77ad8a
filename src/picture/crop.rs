//! A part of a picture, and where it lies in the whole.

use serde::{Deserialize, Serialize};

/// The pixels of a whole picture that a smaller one holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Crop {
    /// Column of its left pixels, counted from 0.
    pub x: u32,
    /// Row of its upper pixels, counted from 0 at the top.
    pub y: u32,
    /// Columns; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// Width and height of the whole picture.
    pub whole: (u32, u32),
}

impl Crop {
    /// Whether all of it lies in the whole picture.
    pub fn is_inside(&self) -> bool {
        let within = |from: u32, size: u32, whole: u32| u64::from(from) + u64::from(size) <= u64::from(whole);
        within(self.x, self.width, self.whole.0) && within(self.y, self.height, self.whole.1)
    }
}

impl std::fmt::Display for Crop {
    /// As `--crop` has it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{},{},{},{}", self.x, self.y, self.width, self.height)
    }
}
