//! `luminaire stability`. What the sweeps promise, and their page, is tested in `crates/measure`.

mod common;
#[path = "../../measure/tests/documents/svg.rs"]
mod svg;

use common::names;
use luminaire_measure::stability::{SUMMARY, SWEEPS};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use svg::texts;

fn stability(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.current_dir(folder).arg("stability").args(words).output().unwrap()
}

#[test]
fn wrong_commands_are_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let fails = |words: &[&str], code: i32, parts: &[&str]| {
        let output = stability(folder.path(), words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words:?} said:\n{said}");
        assert!(parts.iter().all(|part| said.contains(part)) && !said.contains("panicked"), "{words:?} said:\n{said}");
        assert!(!said.contains(SWEEPS[0].title), "{words:?} began to work:\n{said}");
    };
    fails(&["nonsense"], 2, &["nonsense", SWEEPS[0].name]);
    assert!(names(folder.path()).is_empty());
    std::fs::write(folder.path().join("file"), "").unwrap();
    fails(&["--out", "file"], 1, &["error: cannot write file"]);
    fails(&["--out", "file/folder"], 1, &["error: cannot write file/folder"]);
    fails(&["--out", "folder", "--page", "none/page.md"], 1, &["none/page.md", "does not exist"]);
}

#[test]
fn the_list_has_every_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let output = stability(folder.path(), &["--list"]);
    let listed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success());
    assert!(SWEEPS.iter().all(|sweep| listed.contains(sweep.name) && listed.contains(sweep.title)), "{listed}");
    assert!(names(folder.path()).is_empty());
}

/// An interrupt ends the sweeps at once, without half a file.
#[cfg(unix)]
#[test]
fn an_interrupt_leaves_what_is_done() {
    for signal in ["INT", "TERM"] {
        let folder = tempfile::tempdir().unwrap();
        let nothing = folder.path().join("no-driver.json");
        std::fs::write(&nothing, "").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
        command.current_dir(folder.path()).env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
        command.args(["stability", "samples", "albedo", "--long", "--out", "out"]).stderr(Stdio::piped());
        let mut job = command.spawn().unwrap();
        // Its first line comes when it listens.
        let mut said = BufReader::new(job.stderr.take().unwrap());
        let mut line = String::new();
        while !line.contains("1/2 ") {
            assert!(said.read_line(&mut line).unwrap() > 0, "{line}");
        }
        let status = Command::new("sh").args(["-c", &format!("kill -s {signal} {}", job.id())]).status().unwrap();
        assert!(status.success());
        said.read_to_string(&mut line).unwrap();
        assert_eq!(job.wait().unwrap().code(), Some(130), "{signal}: {line}");
        assert!(line.contains("interrupted"), "{signal}: {line}");
        let left = names(&folder.path().join("out"));
        assert!(left.iter().all(|name| name.starts_with("samples") && !name.contains("tmp")), "{signal}: {left:?}");
    }
}

/// A real sweep, without a Vulkan device: the reference alone, and the page says so.
#[test]
fn a_sweep_without_a_device() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = folder.path().join("no-driver.json");
    std::fs::write(&nothing, "").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.current_dir(folder.path()).env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
    let output = command.args(["stability", "samples", "--out", "out", "--page", "page.md"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("not here: compute-bvh, ray-query"), "{said}");
    assert_eq!(names(folder.path()), ["no-driver.json", "out", "page.md"]);
    let files = ["samples-constant.svg", "samples-random.svg", "samples-rendered.svg", "samples.csv"];
    assert_eq!(names(&folder.path().join("out")), files);
    let page = std::fs::read_to_string(folder.path().join("page.md")).unwrap();
    assert!(page.contains("not here: compute-bvh, ray-query"), "{page}");
    // Measured: the sums hold over the whole range, and a plain sum in single precision does not.
    assert!(page.contains("| [samples](#samples) | 1 to 1e6 samples a pixel | ● | f32 sum: ● to"), "{page}");
    let row = page.lines().find(|line| line.starts_with("| [samples]")).unwrap();
    let sentence = row.rsplit(" | ").next().unwrap().trim_end_matches(" |");
    assert!(sentence.chars().count() <= SUMMARY && sentence.ends_with('.'), "{sentence}");
    assert!(page.contains("(<out/samples-constant.svg>)"), "{page}");
    assert!(page.contains("luminaire stability samples --out out --page page.md"), "{page}");
    for svg in &files[..3] {
        texts(&std::fs::read_to_string(folder.path().join("out").join(svg)).unwrap());
    }
    let csv = std::fs::read_to_string(folder.path().join("out/samples.csv")).unwrap();
    assert!(csv.starts_with("chart,method,x,y,error\n") && csv.lines().count() > 10, "{csv}");
}
