//! What a run reads is never written over, by whatever name; nor is what somebody else has written, where nobody asked for that.

mod common;

use common::{Folder, stderr};
use std::collections::BTreeMap;

/// One triangle with a texture, seen by a camera, and images that nothing shows: a map that nothing models, and one of a material that is not used.
fn textured() -> Folder {
    let folder = Folder::new();
    let image = image::RgbImage::from_pixel(2, 2, image::Rgb([200, 100, 50]));
    for name in ["crate.png", "rough.png", "unused.png"] {
        image.save(folder.path().join(name)).unwrap();
    }
    folder.write(
        "crate.mtl",
        "newmtl a\nKe 1 1 1\nKd 1 1 1\nmap_Kd -clamp on crate.png\nmap_Pr -s 2 2 2 rough.png\nnewmtl b\nKd 1 1 1\nmap_Kd unused.png\n",
    );
    folder.write(
        "crate.obj",
        "mtllib crate.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n",
    );
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    folder
}

/// The bytes of every file.
fn contents(folder: &Folder) -> BTreeMap<String, Vec<u8>> {
    let files = folder.names().into_iter().filter(|name| folder.path().join(name).is_file());
    files.map(|name| (name.clone(), std::fs::read(folder.path().join(&name)).unwrap())).collect()
}

/// Runs `luminaire`, which must refuse with exit code 2, say every part, and change nothing.
fn refuses(folder: &Folder, words: &[&str], parts: &[&str]) {
    let before = contents(folder);
    let output = folder.luminaire(words).output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "luminaire {words:?} said:\n{said}");
    for part in parts {
        assert!(said.contains(part), "luminaire {words:?} does not say {part:?}, but:\n{said}");
    }
    assert!(contents(folder) == before, "luminaire {words:?} changed a file");
}

/// Runs `luminaire`, which must do its work.
fn done(folder: &Folder, words: &[&str]) {
    let output = folder.luminaire(words).output().unwrap();
    assert!(output.status.success(), "luminaire {words:?} said:\n{}", stderr(&output));
}

const QUICK: [&str; 8] = ["render", "crate.obj", "--backend", "cpu", "--width", "8", "--spp", "2"];

fn render<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&QUICK, more].concat()
}

#[test]
fn a_render_spares_its_textures_by_every_name() {
    let folder = textured();
    let at = |name: &str| folder.path().join(name);
    std::fs::hard_link(at("crate.png"), at("hard.png")).unwrap();
    let absolute = at("crate.png").display().to_string();
    let round =
        format!("../{}/crate.png", folder.path().canonicalize().unwrap().file_name().unwrap().to_str().unwrap());
    let mut names =
        vec!["crate.png", "./crate.png", "sub/../crate.png", &absolute, &round, "hard.png", "rough.png", "unused.png"];
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("crate.png", at("soft.png")).unwrap();
        symlink("soft.png", at("softer.png")).unwrap();
        symlink(".", at("here")).unwrap();
        names.extend(["soft.png", "softer.png", "here/crate.png"]);
    }
    for name in names {
        refuses(&folder, &render(&["-o", name]), &[name, "a file of the scene"]);
        refuses(&folder, &render(&["-o", "other.png", "--error-map", name]), &["--error-map", name]);
    }
    // By the name that is taken where none is given.
    refuses(&folder, &QUICK, &["crate.png", "a file of the scene", "-o"]);
    done(&folder, &render(&["-o", "other.png", "-o", "sub/crate.png"]));
}

#[cfg(unix)]
#[test]
fn a_link_that_the_scene_names_is_spared_like_what_it_leads_to() {
    use std::os::unix::fs::symlink;
    let folder = textured();
    std::fs::rename(folder.path().join("crate.png"), folder.path().join("sub/real.png")).unwrap();
    symlink("sub/real.png", folder.path().join("crate.png")).unwrap();
    for name in ["crate.png", "sub/real.png"] {
        refuses(&folder, &render(&["-o", name]), &[name, "a file of the scene"]);
    }
    // A link that leads nowhere, to the place of another output.
    symlink("new.png", folder.path().join("dangling.png")).unwrap();
    refuses(&folder, &render(&["-o", "new.png", "-o", "dangling.png"]), &["new.png", "dangling.png", "twice"]);
}

#[test]
fn checkpoints_statistics_skies_and_scene_files() {
    let folder = textured();
    luminaire::picture::save_linear(&folder.path().join("sky.exr"), 2, 1, &[1.0; 6], 0.0).unwrap();
    folder.write("a.toml", "[environment]\nimage = \"sky.exr\"\n[[object]]\nmesh = \"crate.obj\"\n");
    std::fs::copy(folder.path().join("crate.obj"), folder.path().join("b.obj")).unwrap();
    let sky = ["render", "a.toml", "--backend", "cpu", "--width", "8", "--spp", "2"];
    refuses(&folder, &[&sky[..], &["-o", "sky.exr"]].concat(), &["sky.exr", "a file of the scene"]);
    refuses(
        &folder,
        &[&sky[..], &["-o", "a.png", "--checkpoint", "sky.exr", "--resume"]].concat(),
        &["--checkpoint sky.exr"],
    );
    // A texture that is damaged has been read, too.
    folder.write("crate.png", "no picture");
    refuses(&folder, &render(&["-o", "crate.png"]), &["a file of the scene"]);
    // One that is missing is not there to be lost.
    std::fs::remove_file(folder.path().join("crate.png")).unwrap();
    done(&folder, &render(&["-o", "crate.png"]));
    for (one, other) in [("--stats", "a.json"), ("--checkpoint", "a.exr")] {
        refuses(
            &folder,
            &render(&["-o", "b.png", one, other, "--error-map", "./b.png"]),
            &["-o b.png", "--error-map ./b.png", "twice"],
        );
    }
    refuses(&folder, &render(&["-o", "a.exr", "--checkpoint", "sub/../a.exr"]), &["-o a.exr", "--checkpoint", "twice"]);
}

#[test]
fn a_file_of_somebody_elses_is_not_replaced_by_a_name_that_nobody_gave() {
    let folder = Folder::new();
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "8", "--spp", "2"];
    folder.write("good.png", "precious");
    refuses(&folder, &words, &["good.png", "luminaire has not written", "-o"]);
    // Asked for, it is.
    done(&folder, &[&words[..], &["-o", "good.png"]].concat());
    let first = contents(&folder);
    // And then it is a file of our own.
    done(&folder, &[&words[..], &["--seed", "3"]].concat());
    assert!(image::open(folder.path().join("good.png")).is_ok() && first.len() == contents(&folder).len());
    image::RgbImage::new(2, 2).save(folder.path().join("good.png")).unwrap();
    refuses(&folder, &words, &["good.png"]);
}

#[test]
fn compare_merge_bench_and_stability_spare_what_they_read() {
    let folder = textured();
    std::fs::copy(folder.path().join("crate.png"), folder.path().join("b.png")).unwrap();
    for name in ["crate.png", "sub/../b.png"] {
        refuses(&folder, &["compare", "crate.png", "b.png", "--heatmap", name], &[name, "one of the pictures"]);
    }
    refuses(&folder, &["compare", "crate.png", "b.png", "--heatmap", "h.png", "--stats", "h.png"], &[".json"]);
    done(
        &folder,
        &render(&["--samples", "0..2", "-o", "p.exr"][..])
            .into_iter()
            .filter(|w| *w != "--spp" && *w != "2")
            .collect::<Vec<_>>(),
    );
    refuses(&folder, &["merge", "p.exr", "-o", "sub/../p.exr"], &["one of the parts"]);
    refuses(&folder, &["merge", "p.exr", "-o", "m.exr", "-o", "./m.exr"], &["twice"]);

    std::fs::create_dir(folder.path().join("bench")).unwrap();
    folder.write("bench/index.html", "precious");
    let bench = ["bench", "crate.obj", "--quick", "--backend", "cpu"];
    refuses(&folder, &bench, &["index.html", "--out"]);
    std::fs::remove_file(folder.path().join("bench/index.html")).unwrap();
    folder.write("bench/rays-mine.svg", "precious");
    refuses(&folder, &bench, &["rays-mine.svg", "--out"]);
    refuses(
        &folder,
        &[&bench[..], &["--out", "sub", "--page", "crate.mtl"]].concat(),
        &["--page crate.mtl", "a file of a scene"],
    );

    std::fs::create_dir(folder.path().join("stability")).unwrap();
    folder.write("stability/README.md", "precious");
    refuses(&folder, &["stability", "samples"], &["README.md", "--page"]);
    folder.write("sub/README.md", "precious");
    refuses(&folder, &["stability", "samples", "--out", "sub"], &["README.md", "--page"]);
}

#[test]
fn a_folder_names_none_of_the_files_in_it() {
    let folder = textured();
    let bench = ["bench", "crate.obj", "--quick", "--backend", "cpu", "--out", "."];
    let stability = ["stability", "samples", "--out", ".", "--page", "page.md"];
    let man = ["man", "."];
    let spared = |words: &[&str], name: &str| {
        folder.write(name, "precious");
        refuses(&folder, words, &[name, "luminaire has not written", "move the file away"]);
        std::fs::remove_file(folder.path().join(name)).unwrap();
    };
    for name in ["index.html", "figures.csv", "points.csv", "bench.json", "rays-mine.svg"] {
        spared(&bench, name);
    }
    for name in ["samples.csv", "samples-random.svg"] {
        spared(&stability, name);
    }
    for name in ["luminaire.1", "luminaire-render.1"] {
        spared(&man, name);
    }
    // Its own pages are replaced, unless they are protected.
    done(&folder, &man);
    done(&folder, &man);
    let page = folder.path().join("luminaire.1");
    let mut permissions = page.metadata().unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&page, permissions).unwrap();
    let output = folder.luminaire(&man).output().unwrap();
    assert!(output.status.code() == Some(1) && stderr(&output).contains("read-only"), "{}", stderr(&output));

    // A page in the place of a chart would be written over it.
    for page in ["rays-instances-bounce.svg", "sub/../rays-instances-bounce.svg"] {
        refuses(&folder, &[&bench[..], &["--page", page]].concat(), &["--page", page, "give another name"]);
    }
    let page = ["stability", "samples", "--out", ".", "--page", "samples-random.svg"];
    refuses(&folder, &page, &["--page", "samples-random.svg", "give another name"]);
}
