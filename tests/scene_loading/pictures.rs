//! What pictures say about their own colours, as textures and environments.

use super::textures::{diffuse, rgba, texel, textured};
use super::*;
use exr::image::write::WritableImage;
use exr::math::Vec2;
use exr::meta::attribute::{Chromaticities, EnvironmentMap, IntegerBounds};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes};
use glam::Vec3;

/// A PNG of one grey texel with these chunks before its pixels.
fn png(code: u8, chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(1, 1, image::Rgb([code; 3]))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("a PNG");
    let mut bytes = bytes.into_inner();
    // Behind the signature and IHDR.
    let more = chunks.iter().flat_map(|(name, data)| {
        let named = [&name[..], data].concat();
        [&(data.len() as u32).to_be_bytes()[..], &named, &crc(&named).to_be_bytes()].concat()
    });
    bytes.splice(33..33, more.collect::<Vec<u8>>());
    bytes
}

/// The check sum of a chunk (PNG, annex D), bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 })
    })
}

const GAMMA_1: (&[u8; 4], &[u8]) = (b"gAMA", &100_000u32.to_be_bytes());
const LINEAR: (&[u8; 4], &[u8]) = (b"cICP", &[1, 8, 0, 1]);

#[test]
fn a_png_says_what_its_codes_mean() {
    for (name, chunks, expected) in [
        ("nothing", &[][..], 0.215_86),
        ("gAMA 1", &[GAMMA_1], 0.501_96),
        ("gAMA 1/2.2", &[(b"gAMA", &45_455u32.to_be_bytes()[..])], 0.215_86),
        ("gAMA 1/1.8", &[(b"gAMA", &55_556u32.to_be_bytes()[..])], 0.289_18),
        ("sRGB beside gAMA 1", &[(b"sRGB", &[0][..]), GAMMA_1], 0.215_86),
        ("cICP linear", &[LINEAR], 0.501_96),
        ("cICP linear beside sRGB", &[LINEAR, (b"sRGB", &[0])], 0.501_96),
        ("cICP sRGB beside gAMA 1", &[(b"cICP", &[1, 13, 0, 1]), GAMMA_1], 0.215_86),
    ] {
        let folder = textured("map_Kd a.png\nKe 1 1 1\nmap_Ke a.png").with("a.png", png(128, chunks));
        let scene = folder.load("mesh.obj");
        let found = texel(diffuse(&scene), 0);
        assert!(found[..3].iter().all(|value| (value - expected).abs() < 3e-4), "{name}: {found:?}");
        assert!(!scene.warnings.iter().any(|warning| warning.contains("a.png")), "{name}: {:?}", scene.warnings);
        // The other reader says the same.
        let picture = luminaire::picture::read(&folder.path("a.png")).expect("a picture");
        assert!((picture.rgb[0][1] - expected).abs() < 3e-4, "{name}: {picture:?}");
    }
    let hdr = textured("map_Kd a.png").with("a.png", png(128, &[(b"cICP", &[9, 16, 0, 1])])).load("mesh.obj");
    warned(&hdr, &["mesh.mtl:2", "a.png", "PQ", "checkerboard"]);
    // An opacity is a number, whatever the colours mean.
    let scalar = textured("map_d a.png").with("a.png", png(128, &[GAMMA_1])).load("mesh.obj");
    let opacity = texel(&scene_texture(&scalar), 0)[3];
    assert!((opacity - 128.0 / 255.0).abs() < 1e-3, "{opacity}");
}

fn scene_texture(scene: &Scene) -> luminaire::scene::Texture {
    (*scene.textures[0]).clone()
}

/// Display P3 and no profile at all, in PNG, JPEG and WebP: an encoder of each takes one.
#[test]
fn colour_profiles_are_followed() {
    use image::ImageEncoder;
    use image::codecs::{jpeg::JpegEncoder, png::PngEncoder, webp::WebPEncoder};
    let pixels = image::RgbImage::from_pixel(16, 16, image::Rgb([200, 100, 50])).into_raw();
    let p3 = moxcms::ColorProfile::new_display_p3().encode().expect("a profile");
    let write = |name: &str, profile: Vec<u8>| -> Vec<u8> {
        let mut bytes = Vec::new();
        let kind = image::ExtendedColorType::Rgb8;
        match name {
            "a.png" => {
                let mut encoder = PngEncoder::new(&mut bytes);
                encoder.set_icc_profile(profile).expect("a profile");
                encoder.write_image(&pixels, 16, 16, kind).expect("a picture");
            }
            "a.jpg" => {
                let mut encoder = JpegEncoder::new_with_quality(&mut bytes, 100);
                encoder.set_icc_profile(profile).expect("a profile");
                encoder.write_image(&pixels, 16, 16, kind).expect("a picture");
            }
            _ => {
                let mut encoder = WebPEncoder::new_lossless(&mut bytes);
                encoder.set_icc_profile(profile).expect("a profile");
                encoder.write_image(&pixels, 16, 16, kind).expect("a picture");
            }
        }
        bytes
    };
    let linear = |code: f32| ((code / 255.0 + 0.055) / 1.055).powf(2.4);
    let stored = Vec3::new(linear(200.0), linear(100.0), linear(50.0));
    // Display P3 to sRGB, as published.
    let expected = Vec3::new(
        stored.dot(Vec3::new(1.2249, -0.2249, 0.0)),
        stored.dot(Vec3::new(-0.0421, 1.0421, 0.0)),
        stored.dot(Vec3::new(-0.0196, -0.0786, 1.0983)),
    );
    for name in ["a.png", "a.jpg", "a.webp"] {
        for (profile, expected, warns) in [(p3.clone(), expected, false), (b"not a profile".to_vec(), stored, true)] {
            let scene = textured(&format!("map_Kd {name}")).with(name, write(name, profile)).load("mesh.obj");
            let [r, g, b, _] = texel(diffuse(&scene), 0);
            assert!(Vec3::new(r, g, b).abs_diff_eq(expected, 0.01), "{name}: {r} {g} {b}, expected {expected}");
            let warned = scene.warnings.iter().any(|w| w.contains(name) && w.contains("profile"));
            assert_eq!(warned, warns, "{name}: {:?}", scene.warnings);
        }
    }
}

/// An OpenEXR of these rows of red, green, blue and, where it has one, alpha.
fn exr(
    path: &std::path::Path,
    width: usize,
    texels: &[[f32; 4]],
    alpha: bool,
    change: impl Fn(&mut ImageAttributes, &mut LayerAttributes),
) {
    let names = if alpha { &["R", "G", "B", "A"][..] } else { &["R", "G", "B"] };
    let channel = |(index, name): (usize, &&str)| {
        AnyChannel::new(*name, FlatSamples::F32(texels.iter().map(|texel| texel[index]).collect()))
    };
    let list = names.iter().enumerate().map(channel).collect();
    let size = (width, texels.len() / width);
    let (mut image, mut layer) = (ImageAttributes::new(IntegerBounds::new((0, 0), size)), LayerAttributes::named("a"));
    change(&mut image, &mut layer);
    let layer = Layer::new(size, layer, Encoding::UNCOMPRESSED, AnyChannels::sort(list));
    let picture: Image<exr::image::Layers<_>> = Image::from_layers(image, vec![layer]);
    picture.write().to_file(path).expect("an EXR");
}

/// Half covered, not covered, covered.
const COVERED: [[f32; 4]; 3] = [[0.1, 0.2, 0.3, 0.5], [0.5, 0.0, 0.25, 0.0], [0.5, 0.5, 0.5, 1.0]];

#[test]
fn premultiplied_colours_are_divided_where_alpha_is_the_opacity() {
    let read = |mtl: &str| {
        let folder = textured(mtl);
        exr(&folder.path("a.exr"), 3, &COVERED, true, |_, _| {});
        folder.image("mask.png", rgba(&[[255, 255, 255, 9]])).load("mesh.obj")
    };
    let first = |scene: &Scene| texel(diffuse(scene), 0);
    let near = |found: [f32; 4], expected: [f32; 4]| {
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-3), "{found:?} for {expected:?}");
    };
    for mtl in ["map_Kd a.exr", "map_Kd a.exr\nmap_d a.exr", "map_Kd ./a.exr\nmap_d -imfchan m a.exr"] {
        let scene = read(mtl);
        near(first(&scene), [0.2, 0.4, 0.6, 0.5]);
        near(texel(diffuse(&scene), 1), [0.5, 0.0, 0.25, 0.0]);
        near(texel(diffuse(&scene), 2), [0.5, 0.5, 0.5, 1.0]);
    }
    // Nobody looks at alpha: colours over black, as they are stored.
    for mtl in ["map_Kd a.exr\nmap_d mask.png", "map_Kd a.exr\nmap_d -imfchan l a.exr", "Ni 1.5\nillum 7\nmap_Kd a.exr"]
    {
        near(first(&read(mtl)), [0.1, 0.2, 0.3, 0.5]);
    }
    let emission = read("Ke 1 1 1\nmap_Ke a.exr");
    near(texel(&emission.textures[0], 0), [0.1, 0.2, 0.3, 0.5]);
    let both = read("map_Kd a.exr\nmap_Ke a.exr");
    assert_eq!(both.textures.len(), 1, "and what glows in the same file is divided too");
}

#[test]
fn odd_numbers_of_a_texture_are_named() {
    let read = |mtl: &str, texels: &[[f32; 4]]| {
        let folder = textured(mtl);
        exr(&folder.path("a.exr"), texels.len(), texels, false, |_, _| {});
        folder.load("mesh.obj")
    };
    let texels = [[1e6, 0.0, 0.0, 1.0], [7e4, 1.0, 1.0, 1.0], [f32::NAN, 1.0, 1.0, 1.0], [-0.5, 1.0, 1.0, 1.0]];
    let scene = read("Ke 1 1 1\nmap_Ke a.exr", &texels);
    warned(&scene, &["mesh.mtl:3", "a.exr", "2 of its 4 texels are above 65504, up to 1e6"]);
    warned(&scene, &["a.exr", "1 of its 4 texels are NaN"]);
    warned(&scene, &["a.exr", "1 of its 4 texels are negative"]);
    assert_eq!(scene.warnings.iter().filter(|warning| warning.contains("a.exr")).count(), 3, "{:?}", scene.warnings);
    let mask = read("map_d a.exr", &[[255.0; 4], [0.5; 4]]);
    warned(&mask, &["a.exr", "1 of its 2 texels are an opacity outside of 0 to 1"]);
    let plain = read("Kd 0 0 0\nKe 1 1 1\nmap_Ke a.exr", &[[65_504.0, 0.0, 1.0, 1.0]]);
    assert!(!plain.warnings.iter().any(|warning| warning.contains("a.exr")), "{:?}", plain.warnings);
}

fn sky(image: &str) -> Folder {
    scene(&format!("[environment]\nimage = \"{image}\"\n"))
}

fn texels_of(scene: &Scene) -> Vec<Vec3> {
    scene.environment.as_ref().and_then(|environment| environment.image.as_ref()).expect("an image").texels.clone()
}

#[test]
fn environments_of_every_kind_of_openexr() {
    let folder = sky("a.exr");
    // 1e6 stays 1e6.
    exr(&folder.path("a.exr"), 2, &[[1e6, 2.0, 3.0, 0.5], [1.0, 1.0, 1.0, 0.5]], true, |_, _| {});
    let scene = folder.load("scene.toml");
    assert_eq!((&texels_of(&scene)[..], scene.warnings), (&[Vec3::new(1e6, 2.0, 3.0), Vec3::ONE][..], vec![]));
    let cg = Chromaticities {
        red: Vec2(0.713, 0.293),
        green: Vec2(0.165, 0.830),
        blue: Vec2(0.128, 0.044),
        white: Vec2(0.32168, 0.33767),
    };
    exr(&folder.path("a.exr"), 2, &[[1.0, 0.0, 0.0, 1.0], [2.0; 4]], false, |image, _| image.chromaticities = Some(cg));
    let scene = folder.load("scene.toml");
    assert!(texels_of(&scene)[0].abs_diff_eq(Vec3::new(1.7051, 0.0, 0.0), 2e-4), "{:?}", texels_of(&scene));
    assert_eq!(texels_of(&scene)[1], Vec3::splat(2.0), "grey stays grey");
    warned(&scene, &["a.exr", "1 texels are negative", "sRGB cannot show"]);
    let cube =
        |_: &mut ImageAttributes, layer: &mut LayerAttributes| layer.environment_map = Some(EnvironmentMap::Cube);
    exr(&folder.path("a.exr"), 1, &[[1.0; 4]; 6], false, cube);
    let error = folder.error("scene.toml").to_string();
    assert!(error.contains("cube") && error.contains("exrenvmap"), "{error}");
    // A cube that does not say so, or the picture of a mirror ball.
    exr(&folder.path("a.exr"), 4, &[[1.0; 4]; 16], false, |_, _| {});
    warned(&folder.load("scene.toml"), &["a.exr", "4 x 4 texels", "twice as many columns"]);
}

/// The same sky, whatever it was multiplied by when it was written.
#[test]
fn radiance_pictures_are_divided_by_their_exposure() {
    let read = |head: &str, code: u8| {
        let bytes = [head.as_bytes(), b"\n-Y 1 +X 2\n", &[code, code, code, 129, code, code, code, 129]].concat();
        let folder = sky("a.hdr").with("a.hdr", bytes);
        let scene = folder.load("scene.toml");
        assert_eq!(scene.warnings, Vec::<String>::new(), "{head}");
        let picture = luminaire::picture::read(&folder.path("a.hdr")).expect("a picture");
        assert_eq!(Vec3::from(picture.rgb[0]), texels_of(&scene)[0], "the other reader");
        texels_of(&scene)[0].x
    };
    let plain = read("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", 32);
    assert_eq!(plain, 0.25);
    for head in ["EXPOSURE=4\n", "EXPOSURE=2\nEXPOSURE=2\n", "COLORCORR=2 2 2\nCOLORCORR=2 2 2\n"] {
        assert_eq!(read(&format!("#?RGBE\nFORMAT=32-bit_rle_rgbe\n{head}"), 128), plain, "{head}");
    }
    let folder = sky("a.hdr").with("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234");
    let error = folder.error("scene.toml").to_string();
    assert!(error.contains("a.hdr") && error.contains("ra_xyze"), "{error}");
}

#[test]
fn formats_that_are_not_read_say_what_to_convert_with() {
    for (name, content, words) in [
        ("a.dds", &b"DDS |\0\0\0"[..], ["DDS", "magick"]),
        ("a.png", b"DDS |\0\0\0", ["DDS", "magick"]),
        ("a.ktx2", b"\xabKTX 20\xbb\r\n", ["KTX", "ktx"]),
        ("a.psd", b"8BPS\0\x01", ["Photoshop", "magick"]),
        ("a.svg", b"<svg xmlns=\"\"/>", ["SVG", "rsvg-convert"]),
        ("a.avif", b"\0\0\0\x1cftypavif\0\0\0\0", ["AVIF", "magick"]),
        ("a.jxl", b"\xff\x0a1234", ["JPEG XL", "djxl"]),
        ("a.jp2", b"\0\0\0\x0cjP  \r\n\x87\n", ["JPEG 2000", "magick"]),
        ("a.jpg", b"version https://git-lfs.github.com/spec/v1\n", ["Git LFS", "git lfs pull"]),
    ] {
        let scene = textured(&format!("map_Kd {name}")).with(name, content).load("mesh.obj");
        warned(&scene, &[&["mesh.mtl:2", name, "not read here"][..], &words].concat());
        let folder = sky(name).with(name, content);
        let error = folder.error("scene.toml").to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
    for (name, content, words) in [
        ("a.glb", &b"glTF\x02"[..], ["glTF (.glb), which is not read yet", "Blender"]),
        ("a.obj", b"glTF\x02", ["glTF (.glb), which is not read yet", "Wavefront"]),
        ("a.gltf", b"\xef\xbb\xbf{\"asset\": {}}", ["glTF (.gltf), which is not read yet", "Wavefront"]),
        ("a.gltf", b"", ["glTF (.gltf), which is not read yet", "Wavefront"]),
        ("a.obj", b"Kaydara FBX Binary  \0", ["FBX", "Wavefront"]),
        ("a.obj", b"version https://git-lfs.github.com/spec/v1\n", ["Git LFS", "git lfs pull"]),
        ("a.fbx", b"", ["FBX", "Wavefront"]),
        ("a.ply", b"ply\nformat ascii 1.0\n", ["PLY, which is not read yet", "MeshLab"]),
        ("a.xml", b"<scene version=\"3.0.0\">", ["Mitsuba", ".toml"]),
        ("a.pbrt", b"", ["pbrt", ".toml"]),
    ] {
        let error = Folder::new().with(name, content).error(name);
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
        let text = format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"{name}\"\n");
        let error = Folder::new().with(name, content).with("scene.toml", text).error("scene.toml");
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
    }
}

/// Whatever is cut off or changed, there is an answer, soon, and no panic.
#[test]
fn damaged_pictures() {
    let folder = Folder::new();
    let path = folder.path("picture");
    exr(&path, 2, &[[0.5; 4]; 2], true, |image, _| {
        image.chromaticities = Some(Chromaticities {
            red: Vec2(0.708, 0.292),
            green: Vec2(0.170, 0.797),
            blue: Vec2(0.131, 0.046),
            white: Vec2(0.3127, 0.3290),
        });
    });
    let openexr = std::fs::read(&path).expect("a file");
    let radiance = b"#?RGBE\nEXPOSURE=4\nCOLORCORR=1 2 1\nPRIMARIES= .7 .3 .2 .8 .1 .0 .3 .3\n\n-X 2 +Y 1\n\x80\x40\x20\x82\x01\x02\x03\x78".to_vec();
    let chromaticities =
        [31_270u32, 32_900, 70_800, 29_200, 17_000, 79_700, 13_100, 4600].map(u32::to_be_bytes).concat();
    let chunks: [(&[u8; 4], &[u8]); 2] = [GAMMA_1, (b"cHRM", &chromaticities)];
    for bytes in [openexr, radiance, png(128, &chunks), png(128, &[LINEAR])] {
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).expect("a file");
            let read = luminaire::picture::read(&path);
            // In words for people, not those of a decoder or the system.
            if let Err(error) = &read {
                let said = error.to_string();
                let bare =
                    ["{", "os error", "failed to fill", "not recognized"].into_iter().find(|word| said.contains(word));
                assert_eq!(bare, None, "{said}");
            }
            read
        };
        assert!(read(&bytes).is_ok());
        for length in 0..bytes.len() {
            let _ = read(&bytes[..length]);
        }
        for at in 0..bytes.len() {
            for bits in [0x01, 0x80, 0xff] {
                let mut bytes = bytes.clone();
                bytes[at] ^= bits;
                let _ = read(&bytes);
            }
        }
    }
}
