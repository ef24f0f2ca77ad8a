//! Images from disk, as textures and environments need them: OpenEXR, and whatever the `image` crate decodes.

use super::first_bytes::first_bytes;
use super::openexr;
use super::srgb::linear;
use crate::memory::{available, gib};
use half::f16;
use image::{DynamicImage, ImageDecoder, ImageError, ImageReader, Limits};
use rayon::prelude::*;
use std::path::Path;
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
    texels: Texels,
}

#[derive(Debug)]
enum Texels {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
    /// Linear already.
    Float(Vec<f32>),
}

impl ImageFile {
    /// Reads a file; its content says which format it is, and its ending only where the content does not. An image of more than
    /// `most` texels is refused as soon as its header says the size, in the words of `too_many`, which is given that number.
    ///
    /// # Errors
    /// In words that can follow the file's name: it cannot be read, is no image, is damaged, or is too large.
    pub(crate) fn open(path: &Path, most: u64, too_many: impl FnOnce(u64) -> String) -> Result<Self, String> {
        if first_bytes(path)? == openexr::MAGIC {
            return Self::open_exr(path, most, too_many);
        }
        let mut reader =
            ImageReader::open(path).and_then(ImageReader::with_guessed_format).map_err(|e| e.to_string())?;
        let mut limits = Limits::default();
        limits.max_image_width = Some(LARGEST_SIDE);
        limits.max_image_height = Some(LARGEST_SIDE);
        limits.max_alloc = Some(MOST_HEADER);
        reader.limits(limits.clone());
        let mut decoder = reader.into_decoder().map_err(in_words)?;
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
        let image = DynamicImage::from_decoder(decoder).map_err(in_words)?;
        let (width, height, has_alpha) = (image.width(), image.height(), image.color().has_alpha());
        if width == 0 || height == 0 {
            return Err("it has no texels".into());
        }
        let texels = match &image {
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
                Texels::Float(image.into_rgba32f().into_raw())
            }
            _ if image.color().bytes_per_pixel() > image.color().channel_count() => {
                Texels::Sixteen(image.into_rgba16().into_raw())
            }
            _ => Texels::Eight(image.into_rgba8().into_raw()),
        };
        Ok(ImageFile { width, height, has_alpha, texels })
    }

    fn open_exr(path: &Path, most: u64, too_many: impl FnOnce(u64) -> String) -> Result<Self, String> {
        let file = openexr::Opened::new(path, openexr::Several::First)?;
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
        Ok(ImageFile { width, height, has_alpha: file.has_alpha(), texels: Texels::Float(file.rgba()?) })
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

    /// A texel's linear colour and alpha: whole numbers are taken as sRGB, but for alpha; floats are linear as they are.
    pub(crate) fn linear(&self, texel: usize) -> [f32; 4] {
        let [r, g, b, a] = self.stored(texel);
        let at = |channel: usize| 4 * texel + channel;
        match &self.texels {
            Texels::Float(_) => [r, g, b, a],
            Texels::Eight(data) => {
                let colour = |channel| LINEAR_8[usize::from(data[at(channel)])];
                [colour(0), colour(1), colour(2), a]
            }
            Texels::Sixteen(data) => {
                let colour = |channel| LINEAR_16[usize::from(data[at(channel)])];
                [colour(0), colour(1), colour(2), a]
            }
        }
    }

    /// All texels: `colour` of the linear colours (see [`ImageFile::linear`]), and `alpha` of alpha.
    pub(crate) fn decode(
        &self,
        colour: impl Fn(f32) -> f16 + Sync,
        alpha: impl Fn(f32) -> f16 + Sync,
    ) -> Vec<[f16; 4]> {
        if let Texels::Eight(data) = &self.texels {
            let colours: Vec<f16> = LINEAR_8.iter().map(|value| colour(*value)).collect();
            let alphas: Vec<f16> = (0..=u8::MAX).map(|code| alpha(f32::from(code) / 255.0)).collect();
            let [colour, alpha] = [&colours, &alphas].map(|table| |code: u8| table[usize::from(code)]);
            let texel = |t: &[u8]| [colour(t[0]), colour(t[1]), colour(t[2]), alpha(t[3])];
            return data.par_chunks_exact(4).with_min_len(CHUNK).map(texel).collect();
        }
        let texel = |texel| {
            let [r, g, b, a] = self.linear(texel);
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
    match available {
        Some(free) if needed > free => Err(format!(
            "it has {width} x {height} texels, which take {} of memory, of which {} are free: make it smaller",
            gib(needed),
            gib(free)
        )),
        _ => Ok(()),
    }
}

fn too_large() -> String {
    format!("it is too large: at most {LARGEST_SIDE} x {LARGEST_SIDE} texels and {} GiB are read", MOST_MEMORY >> 30)
}

/// What a decoder complains about.
fn in_words(error: ImageError) -> String {
    match error {
        ImageError::Limits(_) => too_large(),
        ImageError::Unsupported(_) => format!("it is in no format that can be read here ({error})"),
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

    #[test]
    fn tables_hold_what_the_formula_gives() {
        let eight: Vec<u8> = (0..=255).collect();
        let sixteen: Vec<u16> = (0..=u16::MAX).collect();
        let texels = [(64, 255.0, Texels::Eight(eight)), (16_384, 65_535.0, Texels::Sixteen(sixteen))];
        for (width, largest, texels) in texels {
            let image = ImageFile { width, height: 1, has_alpha: true, texels };
            let decoded = image.decode(f16::from_f32, f16::from_f32);
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
