//! Maps that bend normals: which image is one of normals and which of heights, how strong it is, and what is said of it.

use super::textures::{rgba, texel, textured};
use super::*;
use image::{DynamicImage, ImageBuffer, Luma, Rgb, RgbImage};
use luminaire::scene::{Choices, load_with, scene_file};

/// Light blue, as maps of normals are: the normals of a few slopes.
fn blue() -> RgbImage {
    RgbImage::from_fn(4, 2, |x, y| {
        let n = glam::Vec3::new(0.2 * (x as f32 - 1.5), 0.4 * (y as f32 - 0.5), 1.0).normalize();
        Rgb((0.5 + 0.5 * n).to_array().map(|channel| (255.0 * channel).round() as u8))
    })
}

/// Grey: heights.
fn grey() -> DynamicImage {
    ImageBuffer::from_fn(4, 2, |x, y| Luma([40 * x as u8 + 7 * y as u8])).into()
}

fn folder(mtl: &str) -> Folder {
    textured(mtl).image("n.png", blue()).image("h.png", grey())
}

/// Names and scales of the maps of normals and of heights.
fn maps(scene: &Scene) -> [Option<(String, f32)>; 2] {
    let m = first_material(scene);
    let name = |texture: u32| scene.textures[texture as usize].name.clone();
    [m.normal_map.map(|map| (name(map.texture), map.scale)), m.bump_map.map(|map| (name(map.texture), map.scale))]
}

#[test]
fn every_word_of_mtl_is_read() {
    let (n, h) = (|scale| Some(("n.png".to_owned(), scale)), |scale| Some(("h.png".to_owned(), scale)));
    for (mtl, expected, said) in [
        ("norm n.png", [n(1.0), None], None),
        ("map_Kn n.png", [n(1.0), None], None),
        ("map_kn -bm 0.5 n.png", [n(0.5), None], None),
        ("bump h.png", [None, h(1.0)], None),
        ("bump -bm 0.02 h.png", [None, h(0.02)], None),
        ("map_Bump -bm -2 h.png", [None, h(-2.0)], None),
        ("map_bump -bm 0 h.png", [None, None], None),
        ("norm n.png\nmap_Bump -bm 0.1 h.png", [n(1.0), h(0.1)], None),
        // One word for both: the image says which.
        ("map_Bump -bm 0.5 n.png", [n(0.5), None], Some(["mesh.mtl:2", "looks like a map of normals"])),
        ("norm -bm 2 n.png\nbump n.png", [n(2.0), None], None),
        // Whoever writes `norm` means it.
        (
            "norm h.png",
            [Some(("h.png".to_owned(), 1.0)), None],
            Some(["mesh.mtl:2", "`norm` is grey and looks like heights, which is `map_Bump`"]),
        ),
        ("Pr 0.4\nnorm n.png", [n(1.0), None], None),
        ("Pm 1\nbump h.png", [None, h(1.0)], None),
        ("norm none.png", [None, None], Some(["mesh.mtl:2", "there is no map then"])),
        ("bump -bm x h.png", [None, None], Some(["mesh.mtl:2", "-bm needs a number"])),
    ] {
        let scene = folder(mtl).load("mesh.obj");
        assert_eq!(maps(&scene), expected, "{mtl}: {:#?}", scene.warnings);
        match said {
            Some(words) => warned(&scene, &words),
            None => assert!(!scene.warnings.iter().any(|w| w.contains("mesh.mtl")), "{mtl}: {:#?}", scene.warnings),
        }
        assert_eq!(scene.meshes[0].tangents.is_empty(), expected[0].is_none(), "{mtl}: tangents are for normals alone");
    }
    // Blender has but one word, and only writes it of a node for normals: nothing to warn of.
    let blender = "# Blender 5.0.1 MTL File: 'a.blend'\n";
    let folder = folder("").with(
        "mesh.mtl",
        format!("{blender}newmtl m\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nNs 250\nillum 2\nmap_Bump -bm 0.7 n.png\n"),
    );
    let scene = folder.load("mesh.obj");
    assert_eq!(maps(&scene), [Some(("n.png".to_owned(), 0.7)), None]);
    assert!(first_material(&scene).physical.is_some());
    assert!(!scene.warnings.iter().any(|w| w.contains("normals")), "{:#?}", scene.warnings);
}

/// Normals are numbers as they are stored, whatever curve the picture has; heights have more digits than a half float, from whatever channel.
#[test]
fn numbers_are_those_of_the_picture() {
    let flat = RgbImage::from_pixel(1, 1, Rgb([128, 64, 255]));
    let scene = textured("norm a.png").image("a.png", flat).load("mesh.obj");
    let [r, g, b, _] = texel(&scene.textures[0], 0);
    for (found, stored) in [(r, 128.0 / 255.0), (g, 64.0 / 255.0), (b, 1.0f32)] {
        assert!((found - stored).abs() <= stored / 2048.0, "{found} for {stored}");
    }
    // With 16 bits the middle is flat to the last bit of what is kept; 8 bits have no middle: a third of a degree.
    let flat: ImageBuffer<Rgb<u16>, _> = ImageBuffer::from_pixel(1, 1, Rgb([32768, 32768, 65535]));
    let scene = textured("norm a.png").image("a.png", flat).load("mesh.obj");
    assert_eq!(texel(&scene.textures[0], 0), [0.5, 0.5, 1.0, 1.0]);
    let height = |scene: &Scene, index| {
        let [upper, lower, ..] = texel(&scene.textures[0], index);
        f64::from(upper) + f64::from(lower)
    };
    let fine: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_fn(3, 1, |x, _| Luma([40_000 + x as u16]));
    let scene = textured("bump a.png").image("a.png", fine).load("mesh.obj");
    for i in 0..3 {
        assert!((height(&scene, i) - (40_000 + i) as f64 / 65_535.0).abs() < 1e-7, "16 bits: {}", height(&scene, i));
    }
    // Three equal channels are one; of different ones the luminance counts, or the channel that is asked for, and `-mm` changes them.
    let coloured = rgba(&[[51, 102, 204, 255], [51, 51, 51, 255]]);
    for (mtl, at, expected) in [
        ("bump a.png", 1, 0.2),
        ("bump a.png", 0, 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.8),
        ("bump -imfchan b a.png", 0, 0.8),
        ("bump -mm 0.25 0.5 -imfchan g a.png", 0, 0.25 + 0.5 * 0.4),
    ] {
        let scene = textured(mtl).image("a.png", coloured.clone()).load("mesh.obj");
        assert!((height(&scene, at) - expected).abs() < 1e-6, "{mtl}: {} for {expected}", height(&scene, at));
    }
    // Only differences of heights count, so that negative ones are none the worse.
    let load = |mtl: &str, colours: &[[f32; 3]]| {
        let folder = textured(mtl);
        let numbers = colours.concat();
        luminaire::picture::save_linear(&folder.path("a.exr"), colours.len() as u32, 1, &numbers, 0.0).expect("an EXR");
        folder.load("mesh.obj")
    };
    let scene = load("bump a.exr", &[[-1.5; 3], [-0.5; 3], [0.5; 3]]);
    assert_eq!(scene.textures.len(), 1, "{:?}", scene.warnings);
    assert_eq!([0, 1, 2].map(|i| height(&scene, i)), [0.0, 1.0, 2.0]);
    let signed = load("norm a.exr", &[[-0.25, 0.5, 1.0]; 2]);
    warned(&signed, &["mesh.mtl:2", "a.exr", "2 of its 2 texels are outside of 0 to 1"]);
    warned(&load("bump a.exr", &[[f32::NAN; 3]]), &["mesh.mtl:2", "1 of its 1 texels are NaN"]);
}

/// One image that is a colour, normals and heights is three textures, and one that is the same twice is one.
#[test]
fn textures_are_shared_by_what_they_are() {
    let scene = folder("map_Kd n.png\nnorm n.png").load("mesh.obj");
    assert_eq!(scene.textures.len(), 2);
    let two = "map_Bump n.png\nnewmtl k\nnorm n.png\n";
    let folder = folder(two);
    let text = std::fs::read_to_string(folder.path("mesh.obj")).expect("the mesh");
    let folder = folder.with("mesh.obj", text + "usemtl k\nf 1/1 2/2 3/3\n");
    assert_eq!(folder.load("mesh.obj").textures.len(), 1);
}

fn keys(lines: &str) -> Folder {
    folder("").with(
        "scene.toml",
        format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n[[material]]\nname = \"m\"\n{lines}"),
    )
}

#[test]
fn keys_of_scene_files_are_read() {
    let (n, h) = (|scale| Some(("n.png".to_owned(), scale)), |scale| Some(("h.png".to_owned(), scale)));
    for (lines, expected) in [
        ("normal_map = \"n.png\"\n", [n(1.0), None]),
        ("normal_map = \"n.png\"\nnormal_scale = -0.5\n", [n(-0.5), None]),
        ("bump_map = \"h.png\"\nbump_scale = 0.01\n", [None, h(0.01)]),
        (
            "normal_map = \"n.png\"\nbump_map = { image = \"h.png\", scale = [2, 2], channel = \"g\" }\n",
            [n(1.0), h(1.0)],
        ),
        ("metallic = 1\nnormal_map = { image = \"n.png\", offset = [0.5, 0] }\n", [n(1.0), None]),
        ("normal_map = \"n.png\"\nnormal_scale = 0\n", [None, None]),
        ("normal_map = \"\"\n", [None, None]),
    ] {
        let scene = keys(lines).load("scene.toml");
        assert_eq!(maps(&scene), expected, "{lines}: {:#?}", scene.warnings);
        assert!(scene.warnings.is_empty(), "{lines}: {:#?}", scene.warnings);
    }
    // A key means what it says, and is asked whether it does.
    let scene = keys("bump_map = \"n.png\"\n").load("scene.toml");
    assert_eq!(maps(&scene), [None, n(1.0)]);
    warned(&scene, &["scene.toml:", "looks like a map of normals, which is `normal_map`"]);
    for (lines, words) in [
        ("normal_scale = 2\n", "`normal_scale` does nothing without `normal_map`"),
        ("bump_scale = 2\n", "`bump_scale` does nothing without `bump_map`"),
        ("metallic = 1\nbump_scale = 2\n", "`bump_scale` does nothing without `bump_map`"),
    ] {
        warned(&keys(lines).load("scene.toml"), &["material `m`", words]);
    }
    // What the scene file says counts before the MTL file, also that there is none.
    let over = |lines: &str| {
        keys(lines).with("mesh.mtl", "newmtl m\nnorm -bm 0.5 n.png\nmap_Bump -bm 3 h.png\n").load("scene.toml")
    };
    assert_eq!(maps(&over("")), [n(0.5), h(3.0)]);
    assert_eq!(maps(&over("normal_scale = 2\nbump_map = \"\"\n")), [n(2.0), None]);
    assert_eq!(maps(&over("normal_map = \"\"\nbump_scale = 0.25\n")), [None, h(0.25)]);
}

#[test]
fn wrong_keys_are_errors_with_their_place() {
    for (line, at, words) in [
        ("normal_map = \"none.png\"", 14, &["none.png"][..]),
        ("normal_map = { image = \"n.png\", channel = \"r\" }", 14, &["`channel` belongs to the map of one number"]),
        ("normal_scale = \"strong\"", 16, &["number"]),
        ("bump_scale = nan", 14, &["finite"]),
        ("bump = \"h.png\"", 1, &["bump_map", "bump_scale"]),
        ("normal = \"n.png\"", 1, &["normal_map"]),
        ("displacement = \"h.png\"", 1, &["not modelled", "bump_map"]),
    ] {
        keys(&format!("{line}\n")).fails_at("scene.toml", "scene.toml", (13, at), words);
    }
}

/// Faces without coordinates, or whose coordinates have no area, show no map of normals, which is said once.
#[test]
fn what_can_show_no_normals_is_said() {
    let mtl = "newmtl m\nnorm n.png\n";
    let bare = with_mtl(mtl).image("n.png", blue()).load("mesh.obj");
    warned(&bare, &["mesh.obj", "without texture coordinates", "material `m`", "no normal is bent"]);
    assert!(bare.meshes[0].tangents.is_empty());
    let mesh = "mtllib mesh.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 2/2 4/2 3/2\nf 2/1 4/2 3/2\n";
    let flat = obj(mesh).with("mesh.mtl", mtl).image("n.png", blue()).load("mesh.obj");
    warned(
        &flat,
        &["2 triangles of 3 have texture coordinates without an area: no normal map or brushing shows there"],
    );
    assert!(
        flat.meshes[0].tangents[..3].iter().all(|t| t.w != 0.0)
            && flat.meshes[0].tangents[3..].iter().all(|t| t.w == 0.0)
    );
    let heights = obj(mesh).with("mesh.mtl", "newmtl m\nbump h.png\n").image("h.png", grey()).load("mesh.obj");
    assert!(heights.meshes[0].tangents.is_empty(), "heights need none");
}

/// What `luminaire scene` writes of a model, uncommented, is the same scene.
#[test]
fn what_is_written_comes_back() {
    for mtl in [
        "norm -bm 0.3 n.png\nmap_Bump -bm 0.01 -imfchan g -s 2 3 -o 0.25 0 h.png",
        "map_Bump -bm 0.7 n.png",
        "Pr 0.3\nnorm n.png\nbump h.png",
        "Kd 0.5 0.5 0.5",
    ] {
        let folder = folder(mtl);
        let written = scene_file(&folder.path("mesh.obj"), &Choices::default(), folder.0.path()).expect("a scene file");
        let bare = load_with(&folder.path("mesh.obj"), &Choices::default()).expect("it loads");
        let (before, tables) = written.text.split_once("\n# [[material]]").expect("a table of materials");
        let (tables, after) = tables.split_once("\n# Luminaires").expect("an end of the tables");
        let tables = format!("# [[material]]{tables}");
        let keys = tables.lines().filter(|line| !line.starts_with("#  ")).map(|line| line.trim_start_matches("# "));
        let whole = format!("{before}\n{}\n# Luminaires{after}", keys.collect::<Vec<_>>().join("\n"));
        for text in [&written.text, &whole] {
            std::fs::write(folder.path("written.toml"), text).expect("a file");
            let loaded = folder.load("written.toml");
            assert_eq!(loaded.materials, bare.materials, "{mtl}: {text}");
            assert_eq!(loaded.textures, bare.textures, "{mtl}");
            assert_eq!(loaded.meshes[0].tangents, bare.meshes[0].tangents, "{mtl}");
        }
    }
}
