//! OpenEXR: pictures of floats, with the standard error of every pixel beside them.

use super::picture::{MOST_PIXELS, Picture, too_large};
use ::exr::image::write::WritableImage;
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels,
    ReadLayers, Text, read,
};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

/// What the names of the channels begin with that hold the standard error.
const ERROR: &str = "error.";

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
}

/// A number for every pixel, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// 32-bit floats.
    Float(Vec<f32>),
    /// 32-bit whole numbers.
    Integer(Vec<u32>),
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
        let layer = Layer::new(size, about, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into()));
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layer(layer).write().to_buffered(&mut bytes).map_err(|e| e.to_string())?;
        let mut bytes = bytes.into_inner();
        sort_attributes(&mut bytes);
        Ok(bytes)
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
pub(super) fn open(path: &Path) -> Result<Picture, String> {
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

fn in_words(error: ::exr::error::Error) -> String {
    match error {
        ::exr::error::Error::NotSupported(what) => format!("this kind of OpenEXR file cannot be read here ({what})"),
        ::exr::error::Error::Invalid(what) => format!("it is damaged or truncated ({what})"),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::math::Vec2;
    use ::exr::meta::attribute::IntegerBounds;
    use ::exr::prelude::{Blocks, Compression, ImageAttributes, LineOrder};
    use half::f16;

    type Part = Layer<AnyChannels<FlatSamples>>;

    fn opened(bytes: &[u8]) -> Result<Picture, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        std::fs::write(&path, bytes).unwrap();
        open(&path)
    }

    fn rgb() -> Vec<[f32; 3]> {
        vec![[0.1, 1e-30, 3e38], [f32::NAN, f32::INFINITY, -2.0], [0.0; 3], [1.0, 2.0, 3.0], [4.0; 3], [5.0; 3]]
    }

    /// A part of 3 x 2 pixels with channels of the values 0 to 5 and more.
    fn part(name: &str, channels: &[&str]) -> Part {
        let channel = |(i, name): (usize, &&str)| {
            AnyChannel::new(*name, FlatSamples::F32((0..6).map(|v| (10 * i + v) as f32).collect()))
        };
        let list = channels.iter().enumerate().map(channel).collect();
        Layer::new((3, 2), LayerAttributes::named(name), Encoding::UNCOMPRESSED, AnyChannels::sort(list))
    }

    fn file(window: IntegerBounds, parts: Vec<Part>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let image: Image<::exr::image::Layers<_>> = Image::from_layers(ImageAttributes::new(window), parts);
        image.write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    }

    fn plain(parts: Vec<Part>) -> Vec<u8> {
        file(IntegerBounds::new((0, 0), (3, 2)), parts)
    }

    #[test]
    fn what_is_written_is_read() {
        let error: Vec<_> = (0..6).map(|i| [0.5, i as f32, f32::MIN_POSITIVE]).collect();
        let attributes = [("samples", Attribute::Number(64.0)), ("scene", Attribute::Text("b\u{e9} \u{4e16}"))];
        let exr = Exr { width: 3, height: 2, rgb: &rgb(), error: Some(&error), more: vec![], attributes: &attributes };
        let bytes = exr.clone().encode().unwrap();
        let picture = opened(&bytes).unwrap();
        assert_eq!((picture.width, picture.height, picture.clamped), (3, 2, false));
        assert_eq!(bytemuck::cast_slice::<_, u32>(&picture.rgb), bytemuck::cast_slice::<_, u32>(&rgb()));
        assert_eq!(picture.error.as_ref(), Some(&error));

        let meta = MetaData::read_from_buffered(&bytes[..], true).unwrap();
        let about = &meta.headers[0].own_attributes;
        assert_eq!(about.software_name.as_ref().unwrap().to_string(), "luminaire");
        let attribute = |name: &str| about.other[&Text::from(name)].clone();
        assert_eq!(attribute("samples"), AttributeValue::F64(64.0));
        assert_eq!(attribute("scene"), AttributeValue::Text(Text::new_or_none("b\u{e9} ?").unwrap()));

        let plain = Exr { error: None, attributes: &[], ..exr.clone() };
        assert_eq!(opened(&plain.encode().unwrap()).unwrap().error, None);
        assert!(Exr { width: 2, ..exr.clone() }.encode().is_err());
        assert!(Exr { width: 0, height: 0, rgb: &[], error: None, more: vec![], attributes: &[] }.encode().is_err());
    }

    #[test]
    fn one_picture_has_one_file() {
        let names: Vec<String> = (0..20).map(|i| format!("number {i}")).collect();
        let attributes: Vec<_> = names.iter().map(|name| (&**name, Attribute::Number(1.0))).collect();
        let exr = Exr { width: 3, height: 2, rgb: &rgb(), error: None, more: vec![], attributes: &attributes };
        let bytes = exr.clone().encode().unwrap();
        assert!((0..10).all(|_| exr.clone().encode().unwrap() == bytes));
    }

    #[test]
    fn any_kind_of_number_and_block() {
        let samples = [
            FlatSamples::F16((0..6).map(|v| f16::from_f32(v as f32 + 0.5)).collect()),
            FlatSamples::F32((0..6).map(|v| v as f32 * 1e10).collect()),
            FlatSamples::U32((0..6).map(|v| v * 1000).collect()),
            FlatSamples::F16(vec![f16::ZERO; 6]),
        ];
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(2, 2))] {
            for compression in [Compression::Uncompressed, Compression::PIZ, Compression::ZIP1, Compression::RLE] {
                let list = ["G", "R", "B", "A"].iter().zip(&samples).map(|(n, s)| AnyChannel::new(*n, s.clone()));
                let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
                let channels = AnyChannels::sort(list.collect());
                let picture =
                    opened(&plain(vec![Layer::new((3, 2), LayerAttributes::named("a"), encoding, channels)])).unwrap();
                let expected: Vec<_> = (0..6).map(|v| v as f32).map(|v| [v * 1e10, v + 0.5, v * 1000.0]).collect();
                assert_eq!(picture.rgb, expected, "{blocks:?} {compression:?}");
            }
        }
    }

    #[test]
    fn the_picture_is_found_among_layers() {
        let red = |bytes: &[u8]| opened(bytes).map(|picture| picture.rgb[1]);
        assert_eq!(red(&plain(vec![part("a", &["Y"])])), Ok([1.0; 3]));
        assert_eq!(red(&plain(vec![part("a", &["Z", "R", "G", "B", "depth.R", "Y"])])), Ok([11.0, 21.0, 31.0]));
        assert_eq!(red(&plain(vec![part("a", &["x", "view.R", "view.G", "view.B"])])), Ok([11.0, 21.0, 31.0]));
        assert_eq!(red(&plain(vec![part("depth", &["Z"]), part("b", &["R", "G", "B"])])), Ok([1.0, 11.0, 21.0]));
        let says = |bytes: &[u8], what: &str| assert!(red(bytes).unwrap_err().contains(what), "{:?}", red(bytes));
        says(&plain(vec![part("a", &["R", "G", "Z"])]), "neither the channels R, G and B nor Y, but G, R, Z");
        says(&plain(vec![part("left", &["Y"]), part("right", &["R", "G", "B"])]), "several pictures (`left`, `right`)");
        says(&plain(vec![part("a", &["c.R", "c.G", "c.B", "d.Y"])]), "several pictures (`a.c`, `a.d`)");
        says(&plain(vec![part("a", &["Y", "RY", "BY"])]), "convert the picture to RGB");
    }

    #[test]
    fn windows() {
        let at = |x: i32, y: i32, window: (i32, i32, usize, usize)| {
            let mut layer = part("a", &["Y"]);
            layer.attributes.layer_position = Vec2(x, y);
            let (left, top, width, height) = window;
            opened(&file(IntegerBounds::new((left, top), (width, height)), vec![layer]))
        };
        let shifted = at(-7, 5, (-7, 5, 3, 2)).unwrap();
        assert_eq!((shifted.width, shifted.height, shifted.rgb[5]), (3, 2, [5.0; 3]));
        // More is stored than is shown: the right one of the lower row is left over.
        let inner = at(-2, -1, (0, 0, 1, 1)).unwrap();
        assert_eq!((inner.width, inner.height, &inner.rgb[..]), (1, 1, &[[5.0; 3]][..]));
        let crop = at(2, 1, (0, 0, 10, 10)).unwrap_err();
        assert!(crop.contains("3 x 2 pixels at 2 1 of a picture of 10 x 10"), "{crop}");
    }

    /// Whatever is cut off or changed, there is an answer, soon, and no panic.
    #[test]
    fn damaged_files() {
        let exr = Exr { width: 3, height: 2, rgb: &rgb(), error: Some(&rgb()), more: vec![], attributes: &[] };
        let bytes = exr.clone().encode().unwrap();
        for length in 0..bytes.len() {
            assert!(opened(&bytes[..length]).is_err(), "{length} of {} bytes", bytes.len());
        }
        for at in 0..bytes.len() {
            for bits in [0x01, 0x80, 0xff] {
                let mut bytes = bytes.clone();
                bytes[at] ^= bits;
                let _ = opened(&bytes);
            }
        }
        let size = bytes.windows(10).position(|w| w == b"dataWindow").unwrap() + 10 + 1 + 6 + 4;
        let mut enormous = bytes;
        enormous[size + 8..size + 12].copy_from_slice(&60_000i32.to_le_bytes());
        enormous[size + 12..size + 16].copy_from_slice(&60_000i32.to_le_bytes());
        let error = opened(&enormous).unwrap_err();
        assert!(error.contains("truncated") || error.contains("60001 x 60001"), "{error}");
    }
}
