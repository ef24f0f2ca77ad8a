//! Reads the picture of an OpenEXR file that any program may have written.

use super::{ERROR, in_words};
use crate::picture::pixels::{MOST_PIXELS, Picture, too_large};
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, read};
use std::path::Path;

/// What to do with a file that holds several pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::picture) enum Several {
    /// Nobody knows which one is meant.
    Refused,
    /// The first part with R, G and B is meant.
    First,
}

/// A file of which the head was read.
#[derive(Debug)]
pub(in crate::picture) struct Opened<'a> {
    path: &'a Path,
    choice: Choice,
    window: Window,
    /// Blocks of the part with the picture.
    chunks: u64,
}

/// Which channels of a file are the picture.
#[derive(Debug, PartialEq)]
struct Choice {
    part: usize,
    /// Red, green and blue, which are one and the same if there is only luminance.
    rgb: [String; 3],
    alpha: Option<String>,
    error: Option<[String; 3]>,
}

impl<'a> Opened<'a> {
    /// Reads the head of a file and finds the picture in it.
    ///
    /// # Errors
    /// In words that can follow the file's name.
    pub(in crate::picture) fn new(path: &'a Path, several: Several) -> Result<Self, String> {
        let meta = MetaData::read_from_file(path, false).map_err(in_words)?;
        let choice = choose(&meta.headers, several)?;
        let window = Window::new(&meta.headers[choice.part])?;
        // The library takes the first part that has the channel.
        let red = &choice.rgb[0];
        let has_red = |header: &Header| header.channels.list.iter().any(|channel| channel.name.to_string() == *red);
        if meta.headers[..choice.part].iter().any(has_red) {
            return Err(format!("several of its parts have a channel {red}: write the picture to a file of its own"));
        }
        let header = &meta.headers[choice.part];
        Ok(Opened { path, choice, window, chunks: header.chunk_count as u64 })
    }

    /// Width and height in pixels.
    pub(in crate::picture) fn size(&self) -> (u32, u32) {
        (self.window.width as u32, self.window.height as u32)
    }

    /// Whether there is alpha.
    pub(in crate::picture) fn has_alpha(&self) -> bool {
        self.choice.alpha.is_some()
    }

    /// The picture. Integers are taken as the numbers they are, luminance alone as grey; alpha is left out, since colours are stored as
    /// they are over black.
    ///
    /// # Errors
    /// In words that can follow the file's name; a crop is one, since what is outside is not known.
    pub(in crate::picture) fn picture(&self) -> Result<Picture, String> {
        let (width, height) = self.size();
        let sizes = [(width as usize, height as usize), self.window.stored].map(|(w, h)| (w as u64, h as u64));
        if let Some((width, height)) = sizes.into_iter().find(|(w, h)| w.saturating_mul(*h) > MOST_PIXELS) {
            return Err(too_large(width, height));
        }
        self.window.check_whole()?;
        let colours = |names: &[String; 3]| self.read(names, None, |[r, g, b, _]| [r, g, b]);
        let (rgb, error) = (colours(&self.choice.rgb)?, self.choice.error.as_ref().map(colours).transpose()?);
        Ok(Picture { width, height, rgb, error, clamped: false })
    }

    /// Red, green, blue and alpha (1 in a file without it) of every pixel. Outside of a crop all that are there are 0.
    ///
    /// # Errors
    /// In words that can follow the file's name.
    pub(in crate::picture) fn rgba(&self) -> Result<Vec<f32>, String> {
        Ok(self.read(&self.choice.rgb, self.choice.alpha.as_deref(), |rgba| rgba)?.into_flattened())
    }

    /// What `pixel` makes of red, green, blue and alpha of every pixel that is shown; no other channel and no other part takes memory. Outside of a crop all are 0,
    /// and so is alpha in a file that has it.
    fn read<T: Copy + 'static>(
        &self,
        names: &[String; 3],
        alpha: Option<&str>,
        pixel: fn([f32; 4]) -> T,
    ) -> Result<Vec<T>, String> {
        // Every block has its place in a table, and a head of its own.
        if std::fs::metadata(self.path).is_ok_and(|about| about.len() < 16 * self.chunks) {
            return Err("it is truncated: its table of blocks is longer than the file".into());
        }
        let window = self.window;
        let outside = pixel([0.0, 0.0, 0.0, if alpha.is_some() { 0.0 } else { 1.0 }]);
        let [r, g, b] = names.each_ref().map(|name| &name[..]);
        // The library wants different names. No channel has these, so that what is asked for has the value that stands beside it.
        let grey = r == g;
        let [g, b] = if grey { ["no channel: green", "no channel: blue"] } else { [g, b] };
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required(r)
            .optional(g, 0.0)
            .optional(b, 0.0)
            .optional(alpha.unwrap_or("no channel: alpha"), 1.0)
            .collect_pixels(
                move |_, _| vec![outside; window.width * window.height],
                move |pixels: &mut Vec<T>, at, (r, g, b, a): (f32, f32, f32, f32)| {
                    if let Some(index) = window.index(at.x(), at.y()) {
                        let [g, b] = if grey { [r; 2] } else { [g, b] };
                        pixels[index] = pixel([r, g, b, a]);
                    }
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_file(self.path)
            .map_err(in_words)?;
        Ok(image.layer_data.channel_data.pixels)
    }
}

/// Finds the picture: R, G and B, else Y, without a prefix; else the only ones with a prefix.
fn choose(headers: &[Header], several: Several) -> Result<Choice, String> {
    let names = |part: usize| headers[part].channels.list.iter().map(|c| c.name.to_string());
    let mut groups: Vec<(usize, String, bool)> = Vec::new();
    for part in 0..headers.len() {
        let has = |name: String| names(part).any(|n| n == name);
        for name in names(part) {
            let prefix = name.strip_suffix('R').or(name.strip_suffix('Y')).filter(|p| p.is_empty() || p.ends_with('.'));
            let Some(prefix) = prefix else { continue };
            let colour = ["R", "G", "B"].iter().all(|c| has(format!("{prefix}{c}")));
            if colour == name.ends_with('R') && prefix != ERROR {
                groups.push((part, prefix.into(), colour));
            }
        }
    }
    let plain: Vec<_> = groups.iter().filter(|(_, prefix, _)| prefix.is_empty()).collect();
    let (part, prefix, colour) = match (&plain[..], &groups[..]) {
        ([one], _) => *one,
        ([first, ..], _) if several == Several::First => plain.iter().find(|(.., colour)| *colour).unwrap_or(first),
        ([], [one]) => one,
        ([], []) => {
            let all: Vec<String> = (0..headers.len()).flat_map(names).collect();
            return Err(format!("it has neither the channels R, G and B nor Y, but {}", all.join(", ")));
        }
        _ => {
            let named = |(part, prefix, _): &(usize, String, bool)| {
                let layer =
                    headers[*part].own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
                format!("`{}`", format!("{layer}.{prefix}").trim_matches('.'))
            };
            let all: Vec<String> = groups.iter().map(named).collect();
            return Err(format!(
                "it holds several pictures ({}): write one of them to a file of its own",
                all.join(", ")
            ));
        }
    };
    let three = |prefix: &str| ["R", "G", "B"].map(|c| format!("{prefix}{c}"));
    let rgb = if *colour { three(prefix) } else { [0; 3].map(|_| format!("{prefix}Y")) };
    let error =
        Some(three(ERROR)).filter(|error| prefix.is_empty() && error.iter().all(|e| names(*part).any(|n| n == *e)));
    for channel in &headers[*part].channels.list {
        let name = channel.name.to_string();
        if rgb.contains(&name) && channel.sampling != ::exr::math::Vec2(1, 1)
            || !colour && ["RY", "BY"].contains(&&*name)
        {
            return Err(format!(
                "its channel {name} does not have a value for every pixel (subsampled chroma?): convert the picture to RGB"
            ));
        }
    }
    let alpha = Some(format!("{prefix}A")).filter(|alpha| names(*part).any(|name| name == *alpha));
    Ok(Choice { part: *part, rgb, alpha, error })
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

    /// Refuses a crop.
    fn check_whole(&self) -> Result<(), String> {
        let Window { width, height, stored, left, top } = self;
        let beyond = |offset: i64, shown: usize, stored: usize| offset + shown as i64 > stored as i64;
        if *left < 0 || *top < 0 || beyond(*left, *width, stored.0) || beyond(*top, *height, stored.1) {
            return Err(format!(
                "it is a crop: the file holds {} x {} pixels at {} {} of a picture of {width} x {height}; write the whole picture, or \
                 the crop as a picture of its own (data window and display window the same)",
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
