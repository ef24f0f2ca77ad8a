//! Denoising through Intel's Open Image Denoise (<https://www.openimagedenoise.org>), with the feature `denoise`.
//!
//! What comes out looks better and is not a measurement any more: it has a bias that no estimate of the error knows.

use crate::film::{Aovs, Film};
use crate::picture::Values;
use crate::{Error, Result};
use oidn::{Device, RayTracing};

/// A film without its noise: linear RGB, row by row from the top. The library chooses the device.
///
/// # Errors
/// [`Error::Denoise`] in the library's words.
pub fn denoise(film: &Film, aovs: &Aovs) -> Result<Vec<f32>> {
    let words = |error: oidn::Error| Error::Denoise(format!("{error:?}"));
    let color = film.to_linear();
    // Channels come one by one, the library wants the numbers of a pixel together.
    let planes: Vec<Vec<f32>> = (aovs.channels().into_iter())
        .filter_map(|(_, values)| if let Values::Float(values) = values { Some(values) } else { None })
        .collect();
    let pixels = |first: usize| -> Vec<f32> {
        (0..film.pixels()).flat_map(|pixel| [0, 1, 2].map(|c| planes[first + c][pixel].clamp(-1.0, 1.0))).collect()
    };
    let (albedo, normal) = (pixels(0), pixels(3));
    let mut output = vec![0.0; color.len()];
    let device = Device::new().map_err(words)?;
    RayTracing::try_new(&device)
        .map_err(words)?
        .image_dimensions(film.width as usize, film.height as usize)
        .albedo_normal(&albedo, &normal)
        .hdr(true)
        .filter(&color, &mut output)
        .map_err(words)?;
    Ok(output)
}
