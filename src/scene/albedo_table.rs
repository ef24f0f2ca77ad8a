//! How much of the light that falls on rough surfaces of microfacets (`reference::microfacet`) leaves them after one reflection or refraction.
//! What is missing to 1 goes on between the microfacets: by these numbers it is not lost.
//!
//! The table is made by `examples/albedo_table.rs` and kept beside this file: `f32`, little-endian. Between its numbers all is linear.

use std::sync::LazyLock;

/// Numbers along the axes of the albedo of all-reflecting microfacets: roughness, and how far from grazing.
pub const ROUGH: usize = 32;
/// The second of these.
pub const STEEP: usize = 32;
/// Numbers along the axes of what dielectrics do: index, roughness, cosine.
pub const INDICES: usize = 24;
/// The second of these.
pub const ROUGHNESSES: usize = 16;
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

/// Means over directions in proportion to their cosine.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DielectricAverage {
    /// Of the albedo by `(F - F0) / (1 - F0)`.
    pub edge: f64,
    /// From inside, of what is transmitted over what leaves at all.
    pub transmitted_inside: f64,
}

/// The numbers of the file.
pub struct AlbedoTable {
    /// `[roughness][steepness]`: the root of what is missing to 1, which goes to 0 towards the normal as the steepness to 1.
    pub missing: Vec<f64>,
    /// The mean of each roughness, over the square of the width.
    pub missing_average: Vec<f64>,
    /// `[index][roughness][cosine, then the mean]`; of the mean `edge` and, in `transmitted_inside`, the other one.
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

/// The place of a cosine on the axis of steepness: narrow lobes are all alike near grazing, but for the scale.
pub fn steepness(cosine: f64, alpha: f64) -> f64 {
    cosine * (1.0 + alpha) / (cosine + alpha)
}

/// The cosine of a steepness.
pub fn cosine_of_steepness(steepness: f64, alpha: f64) -> f64 {
    steepness * alpha / (1.0 + alpha - steepness)
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
        let mut numbers = bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])));
        let mut take = |n: usize| -> Vec<f64> { numbers.by_ref().take(n).collect() };
        let (missing, missing_average) = (take(ROUGH * STEEP), take(ROUGH));
        let dielectric = take(4 * INDICES * ROUGHNESSES * ROW);
        let dielectric = dielectric.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        AlbedoTable { missing, missing_average, dielectric }
    }

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        let numbers = self.missing.iter().chain(&self.missing_average).chain(self.dielectric.iter().flatten());
        numbers.flat_map(|number| (*number as f32).to_le_bytes()).collect()
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

    /// The means of that.
    pub fn dielectric_average(&self, alpha: f64, eta: f64) -> DielectricAverage {
        let (i, s) = place(alpha.sqrt(), ROUGHNESSES);
        let (a, b) = (self.dielectric_at(eta, i, COSINES), self.dielectric_at(eta, i + 1, COSINES));
        DielectricAverage { edge: lerp(a[0], b[0], s), transmitted_inside: lerp(a[3], b[3], s) }
    }
}
