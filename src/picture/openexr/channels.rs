//! Reads every number of an OpenEXR file that this program has written.

use super::{Values, in_words};
use crate::picture::pixels::{MOST_PIXELS, too_large};
use ::exr::meta::MetaData;
use ::exr::prelude::{AttributeValue, FlatSamples, ReadChannels, ReadLayers, read};
use std::collections::BTreeMap;
use std::path::Path;

/// The numbers of a file with one part, by channel.
#[derive(Debug)]
pub(crate) struct Channels {
    values: BTreeMap<String, Values>,
}

impl Channels {
    /// Takes out a channel of whole numbers, one a pixel.
    pub(crate) fn take_integers(&mut self, name: &str) -> Option<Vec<u32>> {
        match self.values.remove(name)? {
            Values::Integer(values) => Some(values),
            Values::Float(_) => None,
        }
    }
}

/// The texts in the head of a file with one part, by name.
///
/// # Errors
/// In words that can follow the file's name.
pub(crate) fn read_texts(path: &Path) -> Result<BTreeMap<String, String>, String> {
    let meta = MetaData::read_from_file(path, false).map_err(in_words)?;
    let [header] = &meta.headers[..] else { return Ok(BTreeMap::new()) };
    let texts = header.own_attributes.other.iter().filter_map(|(name, value)| match value {
        AttributeValue::Text(value) => Some((name.to_string(), value.to_string())),
        _ => None,
    });
    Ok(texts.collect())
}

/// Reads every channel of a file with one part of at most so many, and of this size, that this program has written.
///
/// # Errors
/// In words that can follow the file's name.
pub(crate) fn read_channels(path: &Path, most_channels: usize, size: (u32, u32)) -> Result<Channels, String> {
    let meta = MetaData::read_from_file(path, false).map_err(in_words)?;
    let [header] = &meta.headers[..] else { return Err("it has several parts".into()) };
    let (width, height) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
    if (width, height) != (u64::from(size.0), u64::from(size.1)) {
        return Err("it is damaged: its size is not the one that it says".into());
    }
    if width * height > MOST_PIXELS {
        return Err(too_large(width, height));
    }
    if header.channels.list.len() > most_channels {
        return Err("it is damaged: it has more channels than such a file".into());
    }
    let bytes = width * height * header.channels.list.len() as u64 * 4;
    // Nothing deflates better than 1 : 1032, so that a small file never asks for much memory.
    if std::fs::metadata(path).map_err(|e| e.to_string())?.len() < bytes / 1032 {
        return Err("it is truncated: so few bytes cannot hold so many pixels".into());
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(in_words)?;
    let values = image.layer_data.channel_data.list.into_iter().filter_map(|channel| {
        let values = match channel.sample_data {
            FlatSamples::F32(values) => Values::Float(values),
            FlatSamples::U32(values) => Values::Integer(values),
            FlatSamples::F16(_) => return None,
        };
        Some((channel.name.to_string(), values))
    });
    let values: BTreeMap<_, _> = values.collect();
    let pixels = (width * height) as usize;
    let whole = |values: &Values| match values {
        Values::Float(values) => values.len() == pixels,
        Values::Integer(values) => values.len() == pixels,
    };
    if !values.values().all(whole) {
        return Err("a channel does not have a number for every pixel".into());
    }
    Ok(Channels { values })
}
