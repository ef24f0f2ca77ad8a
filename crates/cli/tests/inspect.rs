//! `luminaire inspect`: what was loaded, and what was not.

mod common;

use common::{Folder, stderr};
use std::process::Command;

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
        let output = folder.luminaire(&["inspect", "a.obj", "--ground", "off"]).output().unwrap();
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

/// Both kinds of surface are in one table, and how an MTL file was read is said among what was chosen.
#[test]
fn inspect_lists_metallic_roughness_surfaces() {
    let folder = Folder::new();
    folder.write("a.ppm", "P3\n1 1\n255\n128 64 32\n");
    let words = "newmtl m\nNs 250\nKa 1 1 1\nKd .5 .25 1\nKs .5 .5 .5\nKe 0 0 0\nNi 1.5\nd 1\nillum 3\nmap_Ns a.ppm\n";
    folder.write(
        "m.mtl",
        &format!("# Blender 5.0.1 MTL File: 'None'\n{words}newmtl n\nKd 1 1 1\nPr .25\nPs 1\nTf 1 1 1\n"),
    );
    let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\nusemtl n\nf 1/1 3/1 2/1\n";
    folder.write("m.obj", &format!("mtllib m.mtl\n{faces}"));
    let output = folder.luminaire(&["inspect", "m.obj"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    for part in [
        "metallic-roughness: base colour (0.5 0.25 1), metallic 1, roughness 1; roughness map a.ppm, red",
        "roughness 0.25, index 1.5; transmission 1; sheen (1 1 1) of roughness 0.5",
        "m.mtl: written by Blender",
    ] {
        assert!(said.contains(part), "{part} is not in\n{said}{}", stderr(&output));
    }
}

/// Of each surface what means something for it: a metal by its name, and no map that nobody set.
#[test]
fn inspect_says_of_a_surface_what_counts() {
    let folder = Folder::new();
    folder.write("a.ppm", "P3\n1 1\n255\n128 64 32\n");
    folder.write("m.mtl", "newmtl metal\nPr .25\nnewmtl half\nPm .5\nnewmtl own\nPm 1\nnewmtl wood\nmap_Kd a.ppm\nPr .5\nnewmtl old\nmap_Kd a.ppm\n");
    let faces = ["metal", "half", "own", "wood", "old"].map(|name| format!("usemtl {name}\nf 1/1 2/1 3/1\n")).concat();
    folder.write("m.obj", &format!("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n{faces}"));
    let table = |name: &str, lines: &str| format!("[[material]]\nname = \"{name}\"\n{lines}\n");
    let text = "[[object]]\nmesh = \"m.obj\"\n".to_owned()
        + &table("metal", "conductor = \"copper\"")
        + &table("half", "conductor = \"gold\"\nmetallic = 0.5")
        + &table("own", "conductor = { eta = [1, 2, 3], k = [4, 5, 6] }");
    folder.write("m.toml", &text);
    let output = folder.luminaire(&["inspect", "m.toml"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    for part in [
        "metallic-roughness: metallic 1, roughness 0.25; conductor copper\n",
        "metallic-roughness: base colour (0.8 0.8 0.8), metallic 0.5, roughness 0.5, index 1.5; conductor gold\n",
        "metallic-roughness: metallic 1, roughness 0.5; conductor of index (1 2 3), extinction (4 5 6)\n",
        "index 1.5; base colour map a.ppm\n",
        "  diffuse map a.ppm\n",
    ] {
        assert!(said.contains(part), "{part} is not in\n{said}{}", stderr(&output));
    }
    assert!(!said.contains("ambient map"), "{said}");
    folder.write("m.mtl", "newmtl metal\nmap_Kd a.ppm\nmap_Ka a.ppm\nKa .5 .5 .5\n");
    let output = folder.luminaire(&["inspect", "m.obj"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("diffuse map a.ppm; ambient map a.ppm"), "{said}");
}

/// The bounds are those of what is seen, not those of a box that was turned with it.
#[test]
fn inspect_tells_the_bounds_of_what_is_turned() {
    let folder = Folder::new();
    folder.write("diamond.obj", "v 0 0 0\nv 1 1 0\nv 0 2 0\nv -1 1 0\nv 9 9 9\nf 1 2 3 4\n");
    let sensor = "[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40\n";
    let place = "rotate = [0, 0, 45]\ntranslate = [1, 0, 0.5]\n";
    folder.write("turned.toml", &format!("{sensor}[[object]]\nmesh = \"diamond.obj\"\n{place}"));
    let output = folder.luminaire(&["inspect", "turned.toml"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("[-0.4142, 0.0000, 0.5000] to [1.0000, 1.4142, 0.5000]"), "{said}{}", stderr(&output));
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

/// What single precision can draw depends on the size that was asked for, not on the scene's.
#[test]
fn a_picture_is_judged_by_the_size_that_is_asked_for() {
    let folder = Folder::new();
    folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let sensor = "[sensor]\nkind = \"orthographic\"\nposition = [0.5, 0.5, 5]\ntarget = [0.5, 0.5, 0]\nheight = 0.05\n";
    let objects = "[[object]]\nmesh = \"t.obj\"\n[[object]]\nmesh = \"t.obj\"\ntranslate = [100, 0, 0]\n";
    folder.write("s.toml", &format!("{sensor}[environment]\nradiance = [1, 1, 1]\n{objects}"));
    for (height, blurred) in [("16", false), ("60000", true)] {
        let output = folder.luminaire(&["inspect", "s.toml", "--width", "16", "--height", height]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(said.contains("single precision"), blurred, "{height}: {said}");
    }
}
