//! The luminaire table, as the kernel has it.

use crate::gpu::bvh::MeshBvh;
use crate::gpu::layout::{self, LuminaireKind};
use crate::scene::rounding::across;
pub use crate::scene::rounding::{
    MOST_NARROW, PLANE_ROUNDINGS, POINT_ROUNDINGS, TO_OBJECT_ROUNDINGS, TO_WORLD_ROUNDINGS, UNIT_ROUNDOFF,
};
use crate::scene::{
    EmissiveTriangle, Luminaire, LuminaireTable, Profile, SampledLuminaire, Scene, photometric_frame, spot_edge,
};
use bytemuck::Zeroable;
use std::sync::Arc;

/// Texels of the luminaire table, and behind it of the profiles that are in it; `places` says where the kernel has each mesh's triangles.
pub(in crate::gpu) fn luminaires(scene: &Scene, table: &LuminaireTable, places: &[MeshBvh]) -> Vec<[u32; 4]> {
    let mut profiles = Profiles::behind(table.entries.len());
    // For each mesh that emits, the place of each of its triangles.
    let mut place_of: Vec<Vec<u32>> = vec![Vec::new(); scene.meshes.len()];
    let mut luminaires = Vec::with_capacity(table.entries.len());
    for (index, entry) in table.entries.iter().enumerate() {
        let (threshold, alias_index) = table.choice.slots[index];
        let pdf = table.choice.pdf[index];
        let slot = layout::Luminaire {
            ideal_probability: table.ideal_probability(index) as f32,
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
            SampledLuminaire::Impulse(Luminaire::Spot { position, direction, intensity, inner, outer }) => {
                let (edge, scale) = spot_edge(*inner, *outer);
                layout::Luminaire {
                    a: position.to_array(),
                    b: direction.to_array(),
                    area: edge as f32,
                    position_error: scale as f32,
                    radiance: intensity.to_array(),
                    kind: LuminaireKind::Spot as u32,
                    ..slot
                }
            }
            SampledLuminaire::Impulse(Luminaire::Photometric { position, direction, up, intensity, profile }) => {
                let [zero, quarter] = photometric_frame(*direction, *up).map(|across| across.as_vec3().to_array());
                layout::Luminaire {
                    a: position.to_array(),
                    b: direction.to_array(),
                    c: zero,
                    normal: quarter,
                    radiance: intensity.to_array(),
                    kind: LuminaireKind::Photometric as u32,
                    triangle: profiles.place(profile),
                    ..slot
                }
            }
            SampledLuminaire::Sun(sun) => layout::Luminaire {
                a: sun.towards.to_array(),
                area: sun.extent as f32,
                radiance: sun.radiance.as_vec3().to_array(),
                kind: LuminaireKind::Sun as u32,
                ..slot
            },
            // The table has discs for those with an extent.
            SampledLuminaire::Impulse(
                Luminaire::Infinite { direction, irradiance } | Luminaire::Sun { direction, irradiance, .. },
            ) => layout::Luminaire {
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
    let mut texels: Vec<[u32; 4]> = bytemuck::cast_slice(&luminaires).to_vec();
    texels.append(&mut profiles.texels);
    texels
}

/// Profiles as texels, each once.
struct Profiles {
    /// At which the first one begins.
    first: usize,
    texels: Vec<[u32; 4]>,
    known: Vec<(Arc<Profile>, u32)>,
}

impl Profiles {
    /// Behind so many luminaires.
    fn behind(luminaires: usize) -> Self {
        let first = luminaires * size_of::<layout::Luminaire>() / 16;
        Profiles { first, texels: Vec::new(), known: Vec::new() }
    }

    /// The texel at which a profile begins.
    fn place(&mut self, profile: &Arc<Profile>) -> u32 {
        if let Some((_, place)) = self.known.iter().find(|(known, _)| Arc::ptr_eq(known, profile)) {
            return *place;
        }
        let place = (self.first + self.texels.len()) as u32;
        let Profile { name: _, vertical, horizontal, candela } = &**profile;
        self.texels.push([vertical.len() as u32, horizontal.len() as u32, 0, 0]);
        let numbers: Vec<f32> = vertical.iter().chain(horizontal).chain(candela).copied().collect();
        self.texels.extend(numbers.chunks(4).map(|four| {
            let mut texel = [0; 4];
            texel.iter_mut().zip(four).for_each(|(bits, number)| *bits = number.to_bits());
            texel
        }));
        self.known.push((profile.clone(), place));
        place
    }
}

/// For each triangle of a mesh, its place among all triangles.
fn inverse(mesh: &MeshBvh) -> Vec<u32> {
    let mut places = vec![0; mesh.order.len()];
    for (place, triangle) in mesh.order.iter().enumerate() {
        places[*triangle as usize] = mesh.triangle_offset + place as u32;
    }
    places
}

/// How far a point that the kernel computes on an emissive triangle can lie from the surface that rays meet: as the same number for each
/// coordinate, of which the kernel takes the part across the triangle.
fn position_error(scene: &Scene, triangle: &EmissiveTriangle) -> f64 {
    let (across, normal) = across(scene, triangle.object, triangle.triangle, triangle.vertices);
    across / normal.abs().element_sum()
}
