//! Glass that touches other surfaces exactly: one warning says what was done, and nothing else changes.

use super::*;
use glam::Vec3;

const MTL: &str = "newmtl glass\nNi 1.5\nillum 7\nnewmtl water\nNi 1.33\nillum 7\nnewmtl white\nKd 0.5 0.5 0.5\n";

/// A closed box between two corners.
fn cuboid(material: &str, low: [f64; 3], high: [f64; 3]) -> String {
    let mut text = format!("usemtl {material}\n");
    for i in 0..8 {
        let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        text += &format!("v {} {} {}\n", pick(0), pick(1), pick(2));
    }
    text + "f -8 -7 -3 -4\nf -6 -2 -1 -5\nf -4 -3 -1 -2\nf -8 -6 -5 -7\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n"
}

const FLOOR: &str = "usemtl white\nv -4 0 -4\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nf -4 -3 -2 -1\n";

/// A scene of one mesh, in these places.
fn placed(mesh: &str, places: &[&str]) -> Scene {
    let objects: String = places.iter().map(|place| format!("[[object]]\nmesh = \"mesh.obj\"\n{place}\n")).collect();
    let light = "[environment]\nradiance = [1, 1, 1]\n";
    let folder = Folder::new().with("mesh.mtl", MTL).with("mesh.obj", format!("mtllib mesh.mtl\n{mesh}"));
    folder.with("scene.toml", format!("{SENSOR}{light}{objects}")).load("scene.toml")
}

#[test]
fn one_warning_says_what_touches_and_where() {
    let unit = || cuboid("glass", [0.0; 3], [1.0; 3]);
    let other = |material: &str| cuboid(material, [1.0, 0.25, 0.25], [2.0, 0.75, 0.75]);
    let label = "usemtl white\nv 0.2 0.2 1\nv 0.8 0.2 1\nv 0.8 0.8 1\nv 0.2 0.8 1\nf -4 -3 -2 -1\n";
    for (name, mesh, faces) in [
        ("on a floor", unit() + FLOOR, 2),
        ("a floor first", FLOOR.to_owned() + &unit(), 2),
        ("a floor whose other side is up", unit() + &FLOOR.replace("f -4 -3 -2 -1", "f -1 -2 -3 -4"), 2),
        ("a label", unit() + label, 2),
        ("a label on the back", unit() + &label.replace(" 1\n", " 0\n"), 2),
        ("beside glass", unit() + &other("glass"), 2),
        ("beside water", unit() + &other("water"), 2),
        ("all at once", unit() + &other("water") + label + FLOOR, 6),
        ("nearly", unit() + &FLOOR.replace(" 0 ", " -0.000001 "), 2),
    ] {
        let scene = placed(&mesh, &[""]);
        assert_eq!(scene.warnings.len(), 1, "{name}: {:?}", scene.warnings);
        warned(&scene, &[&format!("{faces} triangle(s) of glass"), "drawn in", "a hair", "object `mesh`"]);
        // Nothing is left to do.
        assert_eq!(scene.clone().part_touching_glass(), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn what_does_not_touch_stays_as_it_is() {
    let unit = cuboid("glass", [0.0; 3], [1.0; 3]);
    for (name, more) in [
        ("a gap", FLOOR.replace(" 0 ", " -0.001 ")),
        ("an edge in common", cuboid("water", [1.0, 1.0, 0.0], [2.0, 2.0, 1.0])),
        ("a plane in common, beside each other", cuboid("glass", [2.0, 0.0, 0.0], [3.0, 1.0, 1.0])),
        ("crossing", cuboid("water", [0.5, 0.5, 0.5], [1.5, 1.5, 1.5])),
        ("a wall that ends at an edge", "usemtl white\nv 0 -1 0\nv 0 0 0\nv 0 0 1\nv 0 -1 1\nf -4 -3 -2 -1\n".into()),
    ] {
        let scene = placed(&(unit.clone() + &more), &[""]);
        // Bodies that cross are named by another check.
        let moved = |warning: &&String| !warning.contains("reach through each other's surface");
        assert_eq!(scene.warnings.iter().filter(moved).count(), 0, "{name}: {:?}", scene.warnings);
        let (low, high) = scene.meshes[0].bounds();
        assert!(scene.meshes[0].positions[..8].iter().all(|p| p.min(Vec3::ONE).max(Vec3::ZERO) == *p), "{low} {high}");
    }
}

/// A file with six digits, turned: corners of faces that touch are off each other's plane.
#[test]
fn what_touches_but_for_the_rounding_of_the_file_is_drawn_in() {
    let turned = |body: String| {
        let (sine, cosine) = 0.7_f64.sin_cos();
        let turn = |line: &str| {
            let Some(place) = line.strip_prefix("v ") else { return format!("{line}\n") };
            let p: Vec<f64> = place.split(' ').map(|x| 100.0 * x.parse::<f64>().expect("a number")).collect();
            let (x, y) = (cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]);
            let (y, z) = (cosine * y - sine * p[2], sine * y + cosine * p[2]);
            format!("v {x:.3} {y:.3} {z:.3}\n")
        };
        body.lines().map(turn).collect::<String>()
    };
    let unit = |material| cuboid(material, [0.0; 3], [1.0; 3]);
    let beside = |x: f64, material| cuboid(material, [x, 0.1, 0.2], [2.0, 0.7, 0.8]);
    for (name, second) in [
        ("another glass", beside(1.0, "water")),
        ("the same glass", beside(1.0, "glass")),
        ("a small overlap", beside(1.0 - 5e-5, "water")),
        ("a small overlap of the same glass", beside(1.0 - 5e-5, "glass")),
    ] {
        let scene = placed(&turned(unit("glass") + &second), &[""]);
        println!("{name}: {:?}", scene.warnings);
        warned(&scene, &["2 triangle(s) of glass", "drawn in"]);
        assert!(
            !scene.warnings.iter().any(|warning| warning.contains("reach through")),
            "{name}: {:?}",
            scene.warnings
        );
        assert_eq!(scene.clone().part_touching_glass(), Vec::<String>::new(), "{name}");
    }
    // What rays tell apart stays: gaps, the sides of a thin plate, a wall between two surfaces of one body.
    let inner = cuboid("glass", [5e-5; 3], [1.0 - 5e-5; 3]);
    let reversed = |line: &str| match line.strip_prefix("f ") {
        Some(face) => format!("f {}\n", face.split(' ').rev().collect::<Vec<_>>().join(" ")),
        None => format!("{line}\n"),
    };
    for (name, mesh) in [
        ("a gap of a thousandth", unit("glass") + &beside(1.001, "water")),
        ("a gap of a ten-thousandth", unit("glass") + &beside(1.0001, "glass")),
        ("a thin plate", cuboid("glass", [0.0; 3], [1.0, 5e-5, 1.0])),
        ("a thin wall", unit("glass") + &inner.lines().map(reversed).collect::<String>()),
    ] {
        let scene = placed(&turned(mesh), &[""]);
        let touching = |warning: &&String| warning.contains("drawn in") || warning.contains("left as they are");
        assert_eq!(scene.warnings.iter().filter(touching).count(), 0, "{name}: {:?}", scene.warnings);
    }
    // Too thin a body stays, and that is said.
    let foil = cuboid("water", [1.0 - 2e-5, 0.1, 0.2], [1.0 + 3e-5, 0.7, 0.8]);
    let scene = placed(&turned(unit("glass") + &foil), &[""]);
    warned(&scene, &["2 triangle(s) of glass", "left as they are", "too thin"]);
}

/// What is opaque stays where it is, and glass is drawn in by a hair, with all its faces.
#[test]
fn a_hair_is_small_and_bodies_stay_closed() {
    let scene = placed(&(FLOOR.to_owned() + &cuboid("glass", [0.0; 3], [1.0; 3])), &[""]);
    let mesh = &scene.meshes[0];
    for triangle in &mesh.triangles {
        let opaque = scene.materials[triangle.material as usize].name == "white";
        for p in triangle.vertices.map(|v| mesh.positions[v as usize]) {
            assert!(if opaque { p.y == 0.0 } else { p.y == 1.0 || (1e-6..1e-4).contains(&p.y) }, "{p}");
        }
    }
}

/// Instances that are changed in the same way share what they become; those that touch nothing keep the mesh.
#[test]
fn instances_go_on_sharing_meshes() {
    let at = |x: u32| format!("translate = [{x}, 0, 0]");
    let places: Vec<String> = (0..20).map(|k| at(k + k / 10)).collect();
    let scene = placed(&cuboid("glass", [0.0; 3], [1.0; 3]), &places.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!((scene.objects.len(), scene.meshes.len()), (20, 2));
    warned(&scene, &["36 triangle(s) of glass", "drawn in"]);
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

/// Where each instance would need a mesh of its own, they are left.
#[test]
fn large_meshes_are_not_copied_for_each_instance() {
    let at = |k: usize| f64::from(2 * k as u32);
    let mut mesh: String = (0..20).map(|k| cuboid("glass", [0.0, 0.0, at(k)], [1.0, 1.0, at(k) + 1.0])).collect();
    mesh += &format!("usemtl white\nv 0 0 -1\nv 1 0 -1\nv 0 1 -1\n{}", "f -3 -2 -1\n".repeat(20_000));
    let label = "mtllib mesh.mtl\nusemtl white\nv 0.2 0.2 1\nv 0.8 0.2 1\nv 0.8 0.8 1\nv 0.2 0.8 1\nf 1 2 3 4\n";
    let object = |mesh: &str, x: usize, z: usize| format!("[[object]]\nmesh = \"{mesh}\"\ntranslate = [{x}, 0, {z}]\n");
    let objects: String = (0..20).map(|k| object("mesh.obj", 9 * k, 0) + &object("label.obj", 9 * k, 2 * k)).collect();
    let folder = Folder::new().with("mesh.mtl", MTL).with("mesh.obj", format!("mtllib mesh.mtl\n{mesh}"));
    let scene = folder.with("label.obj", label).with("scene.toml", format!("{SENSOR}{objects}")).load("scene.toml");
    assert_eq!((scene.objects.len(), scene.meshes.len()), (40, 2));
    warned(&scene, &["glass touches", "404800 triangles", "left as they are"]);
}

/// A body that is thinner than single precision tells apart there is left; panes are moved off, and are one where they lie on each other.
#[test]
fn what_cannot_be_parted_is_named() {
    let scene = placed(&(cuboid("glass", [0.0; 3], [1.0, 3e-5, 1.0]) + FLOOR), &[""]);
    warned(&scene, &["2 triangle(s) of glass", "left as they are", "too thin", "leave a gap"]);
    assert!(!scene.warnings.iter().any(|warning| warning.contains("drawn in")), "{:?}", scene.warnings);
    let ground = FLOOR.replace('4', "100000").replace("f -100000", "f -4");
    let scene = placed(&(cuboid("glass", [0.0; 3], [1.0; 3]) + &ground), &[""]);
    warned(&scene, &["2 triangle(s) of glass", "left as they are", "too small beside what they touch"]);
    let panes = "[[material]]\nname = \"glass\"\nthin = true";
    let pane = "usemtl glass\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf -4 -3 -2 -1\n";
    let scene = placed(&format!("{pane}{FLOOR}"), &[panes]);
    warned(&scene, &["2 triangle(s) of thin panes", "moved off"]);
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    let scene = placed(&format!("{pane}f -4 -3 -2 -1\nf -3 -2 -1 -4\n"), &[panes]);
    warned(&scene, &["thin panes", "dropped"]);
    warned(&scene, &["thin panes", "cover a part"]);
}

/// One body in two files is said to be there twice, whichever way its faces are cut.
#[test]
fn a_body_in_two_files_is_named() {
    let unit = cuboid("glass", [0.0; 3], [1.0; 3]);
    let other = unit.replace("f -8 -7 -3 -4", "f -7 -3 -4 -8").replace("f -8 -4 -2 -6", "f -4 -2 -6 -8");
    for second in [&unit, &other] {
        let objects = "[[object]]\nmesh = \"a.obj\"\n[[object]]\nmesh = \"b.obj\"\n";
        let folder = Folder::new()
            .with("mesh.mtl", MTL)
            .with("a.obj", format!("mtllib mesh.mtl\n{unit}"))
            .with("b.obj", format!("mtllib mesh.mtl\n{second}"))
            .with("scene.toml", format!("{SENSOR}[environment]\nradiance = [1, 1, 1]\n{objects}"));
        let scene = folder.load("scene.toml");
        warned(&scene, &["objects `a`, `b`: bodies of glass", "lie on each other with all of their surface"]);
        assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
        assert_eq!(scene.meshes[1].bounds(), (Vec3::ZERO, Vec3::ONE));
    }
}

/// Of what there is too much of, nobody is silent.
#[test]
fn too_much_glass_is_not_compared() {
    let mesh: String =
        (0..700).map(|k| cuboid("glass", [0.0, 0.0, f64::from(2 * k)], [1.0, 1.0, f64::from(2 * k + 1)])).collect();
    let places: Vec<String> = (0..250).map(|k| format!("translate = [{}, 0, 0]", 2 * k)).collect();
    let scene = placed(&mesh, &places.iter().map(String::as_str).collect::<Vec<_>>());
    warned(&scene, &["more than 2097152 triangles of glass"]);
}
