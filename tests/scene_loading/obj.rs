//! OBJ files, and what a bare one is given.

use super::*;
use glam::{Vec2, Vec3};
use luminaire::scene::{Estimator, Integrator};

#[test]
fn endings_of_lines_and_files_do_not_matter() {
    for text in [
        TRIANGLE.replace('\n', "\r\n"),
        format!("\u{feff}{TRIANGLE}"),
        TRIANGLE.trim_end().to_owned(),
        format!("# a comment that ends in a backslash \\\n{TRIANGLE}"),
        TRIANGLE.replace("f 1 2 3", "f 1 \\\n  2 3   # a comment"),
        TRIANGLE.replace("f 1 2 3", "\\\n  f 1 2 3"),
        TRIANGLE.replace("v 1 0 0", "v\t+1e0   .0  0. "),
    ] {
        let scene = obj(&text).load("mesh.obj");
        assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y], "{text:?}");
        assert_eq!(scene.meshes[0].triangles.len(), 1);
    }
}

#[test]
fn the_ending_of_the_name_is_compared_without_case() {
    assert_eq!(Folder::new().with("MESH.OBJ", TRIANGLE).load("MESH.OBJ").meshes[0].triangles.len(), 1);
}

#[test]
fn indices_may_be_negative_or_point_ahead() {
    let behind = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nf -3//-1 -2//-1 -1//-1\n").load("mesh.obj");
    assert_eq!(behind.meshes[0].normals, [Vec3::Z; 3]);
    let ahead = obj("usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").load("mesh.obj");
    assert_eq!(ahead.meshes[0].triangles.len(), 2);
}

#[test]
fn polygons_become_fans() {
    let quad = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").load("mesh.obj");
    let corners: Vec<_> = quad.meshes[0].triangles.iter().map(|triangle| triangle.vertices).collect();
    assert_eq!(corners, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn all_groups_are_one_mesh() {
    let scene = obj(format!("o a\n{TRIANGLE}o b\ng c d\nv 5 5 5\nf 1 2 4\ns 1\nl 1 2 3\np 1\n")).load("mesh.obj");
    assert_eq!((scene.objects.len(), scene.meshes[0].triangles.len()), (2, 2), "one, and the ground");
    assert_eq!(scene.meshes[0].name, "mesh.obj");
}

#[test]
fn corners_without_a_normal_have_the_zero_normal() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 3\nf 1//1 2 3//1\nf 1 2 4\n";
    let mesh = &obj(text).load("mesh.obj").meshes[0];
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    let normals = mesh.triangles[0].vertices.map(|v| mesh.normals[v as usize]);
    assert_eq!(normals, [Vec3::Z, Vec3::ZERO, Vec3::Z]);
    assert!(mesh.triangles[1].vertices.iter().all(|v| mesh.normals[*v as usize] == Vec3::ZERO));
}

#[test]
fn vertices_are_split_by_texture_coordinate() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.5\nvt 0.25 -3 7\nvt inf 0\nf 1/1 2/2 3/3\nf 2/2 4/1 3/2\n";
    let scene = obj(text).load("mesh.obj");
    let mesh = &scene.meshes[0];
    let uvs = |triangle: usize| mesh.triangles[triangle].vertices.map(|v| mesh.uvs[v as usize].to_array());
    assert_eq!(uvs(0), [[0.5, 0.0], [0.25, -3.0], [0.0, 0.0]]);
    assert_eq!(uvs(1), [[0.25, -3.0], [0.5, 0.0], [0.25, -3.0]]);
    assert_eq!((mesh.positions.len(), mesh.uvs.len()), (5, 5), "corners 2 of both are one vertex, corners 3 are two");
    assert!(mesh.normals.is_empty());
    warned(&scene, &["mesh.obj:7", "not finite", "0"]);
}

/// The first vertex at a position is found another way than the rest; neither may come from an earlier run.
#[test]
fn vertices_are_numbered_by_first_use_within_a_run_of_one_material() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nusemtl a\nf 1/1 2/1 3/1\nf 1/2 2/2 3/1\nf 2/1 1/2 3/1\n\
                usemtl b\nusemtl a\nf 1/1 2/2 3/1\nusemtl b\nf 1/2 2/1 3/1\nf 1/1 2/1 3/1\nusemtl a\nf 1/1 2/2 3/1\nf 1/2 2/1 3/1\n";
    let scene = obj(text).load("mesh.obj");
    let vertices: Vec<_> = scene.meshes[0].triangles.iter().map(|triangle| triangle.vertices).collect();
    assert_eq!(
        vertices,
        [[0, 1, 2], [3, 4, 2], [1, 3, 2], [0, 4, 2], [5, 6, 7], [8, 6, 7], [9, 10, 11], [12, 13, 11]],
        "a run ends where a face of another material comes"
    );
    assert_eq!(scene.meshes[0].uvs[3..5], [Vec2::ONE; 2]);
}

#[test]
fn corners_without_a_texture_coordinate_have_zero() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nvt 0.5 0.75\nf 1/1/1 2//1 3/1\nf 2 4 3\n";
    let mesh = &obj(text).load("mesh.obj").meshes[0];
    let corner = |t: usize, c: usize| mesh.triangles[t].vertices[c] as usize;
    assert_eq!([0, 1, 2].map(|c| mesh.uvs[corner(0, c)].to_array()), [[0.5, 0.75], [0.0, 0.0], [0.5, 0.75]]);
    assert_eq!([0, 1, 2].map(|c| mesh.normals[corner(0, c)]), [Vec3::Z, Vec3::Z, Vec3::ZERO]);
    assert_eq!([0, 1, 2].map(|c| mesh.uvs[corner(1, c)].to_array()), [[0.0; 2]; 3]);
}

#[test]
fn useless_normals_are_none() {
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 1 inf 0\nf 1//1 2//2 3//1\n").load("mesh.obj");
    assert!(scene.meshes[0].normals.is_empty());
    warned(&scene, &["mesh.obj:5", "normal", "finite"]);
    let tiny = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1e-30\nf 1//1 2//1 3//1\n").load("mesh.obj");
    assert_eq!(tiny.meshes[0].normals, [Vec3::Z; 3], "short is not zero");
}

#[test]
fn indices_into_what_the_file_lacks_are_a_warning() {
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/2 3/3/3\n").load("mesh.obj");
    assert!(scene.meshes[0].normals.is_empty());
    warned(&scene, &["mesh.obj:4", "no normals", "2 more"]);
}

#[test]
fn colours_and_weights_of_vertices() {
    let scene = obj("v 0 0 0 1 nan 0\nv 2 0 0 2\nv 0 1 0\nf 1 2 3\n").load("mesh.obj");
    assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn degenerate_faces_are_dropped_with_one_warning() {
    let scene = obj(format!("{TRIANGLE}f 1 1 2\nf 2 3 2\nv 2 0 0\nf 1 2 4\nf 1 2\nf\nf 3\n")).load("mesh.obj");
    assert_eq!(scene.meshes[0].triangles.len(), 1);
    warned(&scene, &["3 zero-area"]);
    warned(&scene, &["mesh.obj:9", "fewer than 3", "2 more"]);
}

#[test]
fn unknown_keywords_are_one_warning() {
    let scene = obj(format!("{TRIANGLE}bleh 1\nvt3 1\np6\n")).load("mesh.obj");
    warned(&scene, &["mesh.obj:5", "`bleh`", "2 more"]);
}

#[test]
fn bytes_that_are_not_utf8_do_no_harm() {
    let mut text = b"# caf\xe9\n\\\n \xe9\nmtllib mesh.mtl\nusemtl caf\xe9\n".to_vec();
    text.extend(TRIANGLE.as_bytes());
    let folder = obj(text).with("mesh.mtl", b"newmtl caf\xe9\nKd 0.1 0.2 0.3\n");
    assert_eq!(first_material(&folder.load("mesh.obj")).lambert, Vec3::new(0.1, 0.2, 0.3));
}

#[test]
fn a_file_that_is_not_there() {
    let error = Folder::new().error("mesh.obj");
    assert!(matches!(&error, Error::Read { path, .. } if path.ends_with("mesh.obj")), "{error}");
    assert!(error.to_string().contains("No such file"), "{error}");
    assert!(matches!(Folder::new().error("scene.toml"), Error::Read { .. }));
}

#[test]
fn an_ending_that_is_no_scene() {
    for name in ["mesh.off", "mesh", "mesh.obj.gz", ""] {
        let error = Folder::new().with("mesh.off", TRIANGLE).with("mesh", TRIANGLE).error(name);
        let Error::Usage(message) = &error else { panic!("{error}") };
        assert!(message.contains(".toml") && message.contains(".obj"), "{message}");
        assert_eq!(error.exit_code(), 2);
    }
}

#[test]
fn wrong_numbers_are_found_with_their_line() {
    obj_fails(&format!("{TRIANGLE}v 1 2 x\n"), 5, &["`x`", "not a number"]);
    obj_fails(&format!("{TRIANGLE}v 1 3.1+e2 0\n"), 5, &["`3.1+e2`"]);
    obj_fails(&format!("{TRIANGLE}vn 0 1,5 0\n"), 5, &["`1,5`"]);
    obj_fails(&format!("{TRIANGLE}vt ?\n"), 5, &["`?`"]);
    obj_fails(&format!("{TRIANGLE}v 1 2\n"), 5, &["vertex needs 3 numbers", "found 2"]);
    obj_fails(&format!("{TRIANGLE}v 1 2 3 4 5\n"), 5, &["vertex needs 3 numbers", "found 5"]);
    obj_fails(&format!("{TRIANGLE}vn 1 2\n"), 5, &["normal needs 3 numbers", "found 2"]);
    obj_fails(&format!("{TRIANGLE}vt\n"), 5, &["texture coordinate", "none"]);
}

#[test]
fn vertices_that_are_not_finite() {
    for vertex in ["nan 0 0", "0 inf 0", "0 0 -inf", "3E4570711268 0 0", "1 0 0 0", "0 0 0 nan"] {
        obj_fails(&format!("v {vertex}\n{TRIANGLE}"), 1, &["not finite"]);
    }
}

#[test]
fn wrong_indices_are_found_with_their_line() {
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 0"), 4, &["vertex index is 0", "count from 1"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 4"), 4, &["vertex index 4", "out of range", "3 vertex lines"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f -4 -3 -2"), 4, &["relative vertex index -4", "3 vertex lines precede"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 three"), 4, &["`three`", "whole number"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1 2 3.0"), 4, &["`3.0`", "whole number"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f 1/1/1/1 2 3"), 4, &["`1/1/1/1`", "v/vt/vn"]);
    obj_fails(&TRIANGLE.replace("f 1 2 3", "f /1 2 3"), 4, &["`/1`"]);
    obj_fails(&format!("vt 0 0\n{}", TRIANGLE.replace("f 1", "f 1/2")), 5, &["texture coordinate index 2"]);
    obj_fails(&format!("vn 0 0 1\n{}", TRIANGLE.replace("f 1", "f 1//0")), 5, &["normal index is 0"]);
    obj_fails(&format!("vn 0 0 1\n{}", TRIANGLE.replace("f 1", "f 1//-2")), 5, &["relative normal index -2"]);
}

#[test]
fn the_first_wrong_line_counts_even_if_only_the_whole_file_shows_it() {
    obj_fails(&format!("f 1 2 4\n{TRIANGLE}v x\n"), 6, &["vertex needs 3"]);
    obj_fails(&format!("f 1 2 5\n{TRIANGLE}v x\n"), 1, &["vertex index 5", "the file has 4 vertex lines"]);
    obj_fails(&format!("f 1/1 2/1 3/1\n{TRIANGLE}v x\nvt 0\n"), 6, &["vertex needs 3"]);
    obj_fails(&format!("f 1/-1 2/1 3/1\n{TRIANGLE}vt 0\n"), 1, &["relative texture coordinate index -1", "0 texture"]);
}

#[test]
fn huge_indices_do_not_wrap_around() {
    // 2^32 + 1, (2^64 + 2) / 3 and the like would come back into range in 32 bits or when multiplied by 3.
    for index in ["4294967297", "6148914691236517207", "9223372036854775807", "18446744073709551617"] {
        obj_fails(&TRIANGLE.replace("f 1 2 3", &format!("f 1 2 {index}")), 4, &[index]);
        let text = format!("vn 0 0 1\n{}", TRIANGLE.replace("f 1 2 3", &format!("f 1 2 3//{index}")));
        obj_fails(&text, 5, &[index]);
    }
    obj_fails(&TRIANGLE.replace("f 1", "f -9223372036854775808"), 4, &["-9223372036854775808"]);
}

#[test]
fn a_mesh_without_triangles() {
    for text in ["", "v 0 0 0\nv 1 0 0\n", "v 0 0 0\nv 1 0 0\nl 1 2 1\n", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"] {
        let error = obj(text).error("mesh.obj");
        assert!(matches!(&error, Error::Scene { message, .. } if message.contains("nothing to trace")), "{error}");
    }
}

#[test]
fn a_mesh_without_triangles_says_what_was_skipped() {
    let error = obj("v 0 0 0\nvt3 1\nf 1 1\n").error("mesh.obj").to_string();
    assert!(
        ["nothing to trace", "mesh.obj:2", "`vt3`", "mesh.obj:3", "fewer than 3"].iter().all(|w| error.contains(w)),
        "{error}"
    );
}

#[test]
fn text_in_the_wrong_encoding() {
    let utf16: Vec<u8> = "\u{feff}v 0 0 0\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let error = obj(utf16).error("mesh.obj");
    assert!(error.to_string().contains("UTF-16"), "{error}");
    obj_fails("v 0 0 0\nv 1\0 0 0\n", 2, &["NUL"]);
    obj_fails("\0\0\0", 1, &["NUL"]);
}

/// Some exporters write the zero that ends a string, or a whole block of them.
#[test]
fn nul_bytes_at_the_end_of_a_file_are_ignored() {
    for (end, count) in [("\0", 1), ("\0\n", 1), ("\n\0\0\r\n", 2), (&*"\0".repeat(4096), 4096)] {
        let scene = obj(format!("{TRIANGLE}{end}")).load("mesh.obj");
        assert_eq!(scene.meshes[0].triangles.len(), 1);
        warned(&scene, &["mesh.obj", &format!("{count} NUL byte(s) at its end")]);
        let scene = with_mtl(format!("newmtl m\nKd 0.25 0.5 1{end}")).load("mesh.obj");
        warned(&scene, &["mesh.mtl", &format!("{count} NUL byte(s) at its end")]);
        let material = scene.materials.iter().find(|material| material.name == "m").expect("the material");
        assert_eq!(material.lambert.to_array(), [0.25, 0.5, 1.0]);
    }
    obj_fails(&format!("{TRIANGLE}\0# a comment\n\0"), 5, &["NUL"]);
}

#[test]
fn coordinates_beyond_what_single_precision_can_square() {
    let error = obj("v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n").error("mesh.obj");
    assert!(matches!(&error, Error::Scene { message, .. } if message.contains("too large")), "{error}");
}

#[test]
fn a_bare_obj_that_is_dark_gets_a_sky_and_a_framing_camera() {
    let scene = obj("v 10 0 0\nv 14 0 0\nv 10 3 0\nf 1 2 3\n").load("mesh.obj");
    assert!(scene.luminaires.is_empty() && scene.environment.is_some());
    assert_eq!(scene.integrator, Integrator::Path(Estimator::default()));
    assert_eq!(scene.warnings, Vec::<String>::new());
    // Every vertex lies inside the cone around the picture, which is 38 degrees wide and high.
    let sensor = &scene.sensor;
    let view = (sensor.target - sensor.position).normalize();
    for position in &scene.meshes[0].positions {
        let angle = (*position - sensor.position).angle_between(view).to_degrees();
        assert!(angle <= 26.0, "{angle}");
    }
    assert!(view.z < 0.0 && view.y < 0.0, "from the front and above");
}

#[test]
fn a_bare_obj_that_emits_is_path_traced() {
    let scene = with_mtl("newmtl m\nKe 1 2 3\n").load("mesh.obj");
    assert!(scene.luminaires.is_empty() && scene.ground.is_none());
    assert!(scene.environment.is_some_and(|faint| faint.image.is_none()));
    assert_eq!(scene.integrator, Integrator::Path(Estimator::default()));
    assert_eq!(scene.warnings, Vec::<String>::new());
}

/// A floor of this area, and a lamp of area 1.
fn lamp_over(floor: u32) -> Scene {
    let text = format!(
        "mtllib mesh.mtl\nusemtl lamp\nv 0 1 0\nv 2 1 0\nv 0 1 1\nf 1 2 3\n\
         usemtl floor\nv 0 0 0\nv {floor} 0 0\nv 0 0 2\nf 4 5 6\n"
    );
    obj(text).with("mesh.mtl", "newmtl lamp\nKe 1 1 1\nnewmtl floor\nKd .5 .5 .5\n").load("mesh.obj")
}

#[test]
fn a_bare_obj_of_which_next_to_nothing_emits_gets_a_sky_too() {
    let scene = lamp_over(1100);
    assert!(scene.environment.is_some());
    assert_eq!(scene.warnings, Vec::<String>::new());
    assert!(scene.notes[0].contains("only 0.0908 %") && scene.notes[0].contains("studio sky"), "{:?}", scene.notes);
    assert_eq!(first_material(&scene).emission, Vec3::ONE, "it still glows");

    let scene = lamp_over(900);
    // 0.6 times half of a share of 1 in 901.
    let faint = scene.environment.as_ref().map(|sky| (sky.radiance, sky.image.is_some()));
    assert!(scene.luminaires.is_empty() && faint == Some((Vec3::splat(3.3e-4), false)), "{faint:?}");
    assert_eq!(scene.integrator, Integrator::Path(Estimator::default()));
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn a_map_of_emission_emits() {
    let scene = with_mtl("newmtl m\nmap_Ke no.png\n").load("mesh.obj");
    assert!(scene.luminaires.is_empty());
    assert_eq!(first_material(&scene).emission, Vec3::ONE);
}

#[test]
fn a_small_mesh_far_away_still_has_a_camera() {
    let scene = obj("v 1e7 0 0\nv 10000001 0 0\nv 1e7 1 0\nf 1 2 3\n").load("mesh.obj");
    assert_ne!(scene.sensor.position, scene.sensor.target);
}
