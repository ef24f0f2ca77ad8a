//! Reads the picture of an OpenEXR file that any program may have written.

use super::choice::Choice;
use super::in_words;
use crate::memory::available;
use crate::picture::pixels::{MOST_PIXELS, Picture, fits, io_in_words, too_large};
use crate::picture::primaries::Primaries;
use crate::picture::source::Source;
use ::exr::math::Vec2;
use ::exr::meta::MetaData;
use ::exr::meta::attribute::EnvironmentMap;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, read};
use glam::{DMat3, DVec2, DVec3};

/// What is to be done with a crop.
const WHAT_TO_DO: &str =
    "write the whole picture, or the crop as a picture of its own (data window and display window the same)";

/// A file of which the head was read.
#[derive(Debug)]
pub(in crate::picture) struct Opened<'a> {
    source: Source<'a>,
    choice: Choice,
    window: Window,
    /// Blocks of the part with the picture.
    chunks: u64,
    /// From its primaries to those of sRGB.
    matrix: Option<DMat3>,
    cube: bool,
    /// What was guessed or ignored, in words that can follow the file's name.
    pub warnings: Vec<String>,
}

impl<'a> Opened<'a> {
    /// Reads the head of a file and finds the picture in it.
    ///
    /// # Errors
    /// In words that can follow the file's name.
    pub(in crate::picture) fn new(source: impl Into<Source<'a>>) -> Result<Self, String> {
        let source = source.into();
        let stream = source.open().map_err(io_in_words)?;
        let meta = MetaData::read_from_buffered(stream, false).map_err(in_words)?;
        let mut warnings = Vec::new();
        let choice = Choice::new(&meta.headers, &mut warnings)?;
        let header = &meta.headers[choice.part];
        let window = Window::new(header)?;
        let matrix = primaries(header).map_or(Ok(None), Primaries::to_srgb).unwrap_or_else(|why| {
            warnings.push(format!("its chromaticities {why}; they are taken as those of sRGB"));
            None
        });
        let cube = header.own_attributes.environment_map == Some(EnvironmentMap::Cube);
        Ok(Opened { source, window, chunks: header.chunk_count as u64, matrix, cube, warnings, choice })
    }

    /// Width and height in pixels.
    pub(in crate::picture) fn size(&self) -> (u32, u32) {
        (self.window.width as u32, self.window.height as u32)
    }

    /// Whether there is alpha.
    pub(in crate::picture) fn has_alpha(&self) -> bool {
        self.choice.alpha.is_some()
    }

    /// The matrix to linear sRGB, where the file has other primaries.
    pub(in crate::picture) fn matrix(&self) -> Option<DMat3> {
        self.matrix
    }

    /// Whether the file says that it holds the six sides of a cube.
    pub(in crate::picture) fn is_cube(&self) -> bool {
        self.cube
    }

    /// A warning if not all of the pixels that are shown are stored.
    pub(in crate::picture) fn cropped(&self) -> Option<String> {
        self.window.check_whole().err().map(|why| format!("{why}; {WHAT_TO_DO}; 0 is used outside"))
    }

    /// The picture, in sRGB's primaries. Integers are taken as the numbers they are, luminance alone as grey; alpha is left out, since colours are stored as
    /// they are over black.
    ///
    /// # Errors
    /// In words that can follow the file's name; pixels that are shown and not stored are one, but where the file holds a crop, which is a picture of its own.
    pub(in crate::picture) fn picture(&self) -> Result<Picture, String> {
        let mut warnings = self.warnings.clone();
        let window = self.window.pixels(&mut warnings)?;
        let (width, height) = (window.width as u32, window.height as u32);
        let sizes = [(width as usize, height as usize), self.window.stored].map(|(w, h)| (w as u64, h as u64));
        if let Some((width, height)) = sizes.into_iter().find(|(w, h)| w.saturating_mul(*h) > MOST_PIXELS) {
            return Err(too_large(width, height));
        }
        // Three floats a pixel, and three of its error.
        let numbers = if self.choice.error.is_some() { 6 } else { 3 };
        fits((width, height), 4 * numbers * u64::from(width) * u64::from(height), available())?;
        let colours = |names: &[String; 3]| self.read(window, names, None, |[r, g, b, _]| [r, g, b]);
        let (mut rgb, mut error) = (colours(&self.choice.rgb)?, self.choice.error.as_ref().map(colours).transpose()?);
        if let Some(matrix) = self.matrix {
            // A grey is a grey.
            rgb.iter_mut().filter(|rgb| **rgb != [rgb[0]; 3]).for_each(|rgb| {
                *rgb = (matrix * DVec3::from(rgb.map(f64::from))).as_vec3().to_array();
            });
            if error.take().is_some() {
                warnings.push("its error channels are ignored: they are those of other primaries".into());
            }
        }
        Ok(Picture { width, height, rgb, error, clamped: false, warnings })
    }

    /// Red, green, blue, in the file's own primaries, and alpha (1 in a file without it) of every pixel. Outside of a crop all that are there are 0.
    ///
    /// # Errors
    /// In words that can follow the file's name.
    pub(in crate::picture) fn rgba(&self) -> Result<Vec<f32>, String> {
        Ok(self.read(self.window, &self.choice.rgb, self.choice.alpha.as_deref(), |rgba| rgba)?.into_flattened())
    }

    /// What `pixel` makes of red, green, blue and alpha of every pixel in a window; no other channel and no other part takes memory. Outside of a crop all are 0,
    /// and so is alpha in a file that has it.
    fn read<T: Copy + 'static>(
        &self,
        window: Window,
        names: &[String; 3],
        alpha: Option<&str>,
        pixel: fn([f32; 4]) -> T,
    ) -> Result<Vec<T>, String> {
        // Every block has its place in a table, and a head of its own.
        if self.source.len().is_ok_and(|bytes| bytes < 16 * self.chunks) {
            return Err("it is truncated: its table of blocks is longer than the file".into());
        }
        let outside = pixel([0.0, 0.0, 0.0, if alpha.is_some() { 0.0 } else { 1.0 }]);
        let [r, g, b] = names.each_ref().map(|name| &name[..]);
        let empty = move || vec![outside; window.width * window.height];
        let store = move |pixels: &mut Vec<T>, at: Vec2<usize>, rgba| {
            if let Some(index) = window.index(at.x(), at.y()) {
                pixels[index] = pixel(rgba);
            }
        };
        // No channel has this name, so that every pixel has the value that stands beside it.
        let alpha = alpha.unwrap_or("no channel: alpha");
        // The library takes the first part that has all that is required, and so does `Choice`.
        let channels = read().no_deep_data().largest_resolution_level().specific_channels().required(r);
        let stream = self.source.open().map_err(io_in_words)?;
        // It wants different names.
        if r == g {
            let image = channels
                .optional(alpha, 1.0)
                .collect_pixels(
                    move |_, _| empty(),
                    move |pixels, at, (y, a): (f32, f32)| store(pixels, at, [y, y, y, a]),
                )
                .first_valid_layer()
                .all_attributes()
                .from_buffered(stream)
                .map_err(in_words)?;
            return Ok(image.layer_data.channel_data.pixels);
        }
        let image = channels
            .required(g)
            .required(b)
            .optional(alpha, 1.0)
            .collect_pixels(
                move |_, _| empty(),
                move |pixels, at, (r, g, b, a): (f32, f32, f32, f32)| store(pixels, at, [r, g, b, a]),
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(stream)
            .map_err(in_words)?;
        Ok(image.layer_data.channel_data.pixels)
    }
}

/// The primaries that a file states.
fn primaries(header: &Header) -> Option<Primaries> {
    let stated = header.shared_attributes.chromaticities?;
    let point = |at: Vec2<f32>| DVec2::new(at.x().into(), at.y().into());
    Some(Primaries { rgb: [stated.red, stated.green, stated.blue].map(point), white: point(stated.white) })
}

/// Where the stored pixels lie and which are shown.
#[derive(Debug, Clone, Copy)]
struct Window {
    /// Size of what is shown.
    width: usize,
    height: usize,
    /// Size of what is stored.
    stored: (usize, usize),
    /// From the stored pixels' corner to the shown ones'.
    left: i64,
    top: i64,
}

impl Window {
    fn new(header: &Header) -> Result<Self, String> {
        let shown = header.shared_attributes.display_window;
        let (data, size) = (header.own_attributes.layer_position, header.layer_size);
        let offset = |shown: i32, data: i32| i64::from(shown) - i64::from(data);
        let (left, top) = (offset(shown.position.x(), data.x()), offset(shown.position.y(), data.y()));
        let (width, height) = (shown.size.width(), shown.size.height());
        if width == 0 || height == 0 {
            return Err("it has no pixels".into());
        }
        Ok(Window { width, height, stored: (size.width(), size.height()), left, top })
    }

    /// The pixels of the picture: what is shown; or what is stored, where that is a part of it, which is a warning.
    fn pixels(self, warnings: &mut Vec<String>) -> Result<Self, String> {
        let Err(crop) = self.check_whole() else { return Ok(self) };
        let inside = |offset: i64, shown: usize, stored: usize| offset <= 0 && stored as i64 - offset <= shown as i64;
        let Window { width, height, stored, left, top } = self;
        if !inside(left, width, stored.0) || !inside(top, height, stored.1) {
            return Err(format!("{crop}; {WHAT_TO_DO}"));
        }
        warnings.push(format!("{crop}, and taken as a picture of its own"));
        Ok(Window { width: stored.0, height: stored.1, stored, left: 0, top: 0 })
    }

    /// Refuses a crop.
    fn check_whole(&self) -> Result<(), String> {
        let Window { width, height, stored, left, top } = self;
        let beyond = |offset: i64, shown: usize, stored: usize| offset + shown as i64 > stored as i64;
        if *left < 0 || *top < 0 || beyond(*left, *width, stored.0) || beyond(*top, *height, stored.1) {
            return Err(format!(
                "it is a crop: the file holds {} x {} pixels at {} {} of a picture of {width} x {height}",
                stored.0, stored.1, -left, -top
            ));
        }
        Ok(())
    }

    /// Which of the shown pixels a stored one is, if any.
    fn index(&self, column: usize, row: usize) -> Option<usize> {
        let inside = |stored: usize, offset: i64, shown: usize| {
            usize::try_from(stored as i64 - offset).ok().filter(|at| *at < shown)
        };
        Some(inside(row, self.top, self.height)? * self.width + inside(column, self.left, self.width)?)
    }
}
