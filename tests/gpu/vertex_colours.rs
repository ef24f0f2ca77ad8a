//! Colours of vertices: the kernel against the reference, pixel by pixel.

use super::features::assert_specialisation_is_invisible;
use super::pictures::{differing, pixels};
use super::*;
use crate::common::scenes::*;
use glam::Vec3;
use luminaire::gpu::specialization::KernelModel;
use luminaire::reference::Reference;
use luminaire::scene::{Integrator, Scene};

/// The room with a colour at every vertex of all meshes but one.
fn coloured_room() -> Scene {
    let mut scene = cornell_like(64, 64);
    for mesh in scene.meshes.iter_mut().skip(1).map(Arc::make_mut) {
        mesh.colours = mesh.positions.iter().map(|p| (0.5 + 0.3 * (7.0 * *p + Vec3::X).map(f32::sin)).abs()).collect();
    }
    scene
}

#[test]
fn coloured_vertices_equal_the_reference_pixel_by_pixel() {
    let mut path = coloured_room();
    estimator(&mut path).max_bounces = Some(1);
    let mut simple = coloured_room();
    simple.integrator = Integrator::Simple { ambient: Vec3::splat(0.3) };
    simple.materials.iter_mut().for_each(|m| m.ambient = m.lambert);
    assert!(KernelModel::of(&path).features.vertex_colours);
    assert!(!KernelModel::of(&cornell_like(4, 4)).features.vertex_colours);
    for (name, scene) in [("path", path), ("simple", simple)] {
        let expected = pixels(&mut Reference::new(&scene), &scene, 8);
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 8);
            let count = differing(&found, &expected, 2e-4);
            assert!(count <= found.len() / 200, "{name}, {}: {count} of {} differ", backend.name(), found.len());
            if name == "path" {
                assert_specialisation_is_invisible(backend, name, &scene);
            }
        });
    }
}
