//! Vertex normals that are made from the faces.

use super::*;
use glam::Vec3;

/// Two unit squares that meet at a right angle in the edge from 2 to 3: the floor z = 0 and the wall x = 1.
const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n";
const FLOOR: &str = "f 1 2 3 4\n";
const WALL: &str = "f 2 5 6 3\n";

/// The normal at each corner of each triangle of the first mesh.
fn normals(scene: &Scene) -> Vec<[Vec3; 3]> {
    let mesh = &scene.meshes[0];
    if mesh.normals.is_empty() {
        return Vec::new();
    }
    mesh.triangles.iter().map(|triangle| triangle.vertices.map(|v| mesh.normals[v as usize])).collect()
}

fn close(a: Vec3, b: Vec3) -> bool {
    a.distance(b) < 1e-6
}

#[test]
fn a_smoothing_group_shares_normals_and_others_do_not() {
    let both = obj(format!("{CORNER}s 1\n{FLOOR}{WALL}")).load("mesh.obj");
    let shared = (Vec3::Z - Vec3::X).normalize();
    for triangle in normals(&both) {
        assert!(triangle.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
    }
    let floor = normals(&both)[0];
    assert!(close(floor[0], Vec3::Z) && close(floor[1], shared) && close(floor[2], shared), "{floor:?}");
    assert_eq!(both.meshes[0].positions.len(), 6, "vertices within a group are shared");

    let apart = obj(format!("{CORNER}s 1\n{FLOOR}s 2\n{WALL}")).load("mesh.obj");
    assert!(normals(&apart)[..2].iter().flatten().all(|n| close(*n, Vec3::Z)));
    assert!(normals(&apart)[2..].iter().flatten().all(|n| close(*n, -Vec3::X)));

    for off in ["s off", "s 0", "s", ""] {
        let mixed = obj(format!("{CORNER}s 3\n{FLOOR}{off}\n{WALL}")).load("mesh.obj");
        let wall = &normals(&mixed)[2..];
        if off.is_empty() {
            assert!(wall.iter().flatten().all(|n| *n != Vec3::ZERO));
        } else {
            assert!(wall.iter().flatten().all(|n| *n == Vec3::ZERO), "{off}: shaded flat");
            assert!(normals(&mixed)[..2].iter().flatten().all(|n| close(*n, Vec3::Z)), "{off}");
        }
        assert!(normals(&obj(format!("{CORNER}{off}\n{FLOOR}{WALL}")).load("mesh.obj")).is_empty(), "{off}");
    }
    let odd = obj(format!("{CORNER}s one\n{FLOOR}")).load("mesh.obj");
    assert!(odd.meshes[0].normals.is_empty());
    warned(&odd, &["mesh.obj:7", "smoothing group"]);
}

#[test]
fn normals_of_the_file_win_over_smoothing_groups() {
    let scene = obj(format!("{CORNER}vn 1 0 0\ns 1\nf 1//1 2//1 3//1 4//1\n{WALL}")).load("mesh.obj");
    assert!(normals(&scene)[..2].iter().flatten().all(|n| *n == Vec3::X));
    let shared = (Vec3::Z - Vec3::X).normalize();
    assert!(normals(&scene)[2].iter().any(|n| close(*n, shared)), "the floor's face still counts for the wall");
}

#[test]
fn the_cut_into_faces_and_doubled_vertices_do_not_matter() {
    // The floor as two triangles, either way, and the wall with vertices of its own at the same places.
    let doubled = "v 1 0 0\nv 1 1 0\nf 7 5 6 8\n";
    let shared = (Vec3::Z - Vec3::X).normalize();
    for floor in ["f 1 2 3\nf 1 3 4\n", "f 1 2 4\nf 2 3 4\n"] {
        let scene = obj(format!("{CORNER}s 1\n{floor}{doubled}")).load("mesh.obj");
        let mesh = &scene.meshes[0];
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            if position.x == 1.0 && position.z == 0.0 {
                assert!(close(*normal, shared), "{floor}: {normal}");
            }
        }
    }
}

/// The corner as an object with this line.
fn smooth(text: &str, line: &str) -> Scene {
    let file = format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n{line}\n");
    obj(text).with("scene.toml", file).load("scene.toml")
}

#[test]
fn smooth_joins_faces_below_its_angle() {
    let text = format!("{CORNER}{FLOOR}{WALL}");
    let shared = (Vec3::Z - Vec3::X).normalize();
    assert!(normals(&smooth(&text, "")).is_empty());
    assert!(normals(&smooth(&text, "smooth = 0")).is_empty());
    for (line, expected) in [("smooth = 89", Vec3::Z), ("smooth = 91", shared), ("smooth = 180", shared)] {
        let scene = smooth(&text, line);
        assert!(close(normals(&scene)[0][1], expected), "{line}: {:?}", normals(&scene)[0]);
        assert_eq!(scene.warnings, Vec::<String>::new());
    }
}

#[test]
fn smooth_replaces_smoothing_groups_but_not_normals() {
    let grouped = format!("{CORNER}s 1\n{FLOOR}{WALL}");
    assert!(normals(&smooth(&grouped, "smooth = 0")).is_empty());
    assert!(close(normals(&smooth(&grouped, "smooth = 30"))[0][1], Vec3::Z));
    let own = smooth(&format!("{CORNER}vn 1 0 0\nf 1//1 2//1 3//1 4//1\n{WALL}"), "smooth = 180");
    assert_eq!(normals(&own)[0], [Vec3::X; 3]);
    warned(&own, &["mesh.obj", "`smooth`", "vn"]);
}

#[test]
fn one_file_with_two_angles_is_two_meshes() {
    let file = format!("{SENSOR}{LIGHT}{0}smooth = 30\n{0}smooth = 30\n{0}", "[[object]]\nmesh = \"mesh.obj\"\n");
    let scene = obj(format!("{TRIANGLE}f 1 1 2\n")).with("scene.toml", file).load("scene.toml");
    assert_eq!(scene.objects.iter().map(|object| object.mesh).collect::<Vec<_>>(), [0, 0, 1]);
    assert_eq!(scene.warnings.len(), 1, "what is wrong with the file is said once: {:?}", scene.warnings);
}

#[test]
fn a_sphere_is_smooth() {
    // A fan with many faces at its poles: the normals of a sphere point outwards.
    let (rows, columns) = (24, 48);
    let mut text = String::new();
    let point = |row: usize, column: usize| {
        let (theta, phi) = (row as f64 / rows as f64, 2.0 * column as f64 / columns as f64);
        let ((s, c), (sp, cp)) = ((theta * std::f64::consts::PI).sin_cos(), (phi * std::f64::consts::PI).sin_cos());
        [s * cp, c, -s * sp]
    };
    for row in 0..=rows {
        for column in 0..columns {
            let [x, y, z] = point(row, column);
            text += &format!("v {x:.7} {y:.7} {z:.7}\n");
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let at = |row: usize, column: usize| row * columns + column % columns + 1;
            let quad = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            text += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
        }
    }
    let scene = smooth(&text, "smooth = 30");
    let mesh = &scene.meshes[0];
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(normal.dot(position.normalize()) > 0.999, "{position} {normal}");
    }
}
