//! A scene file of any bytes loads, or says why not; what loads can be traced.
#![no_main]

#[path = "../common/folder.rs"]
mod folder;

libfuzzer_sys::fuzz_target!(init: {
    folder::write("mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    folder::write("a.ppm", b"P6 2 1 255\n\xff\x80\x00\x00\x80\xff");
}, |bytes: &[u8]| {
    let path = folder::write("scene.toml", bytes);
    if let Ok(scene) = luminaire::scene::load(&path) {
        assert!(!scene.objects.is_empty());
        let (low, high) = scene.world_bounds();
        assert!(low.is_finite() && high.is_finite());
        luminaire::scene::LuminaireTable::new(&scene);
    }
});
