//! What is wrong with the numbers of a texture: not finite, negative, or beyond what is kept of them.

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

/// What is changed in colours that are kept as half floats, in words that can follow the file's name; `range` makes of each number what counts, which may be
/// another one if it is `changed`. Whole numbers that are sRGB can have no fault otherwise.
pub(super) fn of_colours(
    image: &ImageFile,
    straight: bool,
    changed: bool,
    range: impl Fn(f32) -> f32 + Send + Sync,
) -> Vec<String> {
    if !image.is_unbounded() && !changed {
        return Vec::new();
    }
    let faults = |texel: usize| {
        let [r, g, b, alpha] = if straight { image.straight(texel) } else { image.linear(texel) };
        let colour = [r, g, b].map(&range);
        let largest = colour.into_iter().fold(0.0, f32::max);
        let rounding = image.rounding() * largest;
        Faults {
            nan: usize::from(colour.iter().any(|value| value.is_nan())),
            negative: usize::from(colour.iter().any(|value| *value < -rounding)),
            large: usize::from(largest > f16::MAX.to_f32()),
            largest,
            opacity: usize::from(straight && !is_opacity(alpha)),
        }
    };
    Faults::sum(image, faults).in_words(image, changed)
}

/// The same for opacities.
pub(super) fn of_opacities(
    image: &ImageFile,
    changed: bool,
    opacity: impl Fn(usize) -> f32 + Send + Sync,
) -> Vec<String> {
    if !image.is_float() && !changed {
        return Vec::new();
    }
    let faults = |texel| Faults { opacity: usize::from(!is_opacity(opacity(texel))), ..Faults::default() };
    Faults::sum(image, faults).in_words(image, false)
}

/// The same for heights.
pub(super) fn of_heights(image: &ImageFile, height: impl Fn(usize) -> f32 + Send + Sync) -> Vec<String> {
    if !image.is_float() {
        return Vec::new();
    }
    let faults = |texel| {
        let height = height(texel);
        let large = height > f16::MAX.to_f32();
        let largest = if height.is_finite() { height } else { 0.0 };
        Faults { nan: usize::from(!height.is_finite()), large: usize::from(large), largest, ..Faults::default() }
    };
    Faults::sum(image, faults).in_words(image, false)
}

/// The same for numbers from 0 to 1, one a channel; of alpha nobody knows whether it is one.
pub(super) fn of_numbers(
    image: &ImageFile,
    changed: bool,
    numbers: impl Fn(usize) -> [f32; 4] + Send + Sync,
) -> Vec<String> {
    if !image.is_float() && !changed {
        return Vec::new();
    }
    let faulty = |texel| numbers(texel)[..3].iter().any(|number| !is_opacity(*number));
    let count = (0..image.len()).into_par_iter().with_min_len(CHUNK).filter(|texel| faulty(*texel)).count();
    let said = format!("{count} of its {} texels are outside of 0 to 1; they are clamped", image.len());
    if count > 0 { vec![said] } else { Vec::new() }
}

/// A little beyond 1 is what filters leave.
fn is_opacity(value: f32) -> bool {
    (-0.01..=1.01).contains(&value)
}

impl Faults {
    fn sum(image: &ImageFile, of_one: impl Fn(usize) -> Faults + Send + Sync) -> Self {
        (0..image.len()).into_par_iter().with_min_len(CHUNK).map(of_one).reduce(Faults::default, |a, b| Faults {
            nan: a.nan + b.nan,
            negative: a.negative + b.negative,
            large: a.large + b.large,
            largest: a.largest.max(b.largest),
            opacity: a.opacity + b.opacity,
        })
    }

    fn in_words(&self, image: &ImageFile, changed: bool) -> Vec<String> {
        let all = image.len();
        let mut said = Vec::new();
        if self.nan > 0 {
            said.push(format!("{} of its {all} texels are NaN; 0 is used there", self.nan));
        }
        if self.negative > 0 {
            let why = if image.is_float() || changed { "negative" } else { "colours that sRGB cannot show" };
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
