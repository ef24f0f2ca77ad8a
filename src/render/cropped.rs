//! A part of a picture as a film of its own.

use super::tracer::{Traced, Tracer};
use crate::Result;
use crate::film::{AovSum, Batch, Tile};
use crate::picture::Crop;
use std::ops::Range;

/// Traces a part of a tracer's picture, as if it were the whole: the pixels are the same to the last bit, since random numbers follow from a pixel's place in
/// the whole picture. Samples that are left out are named by that place, too.
pub struct Cropped<'a> {
    tracer: &'a mut dyn Tracer,
    /// The upper left pixel.
    corner: (u32, u32),
}

impl<'a> Cropped<'a> {
    /// The part of the picture that `crop` says; without one, all of it.
    pub fn new(tracer: &'a mut dyn Tracer, crop: Option<&Crop>) -> Self {
        Cropped { tracer, corner: crop.map_or((0, 0), |crop| (crop.x, crop.y)) }
    }

    fn in_whole(&self, tile: Tile) -> Tile {
        Tile { x: tile.x + self.corner.0, y: tile.y + self.corner.1, ..tile }
    }
}

impl Tracer for Cropped<'_> {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        let batch = Batch { tile: self.in_whole(batch.tile), ..batch.clone() };
        self.tracer.trace(&batch)
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        self.tracer.aovs(self.in_whole(tile), samples)
    }

    fn max_sums(&self) -> usize {
        self.tracer.max_sums()
    }

    fn batch_seconds(&self) -> f64 {
        self.tracer.batch_seconds()
    }
}
