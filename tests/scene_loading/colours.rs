//! Colours of vertices.

use super::*;
use glam::Vec3;

const FACE: &str = "f 1 2 3\n";

fn colours(text: &str) -> Vec<Vec3> {
    obj(text).load("mesh.obj").meshes[0].colours.clone()
}

fn near(found: &[Vec3], expected: &[Vec3]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (*a - *b).abs().max_element() < 1e-5)
}

/// sRGB 0.5 is 0.21404 linear.
#[test]
fn they_are_srgb_from_0_to_1_or_to_255() {
    let half = 0.214_041;
    let expected = [Vec3::new(1.0, half, 0.0), Vec3::Y, Vec3::Z];
    assert!(near(&colours(&format!("v 0 0 0 1 0.5 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n{FACE}")), &expected));
    let bytes = format!("v 0 0 0 255 127.5 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 255\n{FACE}");
    assert!(near(&colours(&bytes), &expected));
    warned(&obj(&bytes).load("mesh.obj"), &["reach 255", "0 to 255"]);
    let opacity = format!("v 0 0 0 1 0.5 0 1\nv 1 0 0 0 1 0 1\nv 0 1 0 0 0 1 1\n{FACE}");
    assert!(near(&colours(&opacity), &expected));
    let weight = format!("v 0 0 0 1 1 0.5 0\nv 1 0 0 1 0 1 0\nv 0 1 0 1 0 0 1\n{FACE}");
    assert!(near(&colours(&weight), &expected));
    let both = obj(format!("v 0 0 0 2 1 0.5 0 1\nv 1 0 0 1 0 1 0 1\nv 0 2 0 2 0 0 1 1\n{FACE}")).load("mesh.obj");
    assert!(near(&both.meshes[0].colours, &expected), "a weight, a colour and an opacity");
    assert_eq!(both.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn painted_ones_are_read_from_comments() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let block = "#MRGB ffff000000ff8000\n#MRGB ff0000ff\n";
    let expected = [Vec3::X, Vec3::new(1.0, 0.215_861, 0.0), Vec3::Z];
    for text in
        [format!("{vertices}{block}{FACE}"), format!("{block}{vertices}{FACE}"), format!("{vertices}{FACE}{block}")]
    {
        assert!(near(&colours(&text), &expected), "{text}: {:?}", colours(&text));
    }
    warned(&obj(format!("{vertices}#MRGB ffzz\n{FACE}")).load("mesh.obj"), &["mesh.obj:4", "no colour"]);
    warned(
        &obj(format!("{vertices}#MRGB ffff0000{0}{0}{0}\n{FACE}", "ff00ff00")).load("mesh.obj"),
        &["1 colour(s)", "more than"],
    );
}

#[test]
fn white_and_wrong_ones_are_none() {
    assert!(colours(&format!("v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0\n{FACE}")).is_empty());
    let wrong = obj(format!("v 0 0 0 1 nan 0\nv 1 0 0 1 x 1\nv 0 1 0 0 0 1\n{FACE}")).load("mesh.obj");
    warned(&wrong, &["mesh.obj:1", "white", "1 more"]);
    assert!(near(&wrong.meshes[0].colours, &[Vec3::ONE, Vec3::ONE, Vec3::Z]));
    warned(
        &obj(format!("v 0 0 0 1 -1 0\nv 1 0 0 1 1 1\nv 0 1 0 0 0 1\n{FACE}")).load("mesh.obj"),
        &["1 vertex colour(s)", "outside"],
    );
}

/// They are the diffuse colour where nothing else is said, and multiply it where something is.
#[test]
fn they_multiply_the_diffuse_albedo() {
    let text = format!("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n{FACE}");
    assert_eq!(first_material(&obj(&text).load("mesh.obj")).lambert, Vec3::ONE);
    let with_mtl = obj(format!("mtllib mesh.mtl\nusemtl m\n{text}")).with("mesh.mtl", "newmtl m\nKd 0.5 0.25 1\n");
    assert_eq!(first_material(&with_mtl.load("mesh.obj")).lambert, Vec3::new(0.5, 0.25, 1.0));
    let bare = obj(format!("mtllib mesh.mtl\nusemtl m\n{text}")).with("mesh.mtl", "newmtl m\n");
    assert_eq!(first_material(&bare.load("mesh.obj")).lambert, Vec3::ONE);
    // Another mesh without colours keeps the grey.
    let both = obj(&text).with("plain.obj", TRIANGLE).with(
        "scene.toml",
        format!(
            "{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n[[object]]\nmesh = \"plain.obj\"\ntranslate = [0, 0, 1]\n"
        ),
    );
    let scene = both.load("scene.toml");
    let lambert = |object: usize| {
        let object = &scene.objects[object];
        scene.material_of(object, &scene.meshes[object.mesh as usize].triangles[0]).lambert
    };
    assert_eq!([lambert(0), lambert(1)], [Vec3::ONE, Vec3::splat(0.8)]);
}

#[test]
fn a_scene_file_can_leave_them_out() {
    let text = format!("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n{FACE}");
    let object = "[[object]]\nmesh = \"mesh.obj\"\n";
    let file = format!("{SENSOR}{LIGHT}{object}{object}translate = [0, 0, 1]\nvertex_colours = false\n");
    let scene = obj(text).with("scene.toml", file).load("scene.toml");
    assert_eq!(scene.meshes.iter().map(|mesh| mesh.colours.len()).collect::<Vec<_>>(), [3, 0]);
}

/// A material without `Kd` is white under colours and grey elsewhere, also where meshes with and without colours share it, and where an object has it.
#[test]
fn a_shared_material_is_white_under_colours_alone() {
    let plain = "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let painted = "mtllib m.mtl\nusemtl m\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n";
    let object = |file: &str, more: &str| format!("[[object]]\nmesh = \"{file}.obj\"\n{more}");
    let text = "[[material]]\nname = \"own\"\nexponent = 5\n".to_owned()
        + &object("painted", "")
        + &object("plain", "translate = [0, 0, 1]\n")
        + &object("painted", "translate = [0, 0, 2]\nvertex_colours = false\n")
        + &object("painted", "translate = [0, 0, 3]\nmaterial = \"own\"\n")
        + &object("plain", "translate = [0, 0, 4]\nmaterial = \"own\"\n");
    let files = Folder::new().with("m.mtl", "newmtl m\nNs 5\n").with("plain.obj", plain).with("painted.obj", painted);
    let scene = files.with("scene.toml", format!("{text}{LIGHT}")).load("scene.toml");
    let albedo = |object: &luminaire::scene::Object| {
        let mesh = &scene.meshes[object.mesh as usize];
        scene.materials[object.material.unwrap_or(mesh.triangles[0].material) as usize].lambert.x
    };
    let found: Vec<f32> = scene.objects.iter().map(albedo).collect();
    assert_eq!(found, [1.0, 0.8, 0.8, 1.0, 0.8]);
}
