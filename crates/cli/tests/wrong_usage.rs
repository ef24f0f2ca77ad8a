//! Command lines and scenes that `luminaire` refuses: exit code, message, and no file left behind.

mod common;

use common::{Folder, stderr};

impl Folder {
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
    // The scene does not exist either, but what is wrong with the outputs must come first.
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
        ["--light-choice", "some"],
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
fn options_of_the_error_that_mean_nothing() {
    let folder = Folder::new();
    let fails = |words: &[&str], part: &str| {
        folder.fails(&[&["render", "good.obj", "--backend", "cpu"], words].concat(), 2, &[part]);
    };
    fails(&["--error-map", "map.exr"], ".png");
    fails(&["-o", "a.png", "--error-map", "a.png"], "twice");
    fails(&["--error-map", "good.png"], "twice");
    fails(&["--spp", "1", "--error-map", "e.png"], "--spp 2");
    fails(&["--samples", "4..5", "-o", "a.exr", "--error-map", "e.png"], "two samples");
    folder.write("one.toml", "[render]\nspp = 1\n[[object]]\nmesh = \"good.obj\"\n");
    folder.fails(&["render", "one.toml", "--error-map", "e.png"], 2, &["--spp 2", "`spp = 1`"]);
    fails(&["--width", "16", "--pixel", "16,0", "--sample", "1"], "not on the film");
    fails(&["--pixel", "1,1", "--sample", "1", "-o", "a.png"], "cannot be used with");
    fails(&["--pixel", "1,1"], "--sample");
}

#[test]
fn a_film_beyond_memory() {
    let folder = Folder::new();
    let size = |height| ["render", "good.obj", "--backend", "cpu", "--width", "65536", "--height", height];
    folder.fails(&size("65535"), 1, &["65536 x 65535", "GiB", "--width"]);
    folder.fails(&size("65536"), 2, &["65536 x 65536", "2^32"]);
}

#[test]
fn a_checkpoint_that_is_another_file() {
    let folder = Folder::new();
    luminaire::picture::save_linear(&folder.path().join("sky.exr"), 2, 1, &[1.0; 6], 0.0).unwrap();
    folder.write("text.exr", "precious");
    for name in ["sky.exr", "text.exr"] {
        folder.fails(&["render", "good.obj", "--checkpoint", name], 2, &[name, "no checkpoint: give another name"]);
    }
}

#[test]
fn unknown_device() {
    let folder = Folder::new();
    folder.fails(&["render", "good.obj", "--device", "no such device"], 1, &["no such device"]);
    folder.fails(&["render", "good.obj", "--device", "99"], 1, &["99"]);
}
