//! How much of the light that falls on rough surfaces of microfacets (`reference::microfacet`) leaves them after one reflection or refraction.
//! What is missing to 1 goes on between the microfacets: by these numbers it is not lost.
//!
//! The table is made by `examples/albedo_table.rs` and kept beside this file, little-endian: `f32` of what is missing, half floats of dielectrics. Between its numbers all is linear.

use half::f16;
use std::sync::LazyLock;

/// Numbers along the axes of the albedo of all-reflecting microfacets: roughness, and how far from grazing.
pub const ROUGH: usize = 32;
/// The second of these.
pub const STEEP: usize = 32;
/// Numbers along the axes of what dielectrics do: index, roughness, cosine.
pub const INDICES: usize = 32;
/// The second of these.
pub const ROUGHNESSES: usize = 32;
/// The third of these.
pub const COSINES: usize = 32;
/// Numbers of a row of dielectrics: the cosines, and the mean over them.
pub const ROW: usize = COSINES + 1;
/// The largest index, as `(eta - 1) / (eta + 1)`.
const MOST_BENT: f64 = 0.98;

/// What becomes of light at a rough dielectric, by the first microfacet that it meets, each number over one less [`AlbedoTable::missing`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DielectricAlbedo {
    /// From outside, what is reflected by `(F - F0) / (1 - F0)`, with Fresnel's `F`, which is `F0` at normal incidence.
    pub edge: f64,
    /// From outside, what is transmitted.
    pub transmitted: f64,
    /// From inside, what is reflected and transmitted together.
    pub inside: f64,
    /// From inside, what is transmitted.
    pub transmitted_inside: f64,
}

/// The numbers of the file.
pub struct AlbedoTable {
    /// `[roughness][steepness]`: the root of what is missing to 1, which goes to 0 towards the normal as the steepness to 1.
    pub missing: Vec<f64>,
    /// The mean of each roughness, over the square of the width.
    pub missing_average: Vec<f64>,
    /// `[index][roughness][cosine, then the mean]`; of the mean only `edge`, and not over what is missing to 1.
    pub dielectric: Vec<[f64; 4]>,
}

/// The bytes of the table.
const BYTES: &[u8] = include_bytes!("albedo_table.bin");

/// The table.
pub static TABLE: LazyLock<AlbedoTable> = LazyLock::new(|| AlbedoTable::new(BYTES));

/// Where a number from 0 to 1 lies on an axis: the place before it, and how far behind that.
fn place(x: f64, numbers: usize) -> (usize, f64) {
    let x = x.clamp(0.0, 1.0) * (numbers - 1) as f64;
    let before = (x as usize).min(numbers - 2);
    (before, x - before as f64)
}

/// The place of a cosine on the axis of steepness: narrow lobes are all alike near grazing, but for the scale; and there what is missing goes as the cosine.
pub fn steepness(cosine: f64, alpha: f64) -> f64 {
    (cosine * (1.0 + alpha) / (cosine + alpha)).sqrt()
}

/// The cosine of a steepness.
pub fn cosine_of_steepness(steepness: f64, alpha: f64) -> f64 {
    let square = steepness * steepness;
    square * alpha / (1.0 + alpha - square)
}

/// The place of an index, at least 1, on its axis.
pub fn bent(eta: f64) -> f64 {
    ((eta - 1.0) / (eta + 1.0) / MOST_BENT).min(1.0).sqrt()
}

/// The index of a place.
pub fn index_of_bent(bent: f64) -> f64 {
    let e = bent * bent * MOST_BENT;
    (1.0 + e) / (1.0 - e)
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

impl AlbedoTable {
    /// From the bytes of the file.
    fn new(bytes: &[u8]) -> Self {
        let (singles, halves) = bytes.split_at(4 * (ROUGH * STEEP + ROUGH));
        let mut numbers = singles.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])));
        let mut take = |n: usize| -> Vec<f64> { numbers.by_ref().take(n).collect() };
        let (missing, missing_average) = (take(ROUGH * STEEP), take(ROUGH));
        let half = |b: &[u8], i: usize| f16::from_le_bytes([b[2 * i], b[2 * i + 1]]).to_f64();
        let dielectric = halves.chunks_exact(8).map(|b| [half(b, 0), half(b, 1), half(b, 2), half(b, 3)]).collect();
        AlbedoTable { missing, missing_average, dielectric }
    }

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        let singles = self.missing.iter().chain(&self.missing_average);
        let mut bytes: Vec<u8> = singles.flat_map(|number| (*number as f32).to_le_bytes()).collect();
        let halves = self.dielectric.iter().flatten();
        bytes.extend(halves.flat_map(|number| f16::from_f64(*number).to_le_bytes()));
        bytes
    }

    /// Share of the light that microfacets which reflect all do not send away at once; `alpha` is the width of their distribution.
    pub fn missing(&self, cosine: f64, alpha: f64) -> f64 {
        let (i, s) = place(alpha.sqrt(), ROUGH);
        let (j, t) = place(steepness(cosine, alpha), STEEP);
        let at = |i: usize, j: usize| self.missing[i * STEEP + j];
        lerp(lerp(at(i, j), at(i, j + 1), t), lerp(at(i + 1, j), at(i + 1, j + 1), t), s).powi(2)
    }

    /// The mean of that over directions in proportion to their cosine.
    pub fn missing_average(&self, alpha: f64) -> f64 {
        let (i, s) = place(alpha.sqrt(), ROUGH);
        lerp(self.missing_average[i], self.missing_average[i + 1], s) * alpha * alpha
    }

    /// The rows of one index, at least 1: `[roughness][cosine, then the mean]`.
    pub fn dielectric_rows(&self, eta: f64) -> Vec<[f64; 4]> {
        let columns = (0..ROUGHNESSES).flat_map(|i| (0..ROW).map(move |j| (i, j)));
        columns.map(|(i, j)| self.dielectric_at(eta, i, j)).collect()
    }

    fn dielectric_at(&self, eta: f64, roughness: usize, column: usize) -> [f64; 4] {
        let (k, u) = place(bent(eta), INDICES);
        let at = |k: usize| self.dielectric[(k * ROUGHNESSES + roughness) * ROW + column];
        let (a, b) = (at(k), at(k + 1));
        std::array::from_fn(|i| lerp(a[i], b[i], u))
    }

    /// What becomes of light at a rough dielectric whose index inside is `eta`, at least 1, times that outside.
    pub fn dielectric(&self, cosine: f64, alpha: f64, eta: f64) -> DielectricAlbedo {
        let (i, s) = place(alpha.sqrt(), ROUGHNESSES);
        let (j, t) = place(cosine.sqrt(), COSINES);
        let corners = [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)].map(|(i, j)| self.dielectric_at(eta, i, j));
        let of = |n: usize| lerp(lerp(corners[0][n], corners[1][n], t), lerp(corners[2][n], corners[3][n], t), s);
        DielectricAlbedo { edge: of(0), transmitted: of(1), inside: of(2), transmitted_inside: of(3) }
    }

    /// The mean of what is reflected by `(F - F0) / (1 - F0)` over directions in proportion to their cosine.
    pub fn edge_average(&self, alpha: f64, eta: f64) -> f64 {
        let (i, s) = place(alpha.sqrt(), ROUGHNESSES);
        lerp(self.dielectric_at(eta, i, COSINES)[0], self.dielectric_at(eta, i + 1, COSINES)[0], s)
    }
}
