//! Numbers and their maps: a 0 over which a map is named, a map that cannot be used, and who decides what is a metal.

use super::textures::rgba;
use super::*;
use glam::Vec3;
use luminaire::scene::Physical;

/// A scene file whose triangle, with texture coordinates, shows `m` with these lines over this MTL file; one without lines is no table.
fn folder(lines: &str, mtl: &str) -> Folder {
    let mesh = "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
    let material = if lines.is_empty() { String::new() } else { format!("[[material]]\nname = \"m\"\n{lines}") };
    let text = format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n{material}");
    let folder = obj(mesh).with("mesh.mtl", mtl).with("scene.toml", text).with("bad.png", "no picture");
    rgba(&[[128, 128, 128, 255], [128, 128, 128, 255]]).save(folder.path("grey.png")).expect("a picture");
    folder
}

fn loaded(lines: &str, mtl: &str) -> Scene {
    folder(lines, mtl).load("scene.toml")
}

#[track_caller]
fn physical(scene: &Scene) -> Physical {
    first_material(scene).physical.clone().expect("metallic-roughness")
}

/// What every MTL file of Blender has, whose dielectrics say `Ka 1` and lamps nothing but `Ke 0`.
const BLENDER: &str = "# Blender 5.0.1 MTL File: 'None'\nnewmtl m\nNs 250\nKa 1 1 1\nKd .5 0 0\nKs .5 .5 .5\nKe 0 0 0\nNi 1.5\nd 1\nillum 2\n";

/// A black dielectric stays black; the reflection is the colour of a metal, whoever says that it is one.
#[test]
fn only_a_metal_has_the_colour_of_its_reflection() {
    let gold = Vec3::new(1.0, 0.75, 0.25);
    for (lines, mtl, base, metallic, said) in [
        ("", "Kd 0 0 0\nPr .9\nKs .5 .5 .5", Vec3::ZERO, 0.0, None),
        ("", "Kd 0 0 0\nPr .9\nKs 1 .75 .25", Vec3::ZERO, 0.0, Some("Ks ignored")),
        ("", "Kd 0 0 0\nPm 0\nKs 1 .75 .25", Vec3::ZERO, 0.0, Some("Ks ignored")),
        ("", "Kd 0 0 0\nPm .5\nKs 1 .75 .25", Vec3::ZERO, 0.5, Some("Ks ignored")),
        ("", "Kd 0 0 0\nPm 1\nKs 1 .75 .25", gold, 1.0, Some("Ks taken as the colour of the metal")),
        ("", "Kd 0 0 0\nmap_Pm grey.png\nKs 1 .75 .25", gold, 1.0, Some("Ks taken as the colour of the metal")),
        ("", "Kd 0 0 0\nmap_Pm gone.png\nKs 1 .75 .25", Vec3::ZERO, 0.0, Some("Ks ignored")),
        ("", "Pr .5\nKs 1 .75 .25", Vec3::splat(0.8), 0.0, Some("Ks ignored")),
        ("roughness = 0.3\n", "Kd 0 0 0\nKs 1 .75 .25\nillum 3", Vec3::ZERO, 0.0, Some("Ks ignored")),
        ("metallic = 1\n", "Kd 0 0 0\nKs 1 .75 .25\nillum 3", gold, 1.0, Some("Ks taken")),
        ("metallic = 1\n", "Kd 0 0 0\nPm 0\nKs 1 .75 .25", gold, 1.0, Some("Ks taken")),
        ("metallic = 0\n", "Kd 0 0 0\nPm 1\nKs 1 .75 .25", Vec3::ZERO, 0.0, Some("Ks ignored")),
        ("base_colour = [0, 0, 0]\n", "Kd 0 0 0\nPm 1\nKs 1 .75 .25", Vec3::ZERO, 1.0, None),
        ("conductor = \"gold\"\n", "Kd 0 0 0\nPm 0\nKs 1 .75 .25", Vec3::ZERO, 1.0, None),
    ] {
        let scene = loaded(lines, &format!("newmtl m\n{mtl}\n"));
        let surface = physical(&scene);
        assert_eq!((surface.base_color, surface.metallic), (base, metallic), "{lines}{mtl}: {:?}", scene.warnings);
        match said {
            Some(words) => warned(&scene, &["mesh.mtl: material `m`: Kd is black", words]),
            None => assert!(!scene.warnings.iter().any(|w| w.contains("Ks")), "{lines}{mtl}: {:?}", scene.warnings),
        }
    }
}

/// A map that a scene file names counts where the MTL file has a 0, as every file of Blender does.
#[test]
fn a_map_over_a_zero_of_the_mtl_counts() {
    let zeros = "newmtl m\nKd 0 0 0\nKa 0 0 0\nKe 0 0 0\nd 0\nPr 0\nPm 0\nPc 0\n";
    let of = |key: &str, scene: &Scene| -> (f32, bool) {
        let (m, p) = (first_material(scene), physical(scene));
        match key {
            "base_colour" => (p.base_color.x, p.maps.base_color.is_some()),
            "emission" => (m.emission.x, m.maps.emission.is_some()),
            "ambient" => (m.ambient.x, m.maps.ambient.is_some()),
            "opacity" => (m.opacity, m.maps.opacity.is_some()),
            "metallic" => (p.metallic, p.maps.metallic.is_some()),
            "roughness" => (p.roughness, p.maps.roughness.is_some()),
            "clearcoat" => (p.clearcoat, p.maps.clearcoat.is_some()),
            "specular_colour" => (p.specular * p.specular_color.x, p.maps.specular_color.is_some()),
            _ => panic!("{key}"),
        }
    };
    for key in ["base_colour", "emission", "ambient", "opacity", "metallic", "roughness", "clearcoat"] {
        let scene = loaded(&format!("{key}_map = \"grey.png\"\n"), zeros);
        assert_eq!(of(key, &scene), (1.0, true), "{key}: {:?}", scene.warnings);
        if !["clearcoat", "ambient"].contains(&key) {
            warned(&scene, &["scene.toml:", "material `m`", &format!("has 0 for `{key}`"), "1 is used"]);
        }
        // What the table itself says counts, and is said to be of no use beside the map.
        let scene = loaded(
            &format!("roughness = 0.5\n{key}_map = \"grey.png\"\n{key} = 0\n").replace(
                &format!("{key} = 0\n"),
                match key {
                    "base_colour" | "emission" | "ambient" => format!("{key} = [0, 0, 0]\n"),
                    "roughness" => String::new(),
                    _ => format!("{key} = 0\n"),
                }
                .as_str(),
            ),
            zeros,
        );
        if key != "roughness" {
            assert_eq!(of(key, &scene), (0.0, false), "{key}: {:?}", scene.warnings);
            let words = format!("`{key}_map` does nothing where `{key}` is 0");
            warned(&scene, &["scene.toml:", "material `m`", &words]);
        }
        // Turned off on purpose.
        let all = "newmtl m\nKd 1 1 1\nmap_Kd grey.png\nmap_Ke grey.png\nmap_Pm grey.png\nmap_Pr grey.png\n";
        let scene = loaded("metallic = 0\nroughness = 0\nemission = [0, 0, 0]\n", all);
        assert!(!scene.warnings.iter().any(|w| w.contains("does nothing")), "{:?}", scene.warnings);
    }
    for (lines, key) in [("metallic_map = \"grey.png\"\n", "metallic"), ("emission_map = \"grey.png\"\n", "emission")] {
        assert_eq!(of(key, &loaded(lines, BLENDER)), (1.0, true), "{key}");
    }
    let matt = BLENDER.replace("Ks .5 .5 .5", "Ks 0 0 0").replace("illum 2", "illum 1");
    let specular = |lines: &str| of("specular_colour", &loaded(lines, &matt));
    assert_eq!(specular("roughness = 0.5\n"), (0.0, false));
    assert_eq!(specular("specular_colour = [1, 1, 1]\n"), (1.0, false));
    assert_eq!(specular("specular_colour_map = \"grey.png\"\n"), (1.0, true));
    assert_eq!(specular("specular = 0.5\n"), (0.5, false));
    // A broken one is looked for, too, and leaves what there was.
    let scene = loaded("metallic_map = \"bad.png\"\n", "newmtl m\nPm 0\n");
    warned(&scene, &["bad.png"]);
    assert_eq!(physical(&scene).metallic, 0.0);
    // The lecture's surfaces.
    for (key, zero) in [("diffuse", "Kd 0 0 0"), ("glossy", "Ks 0 0 0\nNs 10"), ("emission", "Ke 0 0 0")] {
        let scene = loaded(&format!("{key}_map = \"grey.png\"\n"), &format!("newmtl m\nKd .2 .2 .2\n{zero}\n"));
        let m = first_material(&scene);
        assert!(m.physical.is_none());
        let maps = [("diffuse", m.maps.lambert), ("glossy", m.maps.glossy), ("emission", m.maps.emission)];
        assert!(maps.iter().any(|(name, map)| *name == key && map.is_some()), "{key}: {:?}", scene.warnings);
        warned(&scene, &["scene.toml:", &format!("has 0 for `{key}`")]);
    }
    warned(&loaded("", "newmtl m\nKs 0 0 0\nmap_Ks grey.png\n"), &["material `m`: map_Ks does nothing where Ks is 0"]);
    let relief = loaded("bump_map = \"grey.png\"\n", "newmtl m\nbump -bm 0 grey.png\n");
    assert_eq!(first_material(&relief).bump_map.map(|map| map.scale), Some(1.0));
}

/// A metal of its own numbers is one, whatever the MTL file says of the material, unless the table says more.
#[test]
fn a_conductor_is_a_metal() {
    for (lines, mtl, metallic) in [
        ("conductor = \"copper\"\n", BLENDER, 1.0),
        ("conductor = \"copper\"\nroughness = 0.2\n", "newmtl m\nPm 0\nPr .5\n", 1.0),
        ("conductor = \"copper\"\n", "newmtl m\nPm .5\n", 1.0),
        ("conductor = \"copper\"\nmetallic = 0.25\n", "newmtl m\nPm 0\n", 0.25),
        ("roughness = 0.2\n", BLENDER, 0.0),
    ] {
        let scene = loaded(lines, mtl);
        assert_eq!(physical(&scene).metallic, metallic, "{lines} {mtl}");
        assert_eq!(scene.warnings, Vec::<String>::new(), "{lines} {mtl}");
    }
    let rusty = physical(&loaded("conductor = \"copper\"\n", "newmtl m\nPm 0\nmap_Pm grey.png\n"));
    assert!(rusty.metallic == 1.0 && rusty.maps.metallic.is_some(), "the map goes on saying where");
}

/// Without its map a number is what it is where none is named, and a warning says so.
#[test]
fn a_map_that_cannot_be_used_makes_no_number() {
    let grey = Physical { base_color: Vec3::splat(0.8), ..Physical::default() };
    let blender = BLENDER.replace("Ka 1 1 1\n", "refl gone.png\n").replace("Kd .5 0 0\n", "Kd .8 .8 .8\n");
    for (lines, mtl, said) in [
        ("", "newmtl m\nmap_Pm gone.png\n", "`metallic` is 0"),
        ("", "newmtl m\nmap_Pm bad.png\n", "`metallic` is 0"),
        ("", "newmtl m\nPm 0\nmap_Pm bad.png\n", "`metallic` is 0"),
        ("", "newmtl m\nmap_ORM gone.png\n", "`metallic` is 0, `roughness` is 0.5"),
        ("", "newmtl m\nmap_Pc gone.png\nmap_Pcr gone.png\n", "`clearcoat` is 0, `clearcoat_roughness` is 0"),
        ("", "newmtl m\nmap_Ps gone.png\nPs 0\n", "`sheen_colour` is black"),
        ("", &blender, "`metallic` is 0"),
        ("transmission_map = \"bad.png\"\n", "newmtl m\n", "`transmission` is 0"),
        ("anisotropy_map = \"bad.png\"\n", "newmtl m\n", "`anisotropy` is 0"),
        ("iridescence_map = \"bad.png\"\n", "newmtl m\n", "`iridescence` is 0"),
        ("roughness_map = \"bad.png\"\n", "newmtl m\n", "`roughness` is 0.5"),
    ] {
        let scene = loaded(lines, mtl);
        let surface = physical(&scene);
        let grey = Physical { sheen_roughness: surface.sheen_roughness, ..grey.clone() };
        assert_eq!(surface, grey, "{lines}{mtl}");
        warned(&scene, &["material `m`: without the map that cannot be used", said]);
        assert!(!scene.warnings.iter().any(|w| w.contains("does nothing")), "{lines}{mtl}: {:?}", scene.warnings);
    }
    let metal = physical(&loaded("metallic_map = \"bad.png\"\nconductor = \"gold\"\n", "newmtl m\n"));
    assert_eq!(metal.metallic, 1.0);
    let stated = physical(&loaded("", "newmtl m\nPm .5\nmap_Pm gone.png\n"));
    assert_eq!(stated.metallic, 0.5, "what is said counts");
    // The lecture's surfaces: diffuse, as without the word.
    for kd in ["", "Kd .8 .8 .8\n"] {
        let scene = loaded("", &format!("newmtl m\n{kd}map_Ks gone.png\n"));
        let m = first_material(&scene);
        assert_eq!((m.lambert, m.glossy, m.ambient), (Vec3::splat(0.8), Vec3::ZERO, Vec3::splat(0.8)), "{kd}");
        warned(&scene, &["material `m`: without the map that cannot be used it is not glossy"]);
        assert!(!scene.warnings.iter().any(|w| w.contains("exponent")), "{:?}", scene.warnings);
    }
}

/// Exporters write 0 beside a map and mean 1, of every word that has both.
#[test]
fn zeros_beside_maps_of_mtl_are_ones() {
    let all = "Pr 0\nPm 0\nPc 0\nPcr 0\nPs 0\nmap_Pr grey.png\nmap_Pm grey.png\nmap_Pc grey.png\nmap_Pcr grey.png\nmap_Ps grey.png\n";
    for head in ["newmtl m\n", "# Blender 5.0.1 MTL File: 'None'\nnewmtl m\n"] {
        let scene = loaded("", &format!("{head}{all}"));
        let p = physical(&scene);
        let numbers = [p.roughness, p.metallic, p.clearcoat, p.clearcoat_roughness, p.sheen_color.x];
        assert_eq!(numbers, [1.0; 5], "{head}");
        let maps = [p.maps.roughness, p.maps.metallic, p.maps.clearcoat, p.maps.clearcoat_roughness];
        assert!(maps.iter().all(Option::is_some) && p.maps.sheen_color.is_some());
        for word in ["Pr", "Pm", "Pc", "Pcr", "Ps"] {
            warned(&scene, &["mesh.mtl: material `m`", &format!("{word} is 0 beside a map_{word}; 1 is used")]);
        }
        assert!(!scene.warnings.iter().any(|w| w.contains("sheen_roughness")), "{:?}", scene.warnings);
    }
    let level = BLENDER.replace("Ks .5 .5 .5", "Ks 0 0 0\nmap_Ks grey.png");
    let scene = loaded("", &level);
    let p = physical(&scene);
    assert!(p.specular == 1.0 && p.specular_color == Vec3::ONE && p.maps.specular_color.is_some());
    warned(&scene, &["Ks is black beside a map_Ks; 1 is used"]);
}

/// A grain needs texture coordinates, whoever asks for it.
#[test]
fn anisotropy_without_texture_coordinates_is_said() {
    let words = ["mesh.obj:", "without texture coordinates", "material `m`", "its grain"];
    warned(&with_mtl("newmtl m\naniso .5\n").load("mesh.obj"), &words);
    let table = "[[material]]\nname = \"m\"\nanisotropy = 0.5\n";
    let folder = with_mtl("newmtl m\nPr .5\n");
    let text = format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n{table}");
    warned(&folder.with("scene.toml", text).load("scene.toml"), &words);
    assert!(loaded("anisotropy = 0.5\n", "newmtl m\n").warnings.is_empty(), "with coordinates there is nothing to say");
    assert!(with_mtl("newmtl m\nPr .5\n").load("mesh.obj").warnings.is_empty());
}

/// The word that says outright what a surface is, is not told off for what it says.
#[test]
fn a_stated_model_is_enough() {
    for lines in
        ["model = \"blinn-phong\"\ndiffuse = [0.5, 0, 0]\n", "diffuse = [0.5, 0, 0]\nmodel = \"blinn-phong\"\n"]
    {
        let scene = loaded(lines, BLENDER);
        assert!(first_material(&scene).physical.is_none());
        assert!(!scene.warnings.iter().any(|w| w.contains("word of Blinn-Phong")), "{:?}", scene.warnings);
    }
    warned(&loaded("diffuse = [0.5, 0, 0]\n", BLENDER), &["`diffuse` is a word of Blinn-Phong"]);
}
