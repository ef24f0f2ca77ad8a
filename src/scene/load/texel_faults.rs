//! What is wrong with the numbers of a texture: not finite, negative, or beyond what is kept of them.

use super::texture::{Channel, MapFile};
use crate::picture::decode::{CHUNK, ImageFile};
use half::f16;
use rayon::prelude::*;

/// How many texels have a fault.
#[derive(Debug, Default, Clone, Copy)]
struct Faults {
    nan: usize,
    negative: usize,
    /// Beyond half floats.
    large: usize,
    largest: f32,
    /// Opacities outside of 0 to 1.
    opacity: usize,
}

/// What is changed in a texture, in words that can follow the file's name. Whole numbers that are sRGB can have none of these faults.
pub(super) fn of(image: &ImageFile, map: &MapFile, scalar: Option<Channel>) -> Vec<String> {
    if !image.is_unbounded() || scalar.is_some() && !image.is_float() {
        return Vec::new();
    }
    let by_alpha = matches!(scalar, Some(Channel::One(3))) || scalar == Some(Channel::Any) && image.has_transparency();
    let range = |value: f32| map.base + map.gain * value;
    // A little beyond 1 is what filters leave.
    let is_opacity = |value: f32| (-0.01..=1.01).contains(&value);
    let of_one = |texel: usize| -> Faults {
        if let Some(channel) = scalar {
            let stored = image.stored(texel);
            let value = match channel {
                _ if by_alpha => stored[3],
                Channel::One(index) => stored[usize::from(index)],
                Channel::Any | Channel::Luminance => luminance(stored),
            };
            return Faults { opacity: usize::from(!is_opacity(range(value))), ..Faults::default() };
        }
        let [r, g, b, alpha] = if map.straight { image.straight(texel) } else { image.linear(texel) };
        let colour = [r, g, b].map(range);
        let largest = colour.into_iter().fold(0.0, f32::max);
        let rounding = image.rounding() * largest;
        Faults {
            nan: usize::from(colour.iter().any(|value| value.is_nan())),
            negative: usize::from(colour.iter().any(|value| *value < -rounding)),
            large: usize::from(largest > f16::MAX.to_f32()),
            largest,
            opacity: usize::from(map.straight && !is_opacity(alpha)),
        }
    };
    let sum = (0..image.len()).into_par_iter().with_min_len(CHUNK).map(of_one).reduce(Faults::default, |a, b| Faults {
        nan: a.nan + b.nan,
        negative: a.negative + b.negative,
        large: a.large + b.large,
        largest: a.largest.max(b.largest),
        opacity: a.opacity + b.opacity,
    });
    sum.in_words(image)
}

impl Faults {
    fn in_words(&self, image: &ImageFile) -> Vec<String> {
        let all = image.len();
        let mut said = Vec::new();
        if self.nan > 0 {
            said.push(format!("{} of its {all} texels are NaN; 0 is used there", self.nan));
        }
        if self.negative > 0 {
            let why = if image.is_float() { "negative" } else { "colours that sRGB cannot show" };
            said.push(format!("{} of its {all} texels are {why}; 0 is used where they are negative", self.negative));
        }
        if self.large > 0 {
            said.push(format!(
                "{} of its {all} texels are above 65504, up to {:e}: textures are kept as half floats, and 65504 is used there; scale the \
                 image down and the number that it multiplies up",
                self.large, self.largest
            ));
        }
        if self.opacity > 0 {
            said.push(format!(
                "{} of its {all} texels are an opacity outside of 0 to 1; they are clamped",
                self.opacity
            ));
        }
        said
    }
}

/// The luminance of linear sRGB primaries (ITU-R BT.709); the weights' sum is 1 even in single precision, so white is 1.
pub(super) fn luminance([r, g, b, _]: [f32; 4]) -> f32 {
    (f64::from(r) * 0.2126 + f64::from(g) * 0.7152 + f64::from(b) * 0.0722) as f32
}
