//! A case, measured by a backend.

use super::case::{Case, Measured, View};
use super::dielectrics::any_scene;
use crate::Workbench;
use crate::statistics::Estimate;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::gpu::probe::{Call, Function};
use luminaire::reference::impulse::fresnel;
use luminaire::{Error, Result};

/// Groups of samples from whose spread the error follows.
const GROUPS: u32 = 16;
/// Samples a pixel in one batch; a multiple of [`GROUPS`].
const MOST_AT_ONCE: u32 = 1024;

/// Runs a case on a backend, with `samples` a pixel for each of its efforts.
///
/// # Errors
/// If the backend is not here or fails.
pub fn measure(bench: &Workbench, case: &Case, backend: Backend, seed: u32, samples: u32) -> Result<Estimate> {
    match &case.measured {
        Measured::Estimated(views) => {
            let (mut mean, mut variance) = (0.0, 0.0);
            for (index, view) in (0u32..).zip(views) {
                let found = picture(bench, view, backend, seed * 16 + index, samples * case.effort)?;
                mean += found.mean;
                variance += found.error * found.error;
            }
            Ok(Estimate { mean, error: variance.sqrt() })
        }
        Measured::Certain { view, .. } => picture(bench, view, backend, seed, GROUPS),
        Measured::Reflectance { eta, angle, .. } => {
            let mean = if backend == Backend::Cpu {
                fresnel(*eta, angle.cos())
            } else {
                reflectance_on_the_device(bench, backend, *eta, *angle)?
            };
            Ok(Estimate { mean, error: 0.0 })
        }
    }
}

/// The weighted mean of a picture. Its pixels' samples are independent, its channels are the same.
fn picture(bench: &Workbench, view: &View, backend: Backend, seed: u32, samples: u32) -> Result<Estimate> {
    let mut scene = view.scene.clone();
    scene.settings.seed = seed;
    let mut tracer = bench.tracer(&scene, backend)?;
    let tile = Tile { x: 0, y: 0, width: scene.film.width, height: scene.film.height };
    let mut means = vec![Vec::new(); tile.pixels()];
    let mut done = 0;
    while done < samples {
        // In batches that no driver takes for a hang.
        let part = (samples - done).min(MOST_AT_ONCE);
        let group = part.div_ceil(GROUPS);
        let traced = tracer.trace(&Batch { tile, samples: done..done + part, group })?;
        if !traced.dropped.is_empty() {
            return Err(Error::scene(&scene.path, format!("{} samples are not finite", traced.dropped.len())));
        }
        for (i, sum) in traced.sums.iter().enumerate() {
            means[i % tile.pixels()].push(sum.radiance.iter().sum::<f64>() / 3.0 / f64::from(group));
        }
        done += part;
    }
    let pixels: Vec<Estimate> = means.into_iter().map(|pixel| Estimate::new(pixel.into_iter())).collect();
    let factor = view.weight / tile.pixels() as f64;
    let variance: f64 = pixels.iter().map(|pixel| pixel.error * pixel.error).sum();
    let mean: f64 = pixels.iter().map(|pixel| pixel.mean).sum();
    Ok(Estimate { mean: factor * mean, error: factor * variance.sqrt() })
}

/// What the kernel's own function says.
fn reflectance_on_the_device(bench: &Workbench, backend: Backend, eta: f64, angle: f64) -> Result<f64> {
    let probe = bench.probe(&any_scene(), backend)?;
    let wo = [angle.sin() as f32, 0.0, angle.cos() as f32, eta as f32].map(f32::to_bits);
    let call: Call = [wo, [0; 4]];
    let [result, _] = probe.call(Function::Refract, &[call])?[0];
    Ok(f64::from(f32::from_bits(result[3])))
}
