//! Pictures to disk: PNG to look at, EXR and HDR to compute with.

use super::mark::{MARK, marked_hdr};
use super::openexr::Exr;
use super::{Development, Format, to_srgb8};
use crate::Result;
use crate::files::write_atomically;
use image::{ExtendedColorType, ImageEncoder, ImageError, ImageResult};
use std::io::Write;
use std::path::Path;

/// Writes linear RGB, row by row from the top, to `path` in the format of its ending. `how` is an exposure in stops, or
/// a whole [`Development`], and changes a PNG only.
///
/// # Errors
/// [`Error::Usage`](crate::Error::Usage) for an unknown ending, [`Error::Write`](crate::Error::Write) if the system refuses; then nothing has changed at `path`.
pub fn save_linear(path: &Path, width: u32, height: u32, linear: &[f32], how: impl Into<Development>) -> Result<()> {
    save_marked(path, (width, height), linear, how.into(), None)
}

/// The same, with a mark in the file's head ([`mark`](super::mark())); not in an EXR, whose mark is one of the film's attributes.
pub(crate) fn save_marked(
    path: &Path,
    (width, height): (u32, u32),
    linear: &[f32],
    how: Development,
    mark: Option<&str>,
) -> Result<()> {
    let format = Format::of(path)?;
    write_atomically(path, |out| match format {
        Format::Png => write_png(out, (width, height), png::ColorType::Rgb, &to_srgb8(linear, how), mark),
        Format::Exr => {
            let exr = Exr {
                width,
                height,
                rgb: bytemuck::cast_slice(linear),
                error: None,
                more: vec![],
                attributes: &[],
                crop: None,
            };
            Ok(out.write_all(&exr.encode().map_err(std::io::Error::other)?)?)
        }
        Format::Hdr => {
            let mut bytes = Vec::new();
            image::codecs::hdr::HdrEncoder::new(&mut bytes).write_image(
                bytemuck::cast_slice(&before_truncation(linear)),
                width,
                height,
                ExtendedColorType::Rgb32F,
            )?;
            if let Some(mark) = mark {
                bytes = marked_hdr(&bytes, mark);
            }
            Ok(out.write_all(&bytes)?)
        }
    })
}

/// Writes an 8-bit picture as a PNG.
///
/// # Errors
/// [`Error::Write`](crate::Error::Write) if the system refuses; then nothing has changed at `path`.
pub fn save_png(path: &Path, picture: &image::RgbImage) -> Result<()> {
    write_atomically(path, |out| write_png(out, picture.dimensions(), png::ColorType::Rgb, picture, None))
}

/// Writes a PNG with alpha. `linear` is linear RGB times alpha, row by row from the top, as it is added over a background; `alpha` is from 0 to 1. The file has colours
/// that are not multiplied, as PNG wants them (straight alpha).
///
/// # Errors
/// [`Error::Write`](crate::Error::Write) if the system refuses; then nothing has changed at `path`.
pub fn save_png_with_alpha(
    path: &Path,
    (width, height): (u32, u32),
    linear: &[f32],
    alpha: &[f32],
    how: impl Into<Development>,
) -> Result<()> {
    save_marked_with_alpha(path, (width, height), linear, alpha, how.into(), None)
}

/// The same, with a mark in the file's head.
pub(crate) fn save_marked_with_alpha(
    path: &Path,
    (width, height): (u32, u32),
    linear: &[f32],
    alpha: &[f32],
    how: Development,
    mark: Option<&str>,
) -> Result<()> {
    let unmultiplied = |(rgb, alpha): (&[f32], &f32)| match *alpha {
        0.0 => [0.0; 3],
        alpha => [rgb[0] / alpha, rgb[1] / alpha, rgb[2] / alpha],
    };
    let straight: Vec<f32> = linear.chunks_exact(3).zip(alpha).flat_map(unmultiplied).collect();
    let colours = to_srgb8(&straight, how);
    let eight_bits = |alpha: &f32| (255.0 * alpha.clamp(0.0, 1.0)).round() as u8;
    let rgba: Vec<u8> =
        colours.chunks_exact(3).zip(alpha).flat_map(|(c, alpha)| [c[0], c[1], c[2], eight_bits(alpha)]).collect();
    write_atomically(path, |out| write_png(out, (width, height), png::ColorType::Rgba, &rgba, mark))
}

/// 8 bits a channel, with the name of the program that made them, by which it knows its own files again.
fn write_png(
    out: &mut dyn Write,
    (width, height): (u32, u32),
    colour: png::ColorType,
    channels: &[u8],
    mark: Option<&str>,
) -> ImageResult<()> {
    let failed = |e: png::EncodingError| ImageError::IoError(e.into());
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.add_text_chunk("Software".into(), "luminaire".into()).map_err(failed)?;
    if let Some(mark) = mark {
        encoder.add_text_chunk(MARK.into(), mark.into()).map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(channels).map_err(failed)?;
    writer.finish().map_err(failed)
}

/// Half a step of RGBE more of everything: the encoder truncates, which would make a picture darker by half a step in the mean (2 % in the
/// weakest channel of the Cornell box).
fn before_truncation(linear: &[f32]) -> Vec<f32> {
    let more = |pixel: &[f32]| {
        let largest = pixel.iter().copied().fold(0.0, f32::max);
        let power = (largest.log2().floor() + 1.0).exp2();
        let step = power / 256.0;
        // The largest channel may be rounded up to the next power of two, where steps are twice as long.
        let half = if largest + 0.5 * step >= power { step } else { 0.5 * step };
        let more = |v: &f32| if largest > 0.0 && half.is_finite() { v + half } else { *v };
        [more(&pixel[0]), more(&pixel[1]), more(&pixel[2])]
    };
    linear.chunks_exact(3).flat_map(more).collect()
}
