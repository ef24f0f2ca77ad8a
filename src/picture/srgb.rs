//! The transfer function of sRGB (IEC 61966-2-1), both ways.

/// The non-linear sRGB value of a linear one in [0, 1] (IEC 61966-2-1).
pub fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The linear value of a non-linear sRGB one in [0, 1] (IEC 61966-2-1).
pub(crate) fn linear(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_transfer_is_continuous() {
        assert!((srgb(0.003_130_8) - srgb(0.003_130_9)).abs() < 1e-5);
    }

    #[test]
    fn decoding_is_the_inverse_of_what_is_written() {
        for code in 0..=255u8 {
            let value = f32::from(code) / 255.0;
            assert!((srgb(linear(value)) - value).abs() < 1e-5, "{code}");
        }
        // The standard's formula worked out by hand.
        assert!((linear(0.5) - 0.214_041).abs() < 1e-6);
        assert!((linear(10.0 / 255.0) - 0.003_035_27).abs() < 1e-8);
    }
}
