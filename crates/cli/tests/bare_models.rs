//! Bare models: what they get, what may be chosen, and `luminaire scene`, which writes it down.

mod common;

use common::{Folder, stderr};

/// A model of two materials, one with a texture, in files with blanks and quotes in their names.
fn model() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("my models")).unwrap();
    folder.write("my models/it's a \"model\".obj", "mtllib it.mtl\nv -1 0 0\nv 1 0 0.2\nv 0 1.5 0\nv 0 0.2 1\nvt 0 0\nvt 1 0\nvt 0 1\no part\nusemtl p\u{e4}int\nf 1/1 2/2 3/3\nf 1/1 4/2 2/3\nusemtl b\nf 2 4 3\nf 1 3 4\n");
    folder.write(
        "my models/it.mtl",
        "newmtl p\u{e4}int\nmap_Kd wood pile.ppm\nnewmtl b\nKd .2 .4 .6\nKs .3 .3 .3\nNs 20\n",
    );
    folder.write("my models/wood pile.ppm", "P3\n2 2\n255\n255 0 0 0 255 0 0 0 255 90 90 90\n");
    folder
}

const MODEL: &str = "my models/it's a \"model\".obj";

/// Runs the program and gives its exit code, stdout and stderr.
fn run(folder: &Folder, words: &[&str]) -> (i32, String, String) {
    let output = folder.luminaire(words).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stdout).into_owned(), stderr(&output))
}

/// The bits of a picture of a scene, by a backend; none where there is no Vulkan.
fn bits(folder: &Folder, scene: &str, backend: &str, more: &[&str]) -> Option<Vec<u32>> {
    let words = ["render", scene, "-o", "p.exr", "--spp", "4", "--width", "12", "--height", "12", "--backend", backend];
    let (code, _, said) = run(folder, &[&words, more].concat());
    if code == 1 && said.contains("Vulkan") {
        assert!(std::env::var_os("LUMINAIRE_REQUIRE_GPU").is_none_or(|v| v != "1"), "{said}");
        eprintln!("SKIP: {backend} cannot run here: {said}");
        return None;
    }
    assert_eq!(code, 0, "{said}");
    let picture = luminaire::picture::read(&folder.path().join("p.exr")).unwrap();
    let bits: Vec<u32> = picture.rgb.iter().flatten().map(|x| x.to_bits()).collect();
    assert!(bits.iter().any(|bits| *bits != 0));
    Some(bits)
}

#[test]
fn the_written_scene_file_renders_to_the_same_bits() {
    let folder = model();
    folder.write(
        "far.obj",
        "v 5654321.25 4321000.5 123.125\nv 5654331.75 4321000.25 123.5\nv 5654321.125 4321009.123456 130\nf 1 2 3\n",
    );
    for (model, options) in [
        (MODEL, &[][..]),
        (MODEL, &["--up", "z", "--smooth", "180", "--sky", "1,0.5,0.3"]),
        ("far.obj", &[]),
        ("good.obj", &["--ground", "on"]),
    ] {
        let (code, text, said) = run(&folder, &[&["scene", model], options].concat());
        assert_eq!((code, said.as_str()), (0, ""), "{model}");
        folder.write("m.toml", &text);
        // Files are named as seen from where the scene file is.
        std::fs::create_dir_all(folder.path().join("out/there")).unwrap();
        let written = [&["scene", model, "-o", "out/there/m.toml", "--overwrite"], options].concat();
        let (code, out, said) = run(&folder, &written);
        assert_eq!((code, out.as_str()), (0, ""), "{said}");
        for backend in ["cpu", "compute-bvh"] {
            let Some(bare) = bits(&folder, model, backend, options) else { continue };
            assert_eq!(Some(&bare), bits(&folder, "m.toml", backend, &[]).as_ref(), "{model}, {backend}");
            assert_eq!(Some(&bare), bits(&folder, "out/there/m.toml", backend, &[]).as_ref(), "{model}, {backend}");
        }
    }
}

#[test]
fn one_line_says_what_was_chosen() {
    let folder = model();
    let words = ["render", MODEL, "--backend", "cpu", "--spp", "1", "--width", "8", "-o", "p.png"];
    let (code, _, said) = run(&folder, &words);
    assert_eq!(code, 0, "{said}");
    let lines: Vec<&str> = said.lines().filter(|line| line.starts_with("bare model: ")).collect();
    let [line] = lines[..] else { panic!("{said}") };
    // The command can be copied into a shell.
    let command = "`luminaire scene 'my models/it'\\''s a \"model\".obj' -o 'it'\\''s a \"model\".toml'`";
    assert!(line.contains("studio sky, ground at y = ") && line.contains(command), "{line}");
    assert!(!said.contains("warning"), "{said}");
    let (code, _, said) = run(&folder, &[&words[..], &["--quiet"]].concat());
    assert_eq!((code, said.as_str()), (0, ""));
    let (code, report, _) = run(&folder, &["inspect", MODEL]);
    assert!(code == 0 && report.contains("\nchosen\n  bare model: studio sky"), "{report}");
    assert!(report.contains("studio, 256 x 128 texels") && report.contains("  ground"), "{report}");
    let (code, report, _) = run(&folder, &["inspect", MODEL, "--sky", "none", "--ground", "off"]);
    assert!(code == 0 && report.contains("the picture will be black"), "{report}");
    assert!(report.contains("bare model: no sky, no ground"), "{report}");
    let command = "`luminaire scene good.obj --sky 1,0.5,0 --ground on --smooth 30 --up z -o good.toml`";
    let words = ["inspect", "good.obj", "--up", "z", "--smooth", "30", "--ground", "on", "--sky", "1,.5,0"];
    let (_, report, _) = run(&folder, &words);
    assert!(report.contains(command), "{report}");
}

#[test]
fn wrong_choices_are_wrong_usage() {
    let folder = model();
    folder.write("s.toml", "[environment]\nradiance = [1, 1, 1]\n[[object]]\nmesh = \"good.obj\"\n");
    for (words, part) in [
        (&["render", "good.obj", "--sky", "0.5"][..], "0.5,0.5,0.5"),
        (&["render", "good.obj", "--sky", "1,-1,0"], "negative"),
        (&["inspect", "good.obj", "--ground", "maybe"], "on or off"),
        (&["inspect", "good.obj", "--smooth", "-3"], "0 to 180"),
        (&["view", "good.obj", "--up", "x"], "y or z"),
        (&["render", "s.toml", "--up", "z"], "rotate = [-90, 0, 0]"),
        (&["inspect", "s.toml", "--smooth", "30"], "`smooth`"),
        (&["scene", "s.toml"], "a scene file already"),
        (&["scene", "good.mtl"], ".obj"),
        (&["scene", "good.obj", "-o", "a.txt"], ".toml"),
        (&["scene", "good.obj", "-o", "s.toml"], "--overwrite"),
        (&["scene", "good.obj", "--overwrite"], "--output"),
    ] {
        let (code, out, said) = run(&folder, words);
        assert!(code == 2 && out.is_empty() && said.contains(part), "{words:?}: {code} {said}");
    }
    let before = std::fs::read(folder.path().join("s.toml")).unwrap();
    let (code, _, said) = run(&folder, &["scene", "gone.obj", "-o", "s.toml", "--overwrite"]);
    assert!(code == 1 && said.contains("gone.obj"), "{said}");
    assert_eq!(std::fs::read(folder.path().join("s.toml")).unwrap(), before, "a failure replaces nothing");
    let (code, _, said) = run(&folder, &["render", "good.obj", "--sky", "no-such.hdr"]);
    assert!(code == 1 && said.contains("no-such.hdr"), "{said}");
    // What the run reads is not written over.
    folder.write("sky.hdr", "no picture");
    let (code, _, said) = run(&folder, &["render", "s.toml", "--sky", "s.toml", "-o", "p.png"]);
    assert!(code == 1 && said.contains("s.toml"), "{said}");
}
