//! Whatever is in a picture, a mesh with it as a texture loads, its texels are finite, and as an environment it is an error or finite too.
#![no_main]

#[path = "../common/folder.rs"]
mod folder;

const MESH: &[u8] = b"mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
/// Colours with their alpha, colours alone, and a scalar.
const MATERIALS: &[u8] = b"newmtl a\nmap_Kd picture\nKe 1 1 1\nmap_Ke -mm 0 2 picture\nKs .1 .1 .1\nNs 1\nmap_Ks picture\nmap_d -imfchan l picture\n";
const SCENE: &[u8] = b"[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40\n[environment]\nimage = \"picture\"\n\
    [[object]]\nmesh = \"mesh.obj\"\n";

libfuzzer_sys::fuzz_target!(init: {
    folder::write("mesh.obj", MESH);
    folder::write("mesh.mtl", MATERIALS);
    folder::write("scene.toml", SCENE);
}, |bytes: &[u8]| {
    let picture = folder::write("picture", bytes);
    let scene = luminaire::scene::load(&folder::file("mesh.obj")).expect("a texture is never fatal");
    for texture in &scene.textures {
        assert!(texture.texels.iter().flatten().all(|number| number.is_finite() && number.to_f32() >= 0.0));
    }
    if let Ok(scene) = luminaire::scene::load(&folder::file("scene.toml"))
        && let Some(image) = scene.environment.as_ref().and_then(|environment| environment.image.as_ref())
    {
        assert!(image.texels.iter().all(|texel| texel.is_finite() && texel.min_element() >= 0.0));
    }
    // The other reader: a picture to compare with. Its numbers may be anything.
    let _ = luminaire::picture::read(&picture);
});
