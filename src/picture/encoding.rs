//! How the numbers of a file become linear sRGB: the curve of its codes, and its primaries.

use super::srgb::srgb;
use glam::DMat3;
use moxcms::{ToneReprCurve, TransferCharacteristics};

/// What a file says about its colours.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Encoding {
    /// From codes to linear values.
    pub curve: Curve,
    /// From linear values to those of sRGB's primaries; none where they are the same.
    pub matrix: Option<DMat3>,
}

/// From a code in [0, 1] to a linear value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Curve {
    /// That of sRGB.
    Srgb,
    /// A power of the code.
    Power(f64),
    /// Of a standard, by its number in ITU-T H.273.
    Standard(TransferCharacteristics),
    /// Of a colour profile, for red, green and blue.
    Profile([ToneReprCurve; 3]),
}

impl Encoding {
    /// What a file means that says nothing.
    pub(super) const SRGB: Self = Encoding { curve: Curve::Srgb, matrix: None };
}

impl Curve {
    /// Red, green and blue of so many codes from 0 to 1; none for those of sRGB, or if a profile's curve cannot be evaluated.
    pub(super) fn table(&self, codes: usize) -> Option<Vec<[f32; 3]>> {
        let all = |value: &dyn Fn(f64) -> [f32; 3]| {
            Some((0..codes).map(|code| value(code as f64 / (codes - 1) as f64)).collect())
        };
        match self {
            Curve::Srgb => None,
            Curve::Power(exponent) => all(&|code| [code.powf(*exponent) as f32; 3]),
            Curve::Standard(standard) => all(&|code| [standard.linearize(code) as f32; 3]),
            Curve::Profile(curves) => {
                let mut evaluators = Vec::new();
                for curve in curves {
                    evaluators.push(curve.make_linear_evaluator().ok()?);
                }
                all(&|code| [0, 1, 2].map(|channel| evaluators[channel].evaluate_value(code as f32)))
            }
        }
    }

    /// Whether it is that of sRGB to within a code or so of 8 bits: profiles and gammas of sRGB are rounded.
    pub(super) fn is_srgb(&self) -> bool {
        const CODES: usize = 256;
        self.table(CODES).is_none_or(|table| {
            (0u8..).zip(table).all(|(code, values)| {
                let code = f32::from(code) / (CODES - 1) as f32;
                values.iter().all(|value| (srgb(value.clamp(0.0, 1.0)) - code).abs() < 0.005)
            })
        })
    }

    /// Whether the codes are linear values.
    pub(super) fn is_linear(&self) -> bool {
        const CODES: usize = 256;
        self.table(CODES).is_some_and(|table| {
            let near = |(code, values): (usize, [f32; 3])| {
                values.iter().all(|value| (value - code as f32 / (CODES - 1) as f32).abs() < 0.002)
            };
            table.into_iter().enumerate().all(near)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_told_apart() {
        let standard = |number: u8| Curve::Standard(TransferCharacteristics::try_from(number).unwrap());
        for (curve, is_srgb, is_linear, at_half) in [
            (Curve::Power(1.0), false, true, 0.5),
            (Curve::Power(2.2), false, false, 0.217_638),
            (standard(13), true, false, 0.214_041),
            (standard(8), false, true, 0.5),
            // BT.709, worked out by hand: ((0.5 + 0.0993) / 1.0993)^(1 / 0.45).
            (standard(1), false, false, 0.259_72),
        ] {
            assert_eq!((curve.is_srgb(), curve.is_linear()), (is_srgb, is_linear), "{curve:?}");
            let table = curve.table(3).unwrap();
            assert!((table[1][0] - at_half).abs() < 1e-4, "{curve:?}: {table:?}");
            assert!(table[0] == [0.0; 3] && (table[2][2] - 1.0).abs() < 1e-6, "{curve:?}: {table:?}");
        }
        assert!(Curve::Srgb.is_srgb() && !Curve::Srgb.is_linear());
    }
}
