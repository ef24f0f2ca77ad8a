//! MTL files of people in a hurry and of other programs: options that nobody knows, names of words that are nearly right.

use super::textures::{rgba, textured};
use super::*;
use image::{ImageBuffer, Luma, Rgb, RgbImage};
use luminaire::scene::Physical;
use std::f32::consts::TAU;

/// Half grey and white, in files whose names have blanks.
fn folder(mtl: &str) -> Folder {
    let grey = rgba(&[[128, 128, 128, 255], [255, 255, 255, 255]]);
    textured(mtl).image("grey.png", grey.clone()).image("my map 01.png", grey.clone()).image("a #1.png", grey)
}

fn surface(scene: &Scene) -> Physical {
    first_material(scene).physical.clone().unwrap_or_else(|| panic!("by the letter: {:?}", scene.warnings))
}

/// The file is what counts: options that nobody knows are skipped and named, those behind the name are read.
#[test]
fn options_that_nobody_knows_do_not_lose_the_map() {
    for (mtl, file, ignored) in [
        ("map_Pr -colorspace Non-Color grey.png", "grey.png", Some("map_Pr -colorspace")),
        ("map_Pr -foo 3 grey.png", "grey.png", Some("map_Pr -foo")),
        ("map_Pr -foo my map 01.png", "my map 01.png", Some("map_Pr -foo")),
        ("map_Pr -imfchan g -foo 3 4 -bar on grey.png", "grey.png", Some("map_Pr -foo, map_Pr -bar")),
        ("map_Pr grey.png -foo 3", "grey.png", Some("map_Pr -foo")),
        ("map_Pr grey.png -imfchan g", "grey.png", None),
        ("map_Pr \"my map 01.png\" # roughness", "my map 01.png", None),
        ("map_Pr \"a #1.png\" # roughness", "a #1.png", None),
        ("map_Pr a #1.png", "a #1.png", None),
        ("map_Pr -bm 0.5 grey.png", "grey.png", Some("map_Pr -bm")),
    ] {
        let scene = folder(mtl).load("mesh.obj");
        let map = surface(&scene).maps.roughness.unwrap_or_else(|| panic!("{mtl}: {:?}", scene.warnings));
        assert_eq!(scene.textures[map.texture as usize].name, file, "{mtl}");
        assert_eq!(map.channel, u8::from(mtl.contains("-imfchan")), "{mtl}");
        match ignored {
            Some(words) => warned(&scene, &["mesh.mtl: material `m`: not modelled, ignored", words]),
            None => assert!(!scene.warnings.iter().any(|w| w.contains("mesh.mtl")), "{mtl}: {:?}", scene.warnings),
        }
    }
    let bump = folder("map_Bump grey.png -bm 0.5 -s 2 3").load("mesh.obj");
    assert_eq!(first_material(&bump).bump_map.map(|map| map.scale), Some(0.5));
    assert_eq!(bump.textures[0].transform.matrix2.to_cols_array(), [2.0, 0.0, 0.0, 3.0]);
    // Where there is no such file there is nothing to find.
    warned(&folder("map_Pr -foo 3 none.png").load("mesh.obj"), &["mesh.mtl:2", "-foo 3 none.png", "no such file"]);
    // A channel of what has three, or of normals, says nothing.
    for (word, rest) in
        [("norm", ""), ("map_Kd", ""), ("map_Ke", ""), ("map_Ks", "Ns 10"), ("map_Ps", ""), ("map_ORM", "")]
    {
        let scene = folder(&format!("{word} -imfchan r grey.png\n{rest}")).load("mesh.obj");
        warned(&scene, &["mesh.mtl: material `m`: not modelled, ignored", &format!("{word} -imfchan")]);
    }
}

/// What an option makes of a picture may leave what can be, of whole numbers as of others.
#[test]
fn texels_beyond_by_an_option_are_counted() {
    for (mtl, words) in [
        ("map_Pr -mm -1 3 grey.png", "1 of its 2 texels are outside of 0 to 1; they are clamped"),
        ("map_Pr -imfchan r -mm -1 3 grey.png", "1 of its 2 texels are outside of 0 to 1; they are clamped"),
        ("map_d -imfchan r -mm -1 3 grey.png", "1 of its 2 texels are an opacity outside of 0 to 1"),
        ("map_Kd -mm -0.5 1 grey.png", "1 of its 2 texels are negative"),
    ] {
        warned(&folder(mtl).load("mesh.obj"), &["mesh.mtl:2", "grey.png", words]);
    }
    for mtl in ["map_Pr -mm 0 1 grey.png", "map_Pr -mm 0.25 0.5 grey.png", "map_Kd -mm 0.25 0.5 grey.png"] {
        let scene = folder(mtl).load("mesh.obj");
        assert!(!scene.warnings.iter().any(|w| w.contains("texels")), "{mtl}: {:?}", scene.warnings);
    }
}

/// Each keyword that nobody knows is named, with what is meant.
#[test]
fn keywords_that_are_nearly_right_are_named_with_what_is_meant() {
    let scene = folder("pr 0.3\nPM 1\nroughness 0.5\npr 0.4\nKdd 1 1 1\nillumm 2\nwhatever 1").load("mesh.obj");
    for words in [
        &["mesh.mtl:2", "`pr` is ignored; did you mean `Pr`?", "1 more like it"][..],
        &["mesh.mtl:3", "`PM` is ignored; did you mean `Pm`?"],
        &["mesh.mtl:4", "`roughness` is ignored; did you mean `Pr`?"],
        &["mesh.mtl:6", "`Kdd` is ignored"],
        &["mesh.mtl:7", "`illumm` is ignored; did you mean `illum`?"],
        &["mesh.mtl:8", "`whatever` is ignored"],
    ] {
        warned(&scene, words);
    }
    assert!(!scene.warnings.iter().any(|w| w.contains("`Kdd`") && w.contains("mean")), "{:?}", scene.warnings);
    let many: String = (0..5000).map(|k| format!("word{k} 1\n")).collect();
    let scene = folder(&many).load("mesh.obj");
    assert!(scene.warnings.len() < 12, "{:?}", scene.warnings);
    warned(&scene, &["mesh.mtl:10", "`word8` and others", "more unknown keywords"]);
    for (word, meant) in [
        ("map_normal", "norm"),
        ("map_Norm", "norm"),
        ("map_Roughness", "map_Pr"),
        ("map_Metallic", "map_Pm"),
        ("map_basecolor", "map_Kd"),
        ("map_Opacity", "map_d"),
    ] {
        let scene = folder(&format!("Pr .5\n{word} grey.png")).load("mesh.obj");
        warned(&scene, &["not modelled, ignored", &format!("{word} (write {meant})")]);
    }
    // Words of images have letters of any size.
    for word in ["Bump", "BUMP", "Map_bump"] {
        assert!(first_material(&folder(&format!("{word} grey.png")).load("mesh.obj")).bump_map.is_some(), "{word}");
    }
    assert!(first_material(&folder("NORM grey.png").load("mesh.obj")).normal_map.is_some());
}

/// A rotation in turns goes round.
#[test]
fn turns_of_the_grain_go_round() {
    for (word, turns) in [("-0.25", 0.75), ("1.5", 0.5), ("1", 1.0), ("0.25", 0.25)] {
        let scene = folder(&format!("aniso .5\nanisor {word}")).load("mesh.obj");
        assert!((surface(&scene).anisotropy_rotation - turns * TAU).abs() < 1e-5, "{word}");
        assert!(!scene.warnings.iter().any(|w| w.contains("anisor")), "{:?}", scene.warnings);
    }
    warned(&folder("aniso .5\nanisor x").load("mesh.obj"), &["mesh.mtl:3", "anisor needs a finite number"]);
}

/// Heights and colours where normals belong are taken as they are said, and asked about.
#[test]
fn pictures_that_are_no_normals_are_asked_about() {
    let heights = ImageBuffer::from_fn(4, 4, |x, y| Luma([(16 * x + 60 * y) as u8]));
    let photo = RgbImage::from_fn(4, 4, |x, y| Rgb([(60 * x) as u8, (20 * y) as u8, 40]));
    let slopes = RgbImage::from_fn(4, 4, |x, _| {
        let n = glam::Vec3::new(0.3 * (x as f32 - 1.5), 0.2, 1.0).normalize();
        Rgb((0.5 + 0.5 * n).to_array().map(|channel| (255.0 * channel).round() as u8))
    });
    // Of an object: all around, but of unit length.
    let around = RgbImage::from_fn(4, 4, |x, y| {
        let (a, b) = (x as f32 * 1.6, y as f32 * 0.8);
        let n = glam::Vec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos());
        Rgb((0.5 + 0.5 * n).to_array().map(|channel| (255.0 * channel).round() as u8))
    });
    let images = |folder: Folder| {
        let grey = image::DynamicImage::from(heights.clone());
        folder
            .image("h.png", grey)
            .image("p.png", photo.clone())
            .image("n.png", slopes.clone())
            .image("o.png", around.clone())
    };
    for (file, words) in [
        ("h.png", Some("is grey and looks like heights, which is")),
        ("p.png", Some("not of unit length")),
        ("n.png", None),
        ("o.png", None),
    ] {
        let by_mtl = images(textured(&format!("norm {file}"))).load("mesh.obj");
        let table = "[[object]]\nmesh = \"mesh.obj\"\n[[material]]\nname = \"m\"\n";
        let text = format!("{SENSOR}{LIGHT}{table}normal_map = \"{file}\"\n");
        let by_key = images(textured("Kd 1 1 1")).with("scene.toml", text).load("scene.toml");
        for (scene, key, bump, at) in
            [(by_mtl, "`norm`", "`map_Bump`", "mesh.mtl:2"), (by_key, "`normal_map`", "`bump_map`", "scene.toml:13")]
        {
            assert!(first_material(&scene).normal_map.is_some());
            match words {
                Some(words) => {
                    warned(&scene, &[at, "material `m`", key, words, "taken as normals"]);
                    assert_eq!(file == "h.png", scene.warnings.iter().any(|w| w.contains(bump)));
                }
                None => assert!(!scene.warnings.iter().any(|w| w.contains(key)), "{:?}", scene.warnings),
            }
        }
    }
}
