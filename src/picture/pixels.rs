//! A picture as numbers to compute with.

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
