//! Metallic-roughness materials of MTL: by words made for them, and by the old words of a file that Blender wrote.

use super::textures::rgba;
use super::*;
use glam::Vec3;
use luminaire::scene::{ChannelMap, Physical};
use std::f32::consts::TAU;

/// The metallic-roughness surface of `m` in an MTL of these lines, and the warnings.
#[track_caller]
fn surface(mtl: &str) -> (Physical, Vec<String>) {
    let scene = loaded(mtl);
    let material = first_material(&scene).clone();
    (material.physical.unwrap_or_else(|| panic!("by the letter: {mtl}")), scene.warnings)
}

fn loaded(mtl: &str) -> Scene {
    with_maps(mtl).load("mesh.obj")
}

/// With texture coordinates, and pictures of two texels that are not grey.
fn with_maps(mtl: &str) -> Folder {
    let mesh = "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
    let folder = obj(mesh).with("mesh.mtl", mtl);
    rgba(&[[255, 0, 0, 255], [51, 102, 204, 255]]).save(folder.path("a.png")).expect("a picture");
    rgba(&[[0, 255, 0, 255], [128, 128, 128, 255]]).save(folder.path("b.png")).expect("a picture");
    folder
}

/// The stored number of a map's texel.
fn texel(scene: &Scene, map: Option<ChannelMap>, texel: usize) -> f32 {
    let ChannelMap { texture, channel } = map.expect("a map");
    scene.textures[texture as usize].texels[texel][usize::from(channel)].to_f32()
}

const GREY: Physical = Physical { base_color: Vec3::splat(0.8), ..NOTHING_SAID };
const NOTHING_SAID: Physical = Physical {
    base_color: Vec3::ONE,
    metallic: 0.0,
    roughness: 0.5,
    anisotropy: 0.0,
    anisotropy_rotation: 0.0,
    ior: 1.5,
    specular: 1.0,
    specular_color: Vec3::ONE,
    conductor: None,
    transmission: 0.0,
    attenuation_color: Vec3::ONE,
    attenuation_distance: f32::INFINITY,
    clearcoat: 0.0,
    clearcoat_roughness: 0.0,
    sheen_color: Vec3::ZERO,
    sheen_roughness: 0.0,
    iridescence: 0.0,
    iridescence_ior: 1.3,
    iridescence_thickness: [100.0, 400.0],
    dispersion: 0.0,
    maps: luminaire::scene::PhysicalMaps {
        base_color: None,
        metallic: None,
        roughness: None,
        anisotropy: None,
        specular: None,
        specular_color: None,
        transmission: None,
        clearcoat: None,
        clearcoat_roughness: None,
        sheen_color: None,
        sheen_roughness: None,
        iridescence: None,
        iridescence_thickness: None,
    },
};

#[test]
fn every_word_is_read() {
    assert_eq!(NOTHING_SAID, Physical::default());
    let words = "newmtl m\nKd .1 .2 .3\nKe 4 5 6\nNi 1.33\nd .5\nPr .25\nPm .75\nPs .5\nPc .4\nPcr .3\naniso .6\nanisor .25\nTf .2 .2 .2\nillum 2\n";
    let scene = loaded(words);
    let material = first_material(&scene);
    let expected = Physical {
        base_color: Vec3::new(0.1, 0.2, 0.3),
        metallic: 0.75,
        roughness: 0.25,
        ior: 1.33,
        transmission: 0.2,
        sheen_color: Vec3::splat(0.5),
        sheen_roughness: 0.5,
        clearcoat: 0.4,
        clearcoat_roughness: 0.3,
        anisotropy: 0.6,
        anisotropy_rotation: 0.25 * TAU,
        ..NOTHING_SAID
    };
    assert_eq!(material.physical.as_ref(), Some(&expected));
    let rest = Material {
        name: "m".into(),
        ambient: expected.base_color,
        emission: Vec3::new(4.0, 5.0, 6.0),
        opacity: 0.5,
        physical: Some(expected),
        ..Material::default()
    };
    assert_eq!(material, &rest, "no albedo of Blinn-Phong beside it");
    warned(&scene, &["material `m`: Tf makes it transmit"]);
    assert!(material.transmits() && material.bends() && material.is_body());
    assert_eq!(material.index_of_refraction(), Some(1.33));
}

#[test]
fn one_word_is_enough_and_the_rest_has_defaults() {
    for (word, expected) in [
        ("Pr 0", Physical { roughness: 0.0, ..GREY }),
        ("Pm 1", Physical { metallic: 1.0, ..GREY }),
        ("Ps 0", GREY),
        ("Pc 1", Physical { clearcoat: 1.0, ..GREY }),
        ("Pcr .5", GREY),
        ("aniso 0", GREY),
        ("anisor .5", GREY),
        ("Pr x", GREY),
        ("Pr .25\nPr x", Physical { roughness: 0.25, ..GREY }),
    ] {
        let (surface, _) = surface(&format!("newmtl m\n{word}\n"));
        assert_eq!(surface, expected, "{word}");
    }
    let quiet = surface("newmtl m\nKd .5 .5 .5\nKs 0 0 0\nKa 1 1 1\nNs 30\nPr .5\nPcr .03\nanisor 0\n").1;
    assert_eq!(quiet, Vec::<String>::new(), "what exporters write beside it says nothing");
    assert!(loaded("newmtl m\nKd .5 .5 .5\nmap_Ns a.png\n").materials.iter().all(|m| m.physical.is_none()));
}

#[test]
fn what_is_out_of_range_is_clamped_with_its_line() {
    for (word, line, words) in [
        ("Pr 1.5", "mesh.mtl:2", &["Pr 1.5", "0 to 1", "clamped"][..]),
        ("Pm -1", "mesh.mtl:2", &["Pm -1"]),
        ("Pc 4", "mesh.mtl:2", &["Pc 4"]),
        ("aniso -0.5", "mesh.mtl:2", &["aniso -0.5"]),
        ("Pr nan", "mesh.mtl:2", &["Pr needs a finite number, found `nan`"]),
        ("Pm", "mesh.mtl:2", &["Pm needs a finite number"]),
        ("Pr .5 .5", "mesh.mtl:2", &["more than one number"]),
        ("Pr .5\nNi .7", "mesh.mtl", &["`m`: Ni 0.7 is below 1"]),
        ("Pr .5\nKd 2 2 2", "mesh.mtl:3", &["Kd 2 is above 1"]),
        ("Pr .5\nKd 2 2 2", "", &["`m` would create energy: its base colour reaches 2"]),
        ("Pm .5\nKd 1 1 1\nKs .2 .2 .2\nNs 5", "mesh.mtl", &["no use for it: Ks, Ns"]),
        ("Pr .5\nillum 7\nKd .5 .5 .5", "mesh.mtl", &["illum 7 asks for glass", "by Tf"]),
        ("Ps .5", "", &["not modelled, ignored: sheen"]),
    ] {
        let (_, warnings) = surface(&format!("newmtl m\n{word}\n"));
        let found = warnings.iter().any(|w| w.contains(line) && words.iter().all(|part| w.contains(part)));
        assert!(found, "{word}: {warnings:?}");
    }
    assert_eq!(surface("newmtl m\nPr 1.5\nPm -1\n").0, Physical { roughness: 1.0, ..GREY });
    assert_eq!(surface("newmtl m\nPr .5\nKd 2 1 0\n").0.base_color, Vec3::new(1.0, 0.5, 0.0));
    // A dark map does not make it right: the base colour itself is at most 1.
    assert_eq!(surface("newmtl m\nPr .5\nKd 1 1 2\nmap_Kd a.png\n").0.base_color, Vec3::new(0.5, 0.5, 1.0));
}

/// Metals are written with a black `Kd` and a coloured `Ks`.
#[test]
fn a_metal_without_kd_has_the_colour_of_its_reflection() {
    let (metal, warnings) = surface("newmtl m\nKd 0 0 0\nKs .9 .6 .2\nNs 798\nPr .25\nPm 1\nillum 3\n");
    let expected = Physical { base_color: Vec3::new(0.9, 0.6, 0.2), metallic: 1.0, roughness: 0.25, ..NOTHING_SAID };
    assert_eq!((metal, warnings.len()), (expected, 1), "{warnings:?}");
    assert!(warnings[0].contains("material `m`: Kd is black, and Ks taken as the colour"), "{warnings:?}");
    let (mapped, _) = surface("newmtl m\nmap_Ks a.png\nPm 1\n");
    assert!(mapped.base_color == Vec3::ONE && mapped.maps.base_color.is_some());
    for kept in ["Kd 0 0 0\nKs 0 0 0\nPm 1", "Kd 0 0 0\nKs .9 .6 .2\nPm .5", "Kd 0 0 0\nPm 1\nPr 1"] {
        assert_eq!(surface(&format!("newmtl m\n{kept}\n")).0.base_color, Vec3::ZERO, "{kept}");
    }
}

/// Glass of a black `Kd` stays glass, now with a roughness; a colour transmits by `Tf` alone.
#[test]
fn glass_may_be_rough() {
    let (frosted, warnings) = surface("newmtl m\nKd 0 0 0\nNi 1.45\nTf .5 .5 .25\nillum 4\nd .1\nPr .3\n");
    let expected =
        Physical { base_color: Vec3::new(1.0, 1.0, 0.5), transmission: 0.5, ior: 1.45, roughness: 0.3, ..NOTHING_SAID };
    assert_eq!((frosted, warnings.len()), (expected, 1), "{warnings:?}");
    assert!(warnings[0].contains("open edges"), "a single triangle is no body: {warnings:?}");
    let (pane, _) = surface("newmtl m\nKd .5 .5 .5\nNi 1\nTf 1 1 1\nPr 0\n");
    assert_eq!((pane.transmission, pane.ior), (1.0, 1.0), "an index of 1 is one, where light passes");
    let (opaque, _) = surface("newmtl m\nKd .5 .5 .5\nNi 1\nPr 0\n");
    assert_eq!((opaque.transmission, opaque.ior), (0.0, 1.5));
}

#[test]
fn maps_are_numbers_as_they_are_stored() {
    let scene = loaded(
        "newmtl m\nKd 0 0 0\nmap_Kd a.png\nmap_Pr a.png\nPm 0\nmap_Pm -imfchan b a.png\nmap_Pc b.png\nPc .5\nmap_Pcr -imfchan g b.png\n",
    );
    let surface = first_material(&scene).physical.clone().expect("metallic-roughness");
    assert_eq!((surface.base_color, surface.roughness, surface.metallic), (Vec3::ONE, 1.0, 1.0));
    assert_eq!((surface.clearcoat, surface.clearcoat_roughness), (0.5, 1.0));
    // Of a colour its luminance.
    assert!((texel(&scene, surface.maps.roughness, 0) - 0.2126).abs() < 1e-3);
    let luminance = 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.8;
    assert!((texel(&scene, surface.maps.roughness, 1) - luminance).abs() < 1e-3);
    assert!((texel(&scene, surface.maps.metallic, 1) - 0.8).abs() < 1e-3, "no curve of sRGB");
    assert_eq!((surface.maps.metallic.unwrap().channel, surface.maps.roughness.unwrap().channel), (2, 0));
    assert!((texel(&scene, surface.maps.clearcoat, 1) - 128.0 / 255.0).abs() < 1e-3);
    assert_eq!(texel(&scene, surface.maps.clearcoat_roughness, 0), 1.0);
    let base = &scene.textures[surface.maps.base_color.expect("a map") as usize];
    assert!((base.texels[1][2].to_f32() - 0.6038).abs() < 1e-3, "a colour has it");
    warned(&scene, &["`m`: Kd is black beside a map_Kd"]);
    warned(&scene, &["`m`: Pm is 0 beside a map_Pm; 1 is used"]);
    assert!(first_material(&scene).has_maps());

    let packed = loaded("newmtl m\nmap_ORM b.png\n");
    let maps = first_material(&packed).physical.as_ref().expect("metallic-roughness").maps;
    assert_eq!((texel(&packed, maps.roughness, 0), texel(&packed, maps.metallic, 0)), (1.0, 0.0));
    assert_eq!(packed.textures.len(), 1, "one picture for both");

    let missing = loaded("newmtl m\nmap_Pr gone.png\n");
    warned(&missing, &["mesh.mtl:2", "gone.png", "there is no map then"]);
    assert!(missing.textures.is_empty());
}

/// What is no picture of colours may still have numbers outside of 0 to 1.
#[test]
fn numbers_of_float_pictures_are_clamped() {
    let folder = with_maps("newmtl m\nmap_Pr wild.exr\n");
    let texels = [2.0, 2.0, 2.0, 0.25, 0.25, 0.25];
    luminaire::picture::save_linear(&folder.path("wild.exr"), 2, 1, &texels, 0.0).expect("an EXR");
    let scene = folder.load("mesh.obj");
    warned(&scene, &["wild.exr", "1 of its 2 texels are outside of 0 to 1"]);
    let map = first_material(&scene).physical.as_ref().expect("metallic-roughness").maps.roughness;
    assert_eq!((texel(&scene, map, 0), texel(&scene, map, 1)), (1.0, 0.25));
}

/// A material as Blender 5.0 writes it by its old words.
fn blenders(ns: f32, ka: f32, ks: f32, rest: &str) -> String {
    format!(
        "# Blender 5.0.1 MTL File: 'None'\n# www.blender.org\n\nnewmtl m\nNs {ns:.6}\nKa {ka:.6} {ka:.6} {ka:.6}\nKd 0.800000 0.800000 0.800000\n\
         Ks {ks:.6} {ks:.6} {ks:.6}\nKe 0.000000 0.000000 0.000000\n{rest}\n"
    )
}

#[test]
fn what_blender_wrote_is_principled() {
    let opaque = "Ni 1.500000\nd 1.000000\nillum";
    for (mtl, expected) in [
        (blenders(250.0, 1.0, 0.5, &format!("{opaque} 2")), GREY),
        (blenders(490.0, 1.0, 0.5, &format!("{opaque} 3")), Physical { metallic: 1.0, roughness: 0.3, ..GREY }),
        (blenders(562.5, 0.5, 0.5, &format!("{opaque} 3")), Physical { metallic: 0.5, roughness: 0.25, ..GREY }),
        (blenders(250.0, 1.0, 0.0, &format!("{opaque} 1")), Physical { specular: 0.0, ..GREY }),
        (blenders(250.0, 0.25, 0.0, &format!("{opaque} 1")), Physical { metallic: 0.25, specular: 0.0, ..GREY }),
        (
            blenders(0.0, 1.0, 1.0, &format!("{opaque} 2")),
            Physical { roughness: 1.0, specular_color: Vec3::splat(2.0), ..GREY },
        ),
        (blenders(1000.0, 1.0, 0.5, "Ni 1.450000\nd 1\nillum 2"), Physical { roughness: 0.0, ior: 1.45, ..GREY }),
        (blenders(250.0, 1.0, 0.5, "Ni 1.500000\nd 0.500000\nillum 9"), GREY),
        (blenders(250.0, 1.0, 0.5, "Ni 1.500000\nd 0.500000\nillum 6"), Physical { metallic: 1.0, ..GREY }),
    ] {
        let (surface, warnings) = surface(&mtl);
        assert!((surface.roughness - expected.roughness).abs() < 1e-6, "{mtl}: {surface:?}");
        assert_eq!(surface, Physical { roughness: surface.roughness, ..expected }, "{mtl}");
        assert_eq!(warnings, Vec::<String>::new(), "{mtl}");
    }
    let scene = loaded(&blenders(250.0, 1.0, 0.5, "Ni 1.500000\nd 0.500000\nillum 9"));
    let material = first_material(&scene);
    assert_eq!((material.opacity, material.transmits()), (0.5, false));
    let notes: Vec<_> = scene.notes.iter().filter(|note| note.contains("Blender")).collect();
    assert!(
        matches!(&notes[..], [note] if note.contains("mesh.mtl: written by Blender") && note.contains("first line")),
        "{notes:?}"
    );
    let (stand_in, warnings) = surface(&blenders(360.0, 1.0, 0.5, "Ni 1.000000\nd 1\nillum 2"));
    assert!(stand_in.ior == 1.5 && warnings[0].contains("Ni 1"), "{warnings:?}");
}

/// Files of all versions: 900 is the largest `Ns` up to 3.1, and the index says nothing of reflection before 4.0.
#[test]
fn older_blenders_have_their_own_numbers() {
    let words =
        "newmtl m\nNs 225.000000\nKa 1 1 1\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.450000\nd 1\nillum 2\n";
    for (first, ns, ior) in [
        ("# Blender MTL File: 'None'\n# Material Count: 1\n\n", "225.0", 1.5),
        ("# Blender MTL File: 'None'\n# Material Count: 1\n\n", "323.999994", 1.5),
        ("# Blender 3.1.2 MTL File: 'None'\n", "225.0", 1.5),
        ("# Blender 3.6.0 MTL File: 'None'\n", "250.0", 1.5),
        ("# Blender 4.0.2 MTL File: 'None'\n", "250.0", 1.45),
        ("# Blender 5.2.1 LTS MTL File: 'None'\n", "250.0", 1.45),
    ] {
        let (surface, warnings) = surface(&format!("{first}{}", words.replace("225.000000", ns)));
        let roughness = if ns.starts_with("323") { 0.4 } else { 0.5 };
        assert!((surface.roughness - roughness).abs() < 1e-6, "{first}: {surface:?}");
        assert_eq!((surface.ior, surface.specular_color, warnings.len()), (ior, Vec3::ONE, 0), "{first}: {warnings:?}");
    }
}

/// Faces without a material have one in files of Blender up to 3.0: grey, and a highlight that nobody chose.
#[test]
fn no_material_of_blender_is_grey() {
    for words in ["Ns 0\nKa 0.000000 0.000000 0.000000", "Ns 500\nKa 0.8 0.8 0.8"] {
        let text = format!(
            "# Blender MTL File: 'None'\n# Material Count: 1\n\nnewmtl m\n{words}\nKd 0.8 0.8 0.8\nKs 0.8 0.8 0.8\nd 1\nillum 2\n"
        );
        assert_eq!(surface(&text), (GREY, Vec::new()));
    }
}

#[test]
fn maps_of_blender_are_those_of_its_sockets() {
    let head = "# Blender 5.0.1 MTL File: 'None'\n\nnewmtl m\n";
    for words in [
        "Ka 1 1 1\nNi 1.5\nillum 2\nmap_Kd a.png\nmap_Ks b.png\nmap_Ns a.png\nmap_refl b.png\n",
        "Ka 1 1 1\nNi 1.5\nillum 2\nmap_Kd a.png\nmap_Ks b.png\nmap_Ns a.png\nrefl b.png\n",
        "Ni 1.5\nillum 2\nPs 0\nPc 0\nPcr 0.03\naniso 0\nanisor 0\nmap_Kd a.png\nmap_Pm b.png\nmap_Ks b.png\nmap_Pr a.png\n",
    ] {
        let scene = loaded(&format!("{head}{words}"));
        let surface = first_material(&scene).physical.clone().expect("metallic-roughness");
        assert_eq!((surface.base_color, surface.roughness, surface.metallic), (Vec3::ONE, 1.0, 1.0), "{words}");
        assert!((texel(&scene, surface.maps.roughness, 0) - 0.2126).abs() < 1e-3, "{words}");
        assert!((texel(&scene, surface.maps.metallic, 0) - 0.7152).abs() < 1e-3, "{words}");
        let level = &scene.textures[surface.maps.specular_color.expect("a map") as usize];
        assert!((level.texels[1][0].to_f32() - 2.0 * 128.0 / 255.0).abs() < 2e-3, "twice the level, without a curve");
        assert_eq!(scene.warnings, Vec::<String>::new(), "{words}");
    }
}

#[test]
fn words_of_both_kinds_in_a_file_of_blender() {
    let pbr = "Kd .9 .6 .2\nKs .25 .25 .25\nKe 0 0 0\nNi 1.33\nd 1\nillum 2\nPr .1\nPm 0\nPs 0\nPc 2\nPcr .2\naniso .4\nanisor .25\nTf .4 .4 .4\n";
    let (surface, warnings) = surface(&format!("# Blender 5.0.1 MTL File: 'None'\nnewmtl m\n{pbr}"));
    let expected = Physical {
        base_color: Vec3::new(0.9, 0.6, 0.2),
        roughness: 0.1,
        ior: 1.33,
        specular_color: Vec3::splat(0.5),
        transmission: 0.4,
        clearcoat: 0.5,
        clearcoat_roughness: 0.2,
        anisotropy: 0.4,
        anisotropy_rotation: 0.25 * TAU,
        ..NOTHING_SAID
    };
    assert_eq!(surface, expected);
    assert!(!warnings.iter().any(|warning| warning.contains("Tf")), "{warnings:?}");
}

/// What Blender does not write is somebody else's word, and means what it says; and so is all of a file without the first line.
#[test]
fn what_another_hand_wrote_is_taken_by_the_letter() {
    let ours = blenders(250.0, 1.0, 0.5, "Ni 1.500000\nd 1.000000\nillum 2");
    for (from, to, why) in [
        ("Ks 0.500000 0.500000 0.500000", "Ks 0.2 0.1 0.1", "its Ks is a colour"),
        ("Ka 1.000000 1.000000 1.000000", "Ka 0.2 0.1 0.1", "its Ka is a colour"),
        ("illum 2", "illum 5", "its illum is 5"),
        ("Ns 250.000000", "Ns 2000", "its Ns is 2000"),
        ("illum 2", "illum 4\nTf 1 1 1", "its illum is 4"),
        ("d 1.000000", "d 1\nTf .5 .5 .5", "it has a Tf"),
    ] {
        let changed = ours.replace(from, to);
        assert_ne!(changed, ours);
        let scene = loaded(&changed);
        assert!(first_material(&scene).physical.is_none(), "{to}");
        warned(&scene, &["mesh.mtl: material `m`", why, "by the letter"]);
        assert!(!scene.notes.iter().any(|note| note.contains("Principled")), "nothing was read so: {:?}", scene.notes);
    }
    let scene = loaded(ours.split_once('\n').expect("lines").1);
    let material = first_material(&scene);
    assert!(material.physical.is_none() && material.glossy.x > 0.3, "{material:?}");
    assert!(!scene.warnings.iter().chain(&scene.notes).any(|said| said.contains("Blender")));
}
