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
//! | [`light_block`]`(b)` | point on the luminaire, u | point on it, v | which luminaire | further bits of that, for a tree of many |
//! | [`scatter_block`]`(b)` | direction, u | direction, v | which lobe | extinction |
//!
//! On the environment, the point is a direction: the first number chooses the row of its image and how far down in it, the second one the column ([`Cdf`]).
//!
//! Whether a ray passes a surface that is partly transparent is decided by [`coverage`], for each surface on its way.
//!
//! [`Sampler::Sobol`] spreads the samples of a pixel out, which are one sequence from number 0 on: numbers 0 and 1 of a block form one two-dimensional point set, numbers 2
//! and 3 another ([`sobol`]). What belongs together, such as the two numbers of a direction, is therefore such a pair.

mod alias;
mod cdf;
mod random;
mod sampler;
pub mod sobol;

pub use alias::AliasTable;
pub use cdf::{CDF_NUMBERS, Cdf};
pub use random::{random4, uniform};
pub use sampler::Sampler;

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

/// What makes a ray's decisions about transparent surfaces independent of other rays'. `ray` is `2 b` for the ray to bounce `b`,
/// `2 b + 1` for the shadow ray from there. Always independent numbers, whatever the sampler: they are few and far between.
pub fn ray_salt(pixel: u32, sample: u32, ray: u32, seed: u32) -> u32 {
    random4(pixel, sample, 0x8000_0000 | ray, seed)[0]
}

/// A ray is stopped by a surface if [`uniform`] of this number is below its opacity. `object` and `triangle` are the scene's
/// indices.
pub fn coverage(salt: u32, object: u32, triangle: u32) -> u32 {
    random4(salt, object, triangle, 0)[0]
}
