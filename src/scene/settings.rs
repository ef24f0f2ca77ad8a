//! How a scene is rendered: size of the picture, samples, seed, and how bright and by which curve it is shown.

use super::filter::Filter;
use crate::picture::Tone;
use crate::sampling::Sampler;

/// Size of the picture and its pixel filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// How a pixel weighs the light around it.
    pub filter: Filter,
    /// Half the width of the filter's square in pixels; greater than 0.
    pub filter_radius: f32,
}

impl FilmSettings {
    /// A film of the same shape, so many pixels wide.
    pub fn at_width(self, width: u32) -> Self {
        let height = f64::from(width) * f64::from(self.height) / f64::from(self.width);
        FilmSettings { width, height: height.round().max(1.0) as u32, ..self }
    }

    /// The filter is the pixel's own square, so that a film point needs no table.
    pub fn is_pixel_square(&self) -> bool {
        self.filter == Filter::Box && self.filter_radius == 0.5
    }
}

/// How bright a picture is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exposure {
    /// In stops: radiance times 2^stops.
    Stops(f32),
    /// As the program finds it by looking at the scene ([`development`](crate::backend::development)).
    Auto,
}

impl Exposure {
    /// The stops; none if they have to be found.
    pub fn stops(self) -> Option<f32> {
        match self {
            Exposure::Stops(stops) => Some(stops),
            Exposure::Auto => None,
        }
    }
}

/// What a scene file may say about its own rendering.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RenderSettings {
    /// Samples a pixel.
    pub spp: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// How bright a PNG shows the picture.
    pub exposure: Exposure,
    /// By which curve.
    pub tone: Tone,
    /// Where the random numbers come from.
    pub sampler: Sampler,
    /// The camera does not see where rays escape to, and the picture has alpha: the share of a pixel's samples that met something. The environment still lights
    /// the scene, and is seen in mirrors and through glass, which count as opaque.
    pub transparent: bool,
}

impl Default for RenderSettings {
    fn default() -> Self {
        RenderSettings {
            spp: 64,
            seed: 0,
            exposure: Exposure::Stops(0.0),
            tone: Tone::default(),
            sampler: Sampler::default(),
            transparent: false,
        }
    }
}

impl RenderSettings {
    /// For a model of which nothing is known: the exposure is found, and the curve shows base colours as they are without clipping highlights.
    pub fn automatic() -> Self {
        RenderSettings { exposure: Exposure::Auto, tone: Tone::Neutral, ..RenderSettings::default() }
    }
}
