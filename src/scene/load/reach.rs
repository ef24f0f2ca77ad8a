//! How far coordinates may reach.

use crate::scene::Scene;
use crate::{Error, Result};

/// World coordinates beyond this are refused: their squares would leave the range of `f32`.
pub(super) const LARGEST_COORDINATE: f64 = 1e18;

/// Refuses a scene that reaches too far.
///
/// # Errors
/// [`Error::Scene`], with the largest coordinate.
pub(super) fn check(scene: &Scene) -> Result<()> {
    let (low, high) = scene.world_bounds();
    let largest = (low + scene.origin).abs().max((high + scene.origin).abs()).max_element();
    if largest > LARGEST_COORDINATE {
        let message = format!("a coordinate of {largest:e} is too large; scale the scene to stay within 1e18");
        return Err(Error::scene(&scene.path, message));
    }
    Ok(())
}
