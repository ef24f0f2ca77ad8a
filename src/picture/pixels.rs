//! A picture as numbers to compute with, and why there is none.

use crate::memory::gib;
use std::io::{Error, ErrorKind};

/// Most pixels of a picture: a small file can claim to be an enormous one.
pub(super) const MOST_PIXELS: u64 = 1 << 28;

/// A picture in linear RGB, rows from the top. Numbers that are not finite are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// The pixels.
    pub rgb: Vec<[f32; 3]>,
    /// The standard error of each of these numbers, where the file has it (the channels `error.R`, `error.G`, `error.B` of an EXR).
    pub error: Option<Vec<[f32; 3]>>,
    /// Whether the file holds whole numbers, which end at white; they have been decoded as sRGB.
    pub clamped: bool,
    /// What in the file was guessed or ignored, in words that can follow its name.
    pub warnings: Vec<String>,
}

/// Why a picture is refused that says it is enormous.
pub(super) fn too_large(width: u64, height: u64) -> String {
    format!("it says that it has {width} x {height} pixels; at most {MOST_PIXELS} are read")
}

/// Refuses what the memory that is free cannot take, in bytes.
pub(super) fn fits((width, height): (u32, u32), needed: u64, available: Option<u64>) -> Result<(), String> {
    match available {
        Some(free) if needed > free => Err(format!(
            "it has {width} x {height} texels, which take {} of memory, of which {} are free: make it smaller",
            gib(needed),
            gib(free)
        )),
        _ => Ok(()),
    }
}

/// What it means that a decoder cannot go on reading: a file that ends too early, or leads to where it has nothing.
pub(super) fn io_in_words(error: Error) -> String {
    match error.kind() {
        ErrorKind::UnexpectedEof => "it is damaged or cut off: it ends before the picture does".into(),
        ErrorKind::InvalidData | ErrorKind::InvalidInput => "it is damaged or cut off".into(),
        _ => error.to_string(),
    }
}
