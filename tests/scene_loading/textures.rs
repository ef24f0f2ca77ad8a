//! Textures: which image is found, and what becomes of its numbers.

use super::*;
use glam::{Affine2, Vec2, Vec3};
use image::{DynamicImage, ImageFormat, RgbImage, RgbaImage};
use luminaire::scene::Texture;

/// The triangle with texture coordinates, and an MTL of one material.
pub(super) fn textured(mtl: &str) -> Folder {
    obj("mtllib mesh.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
        .with("mesh.mtl", format!("newmtl m\n{mtl}\n"))
}

impl Folder {
    pub(super) fn image(self, name: &str, image: impl Into<DynamicImage>) -> Self {
        std::fs::create_dir_all(self.path(name).parent().expect("inside the folder")).expect("a folder");
        image.into().save(self.path(name)).expect("an image");
        self
    }
}

pub(super) fn rgba(texels: &[[u8; 4]]) -> RgbaImage {
    RgbaImage::from_raw(texels.len() as u32, 1, texels.concat()).expect("a size")
}

fn rgb(texels: &[[u8; 3]]) -> RgbImage {
    RgbImage::from_raw(texels.len() as u32, 1, texels.concat()).expect("a size")
}

pub(super) fn texel(texture: &Texture, index: usize) -> [f32; 4] {
    texture.texels[index].map(|channel| channel.to_f32())
}

/// The diffuse texture of the first material.
pub(super) fn diffuse(scene: &Scene) -> &Texture {
    &scene.textures[first_material(scene).maps.lambert.expect("a map") as usize]
}

fn opacity(scene: &Scene) -> &Texture {
    &scene.textures[first_material(scene).maps.opacity.expect("a map") as usize]
}

fn is_fallback(texture: &Texture) -> bool {
    let (pink, black) = ([1.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]);
    (0..texture.texels.len()).all(|i| [pink, black].contains(&texel(texture, i))) && texel(texture, 0) == pink
}

#[test]
fn colours_are_decoded_from_srgb_and_alpha_is_not() {
    let folder = textured("map_Kd a.png").image("a.png", rgba(&[[255, 188, 10, 51], [0, 0, 0, 255]]));
    let scene = folder.load("mesh.obj");
    let texture = diffuse(&scene);
    assert_eq!((texture.name.as_str(), texture.width, texture.height, texture.clamp), ("a.png", 2, 1, false));
    // The standard's formula worked out by hand; half floats have 11 bits.
    for (got, expected) in texel(texture, 0).into_iter().zip([1.0f32, 0.502_886, 0.003_035_3, 0.2]) {
        assert!((got - expected).abs() <= expected / 2048.0, "{got} for {expected}");
    }
    assert_eq!(texel(texture, 1), [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn rows_are_kept_in_the_files_order() {
    let image = RgbImage::from_raw(1, 3, vec![255, 0, 0, 0, 255, 0, 0, 0, 255]).expect("a size");
    let scene = textured("map_Kd a.png").image("a.png", image).load("mesh.obj");
    assert_eq!([0, 1, 2].map(|row| texel(diffuse(&scene), row)[row]), [1.0; 3]);
}

#[test]
fn every_format_is_read() {
    let plain = DynamicImage::from(rgb(&[[255, 255, 255]; 16]));
    for name in ["a.png", "a.bmp", "a.tga", "a.tif", "a.gif", "a.ppm", "a.jpg", "a.webp"] {
        let scene = textured(&format!("map_Kd {name}")).image(name, plain.clone()).load("mesh.obj");
        let [r, g, b, a] = texel(diffuse(&scene), 0);
        assert!(r > 0.98 && g > 0.98 && b > 0.98 && a == 1.0, "{name}: {r} {g} {b} {a}");
        assert!(!scene.warnings.iter().any(|warning| warning.contains("texture")), "{name}: {:?}", scene.warnings);
    }
    let sixteen = image::ImageBuffer::<image::Rgb<u16>, _>::from_raw(1, 1, vec![65_535, 32_768, 0]).expect("a size");
    let scene = textured("map_Kd a.png").image("a.png", DynamicImage::from(sixteen)).load("mesh.obj");
    assert!((texel(diffuse(&scene), 0)[1] - 0.214_05).abs() < 1e-3, "16 bits are sRGB too");
    // A wrong ending does not matter.
    let folder = textured("map_Kd a.jpg");
    plain.save_with_format(folder.path("a.jpg"), ImageFormat::Png).expect("a PNG");
    assert_eq!(diffuse(&folder.load("mesh.obj")).width, 16);
}

#[test]
fn floats_are_linear_and_made_finite() {
    let texels = [0.5, 1e9, f32::NAN, -3.0, f32::INFINITY, 0.25];
    let folder = textured("map_Ke a.exr");
    luminaire::picture::save_linear(&folder.path("a.exr"), 2, 1, &texels, 0.0).expect("an EXR");
    let scene = folder.load("mesh.obj");
    let texture = &scene.textures[first_material(&scene).maps.emission.expect("a map") as usize];
    assert_eq!((texel(texture, 0), texel(texture, 1)), ([0.5, 65_504.0, 0.0, 1.0], [0.0, 65_504.0, 0.25, 1.0]));
}

#[test]
fn base_and_gain_and_clamp() {
    let mtl = "map_Kd -mm 0.25 0.5 -clamp on a.png\nmap_Ka a.png";
    let scene = textured(mtl).image("a.png", rgba(&[[255, 0, 255, 255]])).load("mesh.obj");
    assert_eq!((texel(diffuse(&scene), 0), diffuse(&scene).clamp), ([0.75, 0.25, 0.75, 1.0], true));
    assert_eq!(scene.textures.len(), 2, "other options are another texture");
}

#[test]
fn one_file_is_loaded_once() {
    let mtl = "map_Kd a.png\nKs .1 .1 .1\nNs 9\nmap_Ks ./a.png\nmap_Ka sub\\..\\a.png";
    let scene = textured(mtl).image("a.png", rgb(&[[9, 9, 9]])).with("sub/x", "").load("mesh.obj");
    assert_eq!(scene.textures.len(), 1);
    let maps = first_material(&scene).maps;
    assert_eq!((maps.lambert, maps.glossy, maps.ambient, maps.opacity), (Some(0), Some(0), Some(0), None));
}

#[test]
fn numbers_beside_maps() {
    let read = |mtl: &str| textured(mtl).image("a.png", rgb(&[[255, 255, 255]])).load("mesh.obj");
    let alone = read("map_Kd a.png\nmap_Ke a.png");
    let material = first_material(&alone);
    assert_eq!((material.lambert, material.emission, material.ambient), (Vec3::ONE, Vec3::ONE, Vec3::ONE));
    assert_eq!(material.maps.ambient, material.maps.lambert, "ambient is diffuse with its map");
    let black = read("Kd 0 0 0\nmap_Kd a.png");
    assert_eq!(first_material(&black).lambert, Vec3::ONE);
    warned(&black, &["`m`", "Kd is black"]);
    let stated = read("Ka .5 .5 .5\nKd .25 .25 .25\nmap_Kd a.png");
    let material = first_material(&stated);
    assert_eq!((material.ambient.x, material.maps.ambient, material.lambert.x), (0.5, None, 0.25));
    let unused = read("Ks 0 0 0\nmap_Ks no.png\nKe 0 0 0\nillum 1");
    assert!(unused.textures.is_empty() && unused.warnings.is_empty(), "{:?}", unused.warnings);
}

#[test]
fn names_are_found_in_spite_of_their_spelling() {
    let wood = || rgb(&[[255, 255, 255], [0, 0, 0]]);
    for (statement, file, guess) in [
        ("my wood 01.png", "my wood 01.png", false),
        ("my wood.png  # a comment", "my wood.png", false),
        ("odd # name.png", "odd # name.png", false),
        ("\"my wood.png\"", "my wood.png", false),
        ("sub\\wood.png", "sub/wood.png", false),
        ("sub\\\\wood.png", "sub/wood.png", false),
        ("Sub/WOOD.png", "sub/wood.PNG", true),
        ("C:\\textures\\Wood.png", "wood.png", true),
        ("/home/nobody/wood.png", "wood.png", true),
    ] {
        let scene = textured(&format!("map_Kd {statement}")).image(file, wood()).load("mesh.obj");
        assert_eq!(diffuse(&scene).width, 2, "{statement}: {:?}", scene.warnings);
        let guesses: Vec<_> = scene.warnings.iter().filter(|warning| warning.contains("is used")).collect();
        assert_eq!(guesses.len(), usize::from(guess), "{statement}: {guesses:?}");
        if guess {
            warned(&scene, &["mesh.mtl:2", &format!("`{statement}`"), &format!("`{file}`")]);
        }
    }
}

#[test]
fn a_missing_or_broken_texture_is_seen() {
    let folder = || textured("map_Kd a.png\nmap_Ka a.png\nmap_Ke a.png\nKs .1 .1 .1\nNs 1\nmap_Ks b.png\nmap_d c.png");
    let read = |folder: Folder, words: &[&str]| {
        let scene = folder.load("mesh.obj");
        let maps = first_material(&scene).maps;
        assert_eq!((maps.lambert, maps.emission, maps.ambient), (Some(0), Some(0), Some(0)));
        assert!(is_fallback(&scene.textures[0]) && scene.textures.len() == 1);
        assert_eq!((maps.glossy, maps.opacity), (None, None));
        warned(&scene, &[&["mesh.mtl:2", "a.png", "checkerboard"], words].concat());
        warned(&scene, &["mesh.mtl:7", "b.png", "no map"]);
        assert_eq!(scene.warnings.iter().filter(|warning| warning.contains("a.png")).count(), 1, "once for each file");
    };
    read(folder(), &["no such file"]);
    read(folder().with("a.png", "not a picture"), &[]);
    read(folder().with("a.png/x", ""), &["folder"]);
    let mut half = std::io::Cursor::new(Vec::new());
    DynamicImage::from(rgb(&[[7, 77, 177]; 64])).write_to(&mut half, ImageFormat::Png).expect("a PNG");
    let half = half.into_inner();
    read(folder().with("a.png", &half[..half.len() / 2]), &[]);
}

#[test]
fn an_image_bomb_is_refused() {
    let tga = |width: u16, height: u16| {
        let size = [width.to_le_bytes(), height.to_le_bytes()].concat();
        [b"\0\0\x02\0\0\0\0\0\0\0\0\0".to_vec(), size, vec![24, 0]].concat()
    };
    let hdr = |text: &str| format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{text}\n").into_bytes();
    for (name, header, words) in [
        ("a.tga", tga(16_385, 1), &["too large", "16384"][..]),
        ("a.tga", tga(1, 65_535), &["too large", "16384"]),
        ("a.hdr", hdr("-Y 16384 +X 16384"), &["too large", "1 GiB"]),
        ("a.hdr", hdr("-Y 2147483647 +X 2147483647"), &[]),
        ("a.tga", tga(16_384, 16_384), &[]),
        ("a.tga", tga(0, 5), &[]),
    ] {
        let scene = textured(&format!("map_Kd {name}")).with(name, header).load("mesh.obj");
        assert!(is_fallback(diffuse(&scene)), "{words:?}");
        warned(&scene, &[&[name, "cannot be used"], words].concat());
    }
}

#[test]
fn opacity_is_alpha_where_there_is_some_and_luminance_else() {
    let read = |statement: &str, image: DynamicImage| {
        let scene = textured(&format!("d 0.5\n{statement}")).image("a.png", image).load("mesh.obj");
        assert_eq!(first_material(&scene).opacity, 0.5);
        texel(opacity(&scene), 0)[3]
    };
    let close = |a: f32, b: f32| (a - b).abs() < 1e-3;
    let alpha = || DynamicImage::from(rgba(&[[255, 0, 102, 51]]));
    assert!(close(read("map_d a.png", alpha()), 0.2));
    // The mask of one well-known model: four channels, all opaque, and the mask in the colours. Not decoded from sRGB.
    assert!(close(read("map_d a.png", DynamicImage::from(rgba(&[[136, 136, 136, 255]]))), 136.0 / 255.0));
    assert!(close(read("map_d a.png", DynamicImage::from(rgb(&[[255, 0, 0]]))), 0.2126));
    assert!(close(read("map_d -imfchan r a.png", alpha()), 1.0));
    assert!(close(read("map_d -imfchan b a.png", alpha()), 0.4));
    assert!(close(read("map_d -imfchan m a.png", alpha()), 0.2));
    assert!(close(read("map_d -imfchan l a.png", alpha()), 0.2126 + 0.0722 * 0.4));
    assert!(close(read("map_d -mm 1 -0.5 a.png", alpha()), 0.9));
    let zero = textured("d 0\nmap_d a.png").image("a.png", alpha()).load("mesh.obj");
    assert_eq!(first_material(&zero).opacity, 1.0);
    warned(&zero, &["d is 0", "map_d"]);
}

#[test]
fn the_alpha_of_a_diffuse_map_is_opacity() {
    let read = |alpha: [u8; 2], more: &str| {
        let image = rgba(&[[255, 255, 255, alpha[0]], [255, 255, 255, alpha[1]]]);
        textured(&format!("map_Kd a.png\n{more}")).image("a.png", image).load("mesh.obj")
    };
    let leaf = read([0, 255], "");
    assert_eq!((first_material(&leaf).maps.opacity, leaf.textures.len()), (Some(0), 1));
    assert_eq!(first_material(&read([255, 255], "")).maps.opacity, None);
    let nowhere = read([0, 0], "");
    assert_eq!(first_material(&nowhere).maps.opacity, None);
    warned(&nowhere, &["a.png", "0 everywhere"]);
    let own = read([0, 255], "map_d -imfchan r a.png");
    assert_eq!(texel(opacity(&own), 0)[3], 1.0, "map_d wins");
    assert_eq!(first_material(&read([0, 255], "Ni 1.5\nillum 7")).maps.opacity, None, "glass is no hole");
}

#[test]
fn energy_counts_the_largest_texel() {
    let dim = textured("Kd 1 1 1\nmap_Kd a.png\nKs 0.5 0.5 0.5\nNs 9\nillum 2");
    let scene = dim.image("a.png", rgb(&[[188, 188, 188], [0, 0, 0]])).load("mesh.obj");
    let material = first_material(&scene);
    let sum = material.lambert * texel(diffuse(&scene), 0)[0] + material.glossy;
    assert!((0.999..=1.0).contains(&sum.x), "{sum}");
    warned(&scene, &["create energy", "1.00"]);
    let bright = textured("map_Kd -mm 0 4 a.png").image("a.png", rgb(&[[255, 0, 0]])).load("mesh.obj");
    assert_eq!(first_material(&bright).lambert, Vec3::splat(0.25));
}

#[test]
fn maps_without_texture_coordinates_are_a_warning() {
    let mtl = "newmtl m\nmap_Kd a.png\n";
    let folder = || with_mtl(mtl).image("a.png", rgb(&[[255, 255, 255]]));
    let scene = folder().load("mesh.obj");
    warned(&scene, &["mesh.obj:6", "texture coordinates", "`m`"]);
    assert!(scene.meshes[0].uvs.is_empty());
    let text = format!(
        "{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\nmaterial = \"plain\"\n[[material]]\nname = \"plain\"\n"
    );
    let scene = folder().with("scene.toml", text).load("scene.toml");
    assert_eq!(scene.warnings, Vec::<String>::new(), "a material without maps needs none");
    assert!(scene.textures.is_empty(), "and nobody sees the other one");
}

#[test]
fn scene_files_add_replace_and_remove_maps() {
    let file =
        |keys: &str| format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n[[material]]\nname = \"m\"\n{keys}\n");
    let read = |keys: &str| {
        let folder = textured("map_Kd a.png\nmap_d a.png").image("a.png", rgba(&[[255, 255, 255, 51]]));
        folder.image("maps/b.png", rgb(&[[255, 0, 0], [0, 0, 0]])).with("scene.toml", file(keys)).load("scene.toml")
    };
    assert_eq!(diffuse(&read("")).name, "a.png");
    let all = read(
        "diffuse_map = \"maps/b.png\"\nglossy = [0.1, 0.1, 0.1]\nexponent = 3\nglossy_map = \"maps/b.png\"\n\
         emission_map = \"maps/b.png\"\nambient_map = \"maps/b.png\"\nopacity_map = \"maps/b.png\"",
    );
    let maps = first_material(&all).maps;
    assert!([maps.lambert, maps.glossy, maps.emission, maps.ambient].iter().all(|map| *map == maps.lambert));
    assert_eq!((diffuse(&all).name.as_str(), first_material(&all).emission), ("b.png", Vec3::ONE));
    assert!((texel(opacity(&all), 0)[3] - 0.2126).abs() < 1e-3);
    let none = read("diffuse_map = \"\"\nopacity_map = \"\"");
    assert_eq!((first_material(&none).maps, first_material(&none).lambert), (Default::default(), Vec3::splat(0.8)));
    let folder = textured("").with("scene.toml", file("diffuse_map = \"no.png\""));
    folder.fails_at("scene.toml", "scene.toml", (13, 15), &["no.png", "No such file"]);
}

/// `-s` and `-o` place a picture, each map by its own numbers; one file is decoded once.
#[test]
fn maps_are_placed() {
    let mtl = "Ke 1 1 1\nmap_Kd -s 2 2 1 -o 0.5 0 0 a.png\nmap_Ke -o 0.25 -2.5 a.png\nmap_Ka a.png\nmap_d -s 4 a.png";
    let scene = textured(mtl).image("a.png", rgba(&[[255, 0, 0, 255], [0, 0, 0, 128]])).load("mesh.obj");
    let maps = first_material(&scene).maps;
    let place = |map: Option<u32>| scene.textures[map.expect("a map") as usize].transform;
    let expected = |scale: (f32, f32), offset: (f32, f32)| {
        Affine2::from_scale_angle_translation(Vec2::from(scale), 0.0, Vec2::from(offset))
    };
    assert_eq!(place(maps.lambert), expected((2.0, 2.0), (0.5, 0.0)));
    // Whole turns say nothing.
    assert_eq!(place(maps.emission), expected((1.0, 1.0), (0.25, -0.5)));
    assert_eq!(place(maps.ambient), Affine2::IDENTITY);
    assert_eq!(place(maps.opacity), expected((4.0, 1.0), (0.0, 0.0)));
    let texels = |map: Option<u32>| scene.textures[map.expect("a map") as usize].texels.as_ptr();
    assert_eq!((texels(maps.lambert), texels(maps.emission)), (texels(maps.ambient), texels(maps.ambient)));
    assert_ne!(texels(maps.opacity), texels(maps.ambient), "a scalar has other texels");
    assert_eq!(scene.textures.len(), 4);
    assert!(scene.warnings.iter().all(|warning| !warning.contains("map_")), "{:?}", scene.warnings);

    // The alpha of a placed map_Kd is where its colours are; where a picture ends, turns count.
    let mtl = "map_Kd -clamp on -s 2 -o 1.5 0 a.png";
    let scene = textured(mtl).image("a.png", rgba(&[[255, 0, 0, 255], [0, 0, 0, 128]])).load("mesh.obj");
    let maps = first_material(&scene).maps;
    assert_eq!(maps.opacity, maps.lambert);
    assert_eq!(scene.textures[0].transform, expected((2.0, 1.0), (1.5, 0.0)));

    let odd = textured("map_Kd -s 1e9 2 -o 0.5 -t 1 a.png\nmap_Ke -s 0 0 a.png").image("a.png", rgb(&[[1, 2, 3]]));
    let scene = odd.load("mesh.obj");
    assert_eq!(diffuse(&scene).transform, expected((1.0, 1.0), (0.5, 0.0)));
    warned(&scene, &["mesh.mtl:2: map_Kd: -s needs numbers from -1e6 to 1e6; it is ignored"]);
    warned(&scene, &["mesh.mtl:3: map_Ke: -s 0"]);
    warned(&scene, &["not modelled, ignored: map_Kd -t"]);
}

/// The same in a scene file, by a table in the place of the name.
#[test]
fn a_scene_file_places_maps() {
    let scene = |map: &str| {
        let text = format!("[[object]]\nmesh = \"mesh.obj\"\n[[material]]\nname = \"m\"\ndiffuse_map = {map}\n");
        textured("Kd 1 1 1").image("a.png", rgb(&[[1, 2, 3]])).with("scene.toml", text)
    };
    let placed = scene("{ image = \"a.png\", scale = [2, -3.5], offset = [0.5, 0] }").load("scene.toml");
    let expected = Affine2::from_scale_angle_translation(Vec2::new(2.0, -3.5), 0.0, Vec2::X * 0.5);
    assert_eq!(diffuse(&placed).transform, expected);
    assert_eq!(diffuse(&scene("{ image = \"a.png\" }").load("scene.toml")).transform, Affine2::IDENTITY);
    assert_eq!(first_material(&scene("{ image = \"\" }").load("scene.toml")).maps.lambert, None);
    for (wrong, column, words) in [
        ("{ scale = [1, 2] }", 15, "`image`: the name of the picture"),
        ("{ image = \"a.png\", scale = [0, 1] }", 42, "other than 0"),
        ("{ image = \"a.png\", offset = [0, 1e7] }", 43, "from -1e6 to 1e6"),
        ("{ image = \"a.png\", scal = [1, 1] }", 34, "did you mean `scale`?"),
        ("3", 15, "the name of an image, or { image"),
    ] {
        scene(wrong).fails_at("scene.toml", "scene.toml", (5, column), &[words]);
    }
    scene("{ image = \"b.png\" }").fails_at("scene.toml", "scene.toml", (5, 15), &["b.png"]);
}
