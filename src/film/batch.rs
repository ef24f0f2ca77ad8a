//! Work for a tracer, and what comes back from it.

use crate::sampling::PARTS;
use std::iter::StepBy;
use std::ops::Range;

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
/// A group holds samples of one of the [`PARTS`] into which the samples fall, which are `PARTS` apart: group `g` those from
/// `samples.start + g / PARTS * PARTS * group + g % PARTS`, at most `group` of them and none past `samples.end`.
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
        let stride = u64::from(self.group) * u64::from(PARTS);
        let samples = u64::from(self.samples.end - self.samples.start);
        (samples / stride * u64::from(PARTS) + (samples % stride).min(u64::from(PARTS))) as u32
    }

    /// The samples of a group.
    pub fn group_samples(&self, group: u32) -> StepBy<Range<u32>> {
        let stride = self.group.saturating_mul(PARTS);
        let start = self.samples.start + group / PARTS * stride;
        let end = start.saturating_add(stride).min(self.samples.end);
        (start + group % PARTS..end).step_by(PARTS as usize)
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
