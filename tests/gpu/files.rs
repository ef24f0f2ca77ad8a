//! Scenes from files whose pictures say what their numbers mean: what a picture of them shows, on every backend and the reference.

use super::pictures::pixels;
use super::*;
use glam::DVec3;
use luminaire::reference::Reference;
use luminaire::scene::load;

const SCENE: &str = "[film]\nwidth = 12\nheight = 4\n[sensor]\nkind = \"orthographic\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nheight = 2\n\
    [environment]\nimage = \"sky.hdr\"\n[[object]]\nmesh = \"mesh.obj\"\n";

/// Three squares side by side; the middle one is not there.
const MESH: &str = "mtllib mesh.mtl\nv -3 -1 0\nv -1 -1 0\nv -1 1 0\nv -3 1 0\nv 1 -1 0\nv 3 -1 0\nv 3 1 0\nv 1 1 0\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl lamp\nf 1/1 2/2 3/3 4/4\nusemtl wall\nf 5 6 7 8\n";

/// `wall` is what an exporter writes that asks for glass and for transparency in everything: opaque.
const MATERIALS: &str = "newmtl lamp\nKd 0 0 0\nKe 1 1 1\nmap_Ke code.png\n\
    newmtl wall\nillum 4\nKd 0.5 0.5 0.5\nTf 1 1 1\nNi 1\nTr 1\n";

/// From left to right: a lamp of code 128 of a linear PNG, 128/255; a sky of radiance 1 that was stored four times as bright; and a wall
/// that reflects half of it.
#[test]
fn pictures_mean_what_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("a file");
    write("scene.toml", SCENE.as_bytes());
    write("mesh.obj", MESH.as_bytes());
    write("mesh.mtl", MATERIALS.as_bytes());
    let sky = [128, 128, 128, 131].repeat(2);
    write(
        "sky.hdr",
        &[b"#?RGBE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\nCOLORCORR=2 2 2\n\n-Y 1 +X 2\n", &sky[..]].concat(),
    );
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 1, 1);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&[128])).expect("a PNG");
    write("code.png", &png);

    let scene = load(&folder.path().join("scene.toml")).expect("a scene");
    let check = |name: &str, found: &[DVec3]| {
        let parts = [0, 1, 2].map(|part| {
            let of_part = (0..4).flat_map(|row| (0..4).map(move |column| found[12 * row + 4 * part + column]));
            of_part.sum::<DVec3>() / 16.0
        });
        // Half floats have eleven bits; the sky is seen as it is, and reflected by chance.
        for (part, (expected, tolerance)) in parts.into_iter().zip([(128.0 / 255.0, 3e-4), (1.0, 1e-6), (0.5, 0.01)]) {
            assert!((part - DVec3::splat(expected)).abs().max_element() < tolerance, "{name}: {part}, not {expected}");
        }
    };
    check("the reference", &pixels(&mut Reference::new(&scene), &scene, 64));
    on_every_backend(|backend| check(backend.name(), &pixels(&mut backend.tracer(&scene), &scene, 64)));
}
