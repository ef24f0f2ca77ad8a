//! The scenes of the project.

use super::*;
use glam::Vec3;
use luminaire::scene::{Integrator, Luminaire};

fn own(name: &str) -> Scene {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_projects_scenes_load_without_a_warning() {
    for (name, triangles) in [
        ("cornell/cornell.toml", 38),
        ("furnace/furnace.toml", 320),
        ("instances/instances.toml", 4 + 3 * 1280),
        ("simple/simple.toml", 38),
    ] {
        let scene = own(name);
        assert_eq!(scene.warnings, Vec::<String>::new(), "{name}");
        assert_eq!(scene.triangle_count(), triangles, "{name}");
    }
}

#[test]
fn the_glass_of_the_projects_scenes_is_closed() {
    for name in ["glass/glass.toml", "furnace/glass.toml"] {
        let warnings = own(name).warnings;
        assert!(!warnings.iter().any(|warning| warning.contains("glass")), "{name}: {warnings:?}");
    }
}

#[test]
fn the_cornell_box_is_closed_but_for_its_front_and_faces_inwards() {
    let scene = own("cornell/cornell.toml");
    let mesh = &scene.meshes[0];
    let lamp: f64 = mesh
        .triangles
        .iter()
        .filter(|triangle| scene.material_of(&scene.objects[0], triangle).emission != Vec3::ZERO)
        .map(|triangle| {
            let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
            let normal = (b - a).cross(c - a);
            assert!(normal.y < 0.0, "the lamp faces down");
            0.5 * normal.length()
        })
        .sum();
    assert!((lamp - 130.0 * 105.0).abs() < 1e-6, "{lamp}");
    // Consistent winding: every edge is shared in opposite directions, but for the room's front and the feet of the blocks.
    let mut edges = std::collections::HashMap::new();
    for triangle in &mesh.triangles {
        let corners = triangle.vertices.map(|v| mesh.positions[v as usize].to_array().map(f32::to_bits));
        for i in 0..3 {
            *edges.entry((corners[i], corners[(i + 1) % 3])).or_insert(0) += 1;
        }
    }
    let open = edges.iter().filter(|((a, b), _)| !edges.contains_key(&(*b, *a))).count();
    assert_eq!(open, 4 + 2 * 4, "edges without a neighbour of the opposite direction");
    assert!(edges.values().all(|count| *count == 1), "an edge is used twice in one direction");
}

#[test]
fn the_furnace_is_closed_and_faces_inwards() {
    let scene = own("furnace/furnace.toml");
    let mesh = &scene.meshes[0];
    assert_eq!(first_material(&scene).lambert, Vec3::splat(0.5));
    assert_eq!(first_material(&scene).emission, Vec3::ONE);
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!((-4.19..-3.9).contains(&volume), "negative, and nearly that of the ball: {volume}");
}

#[test]
fn instances_share_a_mesh_and_keep_their_transforms() {
    let scene = own("instances/instances.toml");
    assert_eq!(scene.meshes.len(), 2);
    let [_, bird, tall, mirrored] = &scene.objects[..] else { panic!("{:?}", scene.objects) };
    assert_eq!((bird.mesh, tall.mesh, mirrored.mesh), (1, 1, 1));
    assert!(mirrored.object_to_world.matrix3.determinant() < -0.99);
    assert!((tall.object_to_world.matrix3.determinant() - 0.6 * 1.3 * 0.6).abs() < 1e-5);
    assert_eq!(scene.materials[tall.material.expect("blue") as usize].name, "blue");
    let mesh = &scene.meshes[1];
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-6));
    assert!(matches!(scene.luminaires[..], [Luminaire::Point { .. }, Luminaire::Infinite { .. }]));
}

#[test]
fn the_simple_scene_switches_the_lamp_off() {
    let scene = own("simple/simple.toml");
    assert_eq!(material(&scene, "lamp").emission, Vec3::ZERO);
    assert!(matches!(scene.integrator, Integrator::Simple { .. }));
}
