//! How much of the light that falls on microfacets of two widths (brushed metal) does not leave them at once: what [`albedo_table`](super::albedo_table) says of those
//! of one width.
//!
//! For these, directions are stretched as the microfacets are: so all that is far longer than wide is alike but for a scale, and few numbers are enough.
//! The table is made by `examples/albedo_table.rs` and kept beside this file: half floats, little-endian. Between its numbers all is linear.

use super::albedo_table::{DielectricAlbedo, TABLE, bent, cosine_of_steepness};
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

/// Numbers along the axes of what dielectrics do: index, width along, ratio of the widths, tilt aside, tilt.
pub const BRUSHED_INDICES: usize = 6;
/// The second of these.
pub const BRUSHED_ALONG: usize = 8;
/// The third of these.
pub const BRUSHED_RATIOS: usize = 6;
/// The fourth of these.
pub const BRUSHED_ASIDE: usize = 8;
/// The fifth of these.
pub const BRUSHED_TILTS: usize = 12;
/// Numbers of one index.
pub const BRUSHED_ROW: usize = BRUSHED_ALONG * BRUSHED_RATIOS * BRUSHED_ASIDE * BRUSHED_TILTS;
/// What leaves a brushed dielectric at least that is seen from inside.
pub const LEAST_INSIDE: f64 = 0.05;

/// The numbers of the file.
pub struct BrushedTable {
    /// `[along][ratio][around][tilt]`: the root of what is missing to 1.
    pub missing: Vec<f64>,
    /// `[along][ratio]`: its mean over directions in proportion to their cosine, over the square of the width along.
    pub missing_average: Vec<f64>,
    /// `[index][along][ratio][aside][tilt]`: what becomes of light at a dielectric, less what becomes of it at a round one of [`seen_width`]; in the order of
    /// [`DielectricAlbedo`].
    pub dielectric: Vec<[f64; 4]>,
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

/// The width of round microfacets that are most like these, seen from `w`: in the plane of view as wide.
pub fn seen_width([along, across]: [f64; 2], w: DVec3) -> f64 {
    let (x, y) = (along * w.x, across * w.y);
    (x * x + y * y + 0.5 * w.z * w.z * (along * along + across * across)).sqrt().min(1.0)
}

/// The root of one less the steepness of a cosine, of which `rest` is missing to 1.
fn tilt(cosine: f64, rest: f64, alpha: f64) -> f64 {
    let square = (alpha * rest / (cosine + alpha)).clamp(0.0, 1.0);
    (square / (1.0 + (1.0 - square).sqrt())).sqrt()
}

/// The place on the axes of what dielectrics do, but for the index: the direction is taken apart into what is along y, where the microfacets are narrower, and
/// the angle in the plane across.
pub fn brushed_dielectric_place([along, across]: [f64; 2], w: DVec3) -> [f64; 4] {
    let beside = w.x.hypot(w.z);
    let aside = tilt(beside, w.y * w.y / (1.0 + beside), along);
    [along.sqrt(), (across / along).sqrt(), aside, tilt(w.z / beside, w.x * w.x / (beside * (beside + w.z)), along)]
}

/// A direction at the last two of these.
pub fn direction_of_dielectric_place(along: f64, aside: f64, tilt: f64) -> DVec3 {
    let cosine = |tilt: f64| cosine_of_steepness(1.0 - tilt * tilt, along).clamp(1e-5 * along, 1.0);
    let (beside, cosine) = (cosine(aside), cosine(tilt));
    DVec3::new(beside * (1.0 - cosine * cosine).sqrt(), (1.0 - beside * beside).sqrt(), beside * cosine)
}

/// Where the numbers are that a place of a table with `N` axes of these lengths lies between, and their weights; the last axis is the closest together.
fn corners<const N: usize>(lengths: [usize; N], place: [f64; N]) -> impl Iterator<Item = (usize, f64)> {
    (0..1usize << N).map(move |corner| {
        let (mut at, mut weight) = (0, 1.0);
        for axis in 0..N {
            let x = place[axis].clamp(0.0, 1.0) * (lengths[axis] - 1) as f64;
            let before = (x as usize).min(lengths[axis] - 2);
            let behind = corner >> axis & 1;
            at = at * lengths[axis] + before + behind;
            weight *= if behind == 1 { x - before as f64 } else { 1.0 - (x - before as f64) };
        }
        (at, weight)
    })
}

/// Linear between the numbers of a table.
fn between<const N: usize>(numbers: &[f64], lengths: [usize; N], place: [f64; N]) -> f64 {
    corners(lengths, place).map(|(at, weight)| weight * numbers[at]).sum()
}

impl BrushedTable {
    /// From the bytes of the file.
    fn new(bytes: &[u8]) -> Self {
        let mut numbers = bytes.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f64());
        let mut take = |n: usize| -> Vec<f64> { numbers.by_ref().take(n).collect() };
        let (missing, missing_average) = (take(ALONG * RATIOS * AROUND * TILTS), take(MEANS_ALONG * MEANS_RATIOS));
        let dielectric =
            take(4 * BRUSHED_INDICES * BRUSHED_ROW).chunks_exact(4).map(|n| [n[0], n[1], n[2], n[3]]).collect();
        BrushedTable { missing, missing_average, dielectric }
    }

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        let singles = self.missing.iter().chain(&self.missing_average);
        singles.chain(self.dielectric.iter().flatten()).flat_map(|n| f16::from_f64(*n).to_le_bytes()).collect()
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

    /// The numbers of one index, at least 1: `[along][ratio][aside][tilt]`.
    pub fn dielectric_row(&self, eta: f64) -> Vec<[f64; 4]> {
        let x = bent(eta) * (BRUSHED_INDICES - 1) as f64;
        let before = (x as usize).min(BRUSHED_INDICES - 2);
        let t = x - before as f64;
        let [a, b] = [before, before + 1].map(|k| &self.dielectric[k * BRUSHED_ROW..][..BRUSHED_ROW]);
        a.iter().zip(b).map(|(a, b)| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)).collect()
    }

    /// What becomes of light from `w` at a rough dielectric whose index inside is `eta`, at least 1, times that outside.
    pub fn dielectric(&self, widths: [f64; 2], w: DVec3, eta: f64) -> DielectricAlbedo {
        let [along, ratio, aside, tilt] = brushed_dielectric_place(widths, w);
        let lengths = [BRUSHED_INDICES, BRUSHED_ALONG, BRUSHED_RATIOS, BRUSHED_ASIDE, BRUSHED_TILTS];
        let mut more = [0.0; 4];
        for (at, weight) in corners(lengths, [bent(eta), along, ratio, aside, tilt]) {
            more.iter_mut().zip(self.dielectric[at]).for_each(|(sum, number)| *sum += weight * number);
        }
        let round = TABLE.dielectric(w.z.min(1.0), seen_width(widths, w), eta);
        let inside = (round.inside + more[2]).max(LEAST_INSIDE);
        DielectricAlbedo {
            edge: round.edge + more[0],
            transmitted: (round.transmitted + more[1]).max(0.0),
            inside,
            transmitted_inside: (round.transmitted_inside + more[3]).clamp(0.0, inside),
        }
    }
}
