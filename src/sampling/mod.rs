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
//! | [`light_block`]`(b)` | which luminaire | point on it, u | point on it, v | extinction |
//! | [`scatter_block`]`(b)` | direction, u | direction, v | free | free |

mod alias;

pub use alias::AliasTable;

/// The block that the sensor draws from.
pub const SENSOR_BLOCK: u32 = 0;

/// The block for direct light and extinction at bounce `bounce`.
pub fn light_block(bounce: u32) -> u32 {
    1 + 2 * bounce
}

/// The block for the choice of a direction at bounce `bounce`.
pub fn scatter_block(bounce: u32) -> u32 {
    2 + 2 * bounce
}

/// Four 32-bit random numbers; `pixel` is `y * width + x`.
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
