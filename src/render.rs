//! The progressive loop: batches, limits (samples, time), progress, cancellation.

use crate::Result;
use crate::film::{Batch, PixelSum};

/// What a tracer gives back for a [`Batch`].
#[derive(Debug, Clone, Default)]
pub struct Traced {
    /// One sum a pixel and group: group by group, in each the tile's rows from the top.
    pub sums: Vec<PixelSum>,
    /// Samples that were not finite and count as black; zero in a sound scene.
    pub non_finite: u32,
    /// Seconds that the device was busy by its own clock, if it has one.
    pub device_seconds: Option<f64>,
}

/// Something that turns random numbers into radiance.
pub trait Tracer {
    /// Traces a batch. The result depends on the batch's pixels, samples and grouping alone, never on what ran before.
    ///
    /// # Errors
    /// If the device fails.
    fn trace(&mut self, batch: &Batch) -> Result<Traced>;

    /// The most sums (pixels times groups) that one batch may ask for.
    fn max_sums(&self) -> usize;

    /// How many seconds one batch should take: short on a GPU that also draws a desktop.
    fn batch_seconds(&self) -> f64;
}
