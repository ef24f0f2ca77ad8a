//! Images on surfaces.

use glam::{Affine2, DVec3};
use half::f16;
use std::sync::Arc;

/// An image on surfaces, bilinear between texel centres.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Texture {
    /// A name for messages: the file name.
    pub name: String,
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// Linear RGB and alpha, from the upper left, row by row; not negative, finite. Half floats: both tracers see these very
    /// numbers (11 bits; 8-bit sRGB loses at most 0.05 %). Shared by textures that show the same image in other places.
    pub texels: Arc<Vec<[f16; 4]>>,
    /// Coordinates outside [0, 1] stay at the border instead of repeating (`-clamp on`).
    pub clamp: bool,
    /// From the mesh's texture coordinates to the image's, whose origin is its lower left corner (`-s`, `-o`).
    pub transform: Affine2,
}

impl Texture {
    /// The mean of the colours, unweighted by alpha.
    pub fn mean(&self) -> DVec3 {
        let sum: DVec3 = self.texels.iter().map(|[r, g, b, _]| DVec3::new(r.to_f64(), g.to_f64(), b.to_f64())).sum();
        sum / self.texels.len() as f64
    }
}
