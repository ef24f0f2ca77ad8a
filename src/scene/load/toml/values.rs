//! Numbers of a scene file that are checked as they are read, so that an error points at the very value.

use crate::scene::load::map_file::LARGEST_TRANSFORM;
use crate::scene::load::material_draft::{ETAS, LARGEST_EXPONENT};
use crate::scene::{Estimator, LEAST_ANGLE};
use glam::{DVec2, DVec3, Vec2, Vec3};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// Most pixels in a row or a column.
const LARGEST_FILM: i64 = 65_536;
/// Most stops of exposure, up or down: more would leave the range of `f32`.
const LARGEST_EXPOSURE: f64 = 64.0;

/// Beyond this a filter is a blur.
const LARGEST_FILTER_RADIUS: f32 = 64.0;
/// More blades are a circle.
const MOST_BLADES: i64 = 64;

/// Most widths or heights by which a picture is shifted; real lenses do one or two.
const LARGEST_SHIFT: f32 = 100.0;

type Checked<T> = std::result::Result<T, &'static str>;

/// A list of numbers, no more and no fewer: the parser itself would take the first `N` of a longer one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers<const N: usize>(pub [f64; N]);

impl<'de, const N: usize> Deserialize<'de> for Numbers<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct Elements<const N: usize>;
        impl<'de, const N: usize> Visitor<'de> for Elements<N> {
            type Value = Numbers<N>;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(match N {
                    2 => "two numbers [x, y]",
                    3 => "three numbers [x, y, z]",
                    _ => "rows of four numbers: [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]",
                })
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> std::result::Result<Numbers<N>, A::Error> {
                let mut numbers = Vec::new();
                while let Some(number) = list.next_element()? {
                    numbers.push(number);
                }
                let count = numbers.len();
                numbers.try_into().map(Numbers).map_err(|_| {
                    let advice = if (N, count) == (3, 4) { "; a fourth, as alpha, has no place here" } else { "" };
                    let many = ["two", "three", "four"][N - 2];
                    serde::de::Error::custom(format!("expected {many} numbers, found {count}{advice}"))
                })
            }
        }
        deserializer.deserialize_seq(Elements)
    }
}

/// Three rows of four numbers, or four of which the last is 0, 0, 0, 1.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Vec<Numbers<4>>")]
pub(super) struct Matrix(pub [[Exact; 4]; 3]);

impl TryFrom<Vec<Numbers<4>>> for Matrix {
    type Error = &'static str;
    fn try_from(mut rows: Vec<Numbers<4>>) -> Checked<Self> {
        if rows.len() == 4 && rows[3].0 == [0.0, 0.0, 0.0, 1.0] {
            rows.pop();
        }
        let rows: [Numbers<4>; 3] =
            rows.try_into().map_err(|_| "expected three rows of four numbers; a fourth can only be [0, 0, 0, 1]")?;
        let mut matrix = [[Exact(0.0); 4]; 3];
        for (row, numbers) in matrix.iter_mut().zip(rows) {
            for (number, from) in row.iter_mut().zip(numbers.0) {
                *number = Exact::try_from(from)?;
            }
        }
        Ok(Matrix(matrix))
    }
}

/// A finite number.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Finite(pub f32);

/// A finite number, of which every digit counts.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Exact(pub f64);

/// A point or a vector, as the file has it: a point may lie so far from the origin that every digit counts.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<3>")]
pub(super) struct Triple(pub DVec3);

impl Triple {
    /// In single precision.
    pub(super) fn rounded(self) -> Vec3 {
        self.0.as_vec3()
    }
}

/// Linear RGB, not negative.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<3>")]
pub(super) struct Colour(pub Vec3);

/// Linear RGB from 0 to 1.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<3>")]
pub(super) struct Albedo(pub Vec3);

/// What passes into a material: of Blinn-Phong's an albedo, of a metallic-roughness surface a share.
#[derive(Debug, Clone, Copy)]
pub(super) enum Transmission {
    /// Linear RGB, not negative.
    Albedo(Vec3),
    /// From 0 to 1.
    Share(f32),
}

impl<'de> Deserialize<'de> for Transmission {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        // Not an untagged enum, which would lose the words of errors within.
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Transmission;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("three numbers [r, g, b], or one of a metallic-roughness material")
            }
            fn visit_f64<E: Error>(self, number: f64) -> std::result::Result<Transmission, E> {
                Unit::try_from(number).map(|share| Transmission::Share(share.0)).map_err(E::custom)
            }
            fn visit_i64<E: Error>(self, number: i64) -> std::result::Result<Transmission, E> {
                self.visit_f64(number as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> std::result::Result<Transmission, A::Error> {
                let colour = Colour::deserialize(SeqAccessDeserializer::new(list))?;
                Ok(Transmission::Albedo(colour.0))
            }
        }
        deserializer.deserialize_any(Either)
    }
}

/// Linear RGB above 0, at most 1.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<3>")]
pub(super) struct Attenuation(pub Vec3);

/// An index of refraction of at least 1; 0 stands for an infinite one.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Ior(pub f32);

/// The index of refraction of a film.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct FilmIor(pub f32);

/// The thickness of a film in nanometres: the same everywhere, or the least and the greatest.
#[derive(Debug, Clone, Copy)]
pub(super) struct FilmThickness(pub [f32; 2]);

impl<'de> Deserialize<'de> for FilmThickness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct NumberOrPair;
        impl<'de> Visitor<'de> for NumberOrPair {
            type Value = FilmThickness;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("nanometres, or two of them [least, greatest]")
            }
            fn visit_f64<E: Error>(self, number: f64) -> std::result::Result<FilmThickness, E> {
                [number; 2].try_into().map_err(E::custom)
            }
            fn visit_i64<E: Error>(self, number: i64) -> std::result::Result<FilmThickness, E> {
                self.visit_f64(number as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> std::result::Result<FilmThickness, A::Error> {
                let Numbers(pair) = Numbers::<2>::deserialize(SeqAccessDeserializer::new(list))?;
                pair.try_into().map_err(A::Error::custom)
            }
        }
        deserializer.deserialize_any(NumberOrPair)
    }
}

/// A field of view in degrees.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Fov(pub f32);

/// A Blinn-Phong exponent.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Exponent(pub f32);

/// Stops, or that they are to be found.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "StopsOrWord")]
pub(super) struct Exposure(pub crate::scene::Exposure);

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected stops from -64 to 64, or \"auto\"")]
enum StopsOrWord {
    Stops(f64),
    Word(String),
}

/// A finite number of at least 0.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct NotNegative(pub f32);

/// A finite number greater than 0.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Positive(pub f32);

/// A number in [0, 1].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Unit(pub f32);

/// A number in (0, 1).
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Probability(pub f32);

/// Degrees in [0, 180].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Angle(pub f32);

/// Degrees from the axis of a spot.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct ConeAngle(pub f32);

/// The diameter of a disc at infinity in degrees.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct DiscAngle(pub f32);

/// Radius of a pixel filter in pixels.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct FilterRadius(pub f32);

/// Corners of an aperture.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
pub(super) struct Blades(pub u32);

/// Width or height of a film.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
pub(super) struct Pixels(pub u32);

/// Limit of indirect bounces.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
pub(super) struct Bounces(pub u32);

/// How often a map is there between the coordinates 0 and 1, each way; not 0.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<2>")]
pub(super) struct MapScale(pub Vec2);

/// The place in a map that the coordinates (0, 0) show.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<2>")]
pub(super) struct MapOffset(pub Vec2);

/// By how many widths and heights a picture is shifted.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Numbers<2>")]
pub(super) struct Shift(pub Vec2);

/// An index of refraction.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Eta(pub f32);

/// Samples a pixel.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
pub(super) struct Samples(pub u32);

impl TryFrom<f64> for Finite {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        Some(number as f32).filter(|n| n.is_finite()).map(Finite).ok_or("expected a finite number below 3e38")
    }
}

impl TryFrom<f64> for Exact {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        (number as f32).is_finite().then_some(Exact(number)).ok_or("expected a finite number below 3e38")
    }
}

impl TryFrom<Numbers<3>> for Triple {
    type Error = &'static str;
    fn try_from(Numbers(numbers): Numbers<3>) -> Checked<Self> {
        let vector = DVec3::from(numbers);
        Some(vector).filter(|v| v.as_vec3().is_finite()).map(Triple).ok_or("expected three finite numbers below 3e38")
    }
}

impl TryFrom<Numbers<3>> for Colour {
    type Error = &'static str;
    fn try_from(Numbers(numbers): Numbers<3>) -> Checked<Self> {
        let colour = DVec3::from(numbers).as_vec3();
        Some(colour)
            .filter(|c| c.is_finite() && c.min_element() >= 0.0)
            .map(Colour)
            .ok_or("expected linear RGB: three finite numbers, none of them negative")
    }
}

impl TryFrom<Numbers<3>> for Albedo {
    type Error = &'static str;
    fn try_from(Numbers(numbers): Numbers<3>) -> Checked<Self> {
        let albedo = DVec3::from(numbers).as_vec3();
        let shares = albedo.to_array().iter().all(|share| (0.0..=1.0).contains(share));
        shares.then_some(Albedo(albedo)).ok_or("expected linear RGB: three numbers from 0 to 1")
    }
}

impl TryFrom<Numbers<3>> for Attenuation {
    type Error = &'static str;
    fn try_from(Numbers(numbers): Numbers<3>) -> Checked<Self> {
        let colour = DVec3::from(numbers).as_vec3();
        let some = colour.to_array().iter().all(|share| *share > 0.0 && *share <= 1.0);
        some.then_some(Attenuation(colour)).ok_or("expected linear RGB: three numbers above 0, at most 1")
    }
}

impl TryFrom<f64> for Ior {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        let ior = number as f32;
        let some = ior == 0.0 || (1.0..=*ETAS.end()).contains(&ior);
        some.then_some(Ior(ior)).ok_or(
            "expected an index of refraction from 1 to 100, or 0 for a surface that reflects all of its `specular_colour`",
        )
    }
}

impl TryFrom<f64> for FilmIor {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        let some = (1.0..=f64::from(*ETAS.end())).contains(&number);
        some.then_some(FilmIor(number as f32)).ok_or("expected an index of refraction from 1 to 100")
    }
}

impl TryFrom<[f64; 2]> for FilmThickness {
    type Error = &'static str;
    fn try_from(pair: [f64; 2]) -> Checked<Self> {
        let thickness = pair.map(|number| number as f32);
        let some = thickness.iter().all(|number| number.is_finite() && *number >= 0.0);
        some.then_some(FilmThickness(thickness))
            .ok_or("expected nanometres of at least 0, or two of them [least, greatest]")
    }
}

impl TryFrom<Numbers<2>> for MapScale {
    type Error = &'static str;
    fn try_from(numbers: Numbers<2>) -> Checked<Self> {
        let MapOffset(scale) = numbers.try_into()?;
        let some = scale.x != 0.0 && scale.y != 0.0;
        some.then_some(MapScale(scale)).ok_or("expected two numbers other than 0: how often the picture is there")
    }
}

impl TryFrom<Numbers<2>> for MapOffset {
    type Error = &'static str;
    fn try_from(Numbers(numbers): Numbers<2>) -> Checked<Self> {
        let pair = DVec2::from(numbers).as_vec2();
        // Written so that what is no number fails.
        let some = pair.abs().cmple(Vec2::splat(LARGEST_TRANSFORM)).all();
        some.then_some(MapOffset(pair)).ok_or("expected two numbers from -1e6 to 1e6")
    }
}

impl TryFrom<Numbers<2>> for Shift {
    type Error = &'static str;
    fn try_from(Numbers(numbers): Numbers<2>) -> Checked<Self> {
        let pair = DVec2::from(numbers).as_vec2();
        // Written so that what is no number fails.
        let some = pair.abs().cmple(Vec2::splat(LARGEST_SHIFT)).all();
        some.then_some(Shift(pair))
            .ok_or("expected two numbers from -100 to 100: widths of the picture to the right, and heights upwards")
    }
}

impl TryFrom<f64> for Fov {
    type Error = &'static str;
    fn try_from(degrees: f64) -> Checked<Self> {
        let fov = degrees as f32;
        (fov > 0.0 && fov < 180.0).then_some(Fov(fov)).ok_or("expected degrees between 0 and 180, both excluded")
    }
}

impl TryFrom<f64> for Exponent {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        let exponent = number as f32;
        (0.0..=LARGEST_EXPONENT)
            .contains(&exponent)
            .then_some(Exponent(exponent))
            .ok_or("expected an exponent of at least 0, at most 1e8; sharper is a mirror (`reflection`)")
    }
}

impl TryFrom<f64> for Eta {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        let eta = number as f32;
        ETAS.contains(&eta).then_some(Eta(eta)).ok_or("expected an index of refraction from 0.01 to 100")
    }
}

impl TryFrom<f64> for NotNegative {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        let number = number as f32;
        (number.is_finite() && number >= 0.0)
            .then_some(NotNegative(number))
            .ok_or("expected a finite number of at least 0")
    }
}

impl TryFrom<f64> for Positive {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        let number = number as f32;
        (number.is_finite() && number > 0.0).then_some(Positive(number)).ok_or("expected a finite number above 0")
    }
}

impl TryFrom<f64> for Unit {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        (0.0..=1.0).contains(&number).then_some(Unit(number as f32)).ok_or("expected a number from 0 to 1")
    }
}

impl TryFrom<f64> for Probability {
    type Error = &'static str;
    fn try_from(number: f64) -> Checked<Self> {
        // Never or always would leave one kind of light out.
        let probability = number as f32;
        (probability > 0.0 && probability < 1.0)
            .then_some(Probability(probability))
            .ok_or("expected a probability above 0 and below 1")
    }
}

impl TryFrom<f64> for Angle {
    type Error = &'static str;
    fn try_from(degrees: f64) -> Checked<Self> {
        (0.0..=180.0).contains(&degrees).then_some(Angle(degrees as f32)).ok_or("expected degrees from 0 to 180")
    }
}

impl TryFrom<f64> for ConeAngle {
    type Error = &'static str;
    fn try_from(degrees: f64) -> Checked<Self> {
        let angle = degrees as f32;
        (0.0..=90.0).contains(&angle).then_some(ConeAngle(angle)).ok_or(
            "expected degrees from the axis, 0 to 90; what shines further is a \"point\", with a `profile` perhaps",
        )
    }
}

impl TryFrom<f64> for DiscAngle {
    type Error = &'static str;
    fn try_from(degrees: f64) -> Checked<Self> {
        let angle = degrees as f32;
        (angle == 0.0 || (LEAST_ANGLE..=180.0).contains(&angle))
            .then_some(DiscAngle(angle))
            .ok_or("expected the diameter in degrees, 0.0001 to 180 (the sun's is 0.53), or 0 for parallel light")
    }
}

impl TryFrom<f64> for FilterRadius {
    type Error = &'static str;
    fn try_from(pixels: f64) -> Checked<Self> {
        let radius = pixels as f32;
        (radius > 0.0 && radius <= LARGEST_FILTER_RADIUS)
            .then_some(FilterRadius(radius))
            .ok_or("expected pixels above 0, at most 64")
    }
}

impl TryFrom<i64> for Blades {
    type Error = &'static str;
    fn try_from(blades: i64) -> Checked<Self> {
        let valid = blades == 0 || (3..=MOST_BLADES).contains(&blades);
        valid.then_some(Blades(blades as u32)).ok_or("expected 3 to 64 blades, or 0 for a round aperture")
    }
}

impl TryFrom<StopsOrWord> for Exposure {
    type Error = &'static str;
    fn try_from(said: StopsOrWord) -> Checked<Self> {
        match said {
            StopsOrWord::Stops(stops) if stops.abs() <= LARGEST_EXPOSURE => {
                Ok(Exposure(crate::scene::Exposure::Stops(stops as f32)))
            }
            StopsOrWord::Word(word) if word == "auto" => Ok(Exposure(crate::scene::Exposure::Auto)),
            _ => Err("expected stops from -64 to 64, or \"auto\""),
        }
    }
}

impl TryFrom<i64> for Pixels {
    type Error = &'static str;
    fn try_from(pixels: i64) -> Checked<Self> {
        (1..=LARGEST_FILM).contains(&pixels).then_some(Pixels(pixels as u32)).ok_or("expected 1 to 65536 pixels")
    }
}

impl TryFrom<i64> for Bounces {
    type Error = &'static str;
    fn try_from(bounces: i64) -> Checked<Self> {
        let bounces = u32::try_from(bounces).ok().filter(|n| *n <= Estimator::MOST_BOUNCES);
        bounces.map(Bounces).ok_or("expected 0 to 1000000 bounces; for no limit leave it out")
    }
}

impl TryFrom<i64> for Samples {
    type Error = &'static str;
    fn try_from(samples: i64) -> Checked<Self> {
        let samples = u32::try_from(samples).ok().filter(|n| *n > 0);
        samples.map(Samples).ok_or("expected 1 to 4294967295 samples a pixel")
    }
}
