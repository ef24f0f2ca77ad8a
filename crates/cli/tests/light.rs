//! What `luminaire` says of a picture that lacks its light, and of an error that it cannot know.

mod common;

use common::{Folder, stderr};
use serde_json::Value;
use std::process::Output;

/// Of a folder with a floor, an octahedron of glass around the origin, and a lamp.
fn folder() -> Folder {
    let folder = Folder::new();
    let materials = "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\nTf 1 1 1\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
    folder.write("s.mtl", materials);
    folder.write("floor.obj", "mtllib s.mtl\nusemtl floor\nv -8 -1 -8\nv -8 -1 8\nv 8 -1 8\nv 8 -1 -8\nf 1 2 3 4\n");
    let corners = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
    let faces = "f 3 5 1\nf 3 1 6\nf 3 6 2\nf 3 2 5\nf 4 1 5\nf 4 6 1\nf 4 2 6\nf 4 5 2\n";
    folder.write("ball.obj", &format!("mtllib s.mtl\nusemtl glass\n{corners}{faces}"));
    folder.write("wall.obj", "mtllib s.mtl\nusemtl lamp\nv -99 -99 0\nv 99 -99 0\nv 99 99 0\nv -99 99 0\nf 1 2 3 4\n");
    let sensor = "[sensor]\nposition = [0, 1, 8]\ntarget = [0, -1, 0]\nfov = 40\n[film]\nwidth = 16\nheight = 12\n";
    let lamp = "[[luminaire]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = [10, 10, 10]\n";
    let object = |mesh: &str| format!("[[object]]\nmesh = \"{mesh}.obj\"\n");
    folder.write("bulb.toml", &format!("{sensor}{lamp}{}{}scale = 0.5\n", object("floor"), object("ball")));
    folder.write("open.toml", &format!("{sensor}{lamp}{}", object("floor")));
    folder.write("flat.toml", &format!("{sensor}{}", object("wall")));
    let up = sensor.replace("target = [0, -1, 0]", "target = [0, 9, 0]");
    folder.write("away.toml", &format!("{up}{lamp}{}", object("floor")));
    folder
}

/// What a run says, and its figures.
struct Said {
    out: String,
    err: String,
    stats: Value,
}

fn render(folder: &Folder, words: &[&str]) -> Said {
    let rest = ["--backend", "cpu", "-o", "a.png", "--stats", "s.json"];
    let output: Output = folder.luminaire(&[&["render"][..], words, &rest].concat()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{words:?}: {}", stderr(&output));
    let text = std::fs::read_to_string(folder.path().join("s.json")).unwrap();
    let out = String::from_utf8_lossy(&output.stdout).into_owned();
    Said { out, err: stderr(&output), stats: serde_json::from_str(&text).unwrap() }
}

#[test]
fn a_lost_luminaire_is_said_before_and_after() {
    let folder = folder();
    let Said { out, err, stats } = render(&folder, &["bulb.toml", "--spp", "16"]);
    let sentence = "about 100 % of the light of [[luminaire]] 1 falls on glass or mirrors first";
    assert!(err.contains(&format!("warning: bulb.toml: {sentence}")), "{err}");
    assert!(
        err.contains("the picture is black: none of 16 samples a pixel found any light; an earlier warning"),
        "{err}"
    );
    assert!(out.contains("the error cannot be estimated: the picture is black") && !out.contains("0 %"), "{out}");
    assert_eq!((&stats["error"], &stats["black_share"]), (&Value::Null, &1.0.into()));
    assert_eq!(stats["lacks_light"], true);
    let warnings = stats["warnings"].to_string();
    assert!(warnings.contains(sentence) && warnings.contains("the picture is black"), "{warnings}");
    let inspected = folder.luminaire(&["inspect", "bulb.toml"]).output().unwrap();
    assert!(String::from_utf8_lossy(&inspected.stdout).contains(sentence));

    // Beside another luminaire the picture is not black, and its error is not the whole of it.
    let text = std::fs::read_to_string(folder.path().join("bulb.toml")).unwrap();
    let second = "[[luminaire]]\nkind = \"infinite\"\ndirection = [0, -1, 0]\nirradiance = [1, 1, 1]\n";
    folder.write("two.toml", &(second.to_owned() + &text));
    let Said { out, err, stats } = render(&folder, &["two.toml", "--spp", "16"]);
    assert!(err.contains("[[luminaire]] 2 falls on glass"), "{err}");
    assert!(out.contains("of the light that was found alone: the warnings say what the picture lacks"), "{out}");
    assert!(stats["error"]["relative"].as_f64().is_some() && stats["lacks_light"] == true, "{stats}");

    let Said { out, err, stats } = render(&folder, &["open.toml", "--spp", "16"]);
    assert!(out.contains("estimated error") && !out.contains("lacks") && !err.contains("warning"), "{out}{err}");
    assert_eq!((&stats["lacks_light"], &stats["warnings"]), (&false.into(), &serde_json::json!([])));
}

#[test]
fn a_camera_that_looks_away_sees_black() {
    let folder = folder();
    let Said { out, err, .. } = render(&folder, &["away.toml", "--spp", "4"]);
    assert!(err.contains("the picture is black: none of 4 samples") && err.contains("[sensor]"), "{err}");
    assert!(out.contains("cannot be estimated"), "{out}");
    // There is nothing that a limit of the noise could wait for.
    let Said { out, stats, .. } = render(&folder, &["away.toml", "--noise", "0.1", "--error-map", "e.png"]);
    assert!(
        out.contains("ended by --noise without an estimate") && out.contains("--noise 0.1 was not reached"),
        "{out}"
    );
    assert_eq!((&stats["end"], &stats["spp_most"]), (&"no-estimate".into(), &1024.into()));
}

/// A bright lamp in glass, which hardly a path finds, over a floor that another lamp lights evenly.
#[test]
fn a_limit_of_the_noise_that_fireflies_do_not_keep() {
    let folder = folder();
    let materials = std::fs::read_to_string(folder.path().join("s.mtl")).unwrap();
    folder.write("s.mtl", &(materials + "newmtl bright\nKd 0 0 0\nKe 1e4 1e4 1e4\n"));
    let ceiling = "mtllib s.mtl\nusemtl lamp\nv -8 7 -8\nv 8 7 -8\nv 8 7 8\nv -8 7 8\nf 1 2 3 4\n";
    folder.write("ceiling.obj", ceiling);
    folder.write("spark.obj", "mtllib s.mtl\nusemtl bright\nv 0.2 0 0\nv -0.2 0.2 0\nv 0 0 0.2\nf 1 2 3\n");
    let text = std::fs::read_to_string(folder.path().join("bulb.toml")).unwrap();
    let (before, rest) = text.split_once("[[luminaire]]").unwrap();
    let objects = rest.split_once("[[object]]").unwrap().1;
    let spark = "[[object]]\nmesh = \"spark.obj\"\nscale = 0.5\n[[object]]\nmesh = \"ceiling.obj\"\n";
    folder.write("spark.toml", &format!("{before}[[object]]{objects}{spark}"));
    let words = ["spark.toml", "--noise", "0.3", "--width", "24", "--height", "18"];
    let Said { out, err, stats } = render(&folder, &words);
    assert!(err.contains("warning: --noise 0.3 is reached without the fireflies ("), "{err}");
    assert!(out.contains("ended by --noise") && out.contains("fireflies or very small lamps (with them"), "{out}");
    assert!(stats["warnings"].to_string().contains("which hold most of the error: with them it is"), "{stats}");
    assert!(stats["error"]["relative_with_fireflies"].as_f64().unwrap() > 0.3, "{stats}");
}

#[test]
fn no_noise_and_too_few_samples_are_said_as_such() {
    let folder = folder();
    let flat = render(&folder, &["flat.toml", "--spp", "16"]);
    assert!(flat.out.contains("no noise was found in 16 samples a pixel: all blocks of them agree\n"), "{}", flat.out);
    assert!(!flat.err.contains("warning"), "{}", flat.err);
    let one = render(&folder, &["open.toml", "--spp", "1"]);
    assert!(one.out.contains("the error cannot be estimated: one sample a pixel tells nothing of it"), "{}", one.out);
    let three = render(&folder, &["open.toml", "--spp", "3"]);
    assert!(
        three.out.contains("estimated error") && three.out.contains("uncertain, from 3 samples a pixel"),
        "{}",
        three.out
    );
}

#[test]
fn a_png_that_shows_nothing_is_said() {
    let folder = folder();
    let dim = std::fs::read_to_string(folder.path().join("s.mtl")).unwrap().replace("Ke 1 1 1", "Ke 1e-6 1e-6 1e-6");
    folder.write("s.mtl", &dim);
    let said = render(&folder, &["flat.toml", "--spp", "4"]);
    assert!(
        said.err.contains("warning: a PNG shows nothing of this picture") && said.err.contains("--exposure 17"),
        "{}",
        said.err
    );
    assert!(!render(&folder, &["flat.toml", "--spp", "4", "--exposure", "17"]).err.contains("warning"));
}

#[test]
fn per_cent_is_no_share() {
    let folder = folder();
    let output = folder.luminaire(&["render", "open.toml", "--noise", "2"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("if 2 % is meant, that is 0.02"), "{}", stderr(&output));
}
