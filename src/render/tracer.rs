//! `Tracer`, `SceneTracer`: what the loop asks of whoever traces.

use crate::Result;
use crate::film::{AovSum, Batch, PixelSum, SampleId, Tile};
use crate::scene::{FilmSettings, Integrator, Sensor};
use std::ops::Range;

/// What a tracer gives back for a [`Batch`].
#[derive(Debug, Clone, Default)]
pub struct Traced {
    /// One sum a pixel and group: group by group, in each the tile's rows from the top.
    pub sums: Vec<PixelSum>,
    /// Some of the samples that were not finite and are left out; none in a sound scene.
    pub dropped: Vec<SampleId>,
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

    /// What the camera rays of these samples hit first, for every pixel of a tile of at most [`Tracer::max_sums`] / 2 pixels; rows from the
    /// top.
    ///
    /// # Errors
    /// If the device fails.
    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>>;

    /// The most sums (pixels times groups) that one batch may ask for; at least [`GROUPS_IN_TURN`](crate::film::GROUPS_IN_TURN).
    fn max_sums(&self) -> usize;

    /// How many seconds one batch should take: short on a GPU that also draws a desktop.
    fn batch_seconds(&self) -> f64;
}

/// A tracer of a whole scene that can be changed: then it is as if it had been opened with what is new, but what rays are traced against stays, which
/// is most of the work.
pub trait SceneTracer: Tracer {
    /// Looks at the scene from elsewhere, or with another film. The kind of projection has to be the one that it was opened with.
    ///
    /// # Errors
    /// If the device fails.
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()>;

    /// Takes another integrator.
    ///
    /// # Errors
    /// If its paths never end, or the device fails.
    fn integrate(&mut self, integrator: &Integrator) -> Result<()>;
}
