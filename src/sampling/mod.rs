//! Random numbers as a pure function of (pixel, sample, dimension, seed), shared by both tracers.
//!
//! No state is kept, so a picture can be resumed, split and compared number by number. The generator is `pcg4d`
//! (Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020): integer arithmetic only, so that Rust and
//! GLSL (`shaders/rng.glsl`) give the same bits.
//!
//! A *block* is four dimensions. Block 0 is the sensor's; bounce `b` (0 is the surface that the camera sees) owns two:
//!
//! | block | number 0 | number 1 | number 2 | number 3 |
//! |---|---|---|---|---|
//! | 0, [`SENSOR_BLOCK`] | pixel x | pixel y | lens u | lens v |
//! | [`light_block`]`(b)` | point on the luminaire, u | point on it, v | which luminaire | texel of the environment |
//! | [`scatter_block`]`(b)` | direction, u | direction, v | which lobe | extinction |
//!
//! Whether a ray passes a surface that is partly transparent is decided by [`coverage`], for each surface on its way.
//!
//! [`Sampler::Sobol`] spreads the samples of a pixel out: numbers 0 and 1 of a block form one two-dimensional point set, numbers 2
//! and 3 another ([`sobol`]). What belongs together, such as the two numbers of a direction, is therefore such a pair.

mod alias;
pub mod sobol;

pub use alias::AliasTable;

/// Into how many independent parts the samples of a pixel fall: sample `s` is number `s / PARTS` of part `s % PARTS`. Each part has a
/// scrambling of its own, so that the spread of their means tells the error, which one sequence could not: its samples
/// depend on each other. More parts would tell the error better, and spread the samples out less well.
pub const PARTS: u32 = 4;

/// The block that the sensor draws from.
pub const SENSOR_BLOCK: u32 = 0;

/// The block for direct light at bounce `bounce`.
pub fn light_block(bounce: u32) -> u32 {
    1 + 2 * bounce
}

/// The block for the choice of a direction and for extinction at bounce `bounce`.
pub fn scatter_block(bounce: u32) -> u32 {
    2 + 2 * bounce
}

/// Where the random numbers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Independent numbers: [`random4`].
    Independent,
    /// Owen-scrambled Sobol points, two dimensions at a time: [`sobol::sobol4`]. Less noise for the same number of samples, most of all
    /// where that number is a power of two.
    #[default]
    Sobol,
}

impl Sampler {
    /// The four numbers of a block; `pixel` is `y * width + x`.
    pub fn numbers(self, pixel: u32, sample: u32, block: u32, seed: u32) -> [u32; 4] {
        match self {
            Sampler::Independent => random4(pixel, sample, block, seed),
            Sampler::Sobol => sobol::sobol4(pixel, sample % PARTS, sample / PARTS, block, seed),
        }
    }
}

/// What tells a ray's decisions about transparent surfaces apart from other rays'. `ray` is `2 b` for the ray to bounce `b`,
/// `2 b + 1` for the shadow ray from there. Always independent numbers, whatever the sampler: they are few and far between.
pub fn ray_salt(pixel: u32, sample: u32, ray: u32, seed: u32) -> u32 {
    random4(pixel, sample, 0x8000_0000 | ray, seed)[0]
}

/// A ray is stopped by a surface if [`uniform`] of this number is below its opacity. `object` and `triangle` are the scene's
/// indices.
pub fn coverage(salt: u32, object: u32, triangle: u32) -> u32 {
    random4(salt, object, triangle, 0)[0]
}

/// Four independent 32-bit random numbers; `pixel` is `y * width + x`.
pub fn random4(pixel: u32, sample: u32, block: u32, seed: u32) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] =
        [pixel, sample, block, seed].map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w] = [x, y, z, w].map(|v| v ^ (v >> 16));
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// A number in [0, 1) from the upper 24 bits: exact in `f32` and in `f64`, so both tracers see the same value.
pub fn uniform(random: u32) -> f64 {
    f64::from(random >> 8) / f64::from(1u32 << 24)
}
