//! Tone curves: how linear light of any brightness comes into the range of a screen.

use super::primaries::Primaries;
use glam::{DMat3, DVec3, Vec3};
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// How linear light of any brightness comes into the range from 0 to 1. It takes and gives linear RGB with the primaries of sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tone {
    /// No curve: radiance 1 is white, and what is brighter is clipped, each channel by itself.
    #[default]
    Srgb,
    /// AgX, as film has it: 16.5 stops, 6.5 of them above a middle grey of 0.18, and bright colours go to white.
    Agx,
    /// Khronos PBR Neutral: base colours stay as they are, and only highlights are compressed.
    Neutral,
}

impl Tone {
    /// All of them, in the order in which the window shows them.
    pub const ALL: [Tone; 3] = [Tone::Srgb, Tone::Agx, Tone::Neutral];

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Tone::Srgb => "srgb",
            Tone::Agx => "agx",
            Tone::Neutral => "neutral",
        }
    }

    /// The one after it in [`Tone::ALL`]; after the last one the first.
    #[must_use]
    pub fn next(self) -> Tone {
        let at = Self::ALL.iter().position(|tone| *tone == self).unwrap_or(0);
        Self::ALL[(at + 1) % Self::ALL.len()]
    }

    /// A linear colour, shown: linear again, from 0 to 1. Negative numbers and NaN count as 0. A grey stays a grey.
    pub fn apply(self, rgb: [f32; 3]) -> [f32; 3] {
        // Not so with NaN.
        let light = Vec3::from(rgb.map(|v| if v > 0.0 { v.min(BRIGHTEST) } else { 0.0 }));
        let shown = match self {
            Tone::Srgb => light,
            Tone::Agx => agx(light),
            Tone::Neutral => neutral(light),
        };
        shown.to_array().map(|v| v.clamp(0.0, 1.0))
    }
}

/// What is brighter is white under every curve; above it products would overflow.
const BRIGHTEST: f32 = 1e9;

/// Khronos PBR Neutral, by the formulas of its specification (The Khronos Group, "PBR Neutral Tone Mapper", 2024).
///
/// The Fresnel reflection of 4 % that a usual surface adds to its base colour is taken off, so that base colours of up to 0.8 are shown as they are;
/// what is brighter is compressed by the peak of its channels, and then goes to white.
fn neutral(light: Vec3) -> Vec3 {
    const FRESNEL: f32 = 0.04;
    const START: f32 = 0.8 - FRESNEL;
    const DESATURATION: f32 = 0.15;
    let least = light.min_element();
    // Twice the reflection is where the offset has come to all of it: 6.25 = 1 / (4 * 0.04).
    let offset = if least < 2.0 * FRESNEL { least - least * least / (4.0 * FRESNEL) } else { FRESNEL };
    let base = light - offset;
    let peak = base.max_element();
    if peak < START {
        return base;
    }
    let room = 1.0 - START;
    let compressed = 1.0 - room * room / (peak + room - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    (base * (compressed / peak)).lerp(Vec3::splat(compressed), white)
}

/// Middle grey, which AgX leaves where it is.
const GREY: f32 = 0.18;
/// Stops below and above it.
const STOPS: [f32; 2] = [10.0, 6.5];
/// The curve goes through middle grey, in the middle of its stops and, encoded, where [`ENCODING`] has it, with this slope.
const PIVOT: [f32; 2] = [STOPS[0] / (STOPS[0] + STOPS[1]), 0.489_437_1];
const SLOPE: f32 = 2.4;
/// What of the curve is above the pivot, and what below it, goes to its limits as `t / (1 + t^1.5)^(2/3)` times one of these, toe and shoulder.
const REACHES: [f32; 2] = [-0.565_675_6, 0.715_198_3];
/// The curve gives values to this power.
const ENCODING: f32 = 2.4;

/// Into the primaries in which AgX works, and back.
struct AgxPrimaries {
    from_srgb: glam::Mat3,
    to_srgb: glam::Mat3,
}

static AGX: LazyLock<AgxPrimaries> = LazyLock::new(|| {
    // Rows, as they are published. White stays white: each sums up to 1.
    let inset = DMat3::from_cols_array_2d(&[
        [0.856_627_153_315_983, 0.095_121_240_538_158_8, 0.048_251_606_145_858_3],
        [0.137_318_972_929_847, 0.761_241_990_602_591, 0.101_439_036_467_562],
        [0.111_898_212_999_95, 0.076_799_418_603_190_3, 0.811_302_368_396_859],
    ])
    .transpose();
    let outset = DMat3::from_cols_array_2d(&[
        [0.899_796_955_911_611, 0.087_199_619_202_835_1, 0.013_003_424_885_555],
        [0.111_420_988_957_48, 0.875_575_586_156_966, 0.013_003_424_885_554_8],
        [0.111_420_988_957_48, 0.087_199_619_202_834_9, 0.801_379_391_839_686],
    ])
    .transpose()
    .inverse();
    let rec_2020 = Primaries::REC_2020.to_srgb().ok().flatten().unwrap_or(DMat3::IDENTITY);
    AgxPrimaries { from_srgb: (inset * rec_2020.inverse()).as_mat3(), to_srgb: (rec_2020 * outset).as_mat3() }
});

/// AgX by Troy Sobotka, with the numbers of Blender's (Zijun Eary Zhou, AgX_LUT_Gen, AgXBaseRec2020.py), and Jed Smith's curve itself in the place of a table or
/// a polynomial. It works in Rec. 2020 with primaries that are moved inwards, and gives back some of that afterwards.
///
/// What Blender's table has besides is left out: it takes the hue back by three fifths to where it was before the curve, and moves colours that no screen has.
fn agx(light: Vec3) -> Vec3 {
    if light == Vec3::splat(light.x) {
        // As by the matrices, whose roundings would colour it.
        return Vec3::splat(agx_curve(light.x));
    }
    let inset = AGX.from_srgb * light;
    AGX.to_srgb * Vec3::from(inset.to_array().map(agx_curve))
}

/// AgX of one of its channels: linear, from 0 to 1.
fn agx_curve(light: f32) -> f32 {
    let [below, above] = STOPS;
    // The least `f32` is far below the range.
    let stops = (light.max(f32::MIN_POSITIVE) / GREY).log2();
    let x = ((stops + below) / (below + above)).clamp(0.0, 1.0);
    let reach = REACHES[usize::from(x >= PIVOT[0])];
    let t = SLOPE * (x - PIVOT[0]) / reach;
    let root = (1.0 + t * t.sqrt()).cbrt();
    (PIVOT[1] + reach * t / (root * root)).max(0.0).powf(ENCODING)
}

/// The luminance of a linear colour with the primaries of sRGB (ITU-R BT.709).
pub(crate) fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(tone: Tone, table: &[([f32; 3], [f32; 3])]) {
        for (light, expected) in table {
            let got = tone.apply(*light);
            let off = got.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 2e-5, "{} of {light:?}: {got:?}, expected {expected:?}", tone.name());
        }
    }

    /// The specification's GLSL, worked out in double precision by another program.
    #[test]
    fn neutral_is_that_of_the_specification() {
        assert_near(
            Tone::Neutral,
            &[
                ([0.0; 3], [0.0; 3]),
                ([0.01; 3], [0.000_625; 3]),
                ([0.05, 0.06, 0.07], [0.015_625, 0.025_625, 0.035_625]),
                ([0.18; 3], [0.14; 3]),
                ([0.8; 3], [0.76; 3]),
                ([1.0; 3], [0.869_091; 3]),
                ([4.0; 3], [0.983_256; 3]),
                ([1.0, 0.0, 0.0], [0.88, 0.015_56, 0.015_56]),
                ([8.0, 0.0, 0.0], [0.992_299, 0.508_524, 0.508_524]),
                ([0.5, 0.2, 0.05], [0.465_625, 0.165_625, 0.015_625]),
                ([2.0, 1.0, 0.1], [0.96, 0.534_091, 0.150_772]),
                ([100.0, 1.0, 1.0], [0.999_421, 0.936_948, 0.936_948]),
            ],
        );
    }

    /// The published curve and matrices (sigmoid.py, AgXBaseRec2020.py without hue mixing and guard rails), worked out in double precision by another program.
    #[test]
    fn agx_is_the_published_curve() {
        assert_near(
            Tone::Agx,
            &[
                ([0.0; 3], [0.0; 3]),
                ([0.01; 3], [0.006_262; 3]),
                ([0.18; 3], [0.18; 3]),
                ([1.0; 3], [0.555_999; 3]),
                ([4.0; 3], [0.815_412; 3]),
                ([20.0; 3], [1.0; 3]),
                ([1.0, 0.0, 0.0], [0.698_905, 0.055_11, 0.013_341]),
                ([0.0, 1.0, 0.0], [0.214_297, 0.550_469, 0.078_215]),
                ([0.0, 0.0, 1.0], [0.007_218, 0.097_404, 0.647_681]),
                ([8.0, 0.0, 0.0], [1.0, 0.509_241, 0.399_679]),
                ([0.0, 0.0, 50.0], [0.764_69, 0.865_348, 1.0]),
                ([0.5, 0.2, 0.05], [0.424_351, 0.199_311, 0.051_601]),
                ([2.0, 1.0, 0.1], [0.726_357, 0.549_752, 0.274_077]),
            ],
        );
    }

    /// The rounded constants of the curve are those that its author's formula gives for limits of 0 and 1.
    #[test]
    fn the_curve_ends_at_its_limits() {
        let [x, y] = [10.0 / 16.5, 0.18f64.powf(1.0 / 2.4)];
        let reach = |x: f64, y: f64| {
            let [slope, power] = [2.4, 1.5];
            ((slope * x).powf(-power) * ((slope * x / y).powf(power) - 1.0)).powf(-1.0 / power)
        };
        for (rounded, exact) in
            [(PIVOT[0], x), (PIVOT[1], y), (REACHES[0], -reach(x, y)), (REACHES[1], reach(1.0 - x, 1.0 - y))]
        {
            assert!((f64::from(rounded) - exact).abs() < 1e-7, "{rounded} for {exact}");
        }
    }

    #[test]
    fn greys_stay_grey_and_in_order_and_within_range() {
        for tone in Tone::ALL {
            let mut last = -1.0;
            for step in 0..4000 {
                let light = if step == 0 { 0.0 } else { (0.01 * step as f32 - 20.0).exp2() };
                let [r, g, b] = tone.apply([light; 3]);
                assert!(r == g && g == b, "{tone:?} of {light} is no grey: {r} {g} {b}");
                // Below its range AgX is black, and at the knee of `neutral` two formulas meet.
                assert!(r >= last - 1e-6 && (0.0..=1.0).contains(&r), "{tone:?} of {light}: {r} after {last}");
                last = r;
            }
            assert!(last > 0.999, "{tone:?} ends at {last}");
        }
    }

    #[test]
    fn odd_numbers_are_shown_and_never_nan() {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, f32::MIN_POSITIVE, 1.0, 1e30, f32::MAX];
        for tone in Tone::ALL {
            for r in odd {
                for g in odd {
                    for b in odd {
                        let shown = tone.apply([r, g, b]);
                        assert!(shown.iter().all(|v| (0.0..=1.0).contains(v)), "{tone:?} of {r} {g} {b}: {shown:?}");
                    }
                }
            }
            assert_eq!(tone.apply([f32::NAN, -3.0, f32::NEG_INFINITY]), [0.0; 3]);
            assert!(tone.apply([f32::INFINITY; 3]).iter().all(|v| *v > 0.9999), "{tone:?}");
        }
    }

    #[test]
    fn names_are_those_of_files_and_each_comes_once() {
        let mut tone = Tone::default();
        for expected in Tone::ALL {
            assert_eq!(tone, expected);
            assert_eq!(serde_json::to_value(tone).unwrap(), tone.name());
            tone = tone.next();
        }
        assert_eq!(tone, Tone::default());
    }
}
