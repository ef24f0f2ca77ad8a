//! Bodies of glass that are not closed, or not wound one way, are named; those that are right are not.

use super::*;
use std::fmt::Write;

const GLASS: &str = "newmtl g\nKd 0 0 0\nillum 7\nNi 1.5\nnewmtl tinted\nKd 0 0 0\nTf 0.5 1 0.5\nillum 7\nNi 1.5\n\
                     newmtl water\nKd 0 0 0\nillum 7\nNi 1.33\nnewmtl between\nKd 0 0 0\nillum 7\nNi 0.887\n\
                     newmtl lid\nKd 0.5 0.5 0.5\n";

/// Corners of a box, as vertices.
fn corners(low: [f32; 3], high: [f32; 3]) -> String {
    let mut text = String::new();
    for i in 0..8 {
        let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        writeln!(text, "v {} {} {}", pick(0), pick(1), pick(2)).expect("a string");
    }
    text
}

/// The faces of a box whose first corner is vertex `first`: -z, +z, -y, +y, -x, +x, outwards.
fn faces(first: usize) -> [Vec<usize>; 6] {
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.map(|face| face.iter().map(|corner| first + corner).collect())
}

fn written<'a>(faces: impl IntoIterator<Item = &'a Vec<usize>>) -> String {
    faces
        .into_iter()
        .fold(String::new(), |text, face| text + "f" + &face.iter().map(|v| format!(" {v}")).collect::<String>() + "\n")
}

fn reversed(faces: &[Vec<usize>]) -> Vec<Vec<usize>> {
    faces.iter().map(|face| face.iter().rev().copied().collect()).collect()
}

const UNIT: ([f32; 3], [f32; 3]) = ([0.0; 3], [1.0; 3]);

/// Warnings about glass of an OBJ with this text; that of a metallic-roughness surface has the same. (Of one body to another within it the index may be below
/// 1, which such a surface cannot have.)
fn warnings(text: &str) -> Vec<String> {
    let text = format!("mtllib g.mtl\nusemtl g\n{text}");
    let of = |mtl: &str| {
        let scene = Folder::new().with("mesh.obj", &text).with("g.mtl", mtl).load("mesh.obj");
        scene.warnings.into_iter().filter(|warning| warning.contains("glass")).collect::<Vec<_>>()
    };
    let smooth = of(GLASS);
    if !text.contains("between") {
        assert_eq!(of(&GLASS.replace("illum 7", "illum 7\nPr 0.25")), smooth, "rough");
    }
    smooth
}

#[track_caller]
fn silent(text: &str) {
    assert_eq!(warnings(text), Vec::<String>::new());
}

#[track_caller]
fn named(text: &str, words: &[&str]) {
    let warnings = warnings(text);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(words.iter().all(|word| warnings[0].contains(word)), "{warnings:?}");
}

fn unit() -> String {
    corners(UNIT.0, UNIT.1)
}

/// The faces of the unit box, one of them with a vertex more, at the middle of an edge but for `off`.
fn middle(off: f32) -> String {
    let cube = faces(1);
    format!("v 0.5 {off} 0\n")
        + &written(&cube[1..2])
        + &written(&cube[3..])
        + "f 1 9 6\nf 9 2 6\nf 1 6 5\n"
        + &written(&cube[..1])
}

#[test]
fn closed_bodies_are_not_warned_of() {
    let cube = faces(1);
    silent(&(unit() + &written(&cube)));
    // Vertices split: each face has its own.
    let v = |i: usize| unit().lines().nth(i - 1).expect("a corner").to_owned() + "\n";
    let split = cube.iter().flatten().map(|corner| v(*corner)).collect::<String>();
    silent(&(split + &written(&(0..6).map(|f| (4 * f + 1..4 * f + 5).collect()).collect::<Vec<Vec<usize>>>())));
    // Two materials of one index on one body, and an opaque lid.
    silent(&(unit() + &written(&cube[..3]) + "usemtl tinted\n" + &written(&cube[3..])));
    silent(&(unit() + &written(&cube[..5]) + "usemtl lid\n" + &written(&cube[5..])));
    // Two boxes that share an edge.
    silent(&(unit() + &corners([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]) + &written(&cube) + &written(&faces(9))));
    // A vertex in the middle of an edge, on one side alone.
    silent(&(unit() + &middle(0.0)));
    // A hollow: inwards, within glass.
    let hollow = reversed(&faces(9));
    silent(&(unit() + &corners([0.25; 3], [0.75; 3]) + &written(&cube) + &written(&hollow)));
    // Water in the hollow, in one piece with it or apart.
    let water = corners([0.375; 3], [0.625; 3]) + "usemtl water\n" + &written(&faces(17));
    silent(&(unit() + &corners([0.25; 3], [0.75; 3]) + &written(&cube) + &written(&hollow) + &water));
    // Wound inwards as a whole, but with vertex normals that point outwards.
    let normals = cube.iter().flatten().map(|_| "").collect::<String>() + &normals(1.0);
    let with_normals: String = reversed(&cube)
        .iter()
        .map(|face| "f".to_owned() + &face.iter().map(|v| format!(" {v}//{v}")).collect::<String>() + "\n")
        .collect();
    silent(&(unit() + &normals + &with_normals));
}

/// A normal for each corner of the unit box.
fn normals(sign: f32) -> String {
    corners([-sign; 3], [sign; 3]).replace("v ", "vn ")
}

/// Glass beside water that share a face of which the index is that from one to the other.
#[test]
fn glass_and_water_that_share_a_face_are_closed() {
    let (left, right) = (faces(1), faces(9));
    let positions = unit() + &corners([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]);
    let water = "usemtl water\n".to_owned() + &written([&right[0], &right[1], &right[2], &right[3], &right[5]]);
    // From glass (1.5) outwards into water: 1.5 / 1.33 behind the surface over in front; or turned around, 0.887.
    let between = "usemtl between\n".to_owned() + &written(&reversed(&left[5..]));
    silent(&(positions.clone() + &written(&left[..5]) + &water + &between));
    named(&(positions + &written(&left[..5]) + &water), &["`g`, `water`", "4 edges between faces"]);
}

#[test]
fn bodies_that_are_not_closed_are_named() {
    let cube = faces(1);
    named(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        &["object `mesh", "material `g`", "4 open edges", "if it is a pane, state `thin = true`"],
    );
    // A cap left out; a hole.
    named(&(unit() + &written(&cube[..5])), &["4 open edges", "close it"]);
    // A face turned.
    named(
        &(unit() + &written(&cube[..5]) + &written(&reversed(&cube[5..]))),
        &["4 edges between faces that are wound"],
    );
    // Two indices on one body.
    named(&(unit() + &written(&cube[..5]) + "usemtl water\n" + &written(&cube[5..])), &["`g`, `water`", "4 edges"]);
    // Everything twice: alike, and turned around.
    named(&(unit() + &written(&cube) + &written(&cube)), &["24 faces that lie on each other"]);
    named(&(unit() + &written(&cube) + &written(&reversed(&cube))), &["24 faces that lie on each other"]);
    // The other diagonal of a square, either way around.
    let other = |face: &[usize]| vec![face[1], face[2], face[3], face[0]];
    let others: Vec<_> = cube.iter().map(|face| other(face)).collect();
    named(&(unit() + &written(&cube) + &written(&others)), &["24 faces that lie on each other"]);
    named(&(unit() + &written(&cube) + &written(&reversed(&others))), &["24 faces that lie on each other"]);
    // A pane with two sides in one place.
    let pane = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 4 3 2\n";
    named(pane, &["4 faces that lie on each other", "thin = true"]);
    // A vertex beside the middle of an edge, on one side alone: a gap.
    named(&(unit() + &middle(0.01)), &["3 open edges"]);
    // A pane in a wall.
    named(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nusemtl lid\nf 2 5 6 3\n",
        &["3 open edges", "thin = true"],
    );
}

#[test]
fn bodies_that_are_inside_out_are_named() {
    let inwards = reversed(&faces(1));
    named(&(unit() + &written(&inwards)), &["a body of glass (`g`) is inside out"]);
    // Beside a right one, which does not hold it.
    let other = corners([2.0; 3], [3.0; 3]) + &written(&faces(9));
    named(&(unit() + &written(&inwards) + &other), &["a body of glass (`g`) is inside out"]);
    // Half of the faces against their vertex normals, which are right.
    let mixed: String = (reversed(&faces(1)[..3]).iter().chain(&faces(1)[3..]))
        .map(|face| "f".to_owned() + &face.iter().map(|v| format!(" {v}//{v}")).collect::<String>() + "\n")
        .collect();
    named(&(unit() + &normals(1.0) + &mixed), &["6 of 12 faces of glass (`g`) are wound against their vertex normals"]);
}

#[test]
fn other_objects_may_hold_a_hollow_and_one_body_may_not_stand_twice() {
    let files = || {
        Folder::new()
            .with("g.mtl", GLASS)
            .with("cube.obj", format!("mtllib g.mtl\nusemtl g\n{}{}", unit(), written(&faces(1))))
            .with("hollow.obj", format!("mtllib g.mtl\nusemtl g\n{}{}", unit(), written(&reversed(&faces(1)))))
    };
    let glass = |text: &str| {
        let scene = files().with("scene.toml", format!("{SENSOR}{LIGHT}{text}")).load("scene.toml");
        scene.warnings
    };
    let cube = "[[object]]\nmesh = \"cube.obj\"\n";
    let hollow = "[[object]]\nmesh = \"hollow.obj\"\nscale = 0.5\ntranslate = [0.25, 0.25, 0.25]\n";
    assert_eq!(glass(&format!("{cube}{hollow}")), Vec::<String>::new());
    assert_eq!(glass(&format!("{cube}translate = [2, 0, 0]\n{cube}")), Vec::<String>::new());
    let alone = glass(hollow);
    assert!(alone.len() == 1 && alone[0].contains("inside out"), "{alone:?}");
    let twice = glass(&format!("{cube}{cube}name = \"copy\"\n"));
    assert!(twice.len() == 1 && twice[0].contains("objects `cube` and `copy` are the same body of glass"), "{twice:?}");
    // What is said of a material counts, not what its file says.
    let thin = "[[material]]\nname = \"g\"\nthin = true\n";
    assert_eq!(glass(&format!("{hollow}{thin}")), Vec::<String>::new());
}

/// A scene of OBJs in glass, each with its part of the text of an `[[object]]`; what is warned of.
fn parts(objects: &[(&str, &str, &str)], more: &str) -> Vec<String> {
    let mut folder = Folder::new().with("g.mtl", GLASS);
    let mut scene = format!("{SENSOR}{LIGHT}{more}");
    for (name, mesh, place) in objects {
        folder = folder.with(&format!("{name}.obj"), format!("mtllib g.mtl\nusemtl g\n{mesh}"));
        write!(scene, "[[object]]\nmesh = \"{name}.obj\"\n{place}\n").expect("a string");
    }
    folder.with("scene.toml", scene).load("scene.toml").warnings
}

/// All but the lid of the unit box (x = 1), and the lid.
fn box_and_lid() -> (String, String) {
    let cube = faces(1);
    (unit() + &written(&cube[..5]), unit() + &written(&cube[5..]))
}

#[test]
fn parts_of_a_body_may_stand_in_several_objects() {
    let (open, lid) = box_and_lid();
    let none = Vec::<String>::new();
    assert_eq!(parts(&[("box", &open, ""), ("lid", &lid, "")], ""), none);
    // Each with its own rounding: turned, scaled, moved, and the lid made elsewhere in other units.
    let turned = "rotate = [17, 31, 47]\nscale = 0.37\ntranslate = [3.3, 2.7, -5.1]";
    assert_eq!(parts(&[("box", &open, turned), ("lid", &lid, turned)], ""), none);
    let large: String = corners([0.0; 3], [1000.0; 3]) + &written(&faces(1)[5..]);
    let of_large = turned.replace("0.37", "0.00037");
    assert_eq!(parts(&[("box", &open, turned), ("lid", &large, &of_large)], ""), none);
    // Six decimals of something small.
    let small = corners([0.0; 3], [0.033_333; 3]) + &written(&faces(1)[..5]);
    let small_lid = corners([0.0; 3], [0.033_333_4; 3]) + &written(&faces(1)[5..]);
    assert_eq!(parts(&[("box", &small, ""), ("lid", &small_lid, "")], ""), none);
    // Mirrored: the lid of x = 0 is that of x = 1 seen in a mirror.
    let other_side = unit() + &written(faces(1).iter().enumerate().filter(|(i, _)| *i != 4).map(|(_, face)| face));
    let mirrored = "scale = [-1, 1, 1]\ntranslate = [1, 0, 0]";
    assert_eq!(parts(&[("box", &other_side, ""), ("lid", &lid, mirrored)], ""), none);
    // The lid is one face, the box has a corner in the middle of an edge of it; or the lid in two halves, in two objects.
    let halves = "v 1 0.5 0\nv 1 0.5 1\n";
    let low = unit() + halves + "f 2 9 10 6\n";
    let high = unit() + halves + "f 9 4 8 10\n";
    assert_eq!(parts(&[("box", &open, ""), ("low", &low, ""), ("high", &high, "")], ""), none);
    // Six faces in six objects.
    let six: Vec<String> = faces(1).iter().map(|face| unit() + &written([face])).collect();
    let names = ["a", "b", "c", "d", "e", "f"];
    let six: Vec<_> = names.iter().zip(&six).map(|(name, mesh)| (*name, mesh.as_str(), "")).collect();
    assert_eq!(parts(&six, ""), none);
    // A lid of another material, that is no glass, in another object.
    let wood = "material = \"lid\"";
    assert_eq!(parts(&[("box", &open, ""), ("lid", &lid, wood)], ""), none);
    // Water and glass that share a face, each in its object, and the face in a third.
    let (left, right) = (faces(1), faces(9));
    let positions = unit() + &corners([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]);
    let water =
        positions.clone() + "usemtl water\n" + &written([&right[0], &right[1], &right[2], &right[3], &right[5]]);
    let between = positions.clone() + "usemtl between\n" + &written(&reversed(&left[5..]));
    let glass = positions + &written(&left[..5]);
    assert_eq!(parts(&[("glass", &glass, ""), ("water", &water, ""), ("between", &between, "")], ""), none);
}

#[test]
fn parts_that_do_not_close_a_body_are_named_once() {
    let (open, lid) = box_and_lid();
    let one = |objects: &[(&str, &str, &str)], words: &[&str]| {
        let warnings = parts(objects, "");
        assert!(warnings.len() == 1 && words.iter().all(|word| warnings[0].contains(word)), "{warnings:?}");
    };
    // A lid that is turned, or of another index: no pane.
    let turned = unit() + &written(&reversed(&faces(1)[5..]));
    one(&[("box", &open, ""), ("lid", &turned, "")], &["object `box` (box.obj), with `lid`", "4 edges between faces"]);
    let water = "material = \"water\"";
    one(&[("box", &open, ""), ("lid", &lid, water)], &["with `lid`: the glass of material `g`, `water`", "4 edges"]);
    // The second instance has no lid.
    let away = "translate = [3, 0, 0]";
    one(
        &[("box", &open, &format!("[[object]]\nname = \"far\"\nmesh = \"box.obj\"\n{away}")), ("lid", &lid, "")],
        &["object `far` (box.obj)", "4 open edges"],
    );
    // A gap that can be seen.
    let warnings = parts(&[("box", &open, ""), ("lid", &lid, "translate = [0.001, 0, 0]")], "");
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    // Two halves of a pane are a pane.
    let half = |low: f32, high: f32| corners([low, 0.0, 0.0], [high, 1.0, 0.0]) + "f 1 2 4 3\n";
    let warnings = parts(&[("left", &half(0.0, 1.0), ""), ("right", &half(1.0, 2.0), "")], "");
    assert!(
        warnings.len() == 2 && warnings.iter().all(|w| w.contains("3 open edges") && w.contains("a pane")),
        "{warnings:?}"
    );
    // Inside out, all together.
    let (inner, inner_lid) = (reversed(&faces(1)[..5]), reversed(&faces(1)[5..]));
    let (inner, inner_lid) = (unit() + &written(&inner), unit() + &written(&inner_lid));
    one(&[("box", &inner, ""), ("lid", &inner_lid, "")], &["a body of glass (`g`) is inside out"]);
    // But a hollow of two objects, in a body of two.
    let within = "scale = 0.5\ntranslate = [0.25, 0.25, 0.25]";
    let hollow = [("box", &*open, ""), ("lid", &*lid, ""), ("hollow", &*inner, within), ("plug", &*inner_lid, within)];
    assert_eq!(parts(&hollow, ""), Vec::<String>::new());
}

#[test]
fn bodies_that_reach_through_each_other_are_named_once() {
    let cube = unit() + &written(&faces(1));
    // What touches is drawn apart, which is another warning.
    let parts = |objects: &[(&str, &str, &str)]| {
        parts(objects, "").into_iter().filter(|w| !w.contains("drawn in there by a hair")).collect::<Vec<_>>()
    };
    let two = |place: &str| parts(&[("a", &cube, ""), ("b", &cube, place)]);
    let said = |warnings: &[String], words: &[&str]| {
        assert!(warnings.len() == 1 && words.iter().all(|word| warnings[0].contains(word)), "{warnings:?}");
    };
    let of_both = "objects `a`, `b`: bodies of glass (`g`) reach through each other's surface";
    for place in [
        "translate = [0.5, 0.25, 0.125]",
        // Faces in one plane.
        "translate = [0.5, 0, 0]",
        "translate = [0.99, 0, 0]",
        "rotate = [20, 30, 40]",
        "scale = [-1, 1, 1]\ntranslate = [1.5, 0.2, 0.2]",
        // Crossing bars: no corner of either is within the other.
        "scale = [5, 0.2, 0.2]\ntranslate = [-2, 0.4, 0.4]",
        "scale = [5, 0.2, 1]\ntranslate = [-2, 0.4, 0]",
    ] {
        said(&two(place), &[of_both, "1.500 times 1.500"]);
    }
    let bars = [("a", &*cube, "scale = [8, 0.2, 0.2]"), ("b", &*cube, "scale = [8, 0.2, 0.2]\nrotate = [0, 10, 40]")];
    said(&parts(&bars), &["reach through"]);
    // In one mesh; of two materials; several pairs.
    let shifted = corners([0.5; 3], [1.5; 3]) + "usemtl water\n" + &written(&faces(9));
    named(&(unit() + &written(&faces(1)) + &shifted), &["two bodies of glass (`g`, `water`)", "1.500 times 1.330"]);
    let places = ["", "translate = [0.5, 0.3, 0.3]", "translate = [0.3, 0.6, 0.6]"];
    let three = [("a", &*cube, places[0]), ("b", &cube, places[1]), ("c", &cube, places[2])];
    said(&parts(&three), &["(and 2 more pairs)"]);
    // A part of a body that several objects close.
    let (open, lid) = box_and_lid();
    let water = "material = \"water\"\ntranslate = [0.5, 0.3, 0.3]";
    said(&parts(&[("box", &open, ""), ("lid", &lid, ""), ("water", &cube, water)]), &["`water`", "1.330"]);
    // The same body in another file, in the same place.
    said(&two(""), &["objects `a`, `b`", "lie on each other"]);
    said(&two("scale = [-1, 1, 1]\ntranslate = [1, 0, 0]"), &["lie on each other"]);

    let none = Vec::<String>::new();
    for place in [
        // Apart, nested, and nested with a side in common.
        "translate = [1.1, 0, 0]",
        "scale = 0.5\ntranslate = [0.25, 0.25, 0.25]",
        "scale = 0.5\ntranslate = [0, 0, 0]",
        // A side, a part of a side, an edge, a corner in common.
        "translate = [1, 0, 0]",
        "translate = [1, 0.5, 0.5]",
        "translate = [1, 1, 0]",
        "translate = [1, 1, 1]",
        "translate = [0.99999, 0, 0]",
    ] {
        assert_eq!(two(place), none, "{place}");
    }
    // A part of a side in common, but for the rounding of what was made in other units and is turned.
    let turned = "rotate = [17, 31, 47]\nscale = 0.37\ntranslate = [3.3, 2.7, -5.1]";
    let large = corners([1000.0, 200.0, 100.0], [2000.0, 700.0, 900.0]) + &written(&faces(1));
    let of_large = turned.replace("0.37", "0.00037");
    assert_eq!(parts(&[("a", &cube, turned), ("b", &large, &of_large)]), none);
    // Their boxes overlap, and they do not: one stands on its corner beside the other.
    let beside = "rotate = [0, 0, 45]\ntranslate = [1.1, 0.95, 0]";
    assert_eq!(two(beside), none);
    // A glass of thick walls: water that just fills it, and water that reaches into the wall.
    let (hollow, fill) = (unit() + &written(&reversed(&faces(1))), unit() + &written(&faces(1)));
    let within = "scale = [0.6, 0.6, 0.6]\ntranslate = [0.2, 0.2, 0.2]";
    let glass = [("outer", &*cube, ""), ("inner", &*hollow, within)];
    let water = format!("material = \"water\"\n{within}");
    assert_eq!(parts(&[glass[0], glass[1], ("water", &fill, &water)]), none);
    let wide = "material = \"water\"\nscale = [0.7, 0.3, 0.7]\ntranslate = [0.15, 0.3, 0.15]";
    said(&parts(&[glass[0], glass[1], ("water", &fill, wide)]), &["`inner`, `water`", "1.500 times 1.330"]);
}

#[test]
fn a_camera_within_glass_is_warned_of() {
    let at = |objects: &[(&str, &str, &str)], place: &str| {
        let mut folder = Folder::new().with("g.mtl", GLASS);
        let mut scene = SENSOR.replace("position = [0, 0, 5]", &format!("position = {place}")) + LIGHT;
        assert!(scene.contains(place), "{scene}");
        for (name, mesh, place) in objects {
            folder = folder.with(&format!("{name}.obj"), format!("mtllib g.mtl\nusemtl g\n{mesh}"));
            write!(scene, "[[object]]\nmesh = \"{name}.obj\"\n{place}\n").expect("a string");
        }
        folder.with("scene.toml", scene).load("scene.toml").warnings
    };
    let (open, lid) = box_and_lid();
    let whole = unit() + &written(&faces(1));
    let inside = "[0.4, 0.45, 0.55]";
    let said = |objects: &[(&str, &str, &str)], words: &[&str]| {
        let warnings = at(objects, inside);
        assert!(warnings.len() == 1 && words.iter().all(|word| warnings[0].contains(word)), "{warnings:?}");
    };
    said(
        &[("ball", &whole, "")],
        &["camera stands within glass", "1.500 (`ball`)", "2.250 times as bright", "-1.17 stops"],
    );
    said(&[("pool", &whole, "material = \"water\"")], &["index 1.330", "1.769 times"]);
    said(&[("box", &open, ""), ("lid", &lid, "")], &["1.500", "`box`, `lid`"]);
    said(&[("ball", &whole, "scale = [-3, 3, 3]\ntranslate = [2, -1, -1]")], &["1.500"]);
    let none = Vec::<String>::new();
    assert_eq!(at(&[("ball", &whole, "")], "[0.4, 0.45, 1.01]"), none);
    assert_eq!(at(&[("ball", &whole, "material = \"lid\"")], inside), none);
    // A housing: a hollow around the camera, in one object or another.
    let hollow = unit() + &written(&reversed(&faces(1)));
    assert_eq!(
        at(&[("pool", &whole, ""), ("housing", &hollow, "scale = 0.5\ntranslate = [0.25, 0.25, 0.25]")], inside),
        none
    );
}

#[test]
fn a_thin_material_without_transmission_is_warned_of() {
    let warnings = scene("[[material]]\nname = \"default\"\nthin = true\n").load("scene.toml").warnings;
    assert_eq!(warnings, ["material `default`: `thin` does nothing without `transmission`"]);
}
