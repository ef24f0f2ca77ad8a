//! `luminaire bench`: its files, its page, its baseline, and every way in which the command can be wrong.

mod common;
#[path = "../../measure/tests/documents/html.rs"]
mod html;

use common::names;
use html::check_page;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// A folder with a scene: a floor under a lamp.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("room.mtl", "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n");
    write(
        "room.obj",
        "mtllib room.mtl\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -.3 1 -.3\nv .3 1 -.3\nv .3 1 .3\nv -.3 1 .3\n\
         usemtl floor\nf 1 2 3 4\nusemtl lamp\nf 5 6 7 8\n",
    );
    let camera = "[sensor]\nposition = [0, 0.6, 3]\ntarget = [0, 0.3, 0]\nfov = 45\n";
    write("room.toml", &format!("[film]\nwidth = 32\nheight = 24\n{camera}[[object]]\nmesh = \"room.obj\"\n"));
    folder
}

fn command(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.current_dir(folder).arg("bench").args(words);
    command
}

fn bench(folder: &Path, words: &[&str]) -> Output {
    command(folder, words).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// One run on the CPU, with all its files; then held against better and worse ones.
#[test]
fn a_run_and_its_baselines() {
    let folder = folder();
    let path = folder.path();
    let words = [
        "room.toml",
        "--quick",
        "--width",
        "16",
        "--backend",
        "cpu",
        "--estimator",
        "default",
        "--estimator",
        "cosine",
    ];
    let of_scenes = ["--section", "convergence", "--section", "preparation"];
    let output = bench(path, &[&words[..], &of_scenes, &["--out", "first", "--page", "page.md"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let files = [
        "bench.json",
        "convergence-room-samples.svg",
        "convergence-room-seconds.svg",
        "figures.csv",
        "index.html",
        "points.csv",
    ];
    assert_eq!(names(&path.join("first")), files);

    let page = std::fs::read_to_string(path.join("first/index.html")).unwrap();
    check_page(&page);
    for part in ["luminaire bench room.toml", "room: error over seconds", "Pareto front", "cosine on cpu", "16 x 12"] {
        assert!(page.contains(part), "no {part:?}");
    }
    let markdown = std::fs::read_to_string(path.join("page.md")).unwrap();
    for part in ["(<first/convergence-room-seconds.svg>)", "| room | cpu | cosine |", "## Error over time"] {
        assert!(markdown.contains(part), "no {part:?}");
    }

    let record = json(&path.join("first/bench.json"));
    let sections = record["sections"].as_array().unwrap();
    let figures: Vec<&Value> = sections.iter().flat_map(|section| section["figures"].as_array().unwrap()).collect();
    let csv = std::fs::read_to_string(path.join("first/figures.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + figures.len());
    let columns = |line: &str| line.split(',').count();
    assert!(csv.lines().all(|line| columns(line) == 8), "{csv}");
    assert!(csv.contains("\nconvergence,room/cpu/default/1-spp,seconds,s,"), "{csv}");
    assert!(csv.contains("\npreparation,room/cpu,build-seconds,s,"), "{csv}");
    let value = |name: &str| figures.iter().find(|f| f["name"] == name).expect(name)["median"].as_f64().unwrap();
    // More samples are more exact.
    assert!(value("convergence/room/cpu/default/4-spp/relmse") < value("convergence/room/cpu/default/1-spp/relmse"));
    assert!(value("convergence/room/cpu/default/4-spp/seconds") > 0.0);
    let points: usize = sections
        .iter()
        .flat_map(|section| section["charts"].as_array().unwrap())
        .flat_map(|chart| chart["series"].as_array().unwrap())
        .map(|series| series["points"].as_array().unwrap().len())
        .sum();
    let rows = std::fs::read_to_string(path.join("first/points.csv")).unwrap();
    assert_eq!(rows.lines().count(), 1 + points);

    // A thousand times better or worse is beyond any noise.
    for (factor, code, part) in [(1e-3, 1, "WORSE"), (1e3, 0, "better")] {
        let mut other = record.clone();
        for section in other["sections"].as_array_mut().unwrap() {
            for figure in section["figures"].as_array_mut().unwrap() {
                let factor = if figure["better"] == "lower" { factor } else { 1.0 / factor };
                for key in ["median", "least", "most"] {
                    figure[key] = (figure[key].as_f64().unwrap() * factor).into();
                }
            }
        }
        other["machine"]["device"] = "another device".into();
        std::fs::write(path.join("other.json"), other.to_string()).unwrap();
        let output = bench(path, &[&words[..], &of_scenes, &["--out", "second", "--baseline", "other.json"]].concat());
        let said = said(&output);
        assert_eq!(output.status.code(), Some(code), "{said}");
        let named =
            |line: &str| line.trim().starts_with(part) && line.contains(" convergence/room/cpu/default/1-spp/relmse ");
        assert!(said.lines().any(named), "{said}");
        assert!(said.contains("was another device"), "{said}");
        assert_eq!(said.contains("error: "), code == 1, "{said}");
    }
    // relMSE by another definition, as it was before the record said by which: it is not compared, and that is said.
    let mut other = record.clone();
    other["run"].as_object_mut().unwrap().remove("relmse").expect("the definition of relMSE");
    for section in other["sections"].as_array_mut().unwrap() {
        for figure in section["figures"].as_array_mut().unwrap() {
            let name = figure["name"].as_str().unwrap();
            let factor = if name.contains("/relmse") { 1e-3 } else { 1.0 };
            for key in ["median", "least", "most"] {
                figure[key] = (figure[key].as_f64().unwrap() * factor).into();
            }
        }
    }
    std::fs::write(path.join("other.json"), other.to_string()).unwrap();
    let output = bench(path, &[&words[..], &of_scenes, &["--out", "second", "--baseline", "other.json"]].concat());
    let text = said(&output);
    assert!(
        text.contains("relMSE was mean of (a - b)^2 / (b^2 + 0.01) and is") && text.contains("are not compared"),
        "{text}"
    );
    assert!(!text.lines().any(|line| line.trim().starts_with("WORSE") && line.contains("relmse")), "{text}");
    assert!(text.contains("build-seconds") || text.contains("\nagainst the baseline\n"), "{text}");

    // Nothing in common: nothing is compared, and that is no success.
    let renamed = record.to_string().replace("\"preparation/", "\"separation/");
    std::fs::write(path.join("other.json"), renamed).unwrap();
    let output = bench(path, &[&words[..], &["--baseline", "other.json", "--section", "preparation"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("\n  separation/room/load-seconds"), "{}", said(&output));
}

#[test]
fn a_given_reference() {
    let folder = folder();
    let render =
        ["render", "room.toml", "-o", "truth.exr", "--backend", "cpu", "--spp", "256", "--width", "16", "--seed", "9"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    assert!(command.current_dir(folder.path()).args(render).output().unwrap().status.success());
    let words = [
        "room.toml",
        "--quick",
        "--backend",
        "cpu",
        "--estimator",
        "own",
        "--section",
        "convergence",
        "--reference",
        "truth.exr",
    ];
    let output = bench(folder.path(), &words);
    assert!(output.status.success(), "{}", said(&output));
    let record = json(&folder.path().join("bench/bench.json"));
    assert_eq!((&record["run"]["scenes"][0]["width"], &record["run"]["scenes"][0]["height"]), (&16.into(), &12.into()));
    let text = record["sections"][0]["text"].to_string();
    assert!(text.contains("the picture that was given, whose own relMSE is about"), "{text}");

    // Of another size, with a width besides, or for two scenes it means nothing.
    for more in [&["--width", "8"][..], &["room.obj"]] {
        assert_eq!(bench(folder.path(), &[&words[..], more].concat()).status.code(), Some(2), "{more:?}");
    }
}

/// Every backend that is here; without Vulkan the reference alone, and that is said.
#[test]
fn all_backends_or_what_is_missing() {
    let folder = folder();
    let words = ["room.toml", "--quick", "--width", "16", "--rounds", "1", "--estimator", "default"];
    let output = bench(folder.path(), &words);
    assert!(output.status.success(), "{}", said(&output));
    let backends = json(&folder.path().join("bench/bench.json"))["machine"]["backends"].clone();
    for backend in ["compute-bvh", "ray-query"] {
        let there = backends.as_array().unwrap().contains(&backend.into());
        assert_eq!(there, !said(&output).contains(&format!("SKIP: {backend}")), "{}", said(&output));
        if !there {
            eprintln!("SKIP: {backend} is not here: the benchmark ran without it");
        }
    }

    let nothing = folder.path().join("no-driver.json");
    std::fs::write(&nothing, "").unwrap();
    let hidden = |words: &[&str]| {
        let mut command = command(folder.path(), words);
        command.env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing).output().unwrap()
    };
    let output = hidden(&[&words[..], &["--out", "none"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("SKIP: compute-bvh") && said(&output).contains("SKIP: ray-query"));
    let record = json(&folder.path().join("none/bench.json"));
    assert_eq!(record["machine"]["backends"], serde_json::json!(["cpu"]));
    assert!(record["machine"]["device"].as_str().unwrap().starts_with("no "), "{}", record["machine"]);
    let output = hidden(&[&words[..], &["--backend", "compute-bvh"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("error: compute-bvh cannot run here: no "), "{}", said(&output));
}

#[test]
fn wrong_commands_are_told_before_the_work() {
    let folder = folder();
    let before = names(folder.path());
    std::fs::write(folder.path().join("bad.json"), "{\"run\": 3}").unwrap();
    let fails = |words: &[&str], code: i32, parts: &[&str]| {
        let output = bench(folder.path(), words);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(code), "{words:?} said:\n{said}");
        assert!(parts.iter().all(|part| said.contains(part)) && !said.contains("panicked"), "{words:?} said:\n{said}");
        assert!(!said.contains("reference on"), "{words:?} began to work:\n{said}");
    };
    fails(&[], 2, &["no SCENE", "scenes/cornell/cornell.toml"]);
    fails(&["none.toml"], 1, &["none.toml"]);
    fails(&["room.toml", "--section", "nonsense"], 2, &["nonsense", "convergence", "preparation"]);
    fails(&["room.toml", "--estimator", "photon"], 2, &["photon", "`own`", "+independent"]);
    fails(&["room.toml", "--backend", "auto"], 2, &["ray-query"]);
    fails(&["room.toml", "--quick", "--long"], 2, &["--long"]);
    fails(&["room.toml", "--rounds", "0"], 2, &["--rounds"]);
    fails(&["room.toml", "--width", "0"], 2, &["--width"]);
    fails(&["room.toml", "--baseline", "none.json"], 1, &["error: cannot read none.json"]);
    fails(&["room.toml", "--baseline", "bad.json"], 1, &["bad.json", "bench.json of an earlier"]);
    fails(&["room.toml", "--reference", "none.exr"], 1, &["none.exr"]);
    fails(&["room.toml", "room.obj", "--reference", "none.exr"], 1, &["none.exr"]);
    fails(&["room.toml", "--out", "room.obj"], 1, &["error: cannot write room.obj"]);
    std::fs::remove_file(folder.path().join("bad.json")).unwrap();
    assert_eq!(names(folder.path()), before);
    fails(&["room.toml", "--page", "none/page.md"], 1, &["none/page.md", "does not exist"]);
}
