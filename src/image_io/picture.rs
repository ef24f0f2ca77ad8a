//! Pictures from disk, as numbers to compute with.

use super::image_file::ImageFile;
use super::{openexr, pfm};
use crate::{Error, Result};
use std::io::Read;
use std::path::Path;

/// Most pixels of a picture: a small file can claim to be an enormous one.
pub(super) const MOST_PIXELS: u64 = 1 << 28;

/// A picture in linear RGB, rows from the top. Numbers that are not finite are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// The pixels.
    pub rgb: Vec<[f32; 3]>,
    /// The standard error of each of these numbers, where the file has it (the channels `error.R`, `error.G`, `error.B` of an EXR).
    pub error: Option<Vec<[f32; 3]>>,
    /// Whether the file holds whole numbers, which end at white; they have been decoded as sRGB.
    pub clamped: bool,
}

/// Reads an EXR, PFM or HDR file, or what the `image` crate decodes besides (PNG, JPEG, TIFF, ...); the content says which, not the name.
/// Grey becomes RGB. Where there is alpha, the picture is put on black.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, is no image, is damaged or truncated, has no pixels, or more than 2^28.
pub fn read(path: &Path) -> Result<Picture> {
    decode(path).map_err(|reason| Error::read(path, reason))
}

fn decode(path: &Path) -> std::result::Result<Picture, String> {
    let about = std::fs::metadata(path).map_err(|e| e.to_string())?;
    if !about.is_file() {
        // A pipe or a device may never end.
        return Err(if about.is_dir() { "it is a folder" } else { "it is not a regular file" }.into());
    }
    let mut start = Vec::new();
    let file = std::fs::File::open(path).map_err(|e| e.to_string())?;
    file.take(4).read_to_end(&mut start).map_err(|e| e.to_string())?;
    match start[..] {
        [] => return Err("it is empty".into()),
        [0x76, 0x2f, 0x31, 0x01] => return openexr::open(path),
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
    })
}

/// Why a picture is refused that says it is enormous.
pub(super) fn too_large(width: u64, height: u64) -> String {
    format!("it says that it has {width} x {height} pixels; at most {MOST_PIXELS} are read")
}
