//! `--exposure auto` and `--tone`: one number for every backend, size, seed and part, and the pictures that follow from it.

mod common;

use common::{Folder, stderr};
use luminaire::picture::{self, Development, Tone, to_srgb8};

/// A room that the camera looks into: a lit floor, and a lamp beside the camera.
const ROOM: &str = "[film]\nwidth = 24\nheight = 18\n[sensor]\nposition = [0.3, 0.4, 2]\ntarget = [0.3, 0.2, 0]\nfov = 50\n\
                    [[luminaire]]\nkind = \"point\"\nposition = [0.2, 0.3, 1.5]\nintensity = [40, 30, 20]\n\
                    [[object]]\nmesh = \"plain.obj\"\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("plain.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
    folder.write("room.toml", ROOM);
    folder.write("auto.toml", &format!("[render]\nexposure = \"auto\"\ntone = \"agx\"\n{ROOM}"));
    folder
}

/// Runs the program, which has to succeed; what it said on stderr.
fn run(folder: &Folder, line: &str) -> String {
    let output = folder.luminaire(&line.split(' ').collect::<Vec<_>>()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "luminaire {line}: {}", stderr(&output));
    stderr(&output)
}

fn stats(folder: &Folder) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.path().join("s.json")).unwrap()).unwrap()
}

fn png(folder: &Folder, name: &str) -> Vec<u8> {
    image::open(folder.path().join(name)).unwrap().into_rgb8().into_raw()
}

fn linear(folder: &Folder, name: &str) -> Vec<f32> {
    picture::read(&folder.path().join(name)).unwrap().rgb.into_flattened()
}

#[test]
fn one_number_for_every_backend_size_seed_and_part() {
    let folder = folder();
    let mut found = vec![];
    let rest = "--exposure auto --stats s.json";
    for words in [
        "--backend cpu --spp 1",
        "--backend auto --spp 2 --seed 9 --sampler independent",
        "--backend cpu --spp 1 --width 96",
        "--backend cpu --spp 1 --width 7 --height 31",
        "--backend cpu --samples 3..5",
    ] {
        let said = run(&folder, &format!("render room.toml {words} {rest} -o a.png -o a.exr"));
        let stats = stats(&folder);
        let exposure = stats["exposure"].as_f64().unwrap();
        assert!(said.contains(&format!("exposure auto: {exposure:+} stops")), "{said}");
        assert_eq!((&stats["exposure_found"], &stats["tone"]), (&true.into(), &"srgb".into()));
        found.push(exposure);
    }
    assert!(found[0] < 0.0 && found.iter().all(|stops| *stops == found[0]), "{found:?}");
    // A bright lamp: 1 would be white.
    let shown = png(&folder, "a.png");
    assert!(shown.iter().copied().max().unwrap() < 255, "{shown:?}");
    // An exposure that is given is not looked for, nor is one where nothing is shown.
    let said = run(&folder, "render auto.toml --backend cpu --spp 1 --exposure 2 --stats s.json");
    assert!(!said.contains("exposure"), "{said}");
    assert_eq!((stats(&folder)["exposure"].as_f64(), &stats(&folder)["exposure_found"]), (Some(2.0), &false.into()));
    assert!(!run(&folder, "render auto.toml --backend cpu --pixel 3,3 --sample 0").contains("exposure auto"));
}

#[test]
fn a_png_is_the_linear_picture_developed() {
    let folder = folder();
    let common = "--backend cpu --spp 4 -o a.png -o a.exr --stats s.json --quiet";
    for (words, tone) in
        [("", Tone::Srgb), (" --tone srgb", Tone::Srgb), (" --tone agx", Tone::Agx), (" --tone neutral", Tone::Neutral)]
    {
        assert_eq!(run(&folder, &format!("render room.toml {common} --exposure -1.5{words}")), "");
        let expected = to_srgb8(&linear(&folder, "a.exr"), Development { exposure: -1.5, tone });
        assert_eq!(png(&folder, "a.png"), expected, "{words}");
        assert_eq!(stats(&folder)["tone"], tone.name());
    }
    // The scene's own, unless options have others; light itself stays as it is.
    run(&folder, &format!("render auto.toml {common}"));
    let (own, exposure) = (linear(&folder, "a.exr"), stats(&folder)["exposure"].as_f64().unwrap() as f32);
    assert_eq!(png(&folder, "a.png"), to_srgb8(&own, Development { exposure, tone: Tone::Agx }));
    run(&folder, &format!("render auto.toml {common} --tone srgb --exposure 0"));
    assert_eq!(png(&folder, "a.png"), to_srgb8(&own, 0.0));
    assert_eq!(linear(&folder, "a.exr"), own);
}

#[test]
fn parts_hold_how_they_are_shown() {
    let folder = folder();
    run(&folder, "render auto.toml --backend cpu --spp 4 -o whole.png");
    for (part, samples) in [("a.exr", "0..2"), ("b.exr", "2..4")] {
        run(&folder, &format!("render auto.toml --backend cpu --samples {samples} -o {part}"));
    }
    run(&folder, "merge a.exr b.exr -o merged.png -o merged.exr");
    let agreed = png(&folder, "merged.png");
    let far = png(&folder, "whole.png").iter().zip(png(&folder, "merged.png")).map(|(a, b)| a.abs_diff(b)).max();
    assert!(far.unwrap() <= 1, "but for rounding: {far:?}");
    run(&folder, "merge a.exr b.exr -o merged.png --exposure -3 --tone neutral");
    let how = Development { exposure: -3.0, tone: Tone::Neutral };
    assert_eq!(png(&folder, "merged.png"), to_srgb8(&linear(&folder, "merged.exr"), how));
    // Parts that disagree: the one with sample 0 counts, in whatever order they are given.
    run(&folder, "render auto.toml --backend cpu --samples 2..4 --exposure 2 --tone srgb -o c.exr");
    let merged = ["a.exr c.exr", "c.exr a.exr"].map(|parts| {
        let said = run(&folder, &format!("merge {parts} -o merged.png"));
        assert!(
            said.contains("warning: a.exr says exposure") && said.contains("c.exr says exposure +2, tone `srgb`"),
            "{said}"
        );
        png(&folder, "merged.png")
    });
    assert!(merged[0] == agreed && merged[1] == agreed);
    let said = run(&folder, "merge c.exr a.exr -o merged.png --exposure 1 --tone agx");
    assert!(
        !said.contains("warning") && !run(&folder, "merge c.exr a.exr -o merged.exr").contains("warning"),
        "{said}"
    );
    let output = folder.luminaire(&["merge", "a.exr", "b.exr", "-o", "c.png", "--exposure", "auto"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("parts hold the exposure"), "{}", stderr(&output));
}

#[test]
fn a_scene_of_which_nothing_can_be_said_is_shown_as_it_is() {
    let folder = folder();
    folder.write("dark.toml", "[render]\nexposure = \"auto\"\n[[object]]\nmesh = \"plain.obj\"\n");
    let said = run(&folder, "render dark.toml --backend cpu --spp 1 --width 8 --stats s.json");
    assert!(said.contains("warning: dark.toml: no exposure can be found") && said.contains("auto: +0 stops"), "{said}");
    assert_eq!(stats(&folder)["exposure"].as_f64(), Some(0.0));
}
