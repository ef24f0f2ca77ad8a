//! [`Development`]: from linear light to the numbers that a screen shows.

use super::srgb::srgb;
use super::tone::Tone;
use rayon::prelude::*;

/// How linear light becomes what a screen shows: brighter or darker first, then by a tone curve, at last in the code of sRGB.
///
/// An exposure alone, an `f32`, stands for a development without a curve.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Development {
    /// In stops: what is shown is radiance times 2^exposure.
    pub exposure: f32,
    /// The tone curve.
    pub tone: Tone,
}

impl From<f32> for Development {
    fn from(exposure: f32) -> Self {
        Development { exposure, tone: Tone::Srgb }
    }
}

/// So many numbers are developed at a time by a thread; a multiple of 3.
const PIECE: usize = 3 << 12;

/// Linear RGB, three numbers a pixel, as 8-bit sRGB.
pub fn to_srgb8(linear: &[f32], how: impl Into<Development>) -> Vec<u8> {
    let Development { exposure, tone } = how.into();
    let scale = exposure.exp2();
    // Rust's `as` saturates, and takes NaN (0 times an infinite scale) to 0.
    let code = |v: f32| (255.0 * srgb(v.clamp(0.0, 1.0))).round() as u8;
    let mut bytes = vec![0; linear.len()];
    bytes.par_chunks_mut(PIECE).zip(linear.par_chunks(PIECE)).for_each(|(bytes, linear)| {
        if tone == Tone::Srgb {
            bytes.iter_mut().zip(linear).for_each(|(byte, v)| *byte = code(v * scale));
            return;
        }
        for (bytes, pixel) in bytes.chunks_exact_mut(3).zip(linear.chunks_exact(3)) {
            let shown = tone.apply([pixel[0] * scale, pixel[1] * scale, pixel[2] * scale]);
            bytes.copy_from_slice(&shown.map(code));
        }
    });
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_standard() {
        for code in 0..=255u8 {
            let v = f64::from(code) / 255.0;
            let linear = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
            assert_eq!(to_srgb8(&[linear as f32], 0.0), [code]);
        }
    }

    /// The expected codes are from the published formulas, worked out by another program.
    #[test]
    fn the_curve_comes_after_the_exposure_and_before_the_code() {
        let linear = [0.25, 0.1, 0.025, 4.0, 0.0, 0.0, 0.5, 0.5, 0.5, f32::NAN, 0.0, 0.0];
        let shown = |tone| to_srgb8(&linear, Development { exposure: 1.0, tone });
        assert_eq!(shown(Tone::Agx), [174, 123, 64, 255, 189, 170, 197, 197, 197, 0, 0, 0]);
        assert_eq!(shown(Tone::Neutral), [182, 113, 34, 254, 189, 189, 240, 240, 240, 0, 0, 0]);
        assert_eq!(shown(Tone::Srgb), to_srgb8(&linear, 1.0));
    }

    #[test]
    fn pictures_of_more_than_a_piece_are_developed_in_order() {
        let linear: Vec<f32> = (0..2 * PIECE + 33).map(|i| (i % 97) as f32 / 50.0).collect();
        for tone in Tone::ALL {
            let whole = to_srgb8(&linear, Development { exposure: -0.5, tone });
            let pixels = linear.chunks(3).flat_map(|pixel| to_srgb8(pixel, Development { exposure: -0.5, tone }));
            assert!(whole.len() == linear.len() && whole.into_iter().eq(pixels), "{tone:?}");
        }
    }
}
