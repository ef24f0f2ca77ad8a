//! Every kind of OpenEXR file: written and read, of other programs, cropped, damaged.

use super::*;
use crate::picture::Picture;
use ::exr::image::write::WritableImage;
use ::exr::math::Vec2;
use ::exr::meta::MetaData;
use ::exr::meta::attribute::IntegerBounds;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image, ImageAttributes, Layer,
    LayerAttributes, LineOrder, Text,
};
use half::f16;
use std::io::Cursor;

type Part = Layer<AnyChannels<FlatSamples>>;

fn opened(bytes: &[u8]) -> Result<Picture, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    std::fs::write(&path, bytes).unwrap();
    Opened::new(&path, Several::Refused)?.picture()
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

/// What a texture gets: alpha, nothing outside of a crop, and the first of several pictures.
#[test]
fn four_channels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let rgba = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let opened = Opened::new(&path, Several::First).unwrap();
        (opened.size(), opened.has_alpha(), opened.rgba().unwrap())
    };
    let (size, alpha, texels) = rgba(&plain(vec![part("a", &["R", "G", "B", "A"])]));
    assert_eq!((size, alpha, &texels[4..8]), ((3, 2), true, &[1.0, 11.0, 21.0, 31.0][..]));
    let (_, alpha, texels) = rgba(&plain(vec![part("a", &["Y"]), part("b", &["R", "G", "B"])]));
    assert_eq!((alpha, &texels[4..8]), (false, &[1.0, 11.0, 21.0, 1.0][..]));
    std::fs::write(&path, plain(vec![part("a", &["R"]), part("b", &["R", "G", "B"])])).unwrap();
    assert!(Opened::new(&path, Several::First).unwrap_err().contains("several of its parts have a channel R"));
    let mut layer = part("a", &["R", "G", "B", "A"]);
    layer.attributes.layer_position = Vec2(1, -1);
    // Its lower row lies in the upper one of what is shown, one to the right.
    let (size, _, texels) = rgba(&file(IntegerBounds::new((0, 0), (2, 2)), vec![layer]));
    assert_eq!((size, &texels[..8]), ((2, 2), &[0.0, 0.0, 0.0, 0.0, 3.0, 13.0, 23.0, 33.0][..]));
    assert_eq!(texels[8..], [0.0; 8]);
}
