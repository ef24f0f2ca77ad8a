//! Every kind of OpenEXR file: written and read, of other programs, cropped, damaged.

use super::*;
use crate::picture::Picture;
use crate::picture::decode::ImageFile;
use ::exr::image::write::WritableImage;
use ::exr::math::Vec2;
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{Chromaticities, IntegerBounds};
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
    Opened::new(&path)?.picture()
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
    let exr = Exr {
        width: 3,
        height: 2,
        rgb: &rgb(),
        error: Some(&error),
        more: vec![],
        attributes: &attributes,
        crop: None,
    };
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
    assert!(
        Exr { width: 0, height: 0, rgb: &[], error: None, more: vec![], attributes: &[], crop: None }.encode().is_err()
    );
}

#[test]
fn one_picture_has_one_file() {
    let names: Vec<String> = (0..20).map(|i| format!("number {i}")).collect();
    let attributes: Vec<_> = names.iter().map(|name| (&**name, Attribute::Number(1.0))).collect();
    let exr = Exr { width: 3, height: 2, rgb: &rgb(), error: None, more: vec![], attributes: &attributes, crop: None };
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
    // Lower case, but not beside upper case; a vector is no luminance.
    assert_eq!(red(&plain(vec![part("a", &["r", "g", "b", "a"])])), Ok([1.0, 11.0, 21.0]));
    assert_eq!(red(&plain(vec![part("a", &["id.r", "id.g", "id.b", "Y"])])), Ok([31.0; 3]));
    assert_eq!(red(&plain(vec![part("a", &["N.X", "N.Y", "N.Z", "l.R", "l.G", "l.B"])])), Ok([31.0, 41.0, 51.0]));
    // The library takes the first part that has what is asked for.
    assert_eq!(red(&plain(vec![part("a", &["R"]), part("b", &["R", "G", "B"])])), Ok([1.0, 11.0, 21.0]));
    let says = |bytes: &[u8], what: &str| assert!(red(bytes).unwrap_err().contains(what), "{:?}", red(bytes));
    says(&plain(vec![part("a", &["R", "G", "Z"])]), "neither the channels R, G and B nor Y, but G, R, Z");
    let warns = |parts: Vec<Part>, expected: [f32; 3], what: &str| {
        let picture = opened(&plain(parts)).unwrap();
        assert!(picture.warnings.len() == 1 && picture.warnings[0].contains(what), "{:?}", picture.warnings);
        assert_eq!(picture.rgb[1], expected);
    };
    warns(
        vec![part("left", &["Y"]), part("right", &["R", "G", "B"])],
        [1.0, 11.0, 21.0],
        "`right` is used, not `left`",
    );
    warns(vec![part("l", &["R", "G", "B"]), part("r", &["R", "G", "B"])], [1.0, 11.0, 21.0], "`l` is used, not `r`");
    warns(vec![part("a", &["c.R", "c.G", "c.B", "d.Y"])], [1.0, 11.0, 21.0], "`a.c` is used, not `a.d`");
    let blender = ["V.AO.R", "V.AO.G", "V.AO.B", "V.Combined.R", "V.Combined.G", "V.Combined.B"];
    warns(vec![part("V", &blender)], [31.0, 41.0, 51.0], "`V.Combined` is used, not `V.AO`;");
    says(&plain(vec![part("a", &["x.Y", "x.RY", "x.BY"])]), "x.");
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
    // A part of what is shown is a picture of its own, which is said.
    let crop = at(2, 1, (0, 0, 10, 10)).unwrap();
    assert_eq!((crop.width, crop.height, crop.rgb[5]), (3, 2, [5.0; 3]));
    assert!(crop.warnings[0].contains("3 x 2 pixels at 2 1 of a picture of 10 x 10"), "{:?}", crop.warnings);
    // What reaches beyond it and does not fill it is not.
    let askew = at(2, 1, (0, 0, 4, 10)).unwrap_err();
    assert!(askew.contains("3 x 2 pixels at 2 1 of a picture of 4 x 10"), "{askew}");
}

/// A crop is written with the window of the whole picture, and read back by our reader and another.
#[test]
fn a_crop_knows_its_place() {
    let crop = crate::picture::Crop { x: 4, y: 1, width: 3, height: 2, whole: (9, 5) };
    let pixels: Vec<[f32; 3]> = (0..6).map(|i| [i as f32, 0.5, -1.0]).collect();
    let exr = Exr { width: 3, height: 2, rgb: &pixels, error: None, more: vec![], attributes: &[], crop: Some(crop) };
    let bytes = exr.encode().unwrap();
    let meta = MetaData::read_from_buffered(Cursor::new(&bytes), false).unwrap();
    let header = &meta.headers[0];
    assert_eq!(header.shared_attributes.display_window, IntegerBounds::new((0, 0), (9, 5)));
    assert_eq!(header.data_window(), IntegerBounds::new((4, 1), (3, 2)));
    let read = opened(&bytes).unwrap();
    assert_eq!((read.width, read.height, &read.rgb), (3, 2, &pixels));
    assert!(read.warnings[0].contains("at 4 1 of a picture of 9 x 5"), "{:?}", read.warnings);
}

/// Whatever is cut off or changed, there is an answer, soon, and no panic.
#[test]
fn damaged_files() {
    let exr = Exr { width: 3, height: 2, rgb: &rgb(), error: Some(&rgb()), more: vec![], attributes: &[], crop: None };
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
        let opened = Opened::new(&path).unwrap();
        (opened.size(), opened.has_alpha(), opened.rgba().unwrap())
    };
    let (size, alpha, texels) = rgba(&plain(vec![part("a", &["R", "G", "B", "A"])]));
    assert_eq!((size, alpha, &texels[4..8]), ((3, 2), true, &[1.0, 11.0, 21.0, 31.0][..]));
    let (_, alpha, texels) = rgba(&plain(vec![part("a", &["Y"]), part("b", &["R", "G", "B"])]));
    assert_eq!((alpha, &texels[4..8]), (false, &[1.0, 11.0, 21.0, 1.0][..]));
    let (_, alpha, texels) = rgba(&plain(vec![part("a", &["Y", "A"])]));
    assert_eq!((alpha, &texels[4..8]), (true, &[1.0, 1.0, 1.0, 11.0][..]));
    let mut layer = part("a", &["R", "G", "B", "A"]);
    layer.attributes.layer_position = Vec2(1, -1);
    // Its lower row lies in the upper one of what is shown, one to the right.
    let (size, _, texels) = rgba(&file(IntegerBounds::new((0, 0), (2, 2)), vec![layer]));
    assert_eq!((size, &texels[..8]), ((2, 2), &[0.0, 0.0, 0.0, 0.0, 3.0, 13.0, 23.0, 33.0][..]));
    assert_eq!(texels[8..], [0.0; 8]);
}

/// A file with these chromaticities: x and y of red, green, blue and white.
fn with_primaries(channels: &[&str], [rx, ry, gx, gy, bx, by, wx, wy]: [f32; 8]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut attributes = ImageAttributes::new(IntegerBounds::new((0, 0), (3, 2)));
    let [red, green, blue, white] = [Vec2(rx, ry), Vec2(gx, gy), Vec2(bx, by), Vec2(wx, wy)];
    attributes.chromaticities = Some(Chromaticities { red, green, blue, white });
    let image: Image<::exr::image::Layers<_>> = Image::from_layers(attributes, vec![part("a", channels)]);
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

const ACES_CG: [f32; 8] = [0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767];

#[test]
fn other_primaries_become_those_of_srgb() {
    // The published matrix from ACEScg to sRGB, times 1, 11, 21.
    let picture = opened(&with_primaries(&["R", "G", "B"], ACES_CG)).unwrap();
    let expected = [1.7051 - 6.8397 - 1.7484, -0.1303 + 12.5489 - 0.2215, -0.0240 - 1.4187 + 24.2124];
    let near = |found: [f32; 3]| found.iter().zip(expected).all(|(f, e): (&f32, f32)| (f - e).abs() < 2e-3);
    assert!(near(picture.rgb[1]) && picture.warnings.is_empty(), "{picture:?}");
    // A texture has them by the same matrix.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = |bytes: Vec<u8>| {
        std::fs::write(&path, bytes).unwrap();
        ImageFile::open(&path, 100, |_| String::new()).unwrap()
    };
    let [r, g, b, _] = image(with_primaries(&["R", "G", "B"], ACES_CG)).linear(1);
    assert!(near([r, g, b]), "{r} {g} {b}");
    // Luminance is grey in any primaries, and those of sRGB change nothing.
    assert_eq!(image(with_primaries(&["Y"], ACES_CG)).linear(1), [1.0; 4]);
    let srgb = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329];
    assert_eq!(image(with_primaries(&["R", "G", "B"], srgb)).linear(1), [1.0, 11.0, 21.0, 1.0]);
    let odd = opened(&with_primaries(&["R", "G", "B"], [0.0; 8])).unwrap();
    assert!(odd.rgb[1] == [1.0, 11.0, 21.0] && odd.warnings[0].contains("chromaticities are no colours"), "{odd:?}");
    let error = ["B", "G", "R", "error.B", "error.G", "error.R"];
    let picture = opened(&with_primaries(&error, ACES_CG)).unwrap();
    assert!(picture.error.is_none() && picture.warnings[0].contains("error channels"), "{:?}", picture.warnings);
}

#[test]
fn any_order_of_lines() {
    for (line_order, blocks) in [
        (LineOrder::Increasing, Blocks::ScanLines),
        (LineOrder::Decreasing, Blocks::ScanLines),
        (LineOrder::Increasing, Blocks::Tiles(Vec2(2, 1))),
        (LineOrder::Decreasing, Blocks::Tiles(Vec2(2, 1))),
        (LineOrder::Unspecified, Blocks::Tiles(Vec2(1, 1))),
    ] {
        let mut layer = part("a", &["Y"]);
        layer.encoding = Encoding { compression: Compression::ZIP1, blocks, line_order };
        let rows: Vec<f32> = opened(&plain(vec![layer])).unwrap().rgb.iter().map(|rgb| rgb[0]).collect();
        assert_eq!(rows, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "{line_order:?} {blocks:?}");
    }
}

/// A head by hand: no library here writes files with several samples a pixel.
#[test]
fn deep_files_are_named() {
    let attribute = |name: &str, kind: &str, value: &[u8]| {
        [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &(value.len() as u32).to_le_bytes(), value].concat()
    };
    let channel = |name: &str| [name.as_bytes(), &[0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]].concat();
    let window: Vec<u8> = [0i32, 0, 0, 0].iter().flat_map(|n| n.to_le_bytes()).collect();
    let bytes = [
        // Version 2, with the flag of deep data.
        &[0x76, 0x2f, 0x31, 0x01, 2, 0x08, 0, 0][..],
        &attribute("channels", "chlist", &[channel("B"), channel("G"), channel("R"), vec![0]].concat()),
        &attribute("chunkCount", "int", &1i32.to_le_bytes()),
        &attribute("compression", "compression", &[0]),
        &attribute("dataWindow", "box2i", &window),
        &attribute("displayWindow", "box2i", &window),
        &attribute("lineOrder", "lineOrder", &[0]),
        &attribute("maxSamplesPerPixel", "int", &1i32.to_le_bytes()),
        &attribute("name", "string", b"a"),
        &attribute("pixelAspectRatio", "float", &1f32.to_le_bytes()),
        &attribute("screenWindowCenter", "v2f", &[0; 8]),
        &attribute("screenWindowWidth", "float", &1f32.to_le_bytes()),
        &attribute("type", "string", b"deepscanline"),
        &attribute("version", "int", &1i32.to_le_bytes()),
        &[0; 64],
    ]
    .concat();
    let error = opened(&bytes).unwrap_err();
    assert!(error.contains("deep") && error.contains("--flatten"), "{error}");
}
