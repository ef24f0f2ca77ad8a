//! Images from disk or from memory, as textures and environments need them: OpenEXR, and whatever the `image` crate decodes.

use super::encoding::{Curve, Encoding};
use super::pixels::{self, io_in_words};
use super::radiance::{self, Radiance};
use super::source::Source;
use super::srgb::linear;
use super::{foreign, icc, openexr, png_colours};
use crate::memory::available;
use glam::{DMat3, DVec3};
use half::f16;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use rayon::prelude::*;
use std::sync::LazyLock;

/// Most texels in a row or a column.
const LARGEST_SIDE: u32 = 16_384;
/// Most bytes of memory that decoding may take: a small file can claim to be an enormous picture.
const MOST_MEMORY: u64 = 1 << 30;

/// Most bytes that all but the texels may take, colour profiles for example: they are compressed too.
const MOST_HEADER: u64 = 16 << 20;

/// So many texels are worth another thread.
pub(crate) const CHUNK: usize = 1 << 14;

/// The linear values of all sRGB codes of 8 bits.
static LINEAR_8: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=u8::MAX).map(|code| linear(f32::from(code) / 255.0)).collect());
/// The linear values of all sRGB codes of 16 bits; few images have so many.
static LINEAR_16: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=u16::MAX).map(|code| linear(f32::from(code) / 65_535.0)).collect());

/// A decoded image, four channels a texel, from the upper left, row by row.
#[derive(Debug)]
pub(crate) struct ImageFile {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// The file has an alpha channel.
    pub has_alpha: bool,
    /// What was guessed or ignored, in words that can follow the file's name.
    pub warnings: Vec<String>,
    /// The file says that it holds the six sides of a cube.
    pub cube: bool,
    /// Its colours are multiplied by its alpha already.
    premultiplied: bool,
    texels: Texels,
    /// The linear red, green and blue of each code, where whole numbers are not sRGB.
    table: Option<Vec<[f32; 3]>>,
    /// From linear values to linear sRGB, where the file has other primaries.
    matrix: Option<DMat3>,
}

#[derive(Debug)]
enum Texels {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
    /// Linear already.
    Float(Vec<f32>),
}

impl ImageFile {
    /// Reads a picture; its content says which format it is, and the ending of its name only where the content does not. An image of more than
    /// `most` texels is refused as soon as its header says the size, in the words of `too_many`, which is given that number.
    ///
    /// # Errors
    /// In words that can follow its name: it cannot be read, is no image, is damaged, or is too large.
    pub(crate) fn open<'a>(
        source: impl Into<Source<'a>>,
        most: u64,
        too_many: impl FnOnce(u64) -> String,
    ) -> Result<Self, String> {
        let source = source.into();
        let start = source.first_bytes()?;
        if start.starts_with(&openexr::MAGIC) {
            return Self::open_exr(source, most, too_many);
        }
        if radiance::begins(&start) {
            return Self::open_radiance(source, most, too_many);
        }
        let mut warnings = Vec::new();
        let stream = || source.open().map_err(|e| e.to_string());
        let mut reader = ImageReader::new(stream()?);
        if let Ok(format) = ImageFormat::from_path(source.name()) {
            reader.set_format(format);
        }
        let mut reader = reader.with_guessed_format().map_err(|e| e.to_string())?;
        let mut limits = Limits::default();
        limits.max_image_width = Some(LARGEST_SIDE);
        limits.max_image_height = Some(LARGEST_SIDE);
        limits.max_alloc = Some(MOST_HEADER);
        reader.limits(limits.clone());
        let mut decoder = reader.into_decoder().map_err(|error| match error {
            ImageError::Limits(_) => too_large(),
            error => foreign::named(source.name(), &start)
                .or_else(|| foreign::unknown(source.name(), &start))
                .unwrap_or_else(|| in_words(error)),
        })?;
        let (width, height) = decoder.dimensions();
        let texels = u64::from(width) * u64::from(height);
        if texels > most {
            return Err(too_many(texels));
        }
        limits.max_alloc = Some(MOST_MEMORY);
        // What the decoder takes for itself may be on top of the picture.
        let colour = decoder.color_type();
        let channel = u64::from(colour.bytes_per_pixel() / colour.channel_count().max(1));
        check_memory((width, height), decoder.total_bytes(), channel, available())?;
        limits.reserve(decoder.total_bytes()).map_err(in_words)?;
        decoder.set_limits(limits).map_err(in_words)?;
        // One that cannot be read is as good as none.
        let profile = decoder.icc_profile().ok().flatten();
        let image = DynamicImage::from_decoder(decoder).map_err(in_words)?;
        let (width, height, has_alpha) = (image.width(), image.height(), image.color().has_alpha());
        if width == 0 || height == 0 {
            return Err("it has no texels".into());
        }
        let colours = match profile {
            _ if start.starts_with(&png_colours::MAGIC) => png_colours::encoding(stream()?, &mut warnings)?,
            Some(profile) => icc::encoding(&profile, &mut warnings),
            None => Encoding::SRGB,
        };
        let texels = match &image {
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
                Texels::Float(image.into_rgba32f().into_raw())
            }
            _ if image.color().bytes_per_pixel() > image.color().channel_count() => {
                Texels::Sixteen(image.into_rgba16().into_raw())
            }
            _ => Texels::Eight(image.into_rgba8().into_raw()),
        };
        let table = match &texels {
            Texels::Float(_) => {
                // Without a profile, or with one of sRGB, floats are linear as everywhere.
                if colours.curve != Curve::Srgb && !colours.curve.is_linear() {
                    warnings.push(
                        "its numbers are floats and are taken as linear, which its colour profile says they are not"
                            .into(),
                    );
                }
                None
            }
            Texels::Eight(_) => colours.curve.table(1 << 8),
            Texels::Sixteen(_) => colours.curve.table(1 << 16),
        };
        let table = table.filter(|_| !colours.curve.is_srgb());
        let matrix = colours.matrix;
        Ok(ImageFile { width, height, has_alpha, warnings, cube: false, premultiplied: false, texels, table, matrix })
    }

    fn open_radiance(source: Source, most: u64, too_many: impl FnOnce(u64) -> String) -> Result<Self, String> {
        let mut warnings = Vec::new();
        let file = Radiance::open(source, &mut warnings)?;
        let (width, height) = (file.width, file.height);
        let texels = u64::from(width) * u64::from(height);
        // Three channels as they are decoded.
        let stored = texels * 12;
        if width > LARGEST_SIDE || height > LARGEST_SIDE || stored > MOST_MEMORY {
            return Err(too_large());
        }
        if texels > most {
            return Err(too_many(texels));
        }
        if !file.is_long_enough() {
            return Err("it is truncated: so few bytes cannot hold so many scanlines".into());
        }
        check_memory((width, height), stored, 4, available())?;
        let matrix = file.matrix;
        let texels = Texels::Float(file.rgba().map_err(in_words)?);
        Ok(ImageFile {
            width,
            height,
            has_alpha: false,
            warnings,
            cube: false,
            premultiplied: false,
            texels,
            table: None,
            matrix,
        })
    }

    fn open_exr(source: Source, most: u64, too_many: impl FnOnce(u64) -> String) -> Result<Self, String> {
        let file = openexr::Opened::new(source)?;
        let (width, height) = file.size();
        let texels = u64::from(width) * u64::from(height);
        let stored = texels * if file.has_alpha() { 16 } else { 12 };
        if width > LARGEST_SIDE || height > LARGEST_SIDE || stored > MOST_MEMORY {
            return Err(too_large());
        }
        if texels > most {
            return Err(too_many(texels));
        }
        check_memory((width, height), stored, 4, available())?;
        let mut warnings = file.warnings.clone();
        if !file.has_alpha() {
            warnings.extend(file.cropped());
        }
        Ok(ImageFile {
            width,
            height,
            has_alpha: file.has_alpha(),
            warnings,
            cube: file.is_cube(),
            premultiplied: file.has_alpha(),
            texels: Texels::Float(file.rgba()?),
            table: None,
            matrix: file.matrix(),
        })
    }

    /// How many texels there are.
    pub(crate) fn len(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Whether the file holds floats, which are linear.
    pub(crate) fn is_float(&self) -> bool {
        matches!(self.texels, Texels::Float(_))
    }

    /// A texel's numbers as they are stored; whole numbers are scaled to [0, 1].
    pub(crate) fn stored(&self, texel: usize) -> [f32; 4] {
        let channels = 4 * texel..4 * texel + 4;
        let mut rgba = [0.0; 4];
        match &self.texels {
            Texels::Eight(data) => {
                rgba.iter_mut().zip(&data[channels]).for_each(|(to, from)| *to = f32::from(*from) / 255.0);
            }
            Texels::Sixteen(data) => {
                rgba.iter_mut().zip(&data[channels]).for_each(|(to, from)| *to = f32::from(*from) / 65_535.0);
            }
            Texels::Float(data) => rgba.copy_from_slice(&data[channels]),
        }
        rgba
    }

    /// Whether decoding can leave colours that are negative, not finite, or brighter than white.
    pub(crate) fn is_unbounded(&self) -> bool {
        self.is_float() || self.matrix.is_some()
    }

    /// Whether colours are multiplied by alpha already.
    pub(crate) fn is_premultiplied(&self) -> bool {
        self.premultiplied
    }

    /// Less than this share of a texel's largest channel is what is left of rounding: what is exactly on the edge of one set of primaries
    /// comes out beside it in another.
    pub(crate) fn rounding(&self) -> f32 {
        if self.matrix.is_some() { 2e-3 } else { 0.0 }
    }

    /// A texel's linear colour in sRGB's primaries, and alpha: whole numbers are decoded as the file says, which without a word is as sRGB, but
    /// for alpha; floats are linear as they are.
    pub(crate) fn linear(&self, texel: usize) -> [f32; 4] {
        let [r, g, b, a] = self.stored(texel);
        let at = |channel: usize| 4 * texel + channel;
        let decoded = |channel: usize, code: usize, srgb: &[f32]| match &self.table {
            Some(table) => table[code][channel],
            None => srgb[code],
        };
        let rgb = match &self.texels {
            Texels::Float(_) => [r, g, b],
            Texels::Eight(data) => [0, 1, 2].map(|channel| decoded(channel, data[at(channel)].into(), &LINEAR_8)),
            Texels::Sixteen(data) => [0, 1, 2].map(|channel| decoded(channel, data[at(channel)].into(), &LINEAR_16)),
        };
        let [r, g, b] = match self.matrix {
            // A grey is a grey.
            Some(matrix) if rgb != [rgb[0]; 3] => (matrix * DVec3::from(rgb.map(f64::from))).as_vec3().to_array(),
            _ => rgb,
        };
        [r, g, b, a]
    }

    /// The same, but with colours that are not multiplied by alpha; where alpha is 0, they are as they are stored.
    pub(crate) fn straight(&self, texel: usize) -> [f32; 4] {
        let [r, g, b, a] = self.linear(texel);
        if self.premultiplied && a > 0.0 && a < 1.0 { [r / a, g / a, b / a, a] } else { [r, g, b, a] }
    }

    /// All texels: `colour` of the linear colours, and `alpha` of alpha. Colours are as [`ImageFile::straight`] has them, or as [`ImageFile::linear`].
    pub(crate) fn decode(
        &self,
        straight: bool,
        colour: impl Fn(f32) -> f16 + Sync,
        alpha: impl Fn(f32) -> f16 + Sync,
    ) -> Vec<[f16; 4]> {
        if let (Texels::Eight(data), None, None) = (&self.texels, &self.table, &self.matrix) {
            let colours: Vec<f16> = LINEAR_8.iter().map(|value| colour(*value)).collect();
            let alphas: Vec<f16> = (0..=u8::MAX).map(|code| alpha(f32::from(code) / 255.0)).collect();
            let [colour, alpha] = [&colours, &alphas].map(|table| |code: u8| table[usize::from(code)]);
            let texel = |t: &[u8]| [colour(t[0]), colour(t[1]), colour(t[2]), alpha(t[3])];
            return data.par_chunks_exact(4).with_min_len(CHUNK).map(texel).collect();
        }
        let texel = |texel| {
            let [r, g, b, a] = if straight { self.straight(texel) } else { self.linear(texel) };
            [colour(r), colour(g), colour(b), alpha(a)]
        };
        (0..self.len()).into_par_iter().with_min_len(CHUNK).map(texel).collect()
    }

    /// Whether alpha is below 1 anywhere.
    pub(crate) fn has_transparency(&self) -> bool {
        self.has_alpha
            && match &self.texels {
                Texels::Eight(data) => data.chunks_exact(4).any(|texel| texel[3] < u8::MAX),
                Texels::Sixteen(data) => data.chunks_exact(4).any(|texel| texel[3] < u16::MAX),
                Texels::Float(data) => data.chunks_exact(4).any(|texel| texel[3] < 1.0),
            }
    }
}

/// Refuses what the memory that is free cannot take: the picture as it is stored, as four channels of so many bytes, and as half floats.
fn check_memory((width, height): (u32, u32), stored: u64, channel: u64, available: Option<u64>) -> Result<(), String> {
    let needed = stored + u64::from(width) * u64::from(height) * (4 * channel + 8);
    pixels::fits((width, height), needed, available)
}

fn too_large() -> String {
    format!("it is too large: at most {LARGEST_SIDE} x {LARGEST_SIDE} texels and {} GiB are read", MOST_MEMORY >> 30)
}

/// What a decoder complains about.
fn in_words(error: ImageError) -> String {
    match error {
        ImageError::Limits(_) => too_large(),
        ImageError::Unsupported(_) => format!("it is in no format that can be read here ({error})"),
        ImageError::IoError(error) => io_in_words(error),
        // What decoders say of their own data is for those who write decoders.
        ImageError::Decoding(error) => match error.to_string() {
            what if what.contains(['{', '\n']) => "it is damaged or cut off".into(),
            what => format!("it is damaged or cut off ({what})"),
        },
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_memory_cannot_take_is_refused() {
        // 3 bytes a texel in the file, then 4, then 8.
        assert_eq!(check_memory((100, 10), 3000, 1, Some(15_000)), Ok(()));
        let error = check_memory((100, 10), 3000, 1, Some(14_999)).unwrap_err();
        assert!(error.contains("100 x 10") && error.contains("make it smaller"), "{error}");
        assert_eq!(check_memory((100, 10), 3000, 1, None), Ok(()));
    }

    fn image(width: u32, texels: Texels) -> ImageFile {
        ImageFile {
            width,
            height: 1,
            has_alpha: true,
            warnings: vec![],
            cube: false,
            premultiplied: true,
            texels,
            table: None,
            matrix: None,
        }
    }

    #[test]
    fn premultiplied_colours_are_divided_where_that_is_asked_for() {
        let texels = vec![0.1, 0.2, 0.4, 0.5, 3.0, 0.0, 1.0, 0.0, 0.3, 0.3, 0.3, 1.0];
        let image = image(3, Texels::Float(texels));
        let found = [0, 1, 2].map(|texel| image.straight(texel));
        assert_eq!(found, [[0.2, 0.4, 0.8, 0.5], [3.0, 0.0, 1.0, 0.0], [0.3, 0.3, 0.3, 1.0]]);
        let decoded = |straight| image.decode(straight, f16::from_f32, f16::from_f32)[0][0].to_f32();
        assert!((decoded(true) - 0.2).abs() < 1e-3 && (decoded(false) - 0.1).abs() < 1e-3);
    }

    #[test]
    fn tables_hold_what_the_formula_gives() {
        let eight: Vec<u8> = (0..=255).collect();
        let sixteen: Vec<u16> = (0..=u16::MAX).collect();
        let texels = [(64, 255.0, Texels::Eight(eight)), (16_384, 65_535.0, Texels::Sixteen(sixteen))];
        for (width, largest, texels) in texels {
            let image = image(width, texels);
            let decoded = image.decode(false, f16::from_f32, f16::from_f32);
            assert_eq!(decoded.len(), width as usize);
            for (texel, decoded) in decoded.iter().enumerate() {
                let codes: [f32; 4] = std::array::from_fn(|channel| (4 * texel + channel) as f32 / largest);
                let [r, g, b, a] = codes;
                let expected = [linear(r), linear(g), linear(b), a];
                assert_eq!(image.linear(texel), expected);
                assert_eq!(*decoded, expected.map(f16::from_f32));
            }
        }
    }
}
