//! Glass in white light from everywhere, whose mean is known: what the sweeps over glass look at.

use crate::Workbench;
use crate::statistics::Estimate;
use glam::Vec3;
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::scene::build::{estimator, matte, pinhole};
use luminaire::scene::{Environment, Extinction, Material, Scene};

/// Glass that absorbs nothing.
pub(super) fn glass(eta: f64) -> Material {
    Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(eta as f32), ..matte(Vec3::ZERO) }
}

/// What was seen of glass in white light from everywhere.
pub(super) struct AroundGlass {
    /// Mean radiance over the picture.
    pub(super) mean: f64,
    /// Its standard error.
    pub(super) error: f64,
    /// Share of the paths that found the light before they were cut off.
    pub(super) ended: f64,
    /// Rays of the longest path.
    pub(super) longest: u32,
}

/// Looks from some point to the origin, with paths that only the number of bounces ends.
pub(super) fn around_glass(
    bench: &Workbench,
    scene: &mut Scene,
    backend: Backend,
    bounces: u32,
    samples: u32,
    from: Vec3,
) -> Result<AroundGlass> {
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    scene.sensor = pinhole(from, Vec3::ZERO, Vec3::Y, 50.0);
    estimator(scene).extinction = Extinction::Off;
    estimator(scene).max_bounces = Some(bounces);
    let (width, height) = (scene.film.width, scene.film.height);
    let tile = Tile { x: 0, y: 0, width, height };
    let traced = bench.tracer(scene, backend)?.trace(&Batch { tile, samples: 0..samples, group: 1 })?;
    let Estimate { mean, error } = Estimate::new(traced.sums.iter().map(|sum| sum.radiance[0]));
    let ended = traced.sums.iter().filter(|sum| sum.radiance[0] > 0.0).count() as f64 / traced.sums.len() as f64;
    Ok(AroundGlass { mean, error, ended, longest: traced.sums.iter().map(|sum| sum.rays.all).max().unwrap_or(0) })
}
