//! Images from disk, in whatever format the `image` crate decodes.

use image::{DynamicImage, ImageReader, Limits};
use std::path::Path;

/// Most texels in a row or a column.
const LARGEST_SIDE: u32 = 16_384;
/// Most bytes of memory that decoding may take: a small file can claim to be an enormous picture.
const MOST_MEMORY: u64 = 1 << 30;

/// A decoded image, four channels a texel, from the upper left, row by row.
#[derive(Debug)]
pub(super) struct ImageFile {
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
    /// Reads a file; its content says which format it is, and its ending only where the content does not.
    ///
    /// # Errors
    /// In words that can follow the file's name: it cannot be read, is no image, is damaged, or is too large.
    pub(super) fn open(path: &Path) -> Result<Self, String> {
        let about = std::fs::metadata(path).map_err(|e| e.to_string())?;
        if !about.is_file() {
            // A pipe or a device may never end.
            return Err(if about.is_dir() { "it is a folder" } else { "it is not a regular file" }.into());
        }
        let mut reader =
            ImageReader::open(path).and_then(ImageReader::with_guessed_format).map_err(|e| e.to_string())?;
        let mut limits = Limits::default();
        limits.max_image_width = Some(LARGEST_SIDE);
        limits.max_image_height = Some(LARGEST_SIDE);
        limits.max_alloc = Some(MOST_MEMORY);
        reader.limits(limits);
        let image = reader.decode().map_err(|error| match error {
            image::ImageError::Limits(_) => format!(
                "it is too large: at most {LARGEST_SIDE} x {LARGEST_SIDE} texels and {} GiB are read",
                MOST_MEMORY >> 30
            ),
            image::ImageError::Unsupported(_) => format!("it is in no format that can be read here ({error})"),
            _ => error.to_string(),
        })?;
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

    /// How many texels there are.
    pub(super) fn len(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// A texel's numbers as they are stored; whole numbers are scaled to [0, 1].
    pub(super) fn stored(&self, texel: usize) -> [f32; 4] {
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
    pub(super) fn linear(&self, texel: usize) -> [f32; 4] {
        let [r, g, b, a] = self.stored(texel);
        match self.texels {
            Texels::Float(_) => [r, g, b, a],
            _ => [linear(r), linear(g), linear(b), a],
        }
    }

    /// Whether alpha is below 1 anywhere.
    pub(super) fn has_transparency(&self) -> bool {
        self.has_alpha && (0..self.len()).any(|texel| self.stored(texel)[3] < 1.0)
    }
}

/// The linear value of a non-linear sRGB one in [0, 1] (IEC 61966-2-1).
fn linear(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decoding_is_the_inverse_of_what_is_written() {
        for code in 0..=255u8 {
            let value = f32::from(code) / 255.0;
            assert!((crate::image_io::srgb(linear(value)) - value).abs() < 1e-5, "{code}");
        }
        // The standard's formula worked out by hand.
        assert!((linear(0.5) - 0.214_041).abs() < 1e-6);
        assert!((linear(10.0 / 255.0) - 0.003_035_27).abs() < 1e-8);
    }
}
