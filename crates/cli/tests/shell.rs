//! What the program says about itself: `--help` and `--version`, scripts for shells, manual pages.

use std::process::{Command, Output};

fn luminaire(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_luminaire")).args(words).output().unwrap()
}

#[test]
fn completions_are_printed_and_bash_reads_them() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("luminaire.bash");
    let output = luminaire(&["completions", "bash"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    std::fs::write(&script, &output.stdout).unwrap();
    let read = Command::new("bash").arg("-n").arg(&script).output().expect("bash runs");
    assert!(read.status.success() && read.stderr.is_empty(), "{read:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("render") && text.contains("--backend"));
    assert_eq!(luminaire(&["completions", "tcsh"]).status.code(), Some(2));
}

#[test]
fn manual_pages_are_printed_or_written() {
    let main = luminaire(&["man"]);
    assert!(main.status.success(), "{main:?}");
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("share/man1");
    let all = luminaire(&["man", pages.to_str().unwrap()]);
    assert!(all.status.success(), "{all:?}");
    assert_eq!(std::fs::read(pages.join("luminaire.1")).unwrap(), main.stdout);
    assert!(std::fs::read_to_string(pages.join("luminaire-render.1")).unwrap().starts_with(".ie "));
    assert_eq!(String::from_utf8(all.stdout).unwrap().lines().count(), std::fs::read_dir(&pages).unwrap().count());

    // A file where the folder should be.
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let failed = luminaire(&["man", file.to_str().unwrap()]);
    assert_eq!(failed.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&failed.stderr).starts_with("error: cannot write"), "{failed:?}");
}

#[test]
fn help_and_version() {
    let output = luminaire(&["--help"]);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("Exit codes:") && said.contains("Examples:") && said.contains("130"), "{said}");
    let output = luminaire(&["--version"]);
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("luminaire "), "{output:?}");
}

#[test]
fn the_help_explains_estimators() {
    let output = luminaire(&["render", "--help"]);
    let said = String::from_utf8_lossy(&output.stdout);
    for name in ["simple", "default", "no-light-sampling", "uniform", "cosine", "literal-extinction", "threshold"] {
        assert!(said.contains(&format!("  {name}  ")), "{name} is not explained in\n{said}");
    }
}

#[test]
fn the_help_names_both_samplers() {
    let output = luminaire(&["render", "--help"]);
    let said = String::from_utf8_lossy(&output.stdout);
    let sampler = &said[said.find("--sampler").expect("the option")..];
    let sampler = sampler.split("\n\n").next().unwrap();
    assert!(sampler.contains("independent") && sampler.contains("sobol"), "{sampler}");
}
