//! MTL files.

use super::*;
use glam::Vec3;

#[test]
fn every_modelled_statement_is_read() {
    let scene = with_mtl("newmtl m\nKa .1 .2 .3\nKd .4 .3 .2 # c\nKs 0.5\nNs 96\nKe 7 8 9\nillum 2\nNi 1.5\nd 1\n")
        .load("mesh.obj");
    let expected = Material {
        name: "m".into(),
        ambient: Vec3::new(0.1, 0.2, 0.3),
        lambert: Vec3::new(0.4, 0.3, 0.2),
        glossy: Vec3::splat(0.5),
        exponent: 96.0,
        emission: Vec3::new(7.0, 8.0, 9.0),
        ..Material::default()
    };
    assert_eq!(first_material(&scene), &expected);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn what_is_absent_has_a_default() {
    let grey = with_mtl("newmtl m\n").load("mesh.obj");
    assert_eq!(first_material(&grey).lambert, Vec3::splat(0.8));
    assert_eq!(first_material(&grey).ambient, Vec3::splat(0.8));
    let lamp = with_mtl("newmtl m\nKe 1 1 1\n").load("mesh.obj");
    assert_eq!(first_material(&lamp).lambert, Vec3::ZERO);
    let glossy = with_mtl("newmtl m\nKs 1 1 1\n").load("mesh.obj");
    assert_eq!((first_material(&glossy).lambert, first_material(&glossy).exponent), (Vec3::ZERO, 10.0));
    warned(&glossy, &["`m`", "no exponent"]);
}

#[test]
fn highlights_need_illum_2() {
    for (illum, glossy) in [("", 0.2), ("illum 0", 0.0), ("illum 1", 0.0), ("illum 2", 0.2)] {
        let scene = with_mtl(format!("newmtl m\nKd .5 .5 .5\nKs .2 .2 .2\nNs 5\n{illum}\n")).load("mesh.obj");
        assert_eq!(first_material(&scene).glossy, Vec3::splat(glossy), "{illum}");
    }
}

#[test]
fn albedos_above_one_are_scaled_down() {
    let scene = with_mtl("newmtl m\nKd 0.9 0.2 0.2\nKs 0.6 0.6 0.6\nNs 10\nillum 2\n").load("mesh.obj");
    let material = first_material(&scene);
    assert!((material.lambert + material.glossy).max_element() <= 1.0);
    assert!((material.lambert.x - 0.6).abs() < 1e-6 && (material.glossy.x - 0.4).abs() < 1e-6, "{material:?}");
    warned(&scene, &["`m`", "create energy", "0.6667"]);
}

#[test]
fn a_bad_mtl_is_a_warning_with_its_line() {
    let text = "Kd 1 1 1\nnewmtl m\nKd 0.1 x 0.3\nKs 0.1 0.2\nNs -3\nKa -1 0 0\nKe nan 0 0\nillum two\nfoo 1\nNs inf\n";
    let scene = with_mtl(text).load("mesh.obj");
    assert_eq!(first_material(&scene).lambert, Vec3::splat(0.8));
    assert_eq!(first_material(&scene).ambient, Vec3::ZERO);
    for (line, words) in [
        (1, "newmtl"),
        (3, "three finite numbers, found `0.1 x 0.3`"),
        (4, "`0.1 0.2`"),
        (5, "Ns"),
        (6, "negative"),
        (7, "Ke"),
        (8, "illum"),
        (9, "`foo`"),
        (10, "Ns"),
    ] {
        warned(&scene, &[&format!("mesh.mtl:{line}:"), words]);
    }
}

#[test]
fn materials_that_lack_the_same_share_a_warning() {
    let text: String = (0..10).map(|i| format!("newmtl m{i}\ndisp b.png\n")).collect();
    let faces: String = (0..10).map(|i| format!("usemtl m{i}\nf 1 2 3\n")).collect();
    let scene = obj(format!("mtllib mesh.mtl\n{TRIANGLE}{faces}")).with("mesh.mtl", text).load("mesh.obj");
    warned(&scene, &["mesh.mtl: materials `m0`, `m1`", "`m7` and 2 more: not modelled, ignored: disp"]);
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn what_is_not_modelled_is_a_warning_for_materials_in_use() {
    let feature = "disp b.png\nmap_Ns c.png\ndisp b.png\nd -halo 0.5\nmap_Kd -t 1 0 0 a.png\n";
    let scene = with_mtl(format!("newmtl m\n{feature}newmtl unused\n{feature}")).load("mesh.obj");
    let warnings: Vec<_> = scene.warnings.iter().filter(|warning| warning.contains("not modelled")).collect();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    warned(&scene, &["`m`", "disp, map_Ns, d -halo, map_Kd -t"]);
    assert_eq!(first_material(&scene).opacity, 0.5);
}

/// A mirror by Fresnel over a base is plastic: the mirror takes from the base only what it reflects, so that nothing has to be scaled. A
/// mirror without an index of refraction takes all that it has.
#[test]
fn plastic_is_not_scaled() {
    let (plastic, warnings) = read("Kd .8 .8 .8\nKs 1 1 1\nNs 1000\nNi 1.5\nd 1\nillum 5");
    assert_eq!((plastic.lambert, plastic.reflection, plastic.eta), (Vec3::splat(0.8), Vec3::ONE, Some(1.5)));
    assert!(warnings.is_empty(), "{warnings:?}");
    let (mirror, warnings) = read("Kd .8 .8 .8\nKs 1 1 1\nNs 1000\nNi 1.5\nd 1\nillum 3");
    assert!((mirror.lambert.x - 0.8 / 1.8).abs() < 1e-6 && warnings.len() == 1, "{mirror:?} {warnings:?}");
}

/// The first material after these statements.
fn read(statements: &str) -> (Material, Vec<String>) {
    let scene = with_mtl(format!("newmtl m\n{statements}\n")).load("mesh.obj");
    (first_material(&scene).clone(), scene.warnings)
}

#[test]
fn illum_3_5_and_8_are_mirrors_where_they_are_sharp() {
    let ks = Vec3::new(0.25, 0.5, 0.75);
    for (illum, eta) in [("illum 3", None), ("illum 8", None), ("illum 5", Some(1.75))] {
        for sharp in ["", "Ns 1000\n"] {
            let (m, warnings) = read(&format!("Kd .1 .1 .1\nKs .25 .5 .75\nNi 1.75\n{sharp}{illum}"));
            assert_eq!((m.reflection, m.glossy, m.eta), (ks, Vec3::ZERO, eta), "{illum} {sharp}");
            assert_eq!((m.lambert, m.transmission), (Vec3::splat(0.1), Vec3::ZERO));
            assert!(warnings.is_empty(), "{warnings:?}");
        }
        let (m, _) = read(&format!("Kd .1 .1 .1\nKs .25 .5 .75\nNs 999\n{illum}"));
        assert_eq!((m.reflection, m.glossy, m.exponent), (Vec3::ZERO, ks, 999.0), "{illum}");
    }
    for ni in ["", "Ni 1\n", "Ni 0\n"] {
        assert_eq!(read(&format!("Ks 1 1 1\n{ni}illum 5")).0.eta, None, "{ni}");
    }
    assert_eq!(read("Ks 1 1 1\nillum 3").0.lambert, Vec3::ZERO, "a mirror alone is not grey");
}

/// The same without the warning that a single triangle is no body of glass.
fn read_glass(mtl: &str) -> (Material, Vec<String>) {
    let (material, mut warnings) = read(mtl);
    warnings.retain(|warning| !warning.contains("not a closed body"));
    (material, warnings)
}

#[test]
fn extreme_numbers_are_clamped_or_ignored() {
    let (m, warnings) = read("Ks .5 .5 .5\nNs 2e8\nillum 2");
    assert_eq!(m.exponent, 1e8);
    assert!(warnings.len() == 1 && warnings[0].contains("mesh.mtl:3: Ns 200000000 is above 1e8"), "{warnings:?}");
    for ni in ["1e-3", "101", "1e30"] {
        let (m, warnings) = read(&format!("Ni {ni}\nillum 7"));
        assert_eq!(m.eta, Some(1.5), "{ni}");
        assert!(warnings.iter().any(|w| w.contains("mesh.mtl:2: Ni") && w.contains("0.01 to 100")), "{warnings:?}");
    }
    for (ni, ns) in [(0.01, 0.0), (100.0, 1e8)] {
        let (m, warnings) = read_glass(&format!("Ni {ni:?}\nNs {ns:?}\nillum 7"));
        assert_eq!((m.eta, m.exponent, warnings.as_slice()), (Some(ni), ns, &[][..]));
    }
}

#[test]
fn illum_4_6_7_and_9_are_glass() {
    for illum in [4, 6, 7, 9] {
        let (m, warnings) = read(&format!("Ks .5 .5 .5\nTf .1 .2 .3\nNi 1\nNs 3\nd 0.25\nTr 0.5\nillum {illum}"));
        assert_eq!((m.reflection, m.transmission), (Vec3::splat(0.5), Vec3::new(0.1, 0.2, 0.3)));
        assert_eq!((m.eta, m.opacity, m.glossy, m.lambert), (Some(1.0), 1.0, Vec3::ZERO, Vec3::ZERO));
        assert!(warnings.is_empty(), "{warnings:?}");
    }
    for black in ["", "Ks 0 0 0\nTf 0 0 0\n"] {
        let (m, warnings) = read_glass(&format!("{black}illum 7"));
        assert_eq!((m.reflection, m.transmission, m.eta), (Vec3::ONE, Vec3::ONE, Some(1.5)));
        assert!(warnings.len() == 1 && warnings[0].contains("Ni"), "{warnings:?}");
    }
    let (m, warnings) = read_glass("Kd .5 .5 .5\nNi 1.5\nillum 7");
    assert!((m.lambert.x - 1.0 / 3.0).abs() < 1e-6 && (m.transmission.x - 2.0 / 3.0).abs() < 1e-6, "{m:?}");
    assert!(warnings.len() == 2 && warnings[1].contains("create energy"), "{warnings:?}");
    assert!(
        ["mesh.mtl", "`m`", "illum 7", "Ni 1.5", "Kd"].iter().all(|word| warnings[0].contains(word)),
        "{warnings:?}"
    );
}

/// Exporters write one of glass's models for everything; a material with a colour is glass only by its index of refraction.
#[test]
fn a_colour_without_refraction_is_opaque_whatever_illum_says() {
    for illum in [4, 6, 7, 9] {
        for more in
            ["", "Ni 1\n", "Ni 1.00\nd 1\n", "Ni 0\nTr 0\n", "Tf 1 1 1\nNi 1\n", "Tf 0 0 0\nNi 1.45\nd 1\n", "Tr 1\n"]
        {
            let (m, warnings) = read(&format!("illum {illum}\nKd .5 .4 .3\nKs .1 .1 .1\nNs 20\n{more}"));
            assert_eq!((m.lambert, m.glossy, m.opacity), (Vec3::new(0.5, 0.4, 0.3), Vec3::splat(0.1), 1.0), "{more}");
            assert_eq!((m.transmission, m.reflection, m.eta), (Vec3::ZERO, Vec3::ZERO, None), "{more}");
            let said = |word: &str| warnings.iter().any(|warning| warning.contains(word));
            assert!(said(&format!("illum {illum} asks for glass")) && said("taken as opaque"), "{more}: {warnings:?}");
            assert_eq!(warnings.len(), 1 + usize::from(more.starts_with("Tr 1")), "{more}: {warnings:?}");
        }
        // As of Blender where alpha is below 1.
        for more in ["d 0.25\nNi 1.45\n", "Tr 0.75\n", "d 0.25\nNi 1\n"] {
            let (m, warnings) = read(&format!("illum {illum}\nKd .5 .4 .3\n{more}"));
            assert_eq!((m.opacity, m.transmission, m.eta, m.lambert.x), (0.25, Vec3::ZERO, None, 0.5), "{more}");
            assert!(
                warnings.len() == 1 && warnings[0].contains("opacity") && warnings[0].contains("illum"),
                "{warnings:?}"
            );
        }
    }
    let text: String = (0..3).map(|i| format!("newmtl m{i}\nillum 4\nKd .5 .5 .5\n")).collect();
    let faces: String = (0..3).map(|i| format!("usemtl m{i}\nf 1 2 3\n")).collect();
    let scene = obj(format!("mtllib mesh.mtl\n{TRIANGLE}{faces}")).with("mesh.mtl", text).load("mesh.obj");
    warned(&scene, &["mesh.mtl: materials `m0`, `m1`, `m2`: illum 4"]);
    assert_eq!(scene.warnings.iter().filter(|warning| warning.contains("illum")).count(), 1, "one for all of them");
}

#[test]
fn tr_of_1_alone_is_opaque() {
    for tr in ["Tr 1", "Tr 1.000000", "Tr 100", "illum 2\nTr 1"] {
        let (m, warnings) = read(&format!("Kd .5 .5 .5\n{tr}"));
        assert_eq!(m.opacity, 1.0, "{tr}");
        assert!(warnings.len() == 1, "{warnings:?}");
        assert!(["`m`: Tr 1", "`d 1`", "`d 0`"].iter().all(|word| warnings[0].contains(word)), "{warnings:?}");
    }
    for (statements, opacity, count) in
        [("Tr 0", 1.0, 0), ("d 1\nTr 0", 1.0, 0), ("Tr 0.25", 0.75, 0), ("d 0\nTr 1", 0.0, 1), ("d 1\nTr 1", 1.0, 1)]
    {
        let (m, warnings) = read(&format!("Kd .5 .5 .5\n{statements}"));
        assert_eq!((m.opacity, warnings.len()), (opacity, count), "{statements}: {warnings:?}");
    }
}

#[test]
fn colours_of_other_shapes() {
    for (statement, lambert, word) in [
        ("Kd .5 .4 .3 1.0", Some([0.5, 0.4, 0.3]), "`1.0` is ignored"),
        ("Kd .5 .4 .3 a b", Some([0.5, 0.4, 0.3]), "`a b` is ignored"),
        ("Kd 0,5 0,4 0,3", None, "decimal point"),
        ("Kd 0.5,0.4,0.3", None, "decimal point"),
        ("Kd xyz .1 .2 .3", None, "Kd xyz is not modelled"),
        ("Kd spectral a.rfl 1", None, "Kd spectral is not modelled"),
    ] {
        let (m, warnings) = read(statement);
        assert_eq!(m.lambert.to_array(), lambert.unwrap_or([0.8; 3]), "{statement}");
        assert!(
            warnings.len() == 1 && warnings[0].contains("mesh.mtl:2: Kd") && warnings[0].contains(word),
            "{warnings:?}"
        );
    }
    assert_eq!((read("Kd 0.5").0.lambert, read("Kd 0.5").1.len()), (Vec3::splat(0.5), 0), "one number is grey");
    for keyword in ["Ka", "Ks", "Ke", "Tf"] {
        let (_, warnings) = read(&format!("Ns 1\n{keyword} .1 .1 .1 1"));
        assert!(warnings.len() == 1 && warnings[0].contains(&format!("{keyword} has more")), "{warnings:?}");
    }
    let (m, warnings) = read("Kd 255 128 0");
    assert!(m.lambert.abs_diff_eq(Vec3::new(1.0, 128.0 / 255.0, 0.0), 1e-5), "{m:?}");
    assert!(warnings[0].contains("mesh.mtl:2: Kd 255") && warnings[0].contains("divided by 255"), "{warnings:?}");
    assert!(read("Ke 255 128 0").1.is_empty(), "what emits may have any number");
    assert!(read("d 7").1[0].contains("d 7 is outside") && read("Tr -1").1[0].contains("Tr -1 is outside"));
    assert!(read("Ns 5 6").1[0].contains("`6` is ignored"));
}

#[test]
fn transparency_is_opacity() {
    for (statements, opacity) in [
        ("d 0.25", 0.25),
        ("d 7", 1.0),
        ("d -1", 0.0),
        ("Tr 0.25", 0.75),
        ("d 0.5\nTr 0.5", 0.5),
        ("Tr 0\nd 0.5", 0.5),
        ("d 0.5\nillum 10", 0.5),
        ("d 0.5\nTf 1 0 0\nillum 2", 0.5),
        ("", 1.0),
    ] {
        let (m, _) = read(statements);
        assert_eq!((m.opacity, m.transmission, m.eta), (opacity, Vec3::ZERO, None), "{statements}");
    }
    assert!(read("d 0").1.iter().any(|warning| warning.contains("cannot be seen")));
    assert!(read("Tr 0\nd 0.5").1.iter().any(|warning| warning.contains("contradict")));
    assert!(read("Tf 1 1 1\nillum 2\nd 0.5\nTr 0.5").1.is_empty());
    assert!(read("Tf xyz 1 1 1").1[0].contains("Tf xyz"));
    assert!(read("Tf spectral a.rfl 1").1[0].contains("Tf spectral"));
    assert!(read("illum 11").1[0].contains("0 to 10"));
}

#[test]
fn a_missing_mtl_and_unknown_materials_fall_back() {
    let scene = obj(format!("mtllib no.mtl\nusemtl a\n{TRIANGLE}usemtl b\nf 1 2 3\nf 3 2 1\n")).load("mesh.obj");
    assert_eq!(first_material(&scene).name, "default");
    assert_eq!(first_material(&scene).lambert, Vec3::splat(0.8));
    warned(&scene, &["mesh.obj:1", "no.mtl", "No such file"]);
    warned(&scene, &["mesh.obj:2", "`a`, `b`", "`default`"]);
    assert_eq!(scene.warnings.iter().filter(|warning| warning.contains("no MTL file")).count(), 1);
}

#[test]
fn names_of_mtl_files_and_materials_may_hold_blanks() {
    let text = format!("mtllib one file.mtl sub\\two.mtl\nusemtl  a  b \n{TRIANGLE}usemtl c\nf 1 2 3\n");
    let scene = obj(text)
        .with("one file.mtl", "newmtl a  b\nKd .1 .1 .1\n")
        .with("sub/two.mtl", "newmtl c\nKd .2 .2 .2\n")
        .load("mesh.obj");
    let albedos: Vec<f32> = scene.meshes[0]
        .triangles
        .iter()
        .map(|triangle| scene.material_of(&scene.objects[0], triangle).lambert.x)
        .collect();
    assert_eq!(albedos, [0.1, 0.2]);
}

/// Maya writes `illum 4` and `Ni 1.00` for everything: black rubber and lamps do not become invisible.
#[test]
fn glass_that_nobody_could_see_is_opaque() {
    for (mtl, lambert, emission) in [
        ("Kd 0 0 0\nTf 1 1 1\nNi 1.00\nillum 4", 0.0, 0.0),
        ("Kd 0 0 0\nTf 0 0 0\nNi 1\nillum 7\nd 1", 0.0, 0.0),
        ("Ks 0 0 0\nNi 1\nillum 9", 0.8, 0.0),
        ("Kd 0 0 0\nKe 1 1 1\nNi 1\nillum 4", 0.0, 1.0),
    ] {
        let (m, warnings) = read(mtl);
        assert_eq!((m.lambert.x, m.emission.x, m.opacity), (lambert, emission, 1.0), "{mtl}");
        assert_eq!((m.transmission, m.reflection), (Vec3::ZERO, Vec3::ZERO), "{mtl}");
        assert!(warnings.len() == 1 && warnings[0].contains("illum"), "{warnings:?}");
    }
    assert_eq!(read("Kd 0 0 0\nTf .5 1 1\nNi 1\nillum 4").0.transmission, Vec3::new(0.5, 1.0, 1.0), "a filter");
}

/// Exporters write `Ks 0 0 0` and `Ke 0 0 0` for everything: they say nothing of the diffuse albedo.
#[test]
fn zeros_describe_nothing() {
    for mtl in ["Ks 0 0 0\nNs 10\nillum 2", "Ke 0 0 0", "Ks 0 0 0\nKe 0 0 0"] {
        assert_eq!(read(mtl).0.lambert, Vec3::splat(0.8), "{mtl}");
    }
    assert_eq!(read("Ks .5 .5 .5\nNs 10").0.lambert, Vec3::ZERO);
}

#[test]
fn lines_may_be_joined() {
    let scene = with_mtl("newmtl m\nKd 0.1 \\\n 0.2 0.3\nNi x\n").load("mesh.obj");
    assert_eq!(first_material(&scene).lambert, Vec3::new(0.1, 0.2, 0.3));
    warned(&scene, &["mesh.mtl:4:", "Ni"]);
}

/// As with textures: other letters, and paths of other machines. It is a guess, and said.
#[test]
fn a_library_of_nearly_this_name_is_found() {
    for (line, used) in [
        ("mtllib dup2.mtl", "DUP2.MTL"),
        ("mtllib C:\\models\\my lib.mtl", "my lib.mtl"),
        ("mtllib /home/somebody/My\\ Lib.mtl", "my lib.mtl"),
    ] {
        let scene =
            obj(format!("{line}\nusemtl m\n{TRIANGLE}")).with(used, "newmtl m\nKd 0.5 0.25 0.125\n").load("mesh.obj");
        assert_eq!(first_material(&scene).lambert, Vec3::new(0.5, 0.25, 0.125), "{line}");
        warned(&scene, &["mesh.obj:1: `", &format!("is not there; `{used}` is used")]);
    }
    let blank = obj(format!("mtllib my\\ lib.mtl\nusemtl m\n{TRIANGLE}")).with("my lib.mtl", "newmtl m\nKd 1 0 0\n");
    assert!(!blank.load("mesh.obj").warnings.iter().any(|warning| warning.contains("is used")));
}

#[test]
fn a_library_without_a_name() {
    warned(&obj(format!("mtllib\n{TRIANGLE}")).load("mesh.obj"), &["mesh.obj:1: mtllib names no file"]);
}

#[test]
fn a_library_that_is_missing_is_said_once_for_a_mesh() {
    let objects = "[[object]]\nmesh = \"mesh.obj\"\n[[object]]\nmesh = \"./mesh.obj\"\nsmooth = 30\n";
    let text = format!("{SENSOR}{LIGHT}{objects}");
    let scene = obj(format!("mtllib none.mtl\n{TRIANGLE}")).with("scene.toml", text).load("scene.toml");
    let said = scene.warnings.iter().filter(|warning| warning.contains("none.mtl")).count();
    assert_eq!(said, 1, "{:?}", scene.warnings);
}
