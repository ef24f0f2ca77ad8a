//! What a shell and `man` get from the program: scripts on standard output, pages in a folder.

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
