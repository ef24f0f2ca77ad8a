//! Work for a tracer, and what comes back from it.

use std::ops::Range;

/// The longest group of a film: few enough samples to add them up in `f32`.
pub(crate) const LONGEST_GROUP: u32 = 4;

/// Groups that one invocation of the kernel takes, one after the other: it should be busy for a while, and stay short (Mesa before 23 ends a shader's loops
/// after 65 535 rounds).
pub const GROUPS_IN_TURN: u32 = 4;

/// Samples in the group of a film that holds this sample, by its number alone: 1 below 8, 2 below 16, then 4.
pub(crate) fn group_length(sample: u32) -> u32 {
    1 << (sample / GROUPS_IN_TURN).clamp(1, LONGEST_GROUP).ilog2()
}

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
/// Groups begin at the multiples of `group`; the first may lack its head, where the samples begin within it, and the last its tail.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Batch {
    /// Which pixels.
    pub tile: Tile,
    /// Which samples of each.
    pub samples: Range<u32>,
    /// How many samples go into one sum; at least 1.
    pub group: u32,
}

impl Batch {
    /// Number of groups: those that hold at least one sample.
    pub fn groups(&self) -> u32 {
        let Range { start, end } = self.samples;
        if start < end { (end - 1) / self.group - start / self.group + 1 } else { 0 }
    }

    /// The samples of a group.
    pub fn group_samples(&self, group: u32) -> Range<u32> {
        let start = (self.samples.start / self.group + group) * self.group;
        start.max(self.samples.start)..start.saturating_add(self.group).min(self.samples.end)
    }
}

/// Rays, counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Rays {
    /// Of all kinds: one from the camera for each sample, those that a path goes on with, and shadow rays.
    pub all: u32,
    /// Shadow rays among them.
    pub shadow: u32,
}

impl std::ops::AddAssign for Rays {
    fn add_assign(&mut self, more: Rays) {
        self.all += more.all;
        self.shadow += more.shadow;
    }
}

/// The sum over one group of samples of one pixel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PixelSum {
    /// Radiance of the samples that are finite, added up in linear RGB.
    pub radiance: [f64; 3],
    /// Rays that were traced for it.
    pub rays: Rays,
    /// Samples that were not finite and are left out.
    pub dropped: u32,
    /// Samples whose camera ray met nothing; counted only where the picture is to have alpha.
    pub missed: u32,
}

/// A sample with a larger radiance counts as not finite: sums of such would soon exceed `f32`.
pub const MOST_RADIANCE: f64 = 1e36;

/// One sample of one pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SampleId {
    /// Index of the pixel, `y * width + x`.
    pub pixel: u32,
    /// Number of the sample.
    pub sample: u32,
}
