//! Which kind of numbers a picture is made of.

use super::{random4, sobol};

/// Where the random numbers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Independent numbers: [`random4`].
    Independent,
    /// Owen-scrambled Sobol points, two dimensions at a time: [`sobol::sobol4`], of which sample `s` of a pixel is number `s`. Less noise for the same
    /// number of samples, most of all where that number is a power of two.
    #[default]
    Sobol,
}

impl Sampler {
    /// The four numbers of a block; `pixel` is `y * width + x`.
    pub fn numbers(self, pixel: u32, sample: u32, block: u32, seed: u32) -> [u32; 4] {
        match self {
            Sampler::Independent => random4(pixel, sample, block, seed),
            Sampler::Sobol => sobol::sobol4(pixel, sample, block, seed),
        }
    }
}
