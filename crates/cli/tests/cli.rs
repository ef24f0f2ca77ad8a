//! Every way in which a command line can be wrong: exit code, message, and no file left behind.

use std::path::Path;
use std::process::{Command, Output};

/// A folder of one test, with a scene that is sound: one triangle that emits.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Folder(tempfile::tempdir().unwrap());
        folder.write("good.mtl", "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
        folder.write("good.obj", "mtllib good.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n");
        folder
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path().join(name), text).unwrap();
    }

    fn luminaire(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
        command.current_dir(self.path()).args(words);
        command
    }

    /// Runs `luminaire`, asserts that it fails with `code`, says every one of `parts`, and leaves no file behind.
    fn fails(&self, words: &[&str], code: i32, parts: &[&str]) {
        let before = self.names();
        let output = self.luminaire(words).output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "luminaire {words:?} said:\n{said}");
        assert!(said.lines().any(|line| line.starts_with("error: ")), "luminaire {words:?} said:\n{said}");
        for part in parts {
            assert!(said.contains(part), "luminaire {words:?} does not say {part:?}, but:\n{said}");
        }
        assert!(!said.contains("panicked") && !said.contains("RUST_BACKTRACE"), "{said}");
        assert_eq!(self.names(), before, "luminaire {words:?} left files behind");
    }

    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path()).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Hides every Vulkan driver, and layers that would bring their own.
fn without_vulkan(command: &mut Command, folder: &Folder) {
    folder.write("no-driver.json", "");
    let nothing = folder.path().join("no-driver.json");
    command.env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
}

#[test]
fn missing_scene() {
    let folder = Folder::new();
    for command in ["render", "inspect"] {
        folder.fails(&[command, "none.toml"], 1, &["none.toml", "No such file"]);
        folder.fails(&[command, "none.obj"], 1, &["none.obj", "No such file"]);
    }
}

#[test]
fn scene_of_unknown_kind() {
    let folder = Folder::new();
    folder.write("scene.txt", "hello");
    folder.fails(&["render", "scene.txt"], 2, &["scene.txt", ".obj", ".toml"]);
}

#[test]
fn bad_toml() {
    let folder = Folder::new();
    folder.write("key.toml", "[film]\nwidth = 64\ncolour = \"red\"\n");
    folder.fails(&["render", "key.toml"], 1, &["key.toml:3", "colour"]);
    folder.write("syntax.toml", "[film]\nwidth = = 3\n");
    folder.fails(&["render", "syntax.toml"], 1, &["syntax.toml:2"]);
}

#[test]
fn bad_obj() {
    let folder = Folder::new();
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    folder.write("index.obj", &format!("{three}f 1 2 4\n"));
    folder.fails(&["render", "index.obj"], 1, &["index.obj:4", "4"]);
    folder.write("zero.obj", &format!("{three}f 0 1 2\n"));
    folder.fails(&["render", "zero.obj"], 1, &["zero.obj:4"]);
    folder.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    folder.fails(&["render", "nan.obj"], 1, &["nan.obj:2"]);
    folder.write("none.obj", three);
    folder.fails(&["render", "none.obj"], 1, &["none.obj", "nothing to trace"]);
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.fails(&["render", "flat.obj"], 1, &["flat.obj", "nothing to trace"]);
    folder.write("empty.obj", "");
    folder.fails(&["render", "empty.obj"], 1, &["empty.obj", "nothing to trace"]);
    std::fs::write(folder.path().join("binary.obj"), [0xff, 0xfe, 0x00, 0x80]).unwrap();
    folder.fails(&["render", "binary.obj"], 1, &["binary.obj"]);
}

#[test]
fn outputs_are_checked_before_the_scene() {
    let folder = Folder::new();
    // The scene does not even exist: these must be told first.
    folder.fails(&["render", "none.obj", "-o", "a.jpg"], 2, &["a.jpg", ".png", ".exr", ".hdr"]);
    folder.fails(&["render", "none.obj", "-o", "picture"], 2, &["picture", "ending"]);
    folder.fails(&["render", "none.obj", "-o", "gone/a.png"], 1, &["gone/a.png", "does not exist"]);
    folder.fails(&["render", "none.obj", "-o", "a.png", "-o", "a.png"], 2, &["a.png", "twice"]);
    folder.fails(&["render", "none.obj", "--stats", "good.obj"], 2, &["good.obj", ".json"]);
    folder.fails(&["render", "none.obj", "--stats", "gone/a.json"], 1, &["gone/a.json", "does not exist"]);
    folder.write("file", "");
    folder.fails(&["render", "none.obj", "-o", "file/a.png"], 1, &["file/a.png"]);
}

#[test]
fn numbers_and_names() {
    let folder = Folder::new();
    for words in [
        ["--spp", "0"],
        ["--spp", "many"],
        ["--time", "0"],
        ["--time", "nan"],
        ["--width", "0"],
        ["--width", "65537"],
        ["--height", "-1"],
        ["--seed", "4294967296"],
        ["--exposure", "inf"],
        ["--max-bounces", "x"],
        ["--max-bounces", "1000001"],
        ["--estimator", "photon"],
        ["--light-sampling", "some"],
        ["--area-sampling", "some"],
        ["--directions", "some"],
        ["--extinction", "some"],
        ["--albedo-threshold", "2"],
        ["--sampler", "dice"],
        ["--backend", "gpu"],
    ] {
        folder.fails(&["render", "good.obj", words[0], words[1]], 2, &[words[0], words[1]]);
    }
    folder.fails(&["render"], 2, &["<SCENE>"]);
    folder.fails(&["render", "good.obj", "--speed", "9"], 2, &["--speed"]);
    folder.fails(&["paint"], 2, &["paint"]);
}

#[test]
fn options_that_do_not_go_together() {
    let folder = Folder::new();
    folder.fails(&["render", "good.obj", "--backend", "cpu", "--device", "0"], 2, &["--device", "--backend cpu"]);
    let simple = ["render", "good.obj", "--estimator", "simple", "--max-bounces", "3"];
    folder.fails(&simple, 2, &["--max-bounces", "--estimator"]);
    folder.fails(&["render", "good.obj", "--extinction", "off"], 2, &["never ends", "--max-bounces"]);
    folder.write("simple.toml", "[integrator]\nestimator = \"simple\"\n[[object]]\nmesh = \"good.obj\"\n");
    let directions = ["render", "simple.toml", "--directions", "uniform"];
    folder.fails(&directions, 2, &["--directions", "--estimator default"]);
}

#[test]
fn a_film_beyond_memory() {
    let folder = Folder::new();
    let size = |height| ["render", "good.obj", "--backend", "cpu", "--width", "65536", "--height", height];
    folder.fails(&size("65535"), 1, &["65536 x 65535", "GiB", "--width"]);
    folder.fails(&size("65536"), 2, &["65536 x 65536", "2^32"]);
}

#[test]
fn a_pipe_as_a_material_library() {
    let folder = Folder::new();
    let made = Command::new("mkfifo").arg(folder.path().join("pipe.mtl")).status().unwrap();
    assert!(made.success());
    folder.write("pipe.obj", "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    // It does not wait for somebody to write into the pipe.
    let output = folder.luminaire(&["inspect", "pipe.obj"]).output().unwrap();
    assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("not a regular file"));
}

#[test]
fn unknown_device() {
    let folder = Folder::new();
    folder.fails(&["render", "good.obj", "--device", "no such device"], 1, &["no such device"]);
    folder.fails(&["render", "good.obj", "--device", "99"], 1, &["99"]);
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
fn the_help_explains_estimators() {
    let folder = Folder::new();
    let output = folder.luminaire(&["render", "--help"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    for name in ["simple", "default", "no-light-sampling", "uniform", "cosine", "literal-extinction", "threshold"] {
        assert!(said.contains(&format!("  {name}  ")), "{name} is not explained in\n{said}");
    }
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
        let words = ["render", "good.obj", "--backend", "cpu", "--width", "64", "--time", "600"];
        let child = folder.luminaire(&words).stderr(std::process::Stdio::piped()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_secs(2));
        // The shell's own `kill`: a bare system has no other.
        let kill = format!("kill -s {signal} {}", child.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(said.contains("interrupted"), "{said}");
        assert!(image::open(folder.path().join("good.png")).is_ok(), "{said}");
        std::fs::remove_file(folder.path().join("good.png")).unwrap();
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

#[test]
fn inspect_tells_what_was_loaded() {
    let folder = Folder::new();
    let output = folder.luminaire(&["inspect", "good.obj"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = String::from_utf8_lossy(&output.stdout);
    for part in ["1 in 1 object;", "lamp", "1 emissive triangles", "warnings"] {
        assert!(said.contains(part), "{part} is not in\n{said}");
    }
}

#[test]
fn inspect_lists_the_fallback_where_it_is_seen() {
    let folder = Folder::new();
    let face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("own.mtl", "newmtl default\nKd .1 .2 .3\n");
    let names = |obj: &str| {
        folder.write("a.obj", obj);
        let output = folder.luminaire(&["inspect", "a.obj"]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let rows = said.lines().map(str::trim).skip_while(|line| *line != "materials").skip(2);
        let rows = rows.take_while(|line| !line.is_empty());
        rows.map(|line| line.split("  ").next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(face), ["default"]);
    assert_eq!(names(&format!("mtllib own.mtl\nusemtl default\n{face}")), ["default"]);
    assert_eq!(names(&format!("mtllib own.mtl\n{face}usemtl default\nf 1 2 3\n")), ["default (built in)", "default"]);
    assert_eq!(names(&format!("mtllib good.mtl\nusemtl lamp\n{face}")), ["lamp"]);
}

#[test]
fn the_help_names_both_samplers() {
    let folder = Folder::new();
    let output = folder.luminaire(&["render", "--help"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    let sampler = &said[said.find("--sampler").expect("the option")..];
    let sampler = sampler.split("\n\n").next().unwrap();
    assert!(sampler.contains("independent") && sampler.contains("sobol"), "{sampler}");
}

#[test]
fn help_and_version() {
    let folder = Folder::new();
    let output = folder.luminaire(&["--help"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("Exit codes:") && said.contains("Examples:") && said.contains("130"), "{said}");
    let output = folder.luminaire(&["--version"]).output().unwrap();
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("luminaire "), "{output:?}");
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
    assert_eq!(folder.names(), before);
}

#[test]
fn options_of_the_error_that_mean_nothing() {
    let folder = Folder::new();
    let fails = |words: &[&str], part: &str| {
        folder.fails(&[&["render", "good.obj", "--backend", "cpu"], words].concat(), 2, &[part]);
    };
    fails(&["--error-map", "map.exr"], ".png");
    fails(&["-o", "a.png", "--error-map", "a.png"], "the picture itself");
    fails(&["--error-map", "good.png"], "the picture itself");
    fails(&["--spp", "1", "--error-map", "e.png"], "--spp 2");
    fails(&["--width", "16", "--pixel", "16,0", "--sample", "1"], "not on the film");
    fails(&["--pixel", "1,1", "--sample", "1", "--spp", "4"], "cannot be used with");
    fails(&["--pixel", "1,1"], "--sample");
}
