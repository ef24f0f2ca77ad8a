//! A bare OBJ file of any bytes loads, or says why not.
#![no_main]

#[path = "../common/folder.rs"]
mod folder;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = folder::write("mesh.obj", bytes);
    if let Ok(scene) = luminaire::scene::load(&path) {
        let mesh = &scene.meshes[0];
        assert!(!mesh.triangles.is_empty() && mesh.positions.iter().all(|position| position.is_finite()));
        let count = mesh.positions.len();
        assert!(mesh.triangles.iter().flat_map(|triangle| triangle.vertices).all(|vertex| (vertex as usize) < count));
        assert!([mesh.normals.len(), mesh.uvs.len()].iter().all(|length| *length == 0 || *length == count));
    }
});
