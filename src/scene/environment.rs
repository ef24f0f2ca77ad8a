//! Light from where rays escape to: which direction is chosen, and with which density.

use crate::sampling::Cdf;
use glam::Vec3;
use std::f64::consts::PI;
use std::sync::Arc;

/// Light from infinitely far away in all directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// Radiance, or a factor to the image.
    pub radiance: Vec3,
    /// The image; none: the same from everywhere.
    pub image: Option<Arc<EnvironmentImage>>,
    /// Degrees by which the image is turned about +y, counter-clockwise seen from above.
    pub rotation: f32,
}

impl Environment {
    /// Whether any light comes from it.
    pub fn emits(&self) -> bool {
        let emits = |texel: &Vec3| *texel * self.radiance != Vec3::ZERO;
        self.image.as_ref().map_or(self.radiance != Vec3::ZERO, |image| image.texels.iter().any(emits))
    }
}

/// A latitude-longitude image: the upper edge is +y, the middle is -z, the right half is +x.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentImage {
    /// A name for messages: the file name.
    pub name: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Linear RGB from the upper left, row by row; not negative, finite, not all zero.
    pub texels: Vec<Vec3>,
}

/// Texels of an environment, one of which is chosen by the light that comes from it; a constant environment is one texel.
#[derive(Debug, Clone)]
pub struct EnvironmentDistribution {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Chooses a row.
    pub rows: Cdf,
    /// For each row, chooses a column.
    pub columns: Vec<Cdf>,
    /// What of the radiance is sampled, integrated over all directions and averaged over the channels.
    pub sampled: f64,
}

/// A sky whose radiance is off its mean by less than this (the root of the mean square, as a share of the mean) is as one of a single colour.
const LEAST_CONTRAST: f64 = 0.1;

impl EnvironmentDistribution {
    /// The distribution of an environment, where paths that escape find its light too, and `left_to_them` of its mean radiance is left to them
    /// alone: 0 is in proportion to the radiance, 1 to what is above the mean. None if it is black, or nothing above the mean is worth a ray.
    ///
    /// By the power heuristic whatever paths find well is found twice, so that it does not help to sample it; what they find badly is (Karlik et al.,
    /// "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", 2019).
    pub fn new(environment: &Environment, left_to_them: f64) -> Option<Self> {
        let (width, height) = environment.image.as_ref().map_or((1, 1), |image| (image.width, image.height));
        let factor = environment.radiance.as_dvec3();
        let mut weights: Vec<f64> = match &environment.image {
            None => vec![factor.element_sum() / 3.0],
            Some(image) => smoothed(image, |texel| (texel.as_dvec3() * factor).element_sum() / 3.0),
        };
        // Of a function of the weights, over the directions of each row.
        let rows = |weights: &[f64], of: &dyn Fn(f64) -> f64| -> Vec<f64> {
            let rows = weights.chunks_exact(width as usize).zip(0..);
            rows.map(|(row, y)| row.iter().map(|w| of(*w)).sum::<f64>() * texel_solid_angle(width, height, y)).collect()
        };
        let mut light = rows(&weights, &|weight| weight);
        let total: f64 = light.iter().sum();
        if total <= 0.0 {
            return None;
        }
        if left_to_them > 0.0 {
            let mean = total / (4.0 * PI);
            let square = rows(&weights, &|weight| (weight / mean - 1.0).powi(2)).iter().sum::<f64>() / (4.0 * PI);
            if left_to_them >= 1.0 && square < LEAST_CONTRAST.powi(2) {
                return None;
            }
            weights.iter_mut().for_each(|weight| *weight = (*weight - left_to_them * mean).max(0.0));
            light = rows(&weights, &|weight| weight);
        }
        let columns = weights.chunks_exact(width as usize).map(Cdf::new).collect();
        let sampled = light.iter().sum();
        Some(EnvironmentDistribution { width, height, rows: Cdf::new(&light), columns, sampled })
    }

    /// Column and row of the texel that two random numbers choose, and how far from its left and its upper edge they fall: the first number
    /// goes down, the second one to the right.
    pub fn choose(&self, [down, right]: [u32; 2]) -> ([u32; 2], [f64; 2]) {
        let (row, v) = self.rows.choose(down);
        let (column, u) = self.columns[row].choose(right);
        ([column as u32, row as u32], [u, v])
    }

    /// Density of a texel's directions, per steradian: exactly that of [`EnvironmentDistribution::choose`]. Within a texel they are even over
    /// the solid angle.
    pub fn density(&self, [column, row]: [u32; 2]) -> f64 {
        let probability = self.rows.probability(row as usize) * self.columns[row as usize].probability(column as usize);
        probability / texel_solid_angle(self.width, self.height, row)
    }
}

/// Solid angle of a texel of a row: `2 pi / width * (cos of the upper edge - cos of the lower edge)`, without the cancellation.
fn texel_solid_angle(width: u32, height: u32, row: u32) -> f64 {
    let step = PI / f64::from(height);
    let middle = (f64::from(row) + 0.5) * step;
    2.0 * PI / f64::from(width) * 2.0 * middle.sin() * (0.5 * step).sin()
}

/// The mean over each texel's square of the image's `brightness` as it is looked up, which is bilinear: a direction that carries
/// light can then never have the density zero. Columns wrap around, rows end at the poles. `brightness` is linear, so it does not
/// matter that it is taken first, and one number a texel is all the memory that is needed.
fn smoothed(image: &EnvironmentImage, brightness: impl Fn(&Vec3) -> f64) -> Vec<f64> {
    let (width, height) = (image.width as usize, image.height as usize);
    let mut texels: Vec<f64> = image.texels.iter().map(brightness).collect();
    for row in texels.chunks_exact_mut(width) {
        let (first, mut left) = (row[0], row[width - 1]);
        for x in 0..width {
            let (here, right) = (row[x], row.get(x + 1).copied().unwrap_or(first));
            row[x] = 0.125 * (left + right) + 0.75 * here;
            left = here;
        }
    }
    // The row above as it was; above the first one is itself.
    let mut above = texels[..width].to_vec();
    for y in 0..height {
        let below = (y + 1).min(height - 1) * width;
        for x in 0..width {
            let here = texels[y * width + x];
            texels[y * width + x] = 0.125 * (above[x] + texels[below + x]) + 0.75 * here;
            above[x] = here;
        }
    }
    texels
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the nine texels' weights written out.
    #[test]
    fn a_texel_is_smoothed_with_its_neighbours() {
        for (width, height) in [(1, 1), (1, 3), (2, 1), (2, 2), (3, 2), (5, 4)] {
            let texels =
                (0..width * height).map(|i| Vec3::new((i * 7 % 11) as f32, (i * 5 % 7) as f32, (i % 3) as f32));
            let image = EnvironmentImage { name: String::new(), width, height, texels: texels.collect() };
            let brightness = |texel: &Vec3| texel.as_dvec3().dot(glam::DVec3::new(0.5, 2.0, 1.0));
            let found = smoothed(&image, brightness);
            assert_eq!(found.len(), image.texels.len());
            for (i, found) in (0..).zip(found) {
                let (x, y) = (i % width, i / width);
                let columns = [((x + width - 1) % width, 0.125), (x, 0.75), ((x + 1) % width, 0.125)];
                let rows = [(y.saturating_sub(1), 0.125), (y, 0.75), ((y + 1).min(height - 1), 0.125)];
                let mut expected = 0.0;
                for (column, a) in columns {
                    for (row, b) in rows {
                        expected += a * b * brightness(&image.texels[(row * width + column) as usize]);
                    }
                }
                assert!((found - expected).abs() < 1e-12, "{width} x {height}, texel {i}: {found} {expected}");
            }
        }
    }
}
