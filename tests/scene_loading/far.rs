//! Scenes far from the origin.

use super::*;
use glam::{DVec3, Vec3};
use luminaire::reference::Reference;

const UTM: DVec3 = DVec3::new(412_345.678, 5_654_321.234, 98.5);
const ECEF: DVec3 = DVec3::new(-2_694_045.1, -4_293_642.2, 3_857_878.9);

/// A wall of ten metres with pilasters of two centimetres.
fn wall(at: DVec3) -> String {
    let mut text = String::new();
    let mut quad = |corners: [[f64; 3]; 4]| {
        for corner in corners {
            let DVec3 { x, y, z } = at + DVec3::from(corner);
            text += &format!("v {x:.3} {y:.3} {z:.3}\n");
        }
        text += "f -4 -3 -2 -1\n";
    };
    quad([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 0.0, 6.0], [0.0, 0.0, 6.0]]);
    for k in 0..20 {
        let x = 0.25 + 0.5 * f64::from(k);
        quad([[x, -0.01, 1.0], [x + 0.02, -0.01, 1.0], [x + 0.02, -0.01, 5.0], [x, -0.01, 5.0]]);
        quad([[x, -0.01, 1.0], [x, 0.0, 1.0], [x, 0.0, 5.0], [x, -0.01, 5.0]]);
    }
    text
}

fn file(at: DVec3, objects: &str) -> String {
    let triple = |p: DVec3| format!("[{:.3}, {:.3}, {:.3}]", p.x + at.x, p.y + at.y, p.z + at.z);
    format!(
        "[film]\nwidth = 24\nheight = 16\n[sensor]\nposition = {}\ntarget = {}\nup = [0, 0, 1]\nfov = 35\n\
         [[luminaire]]\nkind = \"point\"\nposition = {}\nintensity = [50, 50, 50]\n{objects}",
        triple(DVec3::new(5.0, -18.0, 6.0)),
        triple(DVec3::new(5.0, 0.0, 3.0)),
        triple(DVec3::new(2.0, -5.0, 4.0)),
    )
}

const OBJECT: &str = "[[object]]\nmesh = \"mesh.obj\"\n";

/// Radiance of the reference at every pixel.
fn picture(scene: &Scene) -> Vec<DVec3> {
    let tracer = Reference::new(scene);
    (0..scene.film.width * scene.film.height).map(|pixel| tracer.radiance(pixel, 0).0).collect()
}

#[track_caller]
fn looks_alike(scene: &Scene, near: &Scene) {
    assert_eq!(scene.triangle_count(), near.triangle_count());
    assert_eq!(scene.warnings, [""; 0]);
    let (found, expected) = (picture(scene), picture(near));
    let differing =
        found.iter().zip(&expected).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-3 * b.max_element());
    // Samples at an edge may fall on its other side.
    let differing = differing.count();
    assert!(differing <= 4, "{differing} of {} pixels", found.len());
}

#[test]
fn a_far_scene_looks_as_the_same_one_at_the_origin() {
    let near = obj(wall(DVec3::ZERO)).with("scene.toml", file(DVec3::ZERO, OBJECT)).load("scene.toml");
    assert_eq!(near.origin, DVec3::ZERO);
    for at in [UTM, ECEF, DVec3::new(0.0, 1e7, 0.0)] {
        let far = obj(wall(at)).with("scene.toml", file(at, OBJECT)).load("scene.toml");
        assert!(far.origin.distance(at) < 20.0, "{}", far.origin);
        assert!(far.objects[0].object_to_world == glam::Affine3A::IDENTITY, "nothing is left to move");
        looks_alike(&far, &near);
        // The mesh is near, the object is far.
        let place = format!("{OBJECT}translate = [{}, {}, {}]\n", at.x, at.y, at.z);
        looks_alike(&obj(wall(DVec3::ZERO)).with("scene.toml", file(at, &place)).load("scene.toml"), &near);
        let matrix = format!("{OBJECT}matrix = [[1, 0, 0, {}], [0, 1, 0, {}], [0, 0, 1, {}]]\n", at.x, at.y, at.z);
        looks_alike(&obj(wall(DVec3::ZERO)).with("scene.toml", file(at, &matrix)).load("scene.toml"), &near);
        // The mesh is far, and the object brings it back.
        let back = format!("{OBJECT}translate = [{}, {}, {}]\n", -at.x, -at.y, -at.z);
        let back = obj(wall(at)).with("scene.toml", file(DVec3::ZERO, &back)).load("scene.toml");
        assert_eq!(back.origin, DVec3::ZERO);
        looks_alike(&back, &near);
    }
}

/// Files that stand where they say share the scene's origin, so that what meets in them goes on meeting.
#[test]
fn neighbours_share_an_origin() {
    let next = DVec3::new(10.0, 0.0, 0.0);
    let objects = format!("{OBJECT}[[object]]\nmesh = \"next.obj\"\n");
    let load = |at: DVec3| {
        obj(wall(at)).with("next.obj", wall(at + next)).with("scene.toml", file(at, &objects)).load("scene.toml")
    };
    let far = load(UTM);
    assert!(far.objects.iter().all(|object| object.object_to_world == glam::Affine3A::IDENTITY));
    assert_eq!(far.meshes[0].positions[1], far.meshes[1].positions[0]);
    looks_alike(&far, &load(DVec3::ZERO));
}

#[test]
fn a_bare_mesh_is_moved_too() {
    let (far, near) = (obj(wall(UTM)).load("mesh.obj"), obj(wall(DVec3::ZERO)).load("mesh.obj"));
    assert_eq!((far.triangle_count(), far.warnings.len()), (near.triangle_count(), near.warnings.len()));
    let (low, high) = far.world_bounds();
    assert!((high - low - DVec3::new(10.0, 0.01, 6.0)).abs().max_element() < 1e-5, "{low} {high}");
    assert!((low + far.origin - UTM - DVec3::new(0.0, -0.01, 0.0)).abs().max_element() < 1e-3);
}

/// Stray vertices that no face uses do not count, and what is not far keeps its numbers to the last bit.
#[test]
fn ordinary_scenes_are_not_touched() {
    let stray = obj(format!("v 0 0 0\n{}", wall(UTM))).load("mesh.obj");
    assert!(stray.origin != DVec3::ZERO);
    let text = "v 10.1 0.3 0\nv 11.7 0.1 0\nv 10.3 1.9 0\nf 1 2 3\n";
    let scene = obj(text).with("scene.toml", format!("{SENSOR}{LIGHT}{OBJECT}translate = [0.1, 0.2, 0.3]\n"));
    let scene = scene.load("scene.toml");
    assert_eq!(scene.origin, DVec3::ZERO);
    assert_eq!(
        scene.meshes[0].positions,
        [Vec3::new(10.1, 0.3, 0.0), Vec3::new(11.7, 0.1, 0.0), Vec3::new(10.3, 1.9, 0.0)]
    );
    assert_eq!(scene.objects[0].object_to_world, glam::Affine3A::from_translation(Vec3::new(0.1, 0.2, 0.3)));
}

#[test]
fn what_single_precision_cannot_hold_is_said() {
    // A village and another one on the other side of the earth in one file.
    let mesh = format!("{}v 0 0 0\nv 1e7 0 0\nv 0 1e7 0\nf -3 -2 -1\n", wall(UTM));
    warned(&obj(mesh).load("mesh.obj"), &["mesh.obj", "too small", "single precision", "split it"]);
    // In two files: each is held well, but not where it stands.
    let objects = format!("{OBJECT}[[object]]\nname = \"there\"\nmesh = \"near.obj\"\n");
    let two = obj(wall(UTM)).with("near.obj", wall(DVec3::ZERO)).with("scene.toml", file(DVec3::ZERO, &objects));
    warned(&two.load("scene.toml"), &["`mesh`", "away", "single precision", "5.6"]);
    // What has no area in the file has none for another reason.
    warned(&obj(format!("{TRIANGLE}f 1 1 2\n")).load("mesh.obj"), &["1 zero-area"]);
}

/// A file in feet, brought to metres and to its own origin by the object: a factor of single precision would move it by centimetres.
#[test]
fn factors_and_turns_of_far_meshes_keep_their_digits() {
    let mesh = "v 4075539.53 931735.27 0\nv 4075540.53 931735.27 0\nv 4075539.53 931736.27 0\nf 1 2 3\n";
    let at = |object: &str| {
        let text = format!("{SENSOR}{LIGHT}{OBJECT}{object}");
        obj(mesh).with("scene.toml", text).load("scene.toml").world_bounds()
    };
    let (dx, dy) = (4_075_539.53f64 * 0.3048, 931_735.27f64 * 0.3048);
    for object in [
        format!("scale = 0.3048\ntranslate = [{}, {}, 0]\n", -dx, -dy),
        format!("matrix = [[0.3048, 0, 0, {}], [0, 0.3048, 0, {}], [0, 0, 0.3048, 0]]\n", -dx, -dy),
    ] {
        let (low, high) = at(&object);
        assert!(
            low.abs().max_element() < 1e-6 && (high - DVec3::new(0.3048, 0.3048, 0.0)).length() < 1e-6,
            "{low} {high}"
        );
    }
    // Turned by 33 degrees about z, then back to where its first corner is the origin.
    let (sin, cos) = 33f64.to_radians().sin_cos();
    let (x, y) = (4_075_539.53 * cos - 931_735.27 * sin, 4_075_539.53 * sin + 931_735.27 * cos);
    let (low, high) = at(&format!("rotate = [0, 0, 33]\ntranslate = [{}, {}, 0]\n", -x, -y));
    let expected = (DVec3::new(-sin, 0.0, 0.0), DVec3::new(cos, sin.max(cos), 0.0));
    assert!((low - expected.0).length() < 1e-3 && high.x - expected.1.x < 1e-3, "{low} {high}");
}
