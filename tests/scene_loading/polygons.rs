//! Polygons of an OBJ file: what they cover, and what is said of those that make no sense.

use super::*;
use glam::{DVec3, Vec3};
use luminaire::reference::Reference;

/// An OBJ of one polygon.
fn polygon(corners: &[[f64; 3]]) -> Folder {
    let vertices: String = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let indices: Vec<_> = (1..=corners.len()).map(|index| index.to_string()).collect();
    obj(format!("mtllib mesh.mtl\nusemtl m\n{vertices}f {}\n", indices.join(" ")))
        .with("mesh.mtl", "newmtl m\nKe 1 1 1\n")
}

/// The areas of all triangles together, and the length of the sum of their area vectors: less if some face backwards.
fn areas(scene: &Scene) -> (f64, f64) {
    let mesh = &scene.meshes[0];
    let area = |triangle: &luminaire::scene::Triangle| {
        let [a, b, c] = triangle.vertices.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
        0.5 * (b - a).cross(c - a)
    };
    let total = mesh.triangles.iter().map(|triangle| area(triangle).length()).sum();
    (total, mesh.triangles.iter().map(area).sum::<DVec3>().length())
}

/// A square of side 4 with a notch from its upper side to below its middle.
const NOTCHED: [[f64; 3]; 5] = [[0.0, 4.0, 0.0], [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [2.0, 1.5, 0.0]];

#[test]
fn a_concave_polygon_covers_its_own_area_wherever_it_begins() {
    for first in 0..5 {
        for backwards in [false, true] {
            let mut corners: Vec<_> = (0..5).map(|k| NOTCHED[(first + k) % 5]).collect();
            if backwards {
                corners.reverse();
            }
            let scene = polygon(&corners).load("mesh.obj");
            assert_eq!((scene.triangle_count(), areas(&scene)), (3, (11.0, 11.0)), "from corner {first}");
            assert_eq!(scene.warnings, Vec::<String>::new());
        }
    }
}

/// Seen by a camera with parallel rays: the polygon glows, the notch is black.
#[test]
fn a_picture_of_a_concave_polygon_shows_the_notch() {
    let camera = "[film]\nwidth = 64\nheight = 64\n[sensor]\nkind = \"orthographic\"\nposition = [2, 2, 5]\ntarget = [2, 2, 0]\n\
                  height = 4\n[[object]]\nmesh = \"mesh.obj\"\n";
    // The first corner is one from which a fan would cover the notch.
    let scene = polygon(&NOTCHED).with("scene.toml", camera).load("scene.toml");
    let tracer = Reference::new(&scene);
    let lit = |x: u32, y: u32| tracer.radiance(y * 64 + x, 0).0.x > 0.5;
    assert!(lit(32, 48) && lit(3, 8) && lit(60, 8) && !lit(32, 4) && !lit(32, 24) && lit(32, 44));
    let count = (0..64).flat_map(|y| (0..64).map(move |x| (x, y))).filter(|(x, y)| lit(*x, *y)).count();
    assert!((count as i32 - 2816).abs() < 96, "{count} of 4096 pixels are lit, expected 11 of 16");
}

#[test]
fn corners_keep_their_texture_coordinates_and_normals() {
    let text = "v 0 4 0\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1.5 0\nvt 0 4\nvt 0 0\nvt 4 0\nvt 4 4\nvt 2 1.5\nvn 0 0 1\n\
                f 1/1/1 2/2/1 3/3/1 4/4/1 5/5/1\n";
    let mesh = &obj(text).load("mesh.obj").meshes[0];
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (3, 5));
    for (position, uv) in mesh.positions.iter().zip(&mesh.uvs) {
        assert_eq!(position.truncate(), *uv);
    }
    assert_eq!(mesh.normals, [Vec3::Z; 5]);
}

#[test]
fn polygons_that_make_no_sense_are_a_warning_with_their_line() {
    let bow_tie = polygon(&[[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]).load("mesh.obj");
    // The two triangles of the guess overlap. They glow, so each place counts once.
    assert_eq!(bow_tie.triangle_count(), 3);
    warned(&bow_tie, &["mesh.obj:7", "crosses or covers itself", "guess"]);
    let mut bent = NOTCHED;
    bent[4][2] = 1.0;
    let bent = polygon(&bent).load("mesh.obj");
    assert_eq!(bent.triangle_count(), 3);
    warned(&bent, &["mesh.obj:8", "do not lie in a plane", "guess"]);
    let twice = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 4 2 3\nf 1 2 4 3 1 2 4 3\nf 1 4 2 3\n").load("mesh.obj");
    warned(&twice, &["mesh.obj:5", "crosses or covers itself", "2 more like it"]);
}

#[test]
fn polygons_of_many_corners() {
    // A comb, whose teeth a fan would fill.
    let count = 15_000;
    let mut corners = vec![[f64::from(count), -1.0, 0.0], [f64::from(count), 1.0, 0.0]];
    corners.extend((1..2 * count).rev().map(|k| [0.5 * f64::from(k), f64::from(k % 2), 0.0]));
    corners.push([0.0, -1.0, 0.0]);
    let scene = polygon(&corners).load("mesh.obj");
    let (total, sum) = areas(&scene);
    let expected = f64::from(count) * 1.5;
    assert!((total - expected).abs() < 1.0 && (sum - expected).abs() < 1.0, "{total} {sum}");
    // More corners are not cut, but loaded.
    let huge: Vec<_> = (0..100_000).map(|k| [f64::from(k), f64::from(k % 7), 0.0]).collect();
    let scene = polygon(&huge).load("mesh.obj");
    warned(&scene, &["mesh.obj:100003", "32768 corners"]);
}
