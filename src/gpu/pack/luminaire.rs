//! The luminaire table, as the kernel has it.

use crate::gpu::bvh::MeshBvh;
use crate::gpu::layout::{self, LuminaireKind};
use crate::scene::{EmissiveTriangle, Luminaire, LuminaireTable, SampledLuminaire, Scene, widen};
use bytemuck::Zeroable;
use glam::{DAffine3, DMat3, DVec3};

/// Half a unit in the last place of 1: the relative error of one rounding. This and the next ones are twins of `shaders/surfel.glsl`.
pub const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 * 0.5;
/// Roundings of a point from its weights and the corners.
pub const POINT_ROUNDINGS: f64 = 7.0;
/// Roundings of a point's distance to the triangle's plane in the intersection tests.
pub const PLANE_ROUNDINGS: f64 = 4.0;
/// By how much the latter grow at most for a narrow triangle.
pub const MOST_NARROW: f64 = 256.0;
/// Roundings of the transform of a ray's origin into the object's space.
pub const TO_OBJECT_ROUNDINGS: f64 = 5.0;
/// Roundings of the transform of a point into world space.
pub const TO_WORLD_ROUNDINGS: f64 = 4.0;

/// The luminaire table; `places` says where the kernel has each mesh's triangles.
pub(in crate::gpu) fn luminaires(scene: &Scene, table: &LuminaireTable, places: &[MeshBvh]) -> Vec<layout::Luminaire> {
    // For each mesh that emits, the place of each of its triangles.
    let mut place_of: Vec<Vec<u32>> = vec![Vec::new(); scene.meshes.len()];
    let mut luminaires = Vec::with_capacity(table.entries.len());
    for (index, entry) in table.entries.iter().enumerate() {
        let (threshold, alias_index) = table.choice.slots[index];
        let pdf = table.choice.pdf[index];
        let ideal = match entry {
            SampledLuminaire::Area(triangle) => table.area_probability(triangle.material, triangle.area()),
            SampledLuminaire::Impulse(_) | SampledLuminaire::Environment => pdf,
        };
        let slot = layout::Luminaire {
            ideal_probability: ideal as f32,
            probability: pdf as f32,
            threshold,
            alias_index,
            ..Zeroable::zeroed()
        };
        luminaires.push(match entry {
            SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => layout::Luminaire {
                a: position.to_array(),
                radiance: intensity.to_array(),
                kind: LuminaireKind::Point as u32,
                ..slot
            },
            SampledLuminaire::Impulse(Luminaire::Infinite { direction, irradiance }) => layout::Luminaire {
                a: (-*direction).to_array(),
                radiance: irradiance.to_array(),
                kind: LuminaireKind::Infinite as u32,
                ..slot
            },
            SampledLuminaire::Area(triangle) => {
                let mesh = scene.objects[triangle.object as usize].mesh as usize;
                if place_of[mesh].is_empty() {
                    place_of[mesh] = inverse(&places[mesh]);
                }
                let material = &scene.materials[triangle.material as usize];
                let [a, b, c] = triangle.vertices.map(|v| v.as_vec3().to_array());
                layout::Luminaire {
                    a,
                    b,
                    area: triangle.area() as f32,
                    c,
                    position_error: position_error(scene, triangle) as f32,
                    normal: triangle.normal.as_vec3().to_array(),
                    one_sided: f32::from(u8::from(material.one_sided)),
                    radiance: material.emission.to_array(),
                    kind: LuminaireKind::Area as u32,
                    triangle: place_of[mesh][triangle.triangle as usize],
                    material: triangle.material,
                    ..slot
                }
            }
            SampledLuminaire::Environment => layout::Luminaire { kind: LuminaireKind::Surroundings as u32, ..slot },
        });
    }
    luminaires
}

/// For each triangle of a mesh, its place among all triangles.
fn inverse(mesh: &MeshBvh) -> Vec<u32> {
    let mut places = vec![0; mesh.order.len()];
    for (place, triangle) in mesh.order.iter().enumerate() {
        places[*triangle as usize] = mesh.triangle_offset + place as u32;
    }
    places
}

/// How far a point that the kernel computes on an emissive triangle can lie from the surface that rays meet, in each
/// coordinate, so far as it lies across the surface: the bounds of `shaders/surfel.glsl`, taken over the whole triangle. They are the
/// rounding of the point itself, of the triangle test (by the triangle's size, and the more the narrower it is), and of the transforms.
fn position_error(scene: &Scene, triangle: &EmissiveTriangle) -> f64 {
    let gamma = |roundings: f64| roundings * UNIT_ROUNDOFF;
    let absolute = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let object = &scene.objects[triangle.object as usize];
    let mesh = &scene.meshes[object.mesh as usize];
    let corners = mesh.triangles[triangle.triangle as usize].vertices.map(|v| mesh.positions[v as usize].as_dvec3());
    let [a, b, c] = corners;
    let size = ((b - a).abs() + (c - a).abs()).max_element();
    let narrow = (size * size / (b - a).cross(c - a).abs().max_element()).min(MOST_NARROW);
    let to_world = widen(object.object_to_world);
    let largest = |points: [DVec3; 3]| points.iter().fold(DVec3::ZERO, |m, v| m.max(v.abs()));
    let reach = largest(triangle.vertices);
    let mut in_object = gamma(POINT_ROUNDINGS) * largest(corners) + gamma(PLANE_ROUNDINGS) * size * narrow;
    let mut in_world = gamma(TO_WORLD_ROUNDINGS) * reach;
    if to_world != DAffine3::IDENTITY {
        let to_object = to_world.inverse();
        in_object += gamma(TO_OBJECT_ROUNDINGS) * (absolute(to_object.matrix3) * reach + to_object.translation.abs());
        in_world +=
            gamma(TO_WORLD_ROUNDINGS) * (absolute(to_world.matrix3) * largest(corners) + to_world.translation.abs());
    }
    // Only what is across the triangle matters, and a transform takes distances across it to such by one factor.
    let object_normal = (b - a).cross(c - a).normalize();
    let normal = to_world.matrix3.inverse().transpose() * object_normal;
    let unit = normal.normalize().abs();
    let across = object_normal.abs().dot(in_object) / normal.length() + unit.dot(in_world);
    // As the same number for each coordinate, of which the kernel takes the part across the triangle.
    across / unit.element_sum()
}
