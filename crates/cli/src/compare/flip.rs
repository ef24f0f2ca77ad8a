//! FLIP of two pictures, at the exposures at which people look at them.

use luminaire::picture::{Picture, bytes_in_words};
use luminaire::{Error, Result};
use luminaire_measure::{flip, metrics};
use serde::Serialize;

/// FLIP of two pictures, and the exposures it was taken at.
#[derive(Serialize)]
pub struct Flip {
    /// The mean over all pixels, from 0 to 1.
    pub mean: f64,
    /// The value of the worst pixel.
    pub largest: f32,
    /// From which exposure to which.
    pub exposures: Exposures,
    /// How many exposures there were; 1 where the pictures were shown as PNGs are.
    pub count: u32,
}

/// Bytes of memory that FLIP takes a pixel at most, beside the two pictures. Measured.
const MEMORY: u64 = 150;

impl Flip {
    /// Refuses pictures for which the memory that is free is not enough.
    ///
    /// # Errors
    /// [`Error::Limit`].
    pub fn fits((width, height): (u32, u32), free: Option<u64>) -> Result<()> {
        let needed = MEMORY * u64::from(width) * u64::from(height);
        match free.filter(|free| needed > *free) {
            None => Ok(()),
            Some(free) => Err(Error::Limit {
                what: format!("FLIP of {width} x {height} pixels"),
                needed: format!("{} of memory", bytes_in_words(needed)),
                device: "this machine".into(),
                limit: format!("{}, what is free now", bytes_in_words(free)),
                advice: "compare smaller pictures, or a part of them".into(),
            }),
        }
    }

    /// FLIP of a picture and its reference; at one exposure in stops, if it is given.
    pub fn new(image: &Picture, reference: &Picture, exposure: Option<f32>) -> Self {
        let (width, height) = (image.width as usize, image.height as usize);
        // A pixel that is not finite in one of them is black in both.
        let pixels = |picture: &Picture, scale: f32| -> Vec<[f32; 3]> {
            let pairs = image.rgb.iter().zip(&reference.rgb).zip(&picture.rgb);
            let known = |((a, b), pixel): ((&[f32; 3], &[f32; 3]), &[f32; 3])| {
                if metrics::finite(a) && metrics::finite(b) { pixel.map(|v| (v * scale).max(0.0)) } else { [0.0; 3] }
            };
            pairs.map(known).collect()
        };
        let (map, exposures, count) = if exposure.is_some() || image.clamped || reference.clamped {
            let exposure = exposure.unwrap_or(0.0);
            let shown = |picture: &Picture| pixels(picture, if picture.clamped { 1.0 } else { exposure.exp2() });
            let map = flip::low_dynamic_range(width, height, &shown(image), &shown(reference));
            (map, Exposures { first: exposure, last: exposure }, 1)
        } else {
            let all = flip::high_dynamic_range(width, height, &pixels(image, 1.0), &pixels(reference, 1.0));
            let (first, last) = all.exposures;
            (all.map, Exposures { first, last }, all.count)
        };
        Flip { mean: flip::mean(&map), largest: map.iter().copied().fold(0.0, f32::max), exposures, count }
    }
}

/// A range of exposures in stops; in JSON, a list of two numbers.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(into = "[f32; 2]")]
pub struct Exposures {
    /// The lowest.
    pub first: f32,
    /// The highest.
    pub last: f32,
}

impl From<Exposures> for [f32; 2] {
    fn from(Exposures { first, last }: Exposures) -> Self {
        [first, last]
    }
}
