//! Reads the picture of an OpenEXR file that any program may have written.

use super::{ERROR, in_words};
use crate::picture::pixels::{MOST_PIXELS, Picture, too_large};
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Layer, ReadChannels, ReadLayers, read};
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
        let opened = Opened { path, choice, window };
        for header in &meta.headers {
            opened.check(header)?;
        }
        Ok(opened)
    }

    /// Width and height in pixels.
    pub(in crate::picture) fn size(&self) -> (u32, u32) {
        (self.window.width as u32, self.window.height as u32)
    }

    /// Whether there is alpha.
    pub(in crate::picture) fn has_alpha(&self) -> bool {
        self.choice.alpha.is_some()
    }

    /// Refuses what the file is too short for, or what is enormous.
    fn check(&self, header: &Header) -> Result<(), String> {
        // Every block has its place in a table, and a head of its own.
        let least = header.chunk_count as u64 * 16;
        if std::fs::metadata(self.path).is_ok_and(|about| about.len() < least) {
            return Err("it is truncated: its table of blocks is longer than the file".into());
        }
        let samples = header.layer_size.area() as u64 * header.channels.list.len() as u64;
        if header.layer_size.area() as u64 > MOST_PIXELS || samples > 4 * MOST_PIXELS {
            return Err(too_large(header.layer_size.width() as u64, header.layer_size.height() as u64));
        }
        Ok(())
    }

    /// The picture. Integers are taken as the numbers they are, luminance alone as grey; alpha is left out, since colours are stored as
    /// they are over black.
    ///
    /// # Errors
    /// In words that can follow the file's name; a crop is one, since what is outside is not known.
    pub(in crate::picture) fn picture(&self) -> Result<Picture, String> {
        self.window.check_whole()?;
        let layer = self.layer()?;
        let planes = |names: &[String; 3]| -> Result<Vec<[f32; 3]>, String> {
            let mut out = vec![[0.0; 3]; self.window.width * self.window.height];
            for (channel, name) in names.iter().enumerate() {
                self.each_sample(&layer, name, |pixel, value| out[pixel][channel] = value)?;
            }
            Ok(out)
        };
        let (width, height) = self.size();
        let (rgb, error) = (planes(&self.choice.rgb)?, self.choice.error.as_ref().map(planes).transpose()?);
        Ok(Picture { width, height, rgb, error, clamped: false })
    }

    /// Red, green, blue and alpha (1 in a file without it) of every pixel. Outside of a crop all that are there are 0.
    ///
    /// # Errors
    /// In words that can follow the file's name.
    pub(in crate::picture) fn rgba(&self) -> Result<Vec<f32>, String> {
        let layer = self.layer()?;
        let alpha = if self.has_alpha() { 0.0 } else { 1.0 };
        let mut out = [0.0, 0.0, 0.0, alpha].repeat(self.window.width * self.window.height);
        for (channel, name) in self.choice.rgb.iter().enumerate() {
            self.each_sample(&layer, name, |pixel, value| out[4 * pixel + channel] = value)?;
        }
        if let Some(name) = &self.choice.alpha {
            self.each_sample(&layer, name, |pixel, value| out[4 * pixel + 3] = value)?;
        }
        Ok(out)
    }

    fn layer(&self) -> Result<Layer<AnyChannels<FlatSamples>>, String> {
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_file(self.path)
            .map_err(in_words)?;
        image.layer_data.into_iter().nth(self.choice.part).ok_or_else(|| "the part with the picture is missing".into())
    }

    /// Calls `take` with the index of a pixel and its number, for every pixel that is stored and shown.
    fn each_sample(
        &self,
        layer: &Layer<AnyChannels<FlatSamples>>,
        name: &str,
        mut take: impl FnMut(usize, f32),
    ) -> Result<(), String> {
        let found = layer.channel_data.list.iter().find(|channel: &&AnyChannel<_>| channel.name.to_string() == name);
        let plane = found.ok_or_else(|| format!("its channel {name} cannot be read"))?;
        let window = &self.window;
        for (y, row) in window.rows() {
            for (x, column) in window.columns() {
                let value = plane.sample_data.value_by_flat_index(row * layer.size.width() + column);
                take(y * window.width + x, value.to_f32());
            }
        }
        Ok(())
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
#[derive(Debug)]
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
        if (width as u64).saturating_mul(height as u64) > MOST_PIXELS {
            return Err(too_large(width as u64, height as u64));
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

    /// Rows that are stored and shown: as shown, and as stored.
    fn rows(&self) -> impl Iterator<Item = (usize, usize)> {
        both(self.height, self.top, self.stored.1)
    }

    /// Columns that are stored and shown: as shown, and as stored.
    fn columns(&self) -> impl Iterator<Item = (usize, usize)> {
        both(self.width, self.left, self.stored.0)
    }
}

/// The `i` below `shown` for which `i + offset` is within what is stored.
fn both(shown: usize, offset: i64, stored: usize) -> impl Iterator<Item = (usize, usize)> {
    let first = (-offset).clamp(0, shown as i64);
    let end = (stored as i64 - offset).clamp(first, shown as i64);
    (first..end).map(move |i| (i as usize, (i + offset) as usize))
}
