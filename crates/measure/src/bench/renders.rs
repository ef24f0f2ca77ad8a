//! Renders with a clock beside them.

use crate::Workbench;
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::picture::Picture;
use luminaire::render::{End, Limits, Rendered, Tracer, render};
use luminaire::scene::Scene;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The first samples of a tracer, which may compile shaders.
pub(super) fn warm_up(tracer: &mut dyn Tracer, scene: &Scene) -> Result<()> {
    let tile = Tile { x: 0, y: 0, width: scene.film.width.min(8), height: scene.film.height.min(8) };
    tracer.trace(&Batch { tile, samples: 0..4, group: 1 }).map(drop)
}

/// What a tracer takes before it renders.
#[derive(Debug, Clone, Copy)]
pub(super) struct Preparation {
    /// Seconds to build it.
    pub build_seconds: f64,
    /// Seconds from the scene to the first samples, building included.
    pub ready_seconds: f64,
    /// Bytes of device memory that it holds; none for the CPU.
    pub device_bytes: Option<u64>,
}

impl Preparation {
    /// Builds a tracer of a scene and renders its first samples.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn measure(bench: &Workbench, scene: &Scene, backend: Backend) -> Result<Self> {
        let before = bench.allocated_bytes(backend);
        let start = Instant::now();
        let mut tracer = bench.tracer(scene, backend)?;
        let build_seconds = start.elapsed().as_secs_f64();
        let device_bytes = bench.allocated_bytes(backend).zip(before).map(|(now, before)| now.saturating_sub(before));
        warm_up(tracer.as_mut(), scene)?;
        Ok(Preparation { build_seconds, ready_seconds: start.elapsed().as_secs_f64(), device_bytes })
    }
}

/// A whole render of `spp` samples a pixel.
pub(super) fn render_samples(tracer: &mut dyn Tracer, scene: &Scene, spp: u32) -> Result<Rendered> {
    let limits = Limits { spp: Some(spp), ..Limits::default() };
    let size = (scene.film.width, scene.film.height);
    let rendered = render(tracer, size, limits, &mut |_| {}, &AtomicBool::new(false))?;
    match rendered.end {
        End::Failed(error) => Err(error),
        _ => Ok(rendered),
    }
}

/// The means of the pixels.
pub(super) fn picture(rendered: &Rendered) -> Picture {
    let film = &rendered.film;
    let rgb = (0..film.pixels()).map(|pixel| film.mean(pixel).map(|v| v as f32)).collect();
    Picture { width: film.width, height: film.height, rgb, error: None, clamped: false, warnings: vec![] }
}
