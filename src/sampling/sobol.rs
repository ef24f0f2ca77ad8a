//! Owen-scrambled Sobol points, two dimensions at a time ("padding").
//!
//! The first two dimensions of Sobol's sequence are a (0, 2)-sequence: of every aligned run of `2^k` points, each of the `2^k`
//! boxes of `2^-a` by `2^(a-k)` holds one. Nested uniform ("Owen") scrambling keeps that, makes every point uniform by itself,
//! and lets the error of a smooth integrand fall with `N^-1.5` instead of `N^-0.5`. Further pairs of dimensions are the same
//! sequence, scrambled differently and in an order of their own, so that pairs are independent of each other: Burley, "Practical
//! Hash-Based Owen Scrambling", JCGT 9(4), 2020. What an integrand makes of two pairs together is found as by independent numbers, at
//! worst with twice their variance (two samples that differ in the last bit of their index swap halves in every dimension), so what
//! belongs together should be a pair.
//!
//! Numbers are 32-bit fractions. *Reversed* ones have their most significant bit, the first binary digit, in bit 0: there a
//! multiplication carries from the larger to the smaller intervals, which is the direction in which the scrambling must work.
//! The twin is `sobol4` in `shaders/rng.glsl`, bit for bit.

use super::random::random4;

/// A nested uniform scramble of a reversed number: which half of an interval is swapped depends on the interval, in a way that
/// `seed`, which must be well mixed, decides. Laine and Karras' idea of a hash that only carries upwards, with the steps and
/// constants of Vegdahl's "full-tree" hash ("Building a Better LK Hash", psychopath.io, 2021).
pub fn owen_scramble(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul(seed >> 16 | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The second dimension of Sobol's sequence at an index, reversed (the first dimension, reversed, is the index itself).
///
/// Its matrix is Pascal's triangle modulo 2: digit `j` is the sum of the index's bits `k` with `C(k, j)` odd, which are those whose
/// `k` has all the bits of `j` (Lucas). Such sums over supersets are built up one bit of `j` after the other.
pub fn second_dimension(index: u32) -> u32 {
    let mut y = index;
    y ^= y >> 1 & 0x5555_5555;
    y ^= y >> 2 & 0x3333_3333;
    y ^= y >> 4 & 0x0f0f_0f0f;
    y ^= y >> 8 & 0x00ff_00ff;
    y ^ y >> 16
}

/// The four numbers of a block: two pairs, each a scrambled (0, 2)-sequence in `index`, independent of each other and of all other
/// pixels, blocks and seeds.
pub fn sobol4(pixel: u32, index: u32, block: u32, seed: u32) -> [u32; 4] {
    // In the place of a sample: the same for all of them.
    let seeds = random4(pixel, u32::MAX, block, seed);
    // Four numbers make six seeds: those of one pair are independent.
    let [x0, y0] = pair(index, seeds[2] ^ seeds[3], [seeds[0], seeds[1]]);
    let [x1, y1] = pair(index, seeds[0] ^ seeds[1], [seeds[2], seeds[3]]);
    [x0, y0, x1, y1]
}

/// One point of a scrambled sequence: the order of the points is scrambled by `order`, the dimensions by `seeds`.
fn pair(index: u32, order: u32, seeds: [u32; 2]) -> [u32; 2] {
    let index = owen_scramble(index.reverse_bits(), order).reverse_bits();
    let reversed = [owen_scramble(index, seeds[0]), owen_scramble(second_dimension(index), seeds[1])];
    reversed.map(u32::reverse_bits)
}
