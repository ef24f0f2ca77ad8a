//! A tracer that fails on purpose, for tests of what happens then.

use luminaire::film::{AovSum, Batch, Tile};
use luminaire::render::{Traced, Tracer};
use luminaire::{Error, Result};
use std::ops::Range;

/// A tracer that reports a lost device after as many batches as the environment variable LUMINAIRE_LOSE_DEVICE_AFTER says.
pub struct FailingTracer<'a> {
    tracer: &'a mut dyn Tracer,
    batches_left: Option<u64>,
}

impl<'a> FailingTracer<'a> {
    /// Without the variable it never fails. A usage error if the variable is not a number.
    pub fn new(tracer: &'a mut dyn Tracer) -> Result<Self> {
        const NAME: &str = "LUMINAIRE_LOSE_DEVICE_AFTER";
        let batches_left = match std::env::var(NAME) {
            Ok(text) => {
                Some(text.parse().map_err(|_| Error::Usage(format!("{NAME}={text}: expected a number of batches")))?)
            }
            Err(_) => None,
        };
        Ok(FailingTracer { tracer, batches_left })
    }
}

impl Tracer for FailingTracer<'_> {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        match &mut self.batches_left {
            Some(0) => Err(Error::Vulkan {
                call: "vkQueueSubmit",
                device: "the device".into(),
                reason: "the device is lost (as LUMINAIRE_LOSE_DEVICE_AFTER asks)".into(),
            }),
            Some(left) => {
                *left -= 1;
                self.tracer.trace(batch)
            }
            None => self.tracer.trace(batch),
        }
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        self.tracer.aovs(tile, samples)
    }

    fn max_sums(&self) -> usize {
        self.tracer.max_sums()
    }

    fn batch_seconds(&self) -> f64 {
        self.tracer.batch_seconds()
    }
}
