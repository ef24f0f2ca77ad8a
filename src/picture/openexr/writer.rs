//! Writes a picture as OpenEXR.

use super::{ERROR, Values};
use crate::picture::crop::Crop;
use ::exr::image::write::WritableImage;
use ::exr::math::Vec2;
use ::exr::meta::attribute::IntegerBounds;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text,
};
use std::io::{BufWriter, Cursor, Read, Seek, Write};

/// The head of a file is shorter.
const MOST_HEAD: u64 = 1 << 20;

/// A picture to write.
#[derive(Debug, Clone)]
pub struct Exr<'a> {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear RGB, rows from the top.
    pub rgb: &'a [[f32; 3]],
    /// Standard error of every number of `rgb`, if it is known; written as the channels `error.R`, `error.G` and `error.B`.
    pub error: Option<&'a [[f32; 3]]>,
    /// Further channels, by name.
    pub more: Vec<(String, Values)>,
    /// What else is known about the picture, by name.
    pub attributes: &'a [(&'a str, Attribute<'a>)],
    /// Which part of a picture it is, if it is one: the data window, in the display window of the whole.
    pub crop: Option<Crop>,
}

/// A value in the head of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attribute<'a> {
    /// Characters beyond Latin-1, which the format does not have, become question marks.
    Text(&'a str),
    /// A number.
    Number(f64),
}

impl Exr<'_> {
    /// The bytes of a file: 32-bit floats without loss, the same bytes for the same picture.
    ///
    /// # Errors
    /// In the encoder's words, for example if there are no pixels, or not `width * height` of them.
    pub fn encode(self) -> Result<Vec<u8>, String> {
        let mut bytes = Cursor::new(Vec::new());
        self.write(&mut bytes)?;
        Ok(bytes.into_inner())
    }

    /// Writes the same bytes to where nothing is yet, for pictures that memory should not hold a second time.
    ///
    /// # Errors
    /// As for [`Exr::encode`], and if `out` fails.
    pub(crate) fn write(self, out: &mut (impl Read + Write + Seek)) -> Result<(), String> {
        let pixels = self.width as usize * self.height as usize;
        if self.rgb.len() != pixels || self.error.is_some_and(|error| error.len() != pixels) {
            return Err(format!("there are not {} x {} pixels", self.width, self.height));
        }
        let planes = |prefix: &str, from: &[[f32; 3]]| {
            [0, 1, 2].map(|channel| {
                let name = format!("{prefix}{}", ["R", "G", "B"][channel]);
                AnyChannel::new(text(&name), FlatSamples::F32(from.iter().map(|p| p[channel]).collect()))
            })
        };
        let mut channels = Vec::from(planes("", self.rgb));
        channels.extend(self.error.into_iter().flat_map(|error| planes(ERROR, error)));
        for (name, values) in self.more {
            let samples = match values {
                Values::Float(values) => FlatSamples::F32(values),
                Values::Integer(values) => FlatSamples::U32(values),
            };
            if samples.len() != pixels {
                return Err(format!("there are not {} x {} numbers in the channel {name}", self.width, self.height));
            }
            channels.push(AnyChannel::new(text(&name), samples));
        }
        let mut about = LayerAttributes { software_name: Some(text("luminaire")), ..LayerAttributes::default() };
        about.other = self.attributes.iter().map(|(name, value)| (text(name), value.stored())).collect();
        let size = (self.width as usize, self.height as usize);
        if let Some(crop) = self.crop {
            about.layer_position = Vec2(crop.x as i32, crop.y as i32);
        }
        let layer = Layer::new(size, about, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into()));
        let mut buffered = BufWriter::with_capacity(1 << 20, &mut *out);
        let mut image = Image::from_layer(layer);
        if let Some(Crop { whole: (width, height), .. }) = self.crop {
            image.attributes.display_window = IntegerBounds::new((0, 0), (width as usize, height as usize));
        }
        image.write().to_buffered(&mut buffered).map_err(|e| e.to_string())?;
        buffered.flush().map_err(|e| e.to_string())?;
        drop(buffered);
        sort_head(out).map_err(|e| e.to_string())
    }
}

impl Attribute<'_> {
    fn stored(&self) -> AttributeValue {
        match self {
            Attribute::Text(value) => AttributeValue::Text(text(value)),
            Attribute::Number(value) => AttributeValue::F64(*value),
        }
    }
}

fn text(value: &str) -> Text {
    let latin: String = value.chars().map(|c| if u32::from(c) < 256 { c } else { '?' }).collect();
    Text::new_or_none(latin).unwrap_or_default()
}

/// Sorts the attributes of a file that was just written.
fn sort_head(out: &mut (impl Read + Write + Seek)) -> std::io::Result<()> {
    let mut head = Vec::new();
    out.rewind()?;
    out.take(MOST_HEAD).read_to_end(&mut head)?;
    sort_attributes(&mut head);
    out.rewind()?;
    out.write_all(&head)
}

/// Puts the attributes in the head of a file with one part in alphabetic order. The encoder takes them from a hash table, and two files of one
/// picture would differ.
fn sort_attributes(bytes: &mut [u8]) {
    // After the magic number and the version: name, type, size, value; an empty name ends them.
    const START: usize = 8;
    let mut attributes: Vec<Vec<u8>> = Vec::new();
    let mut at = START;
    while bytes.get(at).is_some_and(|first| *first != 0) {
        let after_text = |from: usize| bytes[from..].iter().position(|b| *b == 0).map(|length| from + length + 1);
        let Some(size) = after_text(at).and_then(after_text) else { return };
        let Some(length) = bytes.get(size..size + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes) else {
            return;
        };
        let end = size + 4 + length as usize;
        let Some(attribute) = bytes.get(at..end) else { return };
        attributes.push(attribute.to_vec());
        at = end;
    }
    attributes.sort();
    bytes[START..at].copy_from_slice(&attributes.concat());
}
