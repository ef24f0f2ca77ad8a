//! Independent random numbers: `pcg4d`.

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

/// A number in (0, 1) from the upper 23 bits, the middle of one of as many intervals: exact in `f32` and in `f64`, so both tracers see the
/// same value. Neither end is ever met: it would put a direction on the rim of its hemisphere, where its path ends.
pub fn uniform(random: u32) -> f64 {
    (f64::from(random >> 9) + 0.5) / f64::from(1u32 << 23)
}
