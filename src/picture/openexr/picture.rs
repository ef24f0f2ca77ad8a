//! Reads the picture of a file that any program may have written.

use super::{ERROR, in_words};
use crate::picture::pixels::{MOST_PIXELS, Picture, too_large};
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, read};
use std::path::Path;

/// Which channels of a file are the picture.
#[derive(Debug, PartialEq)]
struct Choice {
    part: usize,
    /// Red, green and blue, which are one and the same if there is only luminance.
    rgb: [String; 3],
    error: Option<[String; 3]>,
}

/// Reads the picture of a file. Integers are taken as the numbers they are, luminance alone as grey; alpha is left out, since colours are stored as
/// they are over black.
///
/// # Errors
/// In words that can follow the file's name.
pub(in crate::picture) fn open(path: &Path) -> Result<Picture, String> {
    let meta = MetaData::read_from_file(path, false).map_err(in_words)?;
    let choice = choose(&meta.headers)?;
    let header = &meta.headers[choice.part];
    for other in &meta.headers {
        // Every block has its place in a table, and a head of its own.
        let least = other.chunk_count as u64 * 16;
        if std::fs::metadata(path).is_ok_and(|about| about.len() < least) {
            return Err("it is truncated: its table of blocks is longer than the file".into());
        }
        let samples = other.layer_size.area() as u64 * other.channels.list.len() as u64;
        if other.layer_size.area() as u64 > MOST_PIXELS || samples > 4 * MOST_PIXELS {
            return Err(too_large(other.layer_size.width() as u64, other.layer_size.height() as u64));
        }
    }
    let window = Window::new(header)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_file(path)
        .map_err(in_words)?;
    let layer = &image.layer_data[choice.part];
    let planes = |names: &[String; 3]| -> Result<Vec<[f32; 3]>, String> {
        let mut out = vec![[0.0; 3]; window.width * window.height];
        for (channel, name) in names.iter().enumerate() {
            let found = layer.channel_data.list.iter().find(|c| c.name.to_string() == *name);
            let plane = found.ok_or_else(|| format!("its channel {name} cannot be read"))?;
            for (y, row) in out.chunks_exact_mut(window.width).enumerate() {
                let start = (window.top + y) * layer.size.width() + window.left;
                for (x, pixel) in row.iter_mut().enumerate() {
                    pixel[channel] = plane.sample_data.value_by_flat_index(start + x).to_f32();
                }
            }
        }
        Ok(out)
    };
    Ok(Picture {
        width: window.width as u32,
        height: window.height as u32,
        rgb: planes(&choice.rgb)?,
        error: choice.error.as_ref().map(planes).transpose()?,
        clamped: false,
    })
}

/// Finds the picture: R, G and B, else Y, without a prefix; else the only ones with a prefix.
fn choose(headers: &[Header]) -> Result<Choice, String> {
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
    Ok(Choice { part: *part, rgb, error })
}

/// The display window within the data window.
struct Window {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Window {
    fn new(header: &Header) -> Result<Self, String> {
        let shown = header.shared_attributes.display_window;
        let (data, size) = (header.own_attributes.layer_position, header.layer_size);
        let offset = |shown: i32, data: i32| i64::from(shown) - i64::from(data);
        let (left, top) = (offset(shown.position.x(), data.x()), offset(shown.position.y(), data.y()));
        let (width, height) = (shown.size.width() as i64, shown.size.height() as i64);
        if left < 0 || top < 0 || left + width > size.width() as i64 || top + height > size.height() as i64 {
            return Err(format!(
                "it is a crop: the file holds {} x {} pixels at {} {} of a picture of {width} x {height}; write the whole picture, or \
                 the crop as a picture of its own (data window and display window the same)",
                size.width(),
                size.height(),
                -left,
                -top
            ));
        }
        if width == 0 || height == 0 {
            return Err("it has no pixels".into());
        }
        Ok(Window { left: left as usize, top: top as usize, width: width as usize, height: height as usize })
    }
}
