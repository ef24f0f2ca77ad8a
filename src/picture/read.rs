//! Pictures from disk, in any format that can be read.

use super::decode::ImageFile;
use super::openexr::{self, Opened};
use super::pfm;
use super::pixels::{MOST_PIXELS, Picture};
use super::source::Source;
use crate::{Error, Result};
use std::path::Path;

/// Reads an EXR, PFM or HDR file, or what the `image` crate decodes besides (PNG, JPEG, TIFF, ...); the content says which, not the name.
/// Grey becomes RGB, and other primaries those of sRGB. Where there is alpha, the picture is put on black.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, is no image, is damaged or truncated, has no pixels, or more than 2^28.
pub fn read(path: &Path) -> Result<Picture> {
    decode(path).map_err(|reason| Error::read(path, reason))
}

fn decode(path: &Path) -> std::result::Result<Picture, String> {
    let start = Source::File(path).first_bytes()?;
    match start[..] {
        [] => return Err("it is empty".into()),
        _ if start.starts_with(&openexr::MAGIC) => return Opened::new(path)?.picture(),
        [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace() => return pfm::open(path),
        _ => {}
    }
    let image = ImageFile::open(path, MOST_PIXELS, |_| String::new())?;
    let rgb = |texel: usize| {
        let [r, g, b, alpha] = image.linear(texel);
        [r, g, b].map(|v| if image.has_alpha { v * alpha } else { v })
    };
    Ok(Picture {
        width: image.width,
        height: image.height,
        rgb: (0..image.len()).map(rgb).collect(),
        error: None,
        clamped: !image.is_float(),
        warnings: image.warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, GrayAlphaImage, GrayImage, ImageBuffer, Luma, Rgb, RgbImage, Rgba, RgbaImage};

    fn saved(image: DynamicImage, name: &str) -> Picture {
        let folder = tempfile::tempdir().unwrap();
        image.save(folder.path().join(name)).unwrap();
        // The content counts, not the name.
        std::fs::rename(folder.path().join(name), folder.path().join("picture")).unwrap();
        read(&folder.path().join("picture")).unwrap()
    }

    fn near(found: [f32; 3], expected: [f32; 3]) {
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 2e-6), "{found:?} for {expected:?}");
    }

    /// Half of 255 and of 65535 is 0.2159 and 0.2140 in sRGB.
    #[test]
    fn png_of_every_kind() {
        let half = ((128.0 / 255.0 + 0.055) / 1.055f32).powf(2.4);
        let picture = saved(RgbImage::from_fn(2, 1, |x, _| Rgb([0, 255, 128 * x as u8])).into(), "a.png");
        assert!(picture.clamped && (picture.width, picture.height) == (2, 1));
        near(picture.rgb[0], [0.0, 1.0, 0.0]);
        near(picture.rgb[1], [0.0, 1.0, half]);
        near(saved(GrayImage::from_pixel(1, 1, Luma([128])).into(), "a.png").rgb[0], [half; 3]);
        near(saved(GrayAlphaImage::from_pixel(1, 1, image::LumaA([128, 51])).into(), "a.png").rgb[0], [half * 0.2; 3]);
        near(
            saved(RgbaImage::from_pixel(1, 1, Rgba([255, 128, 0, 51])).into(), "a.png").rgb[0],
            [0.2, half * 0.2, 0.0],
        );
        let sixteen: ImageBuffer<Rgb<u16>, _> = ImageBuffer::from_pixel(1, 1, Rgb([65535u16, 32768, 0]));
        near(saved(sixteen.into(), "a.png").rgb[0], [1.0, ((32768.0 / 65535.0 + 0.055) / 1.055f32).powf(2.4), 0.0]);
    }

    #[test]
    fn hdr_is_linear() {
        let floats: ImageBuffer<Rgb<f32>, _> = ImageBuffer::from_pixel(3, 2, Rgb([8.0f32, 0.5, 0.0]));
        let picture = saved(floats.into(), "a.hdr");
        assert!(!picture.clamped && picture.rgb.len() == 6);
        near(picture.rgb[5], [8.0, 0.5, 0.0]);
    }

    #[test]
    fn what_is_no_picture_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let says = |content: &[u8], part: &str| {
            let path = folder.path().join("a.png");
            std::fs::write(&path, content).unwrap();
            let error = read(&path).unwrap_err();
            assert!(
                error.exit_code() == 1 && error.to_string().contains("a.png") && error.to_string().contains(part),
                "{error}"
            );
        };
        says(b"", "it is empty");
        says(b"hello, this is not a picture", "cannot read");
        says(b"\x89PNG\r\n\x1a\n", "cannot read");
        says(b"\x76\x2f\x31\x01", "truncated");
        says(b"PF\n", "ends within");
        says(b"#?RADIANCE\n\n-Y 99999 +X 99999\n", "too large");
        assert!(read(folder.path()).unwrap_err().to_string().contains("is a folder"));
        assert!(read(&folder.path().join("none.exr")).unwrap_err().to_string().contains("No such file"));
        let mut png = std::io::Cursor::new(Vec::new());
        RgbImage::from_pixel(64, 64, Rgb([1, 2, 3])).write_to(&mut png, image::ImageFormat::Png).unwrap();
        let png = png.into_inner();
        for length in 5..png.len() - 12 {
            says(&png[..length], "cannot read");
        }
    }
}
