//! Which direction of the environment is chosen, and with which density.

use super::{Environment, EnvironmentImage};
use crate::sampling::AliasTable;
use glam::DVec3;
use std::f64::consts::PI;

/// Texels of an environment, one of which is chosen by the light that comes from it; a constant environment is one texel.
#[derive(Debug, Clone)]
pub struct EnvironmentDistribution {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Chooses a texel, row by row from the upper left.
    pub choice: AliasTable,
    /// Density of each texel's directions, per steradian; within a texel they are even over the solid angle.
    pub density: Vec<f64>,
    /// Radiance integrated over all directions, averaged over the channels.
    pub total: f64,
}

impl EnvironmentDistribution {
    /// The distribution of an environment; none if it is black.
    pub fn new(environment: &Environment) -> Option<Self> {
        let (width, height) = environment.image.as_ref().map_or((1, 1), |image| (image.width, image.height));
        let factor = environment.radiance.as_dvec3();
        let mean: Vec<f64> = match &environment.image {
            None => vec![factor.element_sum() / 3.0],
            Some(image) => {
                smoothed(image).into_iter().map(|radiance| (radiance * factor).element_sum() / 3.0).collect()
            }
        };
        let solid_angle = |texel: usize| texel_solid_angle(width, height, texel as u32 / width);
        let weights: Vec<f64> = mean.iter().enumerate().map(|(texel, mean)| mean * solid_angle(texel)).collect();
        let total: f64 = weights.iter().sum();
        if total <= 0.0 {
            return None;
        }
        let choice = AliasTable::new(&weights);
        let density = choice.pdf.iter().enumerate().map(|(texel, pdf)| pdf / solid_angle(texel)).collect();
        Some(EnvironmentDistribution { width, height, choice, density, total })
    }
}

/// Solid angle of a texel of a row: `2 pi / width * (cos of the upper edge - cos of the lower edge)`, without the cancellation.
fn texel_solid_angle(width: u32, height: u32, row: u32) -> f64 {
    let step = PI / f64::from(height);
    let middle = (f64::from(row) + 0.5) * step;
    2.0 * PI / f64::from(width) * 2.0 * middle.sin() * (0.5 * step).sin()
}

/// The mean over each texel's square of the image as it is looked up, which is bilinear: a direction that carries light can then
/// never have the density zero. Columns wrap around, rows end at the poles.
fn smoothed(image: &EnvironmentImage) -> Vec<DVec3> {
    let (width, height) = (image.width as usize, image.height as usize);
    let texel = |x: usize, y: usize| image.texels[y * width + x].as_dvec3();
    let row: Vec<DVec3> = (0..width * height)
        .map(|i| {
            let (x, y) = (i % width, i / width);
            0.125 * (texel((x + width - 1) % width, y) + texel((x + 1) % width, y)) + 0.75 * texel(x, y)
        })
        .collect();
    (0..width * height)
        .map(|i| {
            let (x, y) = (i % width, i / width);
            let (up, down) = (y.saturating_sub(1), (y + 1).min(height - 1));
            0.125 * (row[up * width + x] + row[down * width + x]) + 0.75 * row[i]
        })
        .collect()
}
