//! How much of the light that falls on microfacets of two widths (brushed metal) does not leave them at once: what [`albedo_table`](super::albedo_table) says of those
//! of one width.
//!
//! Directions are stretched as the microfacets are: so all that is far longer than wide is alike but for a scale, and few numbers are enough.
//! The table is made by `examples/albedo_table.rs` and kept beside this file: half floats, little-endian. Between its numbers all is linear.

use glam::DVec3;
use half::f16;
use std::sync::LazyLock;

/// Numbers along the axes of what is missing: width along, ratio of the widths, azimuth, tilt.
pub const ALONG: usize = 16;
/// The second of these.
pub const RATIOS: usize = 6;
/// The third of these.
pub const AROUND: usize = 5;
/// The fourth of these.
pub const TILTS: usize = 24;
/// Numbers along the axes of its means, twice as dense: width along, ratio.
pub const MEANS_ALONG: usize = 2 * ALONG - 1;
/// The second of these.
pub const MEANS_RATIOS: usize = 2 * RATIOS - 1;

/// The numbers of the file.
pub struct BrushedTable {
    /// `[along][ratio][around][tilt]`: the root of what is missing to 1.
    pub missing: Vec<f64>,
    /// `[along][ratio]`: its mean over directions in proportion to their cosine, over the square of the width along.
    pub missing_average: Vec<f64>,
}

/// The table.
pub static BRUSHED: LazyLock<BrushedTable> = LazyLock::new(|| BrushedTable::new(include_bytes!("brushed_table.bin")));

/// The place on its axes, each from 0 to 1, of a direction above microfacets of these widths, the first the larger one.
pub fn brushed_place([along, across]: [f64; 2], w: DVec3) -> [f64; 4] {
    let ratio = across / along;
    let (x, y) = (w.x * w.x, (w.y * ratio).powi(2));
    let length = (w.z * w.z + x + y).sqrt();
    // One less the square of the steepness of a direction that is stretched by the ratio.
    let square = (along * (x + y) / ((length + w.z) * (w.z + along * length))).min(1.0);
    let tilt = (square / (1.0 + (1.0 - square).sqrt())).sqrt();
    [along.sqrt(), ratio, if x + y > 0.0 { y / (x + y) } else { 0.0 }, tilt]
}

/// A direction at the last two of these.
pub fn direction_of_place([along, across]: [f64; 2], around: f64, tilt: f64) -> DVec3 {
    let steep2 = (1.0 - tilt * tilt).powi(2).max(1e-12);
    let cosine = (steep2 * along / (1.0 + along - steep2)).min(1.0);
    let sine = (1.0 - cosine * cosine).sqrt();
    DVec3::new(sine * (1.0 - around).sqrt(), sine * around.sqrt() * along / across, cosine).normalize()
}

/// Linear between the numbers of a table with `N` axes of these lengths, the last of which is the closest together.
fn between<const N: usize>(numbers: &[f64], lengths: [usize; N], place: [f64; N]) -> f64 {
    let mut sum = 0.0;
    for corner in 0..1usize << N {
        let (mut at, mut weight) = (0, 1.0);
        for axis in 0..N {
            let x = place[axis].clamp(0.0, 1.0) * (lengths[axis] - 1) as f64;
            let before = (x as usize).min(lengths[axis] - 2);
            let behind = corner >> axis & 1;
            at = at * lengths[axis] + before + behind;
            weight *= if behind == 1 { x - before as f64 } else { 1.0 - (x - before as f64) };
        }
        sum += weight * numbers[at];
    }
    sum
}

impl BrushedTable {
    /// From the bytes of the file.
    fn new(bytes: &[u8]) -> Self {
        let mut numbers = bytes.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f64());
        let mut take = |n: usize| -> Vec<f64> { numbers.by_ref().take(n).collect() };
        BrushedTable {
            missing: take(ALONG * RATIOS * AROUND * TILTS),
            missing_average: take(MEANS_ALONG * MEANS_RATIOS),
        }
    }

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        self.missing
            .iter()
            .chain(&self.missing_average)
            .flat_map(|number| f16::from_f64(*number).to_le_bytes())
            .collect()
    }

    /// Share of the light that microfacets which reflect all do not send away at once towards `w`; their widths are along x and y, the larger first.
    pub fn missing(&self, widths: [f64; 2], w: DVec3) -> f64 {
        between(&self.missing, [ALONG, RATIOS, AROUND, TILTS], brushed_place(widths, w)).powi(2)
    }

    /// The mean of that over directions in proportion to their cosine.
    pub fn missing_average(&self, [along, across]: [f64; 2]) -> f64 {
        let place = [along.sqrt(), across / along];
        between(&self.missing_average, [MEANS_ALONG, MEANS_RATIOS], place) * along * along
    }
}
