//! Files with lamps that lie on each other over a grey floor. Whatever they are cut into, they light the floor as one lamp does.

use glam::DVec3;
use luminaire::scene::{Scene, load};
use std::fmt::Write;

/// Radiance of the floor under the middle of the lamp, a square of half side 1 and radiance 2 at height 2: the albedo, times the radiance, times the
/// form factor of four rectangles of sides 1 and 1 over their corner (Lambert).
#[allow(dead_code)] // Not where scenes are only loaded.
pub fn expected() -> f64 {
    let x = 1.0f64 / 1.0f64.hypot(2.0);
    0.5 * 2.0 * 4.0 * x * x.atan() / std::f64::consts::PI
}

/// The corners of the lamp's square, and `usemtl lamp`.
const SQUARE: &str = "v -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\nusemtl lamp\n";
/// A side towards the floor, whose corners are counter-clockwise from below.
const DOWN: &str = "f -4 -3 -2 -1\n";

/// The lamp as a chess board of so many squares a side.
fn board(count: u32) -> String {
    let mut text = String::new();
    let at = |k: u32| 2.0 * f64::from(k) / f64::from(count) - 1.0;
    for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
        let (x, z, right, front) = (at(i), at(j), at(i + 1), at(j + 1));
        let _ = writeln!(text, "v {x} 2 {z}\nv {right} 2 {z}\nv {right} 2 {front}\nv {x} 2 {front}\nf -4 -3 -2 -1");
    }
    text
}

/// Name, meshes as text, and what follows in the scene file, of each way to say one lamp twice.
pub fn files() -> Vec<(&'static str, String, &'static str)> {
    let one_sided = "[[material]]\nname = \"lamp\"\none_sided = true\n";
    vec![
        ("single", format!("{SQUARE}{DOWN}"), ""),
        ("listed twice", format!("{SQUARE}{DOWN}{DOWN}"), ""),
        ("five times", format!("{SQUARE}{}", DOWN.repeat(5)), ""),
        ("double-sided", format!("{SQUARE}{DOWN}f -1 -2 -3 -4\n"), ""),
        ("reversed triangles", format!("{SQUARE}{DOWN}f -4 -2 -3\nf -4 -1 -2\n"), ""),
        ("other diagonal", format!("{SQUARE}{DOWN}f -3 -2 -1 -4\n"), ""),
        (
            "nearly the same place",
            format!("{SQUARE}{DOWN}v -1 2.000001 -1\nv 1 2 -1.000001\nv 1 1.999999 1\nv -1 2 1\n{DOWN}"),
            "",
        ),
        (
            "as far above as shadow rays round",
            format!("{SQUARE}{DOWN}v -1 2.000005 -1\nv 1 2.000005 -1\nv 1 2.000005 1\nv -1 2.000005 1\n{DOWN}"),
            "",
        ),
        ("cut finer", format!("{SQUARE}{DOWN}{}", board(4)), ""),
        ("cut finer first", format!("{SQUARE}{}v -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\n{DOWN}", board(3)), ""),
        (
            "shifted halves",
            "usemtl lamp\nv -1 2 -1\nv 0.5 2 -1\nv 0.5 2 1\nv -1 2 1\nf -4 -3 -2 -1\n\
             v -0.5 2 -1\nv 1 2 -1\nv 1 2 1\nv -0.5 2 1\nf -4 -3 -2 -1\n"
                .into(),
            "",
        ),
        ("placed twice", format!("{SQUARE}{DOWN}"), "[[object]]\nmesh = \"lamp.obj\"\n"),
        (
            "placed by another transform",
            format!("{SQUARE}{DOWN}"),
            "[[object]]\nmesh = \"lamp.obj\"\nrotate = [0, 90, 0]\nscale = [-1, 1, 1]\n",
        ),
        (
            "one-sided and placed twice",
            format!("{SQUARE}{DOWN}"),
            "[[object]]\nmesh = \"lamp.obj\"\n[[material]]\nname = \"lamp\"\none_sided = true\n",
        ),
        ("one-sided both ways", format!("{SQUARE}{DOWN}f -4 -2 -3\nf -4 -1 -2\n"), one_sided),
        ("one-sided both ways, other diagonal", format!("{SQUARE}{DOWN}f -1 -2 -3 -4\n"), one_sided),
        (
            "one-sided, another lamp at its back",
            format!("{SQUARE}{DOWN}usemtl up\nf -4 -2 -3\nf -4 -1 -2\n"),
            "[[material]]\nname = \"lamp\"\none_sided = true\n[[material]]\nname = \"up\"\nemission = [9, 9, 9]\none_sided = true\n",
        ),
        (
            "another light in its place",
            format!("{SQUARE}{DOWN}usemtl up\n{DOWN}"),
            "[[material]]\nname = \"up\"\nemission = [9, 9, 9]\n",
        ),
        (
            "another light in its place, other diagonal",
            format!("{SQUARE}{DOWN}usemtl up\nf -3 -2 -1 -4\n"),
            "[[material]]\nname = \"up\"\nemission = [9, 9, 9]\n",
        ),
        (
            "another light that reaches beyond",
            format!(
                "usemtl lamp\nv -1 2 -1\nv 0.5 2 -1\nv 0.5 2 1\nv -1 2 1\n{DOWN}{}{DOWN}",
                SQUARE.replace("lamp", "alike")
            ),
            "",
        ),
        (
            "another light around it",
            format!(
                "usemtl lamp\nv -0.5 2 -0.5\nv 0.5 2 -0.25\nv 0.5 2 0.5\nv -0.5 2 0.5\n{DOWN}{}{DOWN}",
                SQUARE.replace("lamp", "alike")
            ),
            "",
        ),
        (
            "another light around it, of two halves",
            format!(
                "usemtl lamp\nv -0.5 2 -0.5\nv 0.5 2 -0.5\nv 0.5 2 0.5\nv -0.5 2 0.5\n{DOWN}usemtl alike\nv -1 2 -1\nv 0.25 2 -1\nv 0.25 2 1\nv -1 2 1\n\
                 {DOWN}v 0 2 -1\nv 1 2 -1\nv 1 2 1\nv 0 2 1\n{DOWN}"
            ),
            "",
        ),
        ("a black face in its place", format!("{}usemtl black\n{DOWN}usemtl lamp\n{DOWN}", SQUARE), ""),
        (
            "in the plane of a ceiling",
            format!("v -3 2 -3\nv 3 2 -3\nv 3 2 3\nv -3 2 3\nusemtl black\nf -4 -3 -2 -1\n{SQUARE}{DOWN}"),
            "",
        ),
        (
            "one-sided, in the plane of a ceiling",
            format!("v -3 2 -3\nv 3 2 -3\nv 3 2 3\nv -3 2 3\nusemtl black\nf -4 -3 -2 -1\n{SQUARE}{DOWN}"),
            one_sided,
        ),
    ]
}

/// The scene of such a file: a pixel of the floor under the lamp.
pub fn scene(mesh: &str, more: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write(
        "m.mtl",
        "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 2 2 2\nnewmtl alike\nKd 0 0 0\nKa 0.5 0.5 0.5\nKe 2 2 2\n",
    );
    write("floor.obj", "mtllib m.mtl\nv -4 0 -4\nv 4 0 -4\nv 4 0 4\nv -4 0 4\nusemtl floor\nf 4 3 2 1\n");
    write("lamp.obj", &format!("mtllib m.mtl\n{mesh}"));
    let sensor =
        "[sensor]\nposition = [0, 0.5, 0.001]\ntarget = [0, 0, 0]\nfov = 0.15\n[film]\nwidth = 4\nheight = 4\n";
    let objects = "[[object]]\nmesh = \"floor.obj\"\n[[object]]\nmesh = \"lamp.obj\"\n";
    write("scene.toml", &format!("{sensor}{objects}{more}"));
    load(&folder.path().join("scene.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// A white lamp of side 1 and radiance 1 in the plane of a black ceiling of this half side, both tilted, and a sensor that sees the lamp alone.
#[allow(dead_code)] // Not in every program of tests.
pub fn in_a_large_ceiling(half: f64) -> Scene {
    let u = DVec3::new(0.93, 0.25, 0.26).normalize();
    let v = u.cross(DVec3::new(0.36, -0.64, -0.67)).normalize();
    let normal = u.cross(v);
    let centre = DVec3::new(0.65, -0.4, 0.73);
    let square = |half: f64, material: &str| {
        let mut text = format!("mtllib m.mtl\nusemtl {material}\n");
        for (x, y) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
            let DVec3 { x, y, z } = centre + u * x + v * y;
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        text + "f 1 2 3 4\n"
    };
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("m.mtl", "newmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n");
    write("lamp.obj", &square(0.5, "lamp"));
    write("ceiling.obj", &square(half, "black"));
    let eye = centre + 2.0 * normal;
    write(
        "scene.toml",
        &format!(
            "[sensor]\nposition = {:?}\ntarget = {:?}\nfov = 20\n[film]\nwidth = 16\nheight = 16\n\
             [[object]]\nmesh = \"lamp.obj\"\n[[object]]\nmesh = \"ceiling.obj\"\n",
            eye.to_array(),
            centre.to_array()
        ),
    );
    load(&folder.path().join("scene.toml")).unwrap_or_else(|error| panic!("{error}"))
}
