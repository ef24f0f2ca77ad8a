//! `luminaire render`: the files and messages of a run, what ends it, the replay of a sample, and runs without Vulkan or a reader.

mod common;

use common::running::Running;
use common::{Folder, stderr};
use std::process::Command;

/// Hides every Vulkan driver, and layers that would bring their own.
fn without_vulkan(command: &mut Command, folder: &Folder) {
    folder.write("no-driver.json", "");
    let nothing = folder.path().join("no-driver.json");
    command.env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
}

#[test]
fn no_vulkan_at_all() {
    let folder = Folder::new();
    let run = |words: &[&str]| {
        let mut command = folder.luminaire(words);
        without_vulkan(&mut command, &folder);
        command.output().unwrap()
    };
    for backend in ["ray-query", "compute-bvh"] {
        let output = run(&["render", "good.obj", "--backend", backend]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("error: ") && said.contains("Vulkan"), "{said}");
    }
    let output = run(&["devices"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("mesa-vulkan-drivers"), "{}", stderr(&output));
    assert!(!folder.path().join("good.png").exists());

    let output = run(&["render", "good.obj", "--spp", "1", "--width", "8"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.lines().any(|line| line.starts_with("notice: cpu on ")), "{said}");
    assert!(folder.path().join("good.png").exists());
}

#[test]
fn a_render_writes_what_it_says() {
    let folder = Folder::new();
    let files = ["-o", "a.png", "-o", "b.EXR", "-o", "c.hdr", "--stats", "s.json"];
    let rest = ["--backend", "cpu", "--spp", "5", "--width", "16", "--height", "12", "--seed", "7"];
    let words = [&["render", "good.obj"][..], &files, &rest].concat();
    let output = folder.luminaire(&words).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("cpu on "), "{}", stderr(&output));
    let said = String::from_utf8_lossy(&output.stdout);
    for name in ["a.png", "b.EXR", "c.hdr"] {
        assert!(said.contains(&format!("{name}: 16 x 12 pixels, 5 samples a pixel")), "{said}");
        let picture = luminaire::picture::read(&folder.path().join(name)).unwrap();
        assert_eq!((picture.width, picture.height), (16, 12));
    }
    let text = std::fs::read_to_string(folder.path().join("s.json")).unwrap();
    let stats: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&stats["samples"], &stats["seed"], &stats["backend"]), (&960.into(), &7.into(), &"cpu".into()));
    assert_eq!((&stats["end"], &stats["spp_least"]), (&"samples".into(), &5.into()));
    assert!(stats["rays"].as_u64().unwrap() >= 960, "{stats}");
    let by_kind = ["camera_rays", "bounce_rays", "shadow_rays"].map(|kind| stats[kind].as_u64().unwrap());
    assert_eq!(stats["rays"].as_u64().unwrap(), by_kind.iter().sum::<u64>());
    assert_eq!(by_kind[0], 960);

    let again = folder.luminaire(&words).arg("--quiet").output().unwrap();
    assert_eq!(again.status.code(), Some(0));
    assert!(again.stdout.is_empty() && again.stderr.is_empty(), "{again:?}");
}

#[test]
fn whether_a_picture_is_black_depends_on_the_estimator() {
    let folder = Folder::new();
    let light = "[[luminaire]]\nkind = \"point\"\nposition = [0, 0, 1]\nintensity = [1, 1, 1]\n";
    let object = "[[object]]\nmesh = \"plain.obj\"\n";
    folder.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("lit.toml", &format!("{light}{object}"));
    folder.write("by-chance.toml", &format!("[integrator]\nlight_sampling = \"none\"\n{light}{object}"));
    let black = |words: &[&str]| {
        let rest = ["--backend", "cpu", "--spp", "1", "--width", "8", "-o", "a.png"];
        let output = folder.luminaire(&[&["render"][..], words, &rest].concat()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{words:?}: {}", stderr(&output));
        stderr(&output).contains("will be black")
    };
    assert!(!black(&["lit.toml"]));
    assert!(black(&["lit.toml", "--light-sampling", "none"]));
    assert!(black(&["by-chance.toml"]));
    assert!(!black(&["by-chance.toml", "--estimator", "default"]));
}

#[test]
fn time_ends_a_render() {
    let folder = Folder::new();
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "16", "--time", "0.3", "--stats", "s.json"];
    let output = folder.luminaire(&words).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = std::fs::read_to_string(folder.path().join("s.json")).unwrap();
    let stats: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(stats["end"], "time");
    assert!(stats["seconds"]["render"].as_f64().unwrap() >= 0.3, "{stats}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_writes_what_there_is() {
    let folder = Folder::new();
    for signal in ["INT", "TERM"] {
        let saves = ["--checkpoint", "c.exr", "--checkpoint-every", "0.01"];
        let words = ["render", "good.obj", "--backend", "cpu", "--width", "64", "--time", "600"];
        let program = Running::start(&mut folder.luminaire(&[&words[..], &saves].concat()));
        // It has rendered something.
        program.until("a checkpoint", || folder.path().join("c.exr").exists().then_some(()));
        // The shell's own `kill`: a bare system has no other.
        let kill = format!("kill -s {signal} {}", program.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        let output = program.output();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(said.contains("interrupted"), "{said}");
        assert!(image::open(folder.path().join("good.png")).is_ok(), "{said}");
        for name in ["good.png", "c.exr"] {
            std::fs::remove_file(folder.path().join(name)).unwrap();
        }
    }
    assert_eq!(folder.names(), ["good.mtl", "good.obj"], "no temporary file is left");
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_failure() {
    let folder = Folder::new();
    for words in ["inspect good.obj", "render --help", "render good.obj --backend cpu --spp 1 --width 8"] {
        // The reader is gone before the first byte: a pipe whose read end is closed.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let words: Vec<&str> = words.split(' ').collect();
        let output = folder.luminaire(&words).stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{words:?}: {}", stderr(&output));
    }
}

/// A limit of the noise ends a render, says so, and the map of the errors is written.
#[test]
fn noise_ends_a_render() {
    let folder = Folder::new();
    let words = [
        "render",
        "good.obj",
        "--backend",
        "cpu",
        "--width",
        "16",
        "--height",
        "16",
        "--noise",
        "0.5",
        "-o",
        "a.exr",
        "--error-map",
        "e.png",
        "--stats",
        "s.json",
    ];
    let output = folder.luminaire(&words).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("ended by --noise") && said.contains("estimated error"), "{said}");
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("s.json")).unwrap()).unwrap();
    assert_eq!(stats["end"], "noise");
    assert!(stats["error"]["relative"].as_f64().unwrap() <= 0.5, "{stats}");
    let picture = luminaire::picture::read(&folder.path().join("a.exr")).unwrap();
    assert!(picture.error.is_some());
    let map = image::open(folder.path().join("e.png")).unwrap();
    assert!(map.width() >= 16 && map.height() > 16);
}

/// A sample is traced again instead of a render; nothing is written.
#[test]
fn a_sample_is_replayed() {
    let folder = Folder::new();
    let before = folder.names();
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "16", "--pixel", "8,5", "--sample", "3"];
    let output = folder.luminaire(&words).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("pixel 8,5, sample 3"), "{said}{}", stderr(&output));
    assert!(said.contains("throughput") && said.contains("reference"), "{said}");
    // What ended the render that lost it changes nothing.
    for more in [&["--spp", "8"][..], &["--samples", "2..4"], &["--time", "5", "--noise", "0.1"]] {
        let again = folder.luminaire(&[&words[..], more].concat()).output().unwrap();
        assert!(again.status.success() && again.stdout == output.stdout, "{more:?}: {}", stderr(&again));
    }
    assert_eq!(folder.names(), before);
}
