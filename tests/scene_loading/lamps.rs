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
        ("another light in its place, other diagonal", &["2 triangle(s)", "dropped", "the first counts", "`up`"]),
        ("another light that reaches beyond", &["2 triangle(s)", "cut out", "`alike`"]),
        ("another light around it", &["2 triangle(s)", "cut out", "`alike`"]),
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
    assert_eq!(scene.meshes[0].triangles.len(), 2, "one of each material");
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

/// A plate, and in its plane a lamp.
const FIXTURE: &str = "mtllib mesh.mtl\nusemtl plate\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n\
                       usemtl lamp\nv -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 0 0.5\nv -0.5 0 0.5\nf 5 6 7 8\n";
const FIXTURE_MTL: &str = "newmtl plate\nKd 0.5 0.5 0.5\nnewmtl lamp\nKe 1 1 1\n";

/// A scene of one mesh, `mesh.obj`, in these places.
fn instances(mesh: &str, mtl: &str, places: &[String]) -> Scene {
    let objects: String = places.iter().map(|place| format!("[[object]]\nmesh = \"mesh.obj\"\n{place}\n")).collect();
    obj(mesh).with("mesh.mtl", mtl).with("scene.toml", format!("{SENSOR}{objects}")).load("scene.toml")
}

/// Instances that are changed in the same way share what they become, wherever they stand.
#[test]
fn instances_of_a_fixture_go_on_sharing_a_mesh() {
    let places: Vec<String> = (0..30)
        .map(|i| match i % 3 {
            0 => format!("translate = [{}, 0, 7]", 3 * i),
            1 => format!("translate = [{}, 2, 0]\nrotate = [20, 30, {i}]", 3 * i),
            _ => format!("translate = [{}, -1, 0]\nscale = [-1, 1, 1]", 3 * i),
        })
        .collect();
    // Halves that cover each other, cut anew.
    let halves = "mtllib mesh.mtl\nusemtl lamp\nv -1 2 -1\nv 0.5 2 -1\nv 0.5 2 1\nv -1 2 1\nf 1 2 3 4\n\
                  v -0.5 2 -1\nv 1 2 -1\nv 1 2 1\nv -0.5 2 1\nf 5 6 7 8\n";
    // What is mirrored may be cut in another way.
    for (mesh, most, area) in [(FIXTURE, 1, 30.0 * 2.0), (halves, 2, 30.0 * 4.0)] {
        let scene = instances(mesh, FIXTURE_MTL, &places);
        assert_eq!(scene.objects.len(), 30);
        assert!(scene.meshes.len() <= most, "{} meshes", scene.meshes.len());
        let found: f64 = emissive(&scene).iter().map(EmissiveTriangle::area).sum();
        assert!((found - area).abs() < 1e-3, "{found} instead of {area}");
    }
    // As far as the one asks that is furthest from the origin, on both sides.
    let scene = instances(FIXTURE, FIXTURE_MTL, &places);
    let heights: Vec<f32> = scene.meshes[0].positions[8..].iter().map(|p| p.y).collect();
    assert!(heights.iter().all(|y| y.abs() == heights[0].abs() && y.abs() > 1e-3), "{heights:?}");
}

/// Where each instance would need a mesh of its own, they are left.
#[test]
fn large_meshes_are_not_copied_for_each_instance() {
    let mut mesh = "mtllib mesh.mtl\nusemtl lamp\n".to_owned();
    for z in 0..20 {
        mesh += &format!("v 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\nf -3 -2 -1\n");
    }
    mesh += "usemtl plate\nv 0 0 -1\nv 1 0 -1\nv 0 1 -1\n";
    mesh += &"f -3 -2 -1\n".repeat(20_000);
    let object = |mesh: &str, x: usize, z: usize| format!("[[object]]\nmesh = \"{mesh}\"\ntranslate = [{x}, 0, {z}]\n");
    let objects: String = (0..20).map(|i| object("mesh.obj", 9 * i, 0) + &object("plate.obj", 9 * i, i)).collect();
    let plate = "mtllib mesh.mtl\nusemtl plate\nv -1 -1 0\nv 2 -1 0\nv 2 2 0\nv -1 2 0\nf 1 2 3 4\n";
    let folder = obj(mesh).with("mesh.mtl", FIXTURE_MTL).with("plate.obj", plate);
    let scene = folder.with("scene.toml", format!("{SENSOR}{objects}")).load("scene.toml");
    assert_eq!((scene.objects.len(), scene.meshes.len()), (40, 2));
    warned(&scene, &["left as they are", "400400 triangles"]);
}

/// What is moved is moved further than single precision rounds by, and not so far that anybody sees it.
#[test]
fn how_far_a_lamp_moves_goes_by_both_triangles_and_its_own_size() {
    for (half, least) in [(3.0, 1e-5), (100.0, 5e-4), (800.0, 4e-3)] {
        let scene = files::in_a_large_ceiling(half);
        warned(&scene, &["moved off"]);
        let [front, back] = [0, 2].map(|k| emissive(&scene)[k].vertices[0]);
        let moved = 0.5 * front.distance(back);
        assert!((least..=0.01).contains(&moved), "{half}: {moved}");
    }
    // Out of a ceiling that is too large for that it is cut, and so is a small one far from the origin.
    let scenes = [files::in_a_large_ceiling(2000.0), {
        let lamp = "v 5000 0 0.3\nv 5000.02 0 0.3\nv 5000.02 0 0.32\nv 5000 0 0.32\nf -4 -3 -2 -1\n";
        let ceiling = "v 4000 0 -500\nv 5400 0 -500\nv 5400 0 500\nv 4000 0 500\nv 0 -9 0\nf -5 -4 -3 -2\nf -5 -4 -1\n";
        // Flat: of a ceiling that is shaded as a bent one nothing is cut.
        let mesh = format!("mtllib mesh.mtl\ns off\nusemtl lamp\n{lamp}usemtl plate\n{ceiling}");
        obj(mesh).with("mesh.mtl", FIXTURE_MTL).load("mesh.obj")
    }];
    for scene in scenes {
        warned(&scene, &["triangle(s)", "do not emit", "cut out of them"]);
        assert!(!scene.warnings.iter().any(|warning| warning.contains("moved off")), "{:?}", scene.warnings);
        assert_eq!(emissive(&scene).len(), 2);
    }
}

const CUBE: &str = "mtllib mesh.mtl\nusemtl glass\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

/// A body of glass that glows keeps its surface, and is drawn in where it touches something.
#[test]
fn lamps_that_transmit_are_drawn_in() {
    let glass = "newmtl plate\nKd 1 1 1\nnewmtl glass\nKd 0 0 0\nKe 1 1 1\nTf 1 1 1\nNi 1.5\nillum 7\n";
    let floor = "usemtl plate\nv -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nf -4 -3 -2 -1\n";
    let scene = obj(format!("{CUBE}{floor}")).with("mesh.mtl", glass).load("mesh.obj");
    assert_eq!((scene.triangle_count(), emissive(&scene).len()), (14, 12));
    warned(&scene, &["2 triangle(s)", "drawn in", "`glass`"]);
    assert_eq!(scene.warnings.iter().filter(|warning| warning.contains("triangle(s)")).count(), 1);
    // Two that touch have a face in common, which belongs to both.
    let scene = instances(CUBE, glass, &["".into(), "translate = [1, 0, 0]".into()]);
    assert_eq!(scene.triangle_count(), 24);
    warned(&scene, &["2 triangle(s)", "drawn in", "`glass`"]);
}

/// What was in one place twice is gone before anybody is told to remove it.
#[test]
fn glass_that_was_dropped_needs_no_advice() {
    let mtl = "newmtl glass\nKd 0 0 0\nKe 1 1 1\nTf 1 1 1\nNi 1.5\nillum 7\n";
    let scene = instances(CUBE, mtl, &["".into(), "".into()]);
    assert_eq!(scene.triangle_count(), 12);
    warned(&scene, &["12 triangle(s)", "dropped"]);
    assert!(!scene.warnings.iter().any(|warning| warning.contains("remove one")), "{:?}", scene.warnings);
}

/// Colours multiply the ambient albedo, too.
#[test]
fn coloured_lamps_with_an_ambient_albedo_are_not_cut_anew() {
    let halves = "mtllib mesh.mtl\nusemtl lamp\nv -1 2 -1 1 0 0\nv 0.5 2 -1 0 1 0\nv 0.5 2 1 0 1 1\nv -1 2 1 1 1 0\nf 1 2 3 4\n\
                  v -0.5 2 -1 1 0 0\nv 1 2 -1 1 0 0\nv 1 2 1 1 0 0\nv -0.5 2 1 1 0 0\nf 5 6 7 8\n";
    for (ambient, words) in [("Ka 0 0 0", "cut anew"), ("Ka 0.5 0.5 0.5", "counted twice")] {
        let mtl = format!("newmtl lamp\nKd 0 0 0\n{ambient}\nKe 1 1 1\n");
        warned(&obj(halves).with("mesh.mtl", &mtl).load("mesh.obj"), &[words]);
    }
}
