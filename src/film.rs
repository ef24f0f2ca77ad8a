//! The film: what a tracer measured, added up.

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tile {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Tile {
    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// Work for a tracer: the samples `samples` of every pixel of `tile`, added up in groups of `group`.
///
/// Group `g` holds the samples from `samples.start + g * group`, at most `group` of them and none past `samples.end`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Batch {
    /// Which pixels.
    pub tile: Tile,
    /// Which samples of each.
    pub samples: std::ops::Range<u32>,
    /// How many samples go into one sum; at least 1.
    pub group: u32,
}

impl Batch {
    /// Number of groups.
    pub fn groups(&self) -> u32 {
        (self.samples.end - self.samples.start).div_ceil(self.group)
    }
}

/// The sum over one group of samples of one pixel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PixelSum {
    /// Radiance, added up in linear RGB.
    pub radiance: [f64; 3],
    /// Rays that were traced for it, of all kinds.
    pub rays: u32,
}
