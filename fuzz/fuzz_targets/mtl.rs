//! Whatever is in an MTL file, the mesh loads, and its materials are physical.
#![no_main]

#[path = "../common/folder.rs"]
mod folder;

/// The materials that the seeds name.
const MESH: &[u8] = b"mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n\
    usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\nusemtl\nf 1/1 2/2 3/3\n";

libfuzzer_sys::fuzz_target!(init: {
    folder::write("mesh.obj", MESH);
    // A texture of 2 x 1 texels, as PPM.
    folder::write("a.ppm", b"P6 2 1 255\n\xff\x80\x00\x00\x80\xff");
}, |bytes: &[u8]| {
    folder::write("mesh.mtl", bytes);
    let scene = luminaire::scene::load(&folder::file("mesh.obj")).expect("an MTL file is never fatal");
    for material in &scene.materials {
        let parts = [material.lambert, material.glossy, material.emission, material.ambient, material.reflection];
        assert!(parts.iter().all(|part| part.is_finite() && part.min_element() >= 0.0), "{material:?}");
        assert!((0.0..=1.0).contains(&material.opacity), "{material:?}");
        if let Some(surface) = &material.physical {
            let shares = [surface.metallic, surface.roughness, surface.specular, surface.transmission, surface.clearcoat];
            assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)), "{material:?}");
            let colours = [surface.base_color, surface.sheen_color];
            assert!(colours.iter().all(|colour| colour.min_element() >= 0.0 && colour.max_element() <= 1.0), "{material:?}");
            assert!((1.0..=100.0).contains(&surface.ior), "{material:?}");
        }
    }
});
