//! The scene file that is written of a bare model is the same scene.

use super::*;
use glam::Vec3;
use luminaire::part::Provenance;
use luminaire::scene::{Choices, Side, Sky, Up, load_with, scene_file};

/// Models of many kinds: name of the OBJ, files.
fn models() -> Vec<(&'static str, Vec<(&'static str, String)>)> {
    let faces = "v 0 0 0\nv 1 0 0.3\nv 0 1 0.2\nv 1 1 0.7\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n";
    let image = "P3\n2 2\n255\n255 0 0 0 255 0 0 0 255 90 90 90\n".to_owned();
    vec![
        ("plain.obj", vec![("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.2\nf 1 2 3\nf 2 4 3\n".into())]),
        (
            "with mtl.obj",
            vec![
                (
                    "with mtl.obj",
                    format!(
                        "mtllib with mtl.mtl\n{faces}o part \"one\"\nusemtl a \"b\" \\c #d\nf 1/1 2/2 3/3\ng \u{20ac}\u{1b}\nusemtl glass\nf 2/2 4/4 3/3\n\
                         usemtl missing\nf 1/1 2/2 4/4\nusemtl varnish\nf 1 3 4\n"
                    ),
                ),
                (
                    "with mtl.mtl",
                    "newmtl a \"b\" \\c #d\nKd .9 .1 .3333333\nKs .4 .4 .4\nNs 12.345\nmap_Kd -s 2 3 -o .5 0 tex/wood pile.ppm\nmap_Ks -clamp on tex/wood pile.ppm\n\
                     newmtl glass\nKd 0 0 0\nillum 4\nNi 1.45\nTf .7 .8 .9\nnewmtl varnish\nKd .1 .2 .3\nKs .5 .5 .5\nNs 2000\nNi 1.5\nillum 5\nd 0.25\nKa 0 0 1\n\
                     newmtl unused\nKd 1 0 0\nmap_Kd gone.png\n"
                        .into(),
                ),
                ("tex/wood pile.ppm", image),
            ],
        ),
        (
            "lamps.obj",
            vec![
                (
                    "lamps.obj",
                    format!("mtllib lamps.mtl\n{faces}usemtl l\nf 1 2 3\nf 3 2 1\nf 2 3 4\nusemtl w\nf 1 2 4\n"),
                ),
                ("lamps.mtl", "newmtl l\nKe 3 2 1\nnewmtl w\nKd 1.5 .5 .5\n".into()),
            ],
        ),
        (
            "room.obj",
            vec![(
                "room.obj",
                "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 0 3 0\nv 4 3 0\nf 1 4 3 2\nf 1 2 6 5\n".into(),
            )],
        ),
        (
            "far.obj",
            vec![(
                "far.obj",
                "v 5654321.25 4321000.5 123.125\nv 5654331.75 4321000.25 123.5\nv 5654321.125 4321009.123456 130\nv 5654325.1 4321005.3 140.77\nf 1 2 3\nf 2 4 3\n"
                    .into(),
            )],
        ),
        (
            "colours.obj",
            vec![("colours.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0.1 0 0 1\nv 1 1 0 1 1 1\nusemtl x\nf 1 2 3\nf 2 4 3\n".into())],
        ),
        ("smooth.obj", vec![("smooth.obj", format!("s 1\n{faces}f 1 2 3\nf 2 4 3\n"))]),
        ("tiny.obj", vec![("tiny.obj", "v 1e-7 1e-7 0\nv 3e-7 1e-7 1e-8\nv 1e-7 2.5e-7 0\nf 1 2 3\n".into())]),
        ("gr\u{fc}n 'x'.obj", vec![("gr\u{fc}n 'x'.obj", "v 0 0 0\nv 1e6 0 0\nv 0 1e6 1\nf 1 2 3\n".into())]),
    ]
}

fn choices() -> Vec<Choices> {
    let none = Choices::default();
    vec![
        none.clone(),
        Choices { up: Some(Up::Z), smooth: Some(180.0), fill: Some(true), view: Some(Side::Left), ..none.clone() },
        Choices { sky: Some(Sky::Even(Vec3::new(0.1, 0.2, 1.0 / 3.0))), ground: Some(false), ..none.clone() },
        Choices { sky: Some(Sky::None), ground: Some(true), smooth: Some(0.0), ..none },
    ]
}

/// What a scene is, to the last bit.
#[track_caller]
fn assert_same(bare: &Scene, written: &Scene, what: &str) {
    let differences = Provenance::of(bare).differences(&Provenance::of(written));
    assert_eq!(differences, Vec::<String>::new(), "{what}");
    assert_eq!((bare.settings, bare.film, bare.origin), (written.settings, written.film, written.origin), "{what}");
    assert_eq!((bare.ground, &bare.environment), (written.ground, &written.environment), "{what}");
    let names = |scene: &Scene| scene.objects.iter().map(|object| object.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(bare), names(written), "{what}");
}

/// The same scene, the same warnings, whatever the model and wherever the file lies.
#[test]
fn a_written_scene_file_is_the_same_scene() {
    for (name, files) in models() {
        let mut folder = Folder::new().with("elsewhere/deeper/note.txt", "");
        for (file, text) in files {
            folder = folder.with(file, text);
        }
        for (number, choices) in choices().iter().enumerate() {
            let model = folder.path(name);
            let bare = load_with(&model, choices).unwrap();
            for place in ["", "elsewhere/deeper"] {
                let what = format!("{name}, choices {number}, in `{place}`");
                let at = folder.path(place);
                let written = scene_file(&model, choices, &at).unwrap();
                assert_eq!(written.scene.warnings, bare.warnings);
                std::fs::write(at.join("scene.toml"), &written.text).unwrap();
                let loaded =
                    load(&at.join("scene.toml")).unwrap_or_else(|error| panic!("{what}: {error}\n{}", written.text));
                assert_same(&bare, &loaded, &what);
                // They begin with the names of the files, which are those of the model.
                let paths = [&bare, &loaded].map(|scene| scene.path.display().to_string());
                let own = |scene: &Scene| {
                    let warnings = scene.warnings.iter();
                    warnings.map(|w| w.replace(&paths[0], "SCENE").replace(&paths[1], "SCENE")).collect::<Vec<_>>()
                };
                assert_eq!(own(&bare), own(&loaded), "{what}");
            }
        }
    }
}

/// The tables of materials are comments; without their `#` they change nothing.
#[test]
fn the_tables_of_materials_say_what_the_materials_are() {
    for (name, files) in models() {
        let mut folder = Folder::new();
        for (file, text) in files {
            folder = folder.with(file, text);
        }
        let model = folder.path(name);
        let bare = load_with(&model, &Choices::default()).unwrap();
        let text = scene_file(&model, &Choices::default(), &folder.path("")).unwrap().text;
        let (before, tables) = text.split_once("\n# [[material]]").expect("a table of materials");
        let (tables, after) = tables.split_once("\n# Luminaires").expect("an end of the tables");
        let tables = format!("# [[material]]{tables}");
        // What is no key is indented.
        let key = |line: &&str| !line.starts_with("#  ");
        let tables: String =
            tables.lines().filter(key).map(|line| line.trim_start_matches("# ").to_owned() + "\n").collect();
        let whole = format!("{before}{tables}\n# Luminaires{after}");
        let loaded = folder.with("scene.toml", &whole).load("scene.toml");
        assert_eq!(bare.materials.len(), loaded.materials.len());
        for (index, (a, b)) in (0..).zip(bare.materials.iter().zip(&loaded.materials)) {
            if !bare.meshes.iter().flat_map(|mesh| &mesh.triangles).any(|triangle| triangle.material == index) {
                continue;
            }
            let close = |a: Vec3, b: Vec3| (a - b).abs().max_element() <= 1e-6;
            assert!(close(a.lambert, b.lambert) && close(a.glossy, b.glossy), "{name}: {a:?} {b:?}\n{whole}");
            assert!(close(a.reflection, b.reflection) && close(a.transmission, b.transmission), "{name}: {a:?} {b:?}");
            assert_eq!((a.emission, a.eta, a.opacity, a.ambient), (b.emission, b.eta, b.opacity, b.ambient), "{name}");
            assert_eq!((&a.name, a.thin, a.one_sided, a.maps), (&b.name, b.thin, b.one_sided, b.maps), "{name}");
        }
    }
}

#[test]
fn only_a_bare_model_is_written_down() {
    let folder = scene("");
    let error = scene_file(&folder.path("scene.toml"), &Choices::default(), &folder.path("")).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("a scene file already"), "{error}");
    let folder = folder.with("x.ply", "ply\n").with("x.off", "OFF\n");
    for name in ["x.ply", "x.off"] {
        let error = scene_file(&folder.path(name), &Choices::default(), &folder.path("")).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(".obj"), "{error}");
    }
    let error = scene_file(&folder.path("mash.obj"), &Choices::default(), &folder.path("")).unwrap_err();
    assert!(error.exit_code() == 1 && error.to_string().contains("there is mesh.obj"), "{error}");
}

/// Every key that a scene file may have is in it, with what it means: whoever has only the program has nothing else to read.
#[test]
fn every_key_is_written_down() {
    let folder = obj(TRIANGLE);
    let text = scene_file(&folder.path("mesh.obj"), &Choices::default(), &folder.path("")).expect("a scene file").text;
    let words: std::collections::HashSet<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    for table in [
        "[film]",
        "[sensor]",
        "[environment]",
        "[ground]",
        "[integrator]",
        "[render]",
        "[[object]]",
        "[[material]]",
        "[[luminaire]]",
    ] {
        let wrong = folder.0.path().join("wrong.toml");
        std::fs::write(&wrong, format!("{table}\nno_such_key = 1\n")).expect("a file");
        let message = folder.error("wrong.toml").to_string();
        let (_, list) = message.split_once("there are `").expect("a list of the keys");
        let keys: Vec<&str> = list.trim_end_matches('`').split("`, `").collect();
        assert!(keys.len() >= 3, "{message}");
        for key in keys {
            assert!(words.contains(key), "`{key}` of {table} is not written down");
        }
    }
}
