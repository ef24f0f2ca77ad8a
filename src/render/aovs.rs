//! What the camera sees first, over a whole film.

use super::tracer::Tracer;
use crate::Result;
use crate::film::{Aovs, Tile};
use std::sync::atomic::{AtomicBool, Ordering};

/// Camera rays of a pixel for its AOVs: enough for edges, and few against those of a picture.
const AOV_SAMPLES: u32 = 64;

/// What the camera sees first, in the first samples of a render, at most 64. None if `stop` was set before all pixels were done.
///
/// # Errors
/// If the device fails.
pub fn aovs(
    tracer: &mut dyn Tracer,
    (width, height): (u32, u32),
    samples: u32,
    stop: &AtomicBool,
) -> Result<Option<Aovs>> {
    let samples = samples.min(AOV_SAMPLES);
    let mut sums = Vec::with_capacity(width as usize * height as usize);
    // Pieces as short as a batch of a path tracer, by rule of thumb.
    let pixels = (tracer.max_sums() / 2).clamp(1, 1 << 16);
    let rows = (pixels / width.max(1) as usize).max(1) as u32;
    for y in (0..height).step_by(rows as usize) {
        // A row may be longer than a piece; then its pieces follow each other.
        let columns = if rows == 1 { width.min(pixels as u32) } else { width };
        for x in (0..width).step_by(columns.max(1) as usize) {
            if stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let tile = Tile { x, y, width: columns.min(width - x), height: rows.min(height - y) };
            sums.extend(tracer.aovs(tile, 0..samples)?);
        }
    }
    Ok(Some(Aovs { samples, sums }))
}
