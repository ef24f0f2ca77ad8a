//! A checkpoint or part of a render of any bytes is read, or refused; what is read can be merged, estimated and gone on from.
#![no_main]

#[path = "../common/folder.rs"]
mod folder;

use luminaire::film::{AovSum, Batch, PixelSum, Tile};
use luminaire::render::{Limits, Traced, Tracer, resume};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Sees nothing.
struct Dark;

const MAX_SUMS: usize = 1 << 20;

impl Tracer for Dark {
    fn trace(&mut self, batch: &Batch) -> luminaire::Result<Traced> {
        let sums = batch.tile.pixels() * batch.groups() as usize;
        assert!(sums <= MAX_SUMS);
        Ok(Traced { sums: vec![PixelSum::default(); sums], ..Traced::default() })
    }

    fn aovs(&mut self, tile: Tile, _: Range<u32>) -> luminaire::Result<Vec<AovSum>> {
        Ok(vec![AovSum::default(); tile.pixels()])
    }

    fn max_sums(&self) -> usize {
        MAX_SUMS
    }

    fn batch_seconds(&self) -> f64 {
        0.01
    }
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = folder::write("part.exr", bytes);
    if let Ok((rendered, _)) = luminaire::part::read(&path) {
        assert_eq!(rendered.film.pixels(), rendered.film.width as usize * rendered.film.height as usize);
        rendered.film.error();
        rendered.film.to_linear();
        let (stop, batches) = (AtomicBool::new(false), AtomicU32::new(0));
        let limits = Limits { noise: Some(0.1), ..Limits::default() };
        let mut watch = |_: &_| stop.store(batches.fetch_add(1, Ordering::Relaxed) > 3, Ordering::Relaxed);
        resume(&mut Dark, rendered, limits, &mut watch, &stop);
    }
    let _ = luminaire::part::merge(&[path.clone(), path]);
});
