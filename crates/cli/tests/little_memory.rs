//! Under `ulimit -v`, which Linux keeps: the reference or an error, but no crash, whatever is left.
#![cfg(target_os = "linux")]

mod common;

use common::{Folder, stderr};
use std::process::{Command, Output};

/// Runs `luminaire` with so many MiB of address space.
fn within(folder: &Folder, mib: u32, words: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_luminaire");
    let line = format!("ulimit -v {} && exec {program} {words}", mib * 1024);
    let output = Command::new("sh").current_dir(folder.path()).args(["-c", &line]).output().unwrap();
    assert!(output.status.code().is_some(), "{mib} MiB, {words}: {:?}\n{}", output.status, stderr(&output));
    output
}

#[test]
fn drivers_that_would_crash_are_not_loaded() {
    let folder = Folder::new();
    for mib in [250, 400, 700, 1000] {
        let small = "good.obj --width 8 --spp 2 -o a.png";
        let auto = within(&folder, mib, &format!("render {small}"));
        let said = stderr(&auto);
        assert!(
            auto.status.success() && said.contains("notice: cpu on ") && said.contains("ulimit -v"),
            "{mib}: {said}"
        );
        for backend in ["compute-bvh", "ray-query"] {
            let named = within(&folder, mib, &format!("render {small} --backend {backend}"));
            assert!(named.status.code() == Some(1) && stderr(&named).contains("error: this process may take"), "{mib}");
        }
        assert!(within(&folder, mib, &format!("render {small} --backend cpu")).status.success(), "{mib}");
        let devices = within(&folder, mib, "devices");
        let said = stderr(&devices);
        assert!(
            devices.status.code() == Some(1)
                && said.contains("error: this process may take")
                && said.contains("ulimit -v"),
            "{mib}: {said}"
        );
        assert!(!said.contains("Install") && !said.contains("apt"), "{mib}: {said}");
        assert!(within(&folder, mib, "inspect good.obj").status.success(), "{mib}");
    }
}

#[test]
fn a_film_that_does_not_fit_is_refused_with_what_it_wants() {
    let folder = Folder::new();
    let words = "render good.obj --backend cpu --width 4096 --height 4096 --spp 2 -o a.exr";
    for (more, needed) in [("", "4024.0 MiB"), ("--checkpoint c.exr", "7160.0 MiB")] {
        let output = within(&folder, 600, &format!("{words} {more}"));
        let said = stderr(&output);
        assert!(output.status.code() == Some(1) && said.contains(needed) && said.contains("--width"), "{said}");
        assert!(!folder.names().iter().any(|name| name.ends_with(".exr") || name.ends_with(".lock")));
    }
}

#[test]
fn what_is_rendered_is_written_or_refused_before() {
    let folder = Folder::new();
    let mut codes = vec![];
    // Where the threads reserve what the files then want.
    for (more, least) in [("", 430), ("--aov", 485)] {
        for mib in [least, least + 20, least + 160] {
            let words = format!("render good.obj --backend cpu --width 1280 --height 720 --spp 1 -o a.exr {more}");
            let output = within(&folder, mib, &words);
            let said = stderr(&output);
            let refused = output.status.code() == Some(1) && said.contains("--width") && !said.contains("allocation");
            assert!(output.status.success() || refused, "{mib} MiB {more}: {said}");
            assert!(!folder.names().iter().any(|name| name.ends_with(".tmp")), "{mib} MiB {more}");
            codes.push(refused);
        }
    }
    // Neither limit is passed by refusing everything or nothing.
    assert!(codes[0] && !codes[2] && codes[3] && !codes[5], "{codes:?}");
}

#[test]
fn memory_is_told_before_a_render_begins() {
    let folder = Folder::new();
    let output = folder.luminaire(&["inspect", "good.obj", "--width", "3840", "--height", "2160"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    // 214, 313 and 445 bytes a pixel and 40 MiB, 220 bytes a pixel on disk.
    for part in [
        "3840 x 2160 pixels",
        "1.69 GiB for a picture",
        "2.46 GiB with layers",
        "3.48 GiB with --checkpoint",
        "up to 1.70 GiB",
    ] {
        assert!(said.contains(part), "{part} is not in\n{said}");
    }
}

#[test]
fn flip_is_left_out_where_it_does_not_fit() {
    let folder = Folder::new();
    let head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2048 +X 2048\n";
    let picture = [&head[..], &[128, 64, 32, 129].repeat(2048 * 2048)].concat();
    std::fs::write(folder.path().join("a.hdr"), picture).unwrap();
    let plain = within(&folder, 600, "compare a.hdr a.hdr");
    let (said, found) = (stderr(&plain), String::from_utf8_lossy(&plain.stdout));
    assert!(plain.status.success() && found.contains("RMSE        0") && !found.contains("FLIP"), "{said}{found}");
    assert!(
        said.contains("warning: FLIP of 2048 x 2048 pixels needs 600.0 MiB") && said.contains("left out"),
        "{said}"
    );
    let limited = within(&folder, 600, "compare a.hdr a.hdr --max-flip 0.1");
    assert!(limited.status.code() == Some(1) && stderr(&limited).contains("error: FLIP of"), "{}", stderr(&limited));
}
