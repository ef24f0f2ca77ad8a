//! What OBJ files have besides polygons, the words of other programs for numbers, and the line ends of other systems.

use super::*;
use glam::Vec3;

const CURVES: &str = "vp 0.2 0.3\ncstype rat bspline\ndeg 2 2\nsurf -1 2 -2 2 \\\n 1 2 3 4\nparm u 0 1\nparm v 0 1\ntrim 0 1 1\nend\n\
                      curv 0 1 1 2 3\ncurv2 1 1\n";

#[test]
fn curves_and_surfaces_are_named() {
    let scene = obj(format!("{TRIANGLE}{CURVES}l 1 2\nl 2 3\np 1\n")).load("mesh.obj");
    warned(
        &scene,
        &["mesh.obj:5", "free-form", "`cstype`", "`surf`", "`curv`", "`curv2`", "`trim`", "2 `parm`", "polygons"],
    );
    warned(&scene, &["mesh.obj:16", "line (`l`)", "1 more"]);
    warned(&scene, &["mesh.obj:18", "point (`p`)"]);
    let error = obj(format!("{}{CURVES}l 1 2\nbleh\n", TRIANGLE.replace("f 1 2 3", ""))).error("mesh.obj").to_string();
    for part in [
        "no face with 3 or more corners",
        "3 vertices",
        "1 lines (`l`)",
        "`surf`",
        "`curv`",
        "1 lines with unknown keywords",
    ] {
        assert!(error.contains(part), "{part} is not in {error}");
    }
}

#[test]
fn nothing_is_called() {
    let scene = obj(format!("call other.obj\ncsh rm -rf here\n{TRIANGLE}")).load("mesh.obj");
    warned(&scene, &["mesh.obj:1", "`call`", "`csh`", "never done"]);
}

#[test]
fn every_unknown_word_is_named() {
    let scene = obj(format!("{TRIANGLE}bleh\nfoo\nbleh\n")).load("mesh.obj");
    warned(&scene, &["mesh.obj:5", "`bleh`", "`foo`", "2 more"]);
}

#[test]
fn lines_end_as_on_any_system() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for text in [
        TRIANGLE.replace('\n', "\r"),
        TRIANGLE.replacen('\n', "\r", 2),
        TRIANGLE.replace("f 1 2 3", "fo 1 2 3"),
        TRIANGLE.replace(' ', "\t"),
        TRIANGLE.replace('\n', "\r").replace("f 1 2 3", "f 1 \\\r2 3"),
    ] {
        assert_eq!(obj(&text).load("mesh.obj").meshes[0].positions, positions, "{text:?}");
    }
    obj_fails("v 0 0 0\rv 1 0 0\r\nv x 0 0\n", 3, &["`x`"]);
    let mtl = with_mtl("newmtl m\rKd 0.1 0.2 0.3\r");
    assert_eq!(first_material(&mtl.load("mesh.obj")).lambert, Vec3::new(0.1, 0.2, 0.3));
}

#[test]
fn numbers_that_are_none_by_their_many_names() {
    for word in ["-1.#IND00", "1.#QNAN", "1.#INF", "-1.#INF00", "nan(ind)", "-nan(ind)", "1.#SNAN", "nan", "inf"] {
        let scene = obj(format!(
            "vt {word} 0\nvt 1 0\nvn 0 {word} 1\nvn 0 0 1\n{}",
            TRIANGLE.replace("f 1 2 3", "f 1/1/1 2/2/2 3/2/2")
        ));
        let scene = scene.load("mesh.obj");
        warned(&scene, &["mesh.obj:1", "not finite"]);
        warned(&scene, &["mesh.obj:3", "normal", "not finite"]);
        obj_fails(&format!("{TRIANGLE}v 0 {word} 0\n"), 5, &["not finite", word]);
        warned(
            &with_mtl(format!("newmtl m\nKd {word} 0 0\nNs {word}\n")).load("mesh.obj"),
            &["mesh.mtl:2", "Kd", "finite"],
        );
    }
}
