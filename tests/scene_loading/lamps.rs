//! Lamps that lie on each other.

use super::*;
use luminaire::scene::{EmissiveTriangle, LuminaireTable, SampledLuminaire};

#[path = "../common/lamps.rs"]
mod files;

fn emissive(scene: &Scene) -> Vec<EmissiveTriangle> {
    let entries = LuminaireTable::new(scene).entries;
    entries.into_iter().filter_map(|entry| if let SampledLuminaire::Area(t) = entry { Some(t) } else { None }).collect()
}

/// How much area shines downwards, each place once.
#[test]
fn each_way_to_say_a_lamp_twice_leaves_one_and_a_warning() {
    for (name, mesh, more) in files::files() {
        let scene = files::scene(&mesh, more);
        let down = |t: &EmissiveTriangle| !scene.materials[t.material as usize].one_sided || t.normal.y < 0.0;
        let area: f64 = emissive(&scene).iter().filter(|t| down(t)).map(EmissiveTriangle::area).sum();
        assert!((area - 4.0).abs() < 1e-4, "{name}: {area}");
        let expected = usize::from(name != "single");
        assert_eq!(scene.warnings.len(), expected, "{name}: {:?}", scene.warnings);
    }
}

#[test]
fn the_warning_says_how_many_and_where() {
    let find = |name: &str| files::files().into_iter().find(|(file, ..)| *file == name).expect(name);
    for (name, words) in [
        ("double-sided", &["2 triangle(s)", "same light", "dropped", "object `lamp`", "material `lamp`", "2.0"][..]),
        ("cut finer first", &["2 triangle(s)", "dropped"]),
        ("shifted halves", &["4 triangle(s)", "cut anew"]),
        ("placed twice", &["2 triangle(s)", "dropped"]),
        ("one-sided both ways", &["2 triangle(s)", "both ways"]),
        ("another light in its place", &["2 triangle(s)", "`up`", "`lamp` shows"]),
        ("a black face in its place", &["2 triangle(s)", "do not emit", "`black`"]),
        ("in the plane of a ceiling", &["2 triangle(s)", "do not emit", "moved off"]),
    ] {
        let (_, mesh, more) = find(name);
        let scene = files::scene(&mesh, more);
        warned(&scene, words);
    }
}

/// An instance that lies on nothing keeps the mesh that another one has to give up.
#[test]
fn instances_elsewhere_keep_their_lamps() {
    let lamp = "mtllib mesh.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf 4 5 6\n";
    let at = |x: f64| format!("[[object]]\nmesh = \"mesh.obj\"\ntranslate = [{x}, 0, 0]\n");
    let folder = obj(lamp).with("mesh.mtl", "newmtl m\nKe 1 1 1\n");
    let scene = folder.with("scene.toml", format!("{SENSOR}{}{}{}", at(0.0), at(0.0), at(3.0))).load("scene.toml");
    assert_eq!((scene.objects.len(), scene.meshes.len(), scene.triangle_count()), (2, 1, 4));
    warned(&scene, &["2 triangle(s)", "dropped"]);
    // The second one lies on the first with one of its triangles only.
    let turned = "[[object]]\nmesh = \"mesh.obj\"\ntranslate = [0, 0, 5]\n";
    let folder = obj(lamp).with("mesh.mtl", "newmtl m\nKe 1 1 1\n");
    let scene = folder.with("scene.toml", format!("{SENSOR}{}{turned}", at(0.0))).load("scene.toml");
    assert_eq!((scene.objects.len(), scene.meshes.len(), scene.triangle_count()), (2, 2, 3));
    assert_eq!(emissive(&scene).len(), 3);
}

#[test]
fn veils_in_one_place_count_once() {
    let mesh = format!("mtllib mesh.mtl\nusemtl m\n{TRIANGLE}f 3 2 1\nusemtl n\nf 1 2 3\n");
    let folder = obj(mesh).with("mesh.mtl", "newmtl m\nd 0.5\nnewmtl n\nd 0.25\n");
    let scene = folder.load("mesh.obj");
    assert_eq!(scene.triangle_count(), 2, "one of each material");
    warned(&scene, &["1 triangle(s)", "partly transparent", "opacity counts once"]);
}

/// Neighbours, doubled opaque faces, and a lamp that fills a hole are nobody's business.
#[test]
fn what_does_not_overlap_is_left_alone() {
    let mesh = "mtllib mesh.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n\
                usemtl n\nv 0 2 0\nv 2 2 0\nf 8 7 4 3 6\nf 8 7 4 3 6\n";
    let scene = obj(mesh).with("mesh.mtl", "newmtl m\nKe 1 1 1\nnewmtl n\nKd 0.5 0.5 0.5\n").load("mesh.obj");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(emissive(&scene).len(), 4);
}

/// Any number in one place takes time in proportion.
#[test]
fn many_in_one_place_are_compared_in_no_time() {
    let start = std::time::Instant::now();
    let mesh = format!("mtllib mesh.mtl\nusemtl m\n{TRIANGLE}{}", "f 1 2 3\n".repeat(200_000));
    let scene = obj(mesh).with("mesh.mtl", "newmtl m\nKe 1 1 1\n").load("mesh.obj");
    assert_eq!(scene.triangle_count(), 1);
    warned(&scene, &["200000 triangle(s)"]);
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}
