//! Metallic-roughness materials of scene files: their keys, what is wrong with them, and what becomes of an MTL file below.

use super::textures::rgba;
use super::*;
use glam::Vec3;
use luminaire::scene::{Choices, Physical, load_with, scene_file};

/// A scene file whose triangle, with texture coordinates, shows `m` with these lines.
fn folder(lines: &str, mtl: &str) -> Folder {
    let mesh = "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
    let material = format!("[[material]]\nname = \"m\"\n{lines}");
    let text = format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n{material}");
    let folder = obj(mesh).with("mesh.mtl", mtl).with("scene.toml", text);
    rgba(&[[255, 0, 0, 255], [51, 102, 204, 153]]).save(folder.path("a.png")).expect("a picture");
    folder
}

fn loaded(lines: &str, mtl: &str) -> Scene {
    folder(lines, mtl).load("scene.toml")
}

/// Nothing is said by the MTL file.
#[track_caller]
fn surface(lines: &str) -> Physical {
    first_material(&loaded(lines, "newmtl m\n")).physical.clone().expect("metallic-roughness")
}

#[test]
fn every_key_is_read() {
    let lines = "base_colour = [0.1, 0.2, 0.3]\nmetallic = 0.25\nroughness = 0.75\nior = 1.33\nspecular = 0.5\nspecular_colour = [2, 1, 0]\n\
        conductor = { eta = [0.2, 0.4, 1.5], k = [4, 2, 1] }\ntransmission = 0.5\nattenuation_colour = [1, 0.5, 0.25]\nattenuation_distance = 2\n\
        clearcoat = 0.5\nclearcoat_roughness = 0.125\nsheen_colour = [0.5, 0.25, 0]\nsheen_roughness = 0.5\nanisotropy = 0.5\nanisotropy_rotation = 90\n\
        iridescence = 1\niridescence_ior = 1.5\niridescence_thickness = [200, 300]\ndispersion = 0.5\nemission = [1, 2, 3]\nopacity = 0.5\n";
    let scene = loaded(lines, "newmtl m\n");
    let expected = Physical {
        base_color: Vec3::new(0.1, 0.2, 0.3),
        metallic: 0.25,
        roughness: 0.75,
        ior: 1.33,
        specular: 0.5,
        specular_color: Vec3::new(2.0, 1.0, 0.0),
        conductor: Some([Vec3::new(0.2, 0.4, 1.5), Vec3::new(4.0, 2.0, 1.0)]),
        transmission: 0.5,
        attenuation_color: Vec3::new(1.0, 0.5, 0.25),
        attenuation_distance: 2.0,
        clearcoat: 0.5,
        clearcoat_roughness: 0.125,
        sheen_color: Vec3::new(0.5, 0.25, 0.0),
        sheen_roughness: 0.5,
        anisotropy: 0.5,
        anisotropy_rotation: std::f32::consts::FRAC_PI_2,
        iridescence: 1.0,
        iridescence_ior: 1.5,
        iridescence_thickness: [200.0, 300.0],
        dispersion: 0.5,
        maps: Default::default(),
    };
    let material = first_material(&scene);
    assert_eq!(material.physical.as_ref(), Some(&expected));
    assert_eq!((material.emission, material.opacity), (Vec3::new(1.0, 2.0, 3.0), 0.5));
    assert_eq!((material.lambert, material.glossy, material.has_impulse()), (Vec3::ZERO, Vec3::ZERO, false));
    for (lines, expected) in [
        ("model = \"metallic-roughness\"\n", Physical::default()),
        ("base_colour = [0.8, 0.8, 0.8]\n", Physical::default()),
        ("ior = 0\n", Physical { ior: 0.0, ..Physical::default() }),
        ("transmission = 1\n", Physical { transmission: 1.0, ..Physical::default() }),
        (
            "iridescence = 1\niridescence_thickness = 250\n",
            Physical { iridescence: 1.0, iridescence_thickness: [250.0; 2], ..Physical::default() },
        ),
    ] {
        assert_eq!(surface(lines), Physical { base_color: Vec3::splat(0.8), ..expected }, "{lines}");
    }
    let gold = surface("conductor = \"gold\"\n");
    assert_eq!(
        (gold.metallic, gold.conductor.map(|[eta, _]| eta.z)),
        (1.0, Some(1.442_479)),
        "a metal, unless it is said otherwise"
    );
}

#[test]
fn every_map_is_read() {
    let keys = [
        "metallic",
        "roughness",
        "specular",
        "transmission",
        "clearcoat",
        "clearcoat_roughness",
        "sheen_roughness",
        "iridescence",
        "iridescence_thickness",
    ];
    let mut lines: String =
        keys.iter().map(|key| format!("{key}_map = {{ image = \"a.png\", channel = \"b\" }}\n")).collect();
    for key in ["base_colour", "specular_colour", "sheen_colour", "anisotropy"] {
        lines += &format!("{key}_map = \"a.png\"\n");
    }
    let scene = loaded(&lines, "newmtl m\n");
    let surface = first_material(&scene).physical.clone().expect("metallic-roughness");
    let maps = surface.maps;
    let numbers = [
        maps.metallic,
        maps.roughness,
        maps.specular,
        maps.transmission,
        maps.clearcoat,
        maps.clearcoat_roughness,
        maps.sheen_roughness,
        maps.iridescence,
        maps.iridescence_thickness,
    ];
    for (map, key) in numbers.into_iter().zip(keys) {
        let map = map.unwrap_or_else(|| panic!("no {key}_map"));
        let texel = scene.textures[map.texture as usize].texels[1];
        assert_eq!(map.channel, 2, "{key}");
        assert!((texel[2].to_f32() - 0.8).abs() < 1e-3, "{key}: a number has no curve: {texel:?}");
    }
    let texel = |map: Option<u32>| scene.textures[map.expect("a map") as usize].texels[1][2].to_f32();
    for colour in [maps.base_color, maps.specular_color, maps.sheen_color] {
        assert!((texel(colour) - 0.6038).abs() < 1e-3, "a colour is sRGB");
    }
    assert!((texel(maps.anisotropy) - 0.8).abs() < 1e-3, "a direction is no colour");
    assert_eq!(scene.textures.len(), 2, "one picture as colours and one as numbers");
    // What is not said is 1 where there is a map.
    let ones =
        [surface.metallic, surface.roughness, surface.clearcoat, surface.clearcoat_roughness, surface.transmission];
    assert_eq!((ones, surface.base_color, surface.sheen_color), ([1.0; 5], Vec3::ONE, Vec3::ONE));

    let plain = loaded("roughness_map = \"a.png\"\n", "newmtl m\n");
    let map = first_material(&plain).physical.as_ref().and_then(|surface| surface.maps.roughness).expect("a map");
    let luminance = plain.textures[map.texture as usize].texels[0][usize::from(map.channel)].to_f32();
    assert!((luminance - 0.2126).abs() < 1e-3);
    // The opacity may be any channel, too; and what has alpha is transparent by the map of its colour.
    let holes = loaded("base_colour_map = \"a.png\"\n", "newmtl m\n");
    let material = first_material(&holes);
    assert_eq!(material.maps.opacity, material.physical.as_ref().and_then(|surface| surface.maps.base_color));
    let red = loaded("opacity_map = { image = \"a.png\", channel = \"r\" }\n", "newmtl m\n");
    let opacity = &red.textures[first_material(&red).maps.opacity.expect("a map") as usize];
    assert!((opacity.texels[1][3].to_f32() - 0.2).abs() < 1e-3);
}

#[test]
fn what_is_wrong_is_found_with_line_and_column() {
    let fails = |line: &str, column: usize, words: &[&str]| {
        folder("", "newmtl m\n").with("scene.toml", format!("[[material]]\nname = \"m\"\n{line}\n")).fails_at(
            "scene.toml",
            "scene.toml",
            (3, column),
            words,
        );
    };
    for key in ["metallic", "roughness", "specular", "clearcoat", "clearcoat_roughness", "anisotropy", "iridescence"] {
        fails(&format!("{key} = 1.01"), key.len() + 4, &["from 0 to 1"]);
        fails(&format!("{key} = [1, 1, 1]"), key.len() + 4, &["expected a number"]);
    }
    fails("ior = 0.9", 7, &["from 1 to 100, or 0"]);
    fails("iridescence_ior = 0", 19, &["from 1 to 100"]);
    fails("base_colour = [1.1, 0, 0]", 15, &["from 0 to 1"]);
    fails("base_colour = 0.5", 15, &["[0.5, 0.5, 0.5]"]);
    fails("sheen_colour = [1.1, 0, 0]", 16, &["from 0 to 1"]);
    fails("specular_colour = [-1, 0, 0]", 19, &["negative"]);
    fails("attenuation_colour = [0, 1, 1]", 22, &["above 0, at most 1"]);
    fails("attenuation_distance = 0", 24, &["above 0"]);
    fails("transmission = 1.5", 16, &["from 0 to 1"]);
    fails("transmission = [1, 1]", 16, &["three numbers, found 2"]);
    fails("transmission = [1, -1, 1]", 16, &["negative"]);
    fails("transmission = \"all\"", 16, &["three numbers", "or one"]);
    fails("dispersion = -1", 14, &["at least 0"]);
    fails("iridescence_thickness = [1, 2, 3]", 25, &["two numbers, found 3"]);
    fails("iridescence_thickness = -1", 25, &["nanometres"]);
    fails("anisotropy_rotation = inf", 23, &["finite"]);
    fails("conductor = \"unobtainium\"", 13, &["no metal is called \"unobtainium\"", "\"gold\"", "eta = "]);
    fails("conductor = { eta = [1, 1, 1] }", 13, &["`k`", "extinction coefficient [r, g, b]"]);
    fails("conductor = { eta = [1, 1, 1], k = [1, -1, 1] }", 36, &["negative"]);
    fails("model = \"cartoon\"", 9, &["blinn-phong", "metallic-roughness"]);
    fails("roughness_map = \"gone.png\"", 17, &["gone.png"]);
    fails("roughness_map = { image = \"a.png\", channel = \"x\" }", 46, &["`x`", "`luminance`"]);
    fails("roughness_map = { image = \"a.png\", chanel = \"r\" }", 36, &["`chanel` of a map", "`channel`?"]);
    fails("roughness_map = { image = \"a.png\", scale = [0, 1] }", 44, &["other than 0"]);
    fails("base_colour_map = { image = \"a.png\", channel = \"r\" }", 19, &["one number"]);
    fails("anisotropy_map = { image = \"a.png\", channel = \"r\" }", 18, &["one number"]);
}

/// Keys of both kinds of surface: the error stands at the later one, and names the line of the other.
#[test]
fn the_two_kinds_do_not_mix() {
    for (blinn_phong, counterpart) in [
        ("diffuse = [1, 1, 1]", "base_colour"),
        ("glossy = [1, 1, 1]", "roughness"),
        ("exponent = 10", "roughness"),
        ("reflection = [1, 1, 1]", "metallic"),
        ("transmission = [1, 1, 1]", "one number"),
        ("eta = 1.5", "ior"),
        ("impulse_probability = 0.5", ""),
        ("diffuse_map = \"a.png\"", "base_colour_map"),
        ("model = \"blinn-phong\"", ""),
    ] {
        for physical in ["roughness = 0.5", "metallic_map = \"a.png\"", "conductor = \"gold\""] {
            let key = |line: &str| format!("`{}`", line.split(' ').next().expect("a key"));
            for [first, second] in [[blinn_phong, physical], [physical, blinn_phong]] {
                let text = format!(
                    "[[material]]\nname = \"other\"\n[[material]]\nname = \"m\"\n{first}\nopacity = 1\n{second}\n"
                );
                let folder = folder("", "newmtl m\n").with("scene.toml", text);
                let lines = if first == blinn_phong { ["line 5", "line 7"] } else { ["line 7", "line 5"] };
                let words = [&*key(blinn_phong), &key(physical), lines[0], lines[1], counterpart];
                folder.fails_at("scene.toml", "scene.toml", (7, 1), &words);
            }
        }
    }
    for line in ["base_colour = [1, 1, 1]\ndiffuse = [1, 1, 1]", "model = \"metallic-roughness\"\neta = 1.5"] {
        let text = format!("[[material]]\nname = \"m\"\n{line}\n");
        folder("", "newmtl m\n").with("scene.toml", text).fails_at(
            "scene.toml",
            "scene.toml",
            (4, 1),
            &["line 3", "line 4"],
        );
    }
}

#[test]
fn what_does_nothing_or_is_not_modelled_is_warned_of() {
    for (lines, words) in [
        ("metallic = 1\ntransmission = 1\n", &["`transmission` does nothing", "`metallic` is 1"][..]),
        ("roughness = 1\nthin = true\n", &["`thin` does nothing without `transmission`"]),
        ("attenuation_distance = 1\n", &["attenuation does nothing without `transmission`"]),
        ("transmission = 1\nthin = true\nattenuation_distance = 1\n", &["attenuation does nothing", "no inside"]),
        ("transmission = 1\nattenuation_colour = [1, 0.5, 1]\n", &["without `attenuation_distance`"]),
        ("conductor = \"gold\"\nmetallic = 0\n", &["`conductor` does nothing"]),
        ("clearcoat_roughness = 0.5\n", &["without `clearcoat`"]),
        ("sheen_roughness = 0.5\n", &["without `sheen_colour`"]),
        ("iridescence_ior = 1.5\n", &["without `iridescence`"]),
        ("anisotropy_rotation = 30\n", &["without `anisotropy`"]),
        ("dispersion = 1\n", &["`dispersion` does nothing"]),
        ("roughness = 1\none_sided = true\n", &["`one_sided` does nothing"]),
        ("ior = 0\ntransmission = 1\n", &["`ior = 0`", "nothing is transmitted"]),
        ("sheen_colour = [1, 1, 1]\nsheen_roughness = 1\n", &["not modelled, ignored", "sheen"]),
    ] {
        warned(&loaded(lines, "newmtl m\n"), words);
    }
    let quiet =
        "base_colour = [1, 0.5, 0.25]\nmetallic = 1\nroughness = 0.25\nclearcoat = 1\nclearcoat_roughness = 0\n";
    assert_eq!(loaded(quiet, "newmtl m\n").warnings, Vec::<String>::new());
    // A single triangle is no body.
    warned(&loaded("transmission = 1\n", "newmtl m\n"), &["`m`", "open edges"]);
    for quiet in ["transmission = 1\nthin = true\n", "transmission = 1\nior = 1\n"] {
        assert_eq!(loaded(quiet, "newmtl m\n").warnings, Vec::<String>::new(), "{quiet}");
    }
}

/// Colour, emission, index and opacity come from the MTL file, whatever it means by the rest.
#[test]
fn an_mtl_below_gives_what_both_kinds_have() {
    let plain = "newmtl m\nKd .1 .2 .3\nKs .5 .5 .5\nNs 30\nKe 1 2 3\nNi 1.33\nd .5\nmap_Kd a.png\nillum 2\n";
    let scene = loaded("roughness = 0.25\n", plain);
    let material = first_material(&scene);
    let surface = material.physical.as_ref().expect("metallic-roughness");
    assert_eq!((surface.base_color, surface.roughness, surface.ior), (Vec3::new(0.1, 0.2, 0.3), 0.25, 1.33));
    assert_eq!((material.emission, material.opacity), (Vec3::new(1.0, 2.0, 3.0), 0.5));
    assert!(surface.maps.base_color.is_some() && material.maps.lambert.is_none());
    let removed = loaded("base_colour_map = \"\"\n", plain);
    assert!(first_material(&removed).physical.as_ref().is_some_and(|surface| surface.maps.base_color.is_none()));
    // What both kinds have makes none of both.
    assert!(first_material(&loaded("opacity = 0.25\n", plain)).physical.is_none());
    let frosted = loaded("roughness = 0.25\n", "newmtl m\nKd 0 0 0\nNi 1.45\nillum 4\n");
    let glass = first_material(&frosted).physical.as_ref().expect("metallic-roughness");
    assert_eq!((glass.transmission, glass.ior, glass.base_color), (1.0, 1.45, Vec3::ONE));

    let words = "newmtl m\nKd .1 .2 .3\nPr .5\nPm 1\n";
    let surface = |lines: &str| first_material(&loaded(lines, words)).physical.clone().expect("metallic-roughness");
    assert_eq!((surface("roughness = 0.25\n").roughness, surface("roughness = 0.25\n").metallic), (0.25, 1.0));
    assert_eq!(surface("opacity = 0.5\n").metallic, 1.0);
    assert_eq!(surface("base_colour = [1, 1, 1]\n").base_color, Vec3::ONE);
}

/// A scene file of before goes on meaning the same: its `diffuse` makes Blinn-Phong of the material, with what the MTL file says by the letter.
#[test]
fn words_of_blinn_phong_take_the_mtl_by_the_letter() {
    let words = "Ns 250\nKa 1 1 1\nKd .25 .25 .25\nKs .5 .5 .5\nKe 0 0 0\nNi 1.5\nd 1\nillum 2\n";
    let blender = format!("# Blender 5.0.1 MTL File: 'None'\nnewmtl m\n{words}");
    let plain = format!("newmtl m\n{words}");
    for lines in [
        "glossy = [0.125, 0.125, 0.125]\n",
        "diffuse = [0.5, 0.25, 0.25]\n",
        "eta = 1.5\n",
        "model = \"blinn-phong\"\n",
    ] {
        let (scene, expected) = (loaded(lines, &blender), loaded(lines, &plain));
        assert_eq!(first_material(&scene), first_material(&expected), "{lines}");
        let said =
            scene.warnings.iter().any(|warning| warning.contains("scene.toml:") && warning.contains("by the letter"));
        assert_eq!(said, !lines.starts_with("model"), "{lines}: {:?}", scene.warnings);
    }
    assert!(first_material(&loaded("opacity = 1\n", &blender)).physical.is_some());
    assert!(first_material(&loaded("model = \"metallic-roughness\"\n", &plain)).physical.is_some());
}

/// `luminaire scene` writes every number to the last bit: with its tables uncommented the materials are the same.
#[test]
fn a_written_scene_file_has_the_same_surfaces() {
    let mtl = "# Blender 5.0.1 MTL File: 'None'\n\nnewmtl a\nNs 323.3\nKa 0.3 0.3 0.3\nKd 0.7 0.123456 0.3\nKs 0.3 0.3 0.3\nKe 0 0 0\nNi 1.47\nd 0.7\nillum 6\n\
        newmtl b\nKd 1 .9 .9\nPr .3\nPm .1\nPs .2\nPc 3.3\nPcr .1\naniso .7\nanisor .123\nTf .3 .3 .3\nKs .5 .5 .5\nNi 1.2\nd 1\n\
        newmtl c\nNi 1.5\nKs .5 .5 .5\nmap_Kd -s 2 3 a.png\nmap_Pr a.png\nmap_Pm -imfchan b a.png\nmap_Pc -imfchan g -o .5 0 a.png\nKe 1 2 3\n\
        newmtl d\nillum 2\nmap_Kd a.png\nmap_Ks a.png\nmap_Ns a.png\nmap_refl a.png\nmap_d -imfchan r a.png\n\
        newmtl e\nKd .5 .5 .5\nKs .2 .1 .1\nNs 10\nillum 2\n";
    let mesh = "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 .2\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 2/1 4/2 3/3\nusemtl c\nf 1/1 2/2 4/3\n\
        usemtl d\nf 1/1 3/2 4/3\nusemtl e\nf 1/1 4/2 3/3\n";
    let folder = folder("", mtl).with("mesh.obj", mesh);
    let bare = load_with(&folder.path("mesh.obj"), &Choices::default()).expect("a model");
    let text = scene_file(&folder.path("mesh.obj"), &Choices::default(), &folder.path("")).expect("a scene file").text;
    let (before, tables) = text.split_once("\n# [[material]]").expect("a table of materials");
    let (tables, after) = tables.split_once("\n# Luminaires").expect("an end of the tables");
    let tables = format!("# [[material]]{tables}");
    let keys = tables.lines().filter(|line| !line.starts_with("#  ")).map(|line| line.trim_start_matches("# "));
    let whole = format!("{before}{}\n# Luminaires{after}", keys.collect::<Vec<_>>().join("\n"));
    for text in [&text, &whole] {
        std::fs::write(folder.path("written.toml"), text).expect("a file");
        let loaded = folder.load("written.toml");
        assert_eq!(loaded.materials, bare.materials, "{text}");
        assert_eq!(loaded.textures, bare.textures);
    }
    assert!(whole.contains("channel = \"b\"") && whole.contains("model = \"metallic-roughness\""), "{whole}");
}
