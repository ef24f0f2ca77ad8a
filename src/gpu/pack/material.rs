//! Materials, as the kernel has them.

use crate::gpu::layout;
use crate::scene::{LuminaireTable, Material, Scene, coat_transmittance};
use glam::Vec3;
use std::f64::consts::PI;

/// A material of a scene; `physical` is the texel of its metallic-roughness surface, 0 if it has none.
pub(in crate::gpu) fn material(scene: &Scene, table: &LuminaireTable, index: usize, physical: u32) -> layout::Material {
    let material: &Material = &scene.materials[index];
    let m = f64::from(material.exponent);
    // N(m), by which the lobe reflects no more than its albedo.
    let normalisation = (m + 2.0) * (m + 4.0) / (8.0 * PI * ((-m / 2.0).exp2() + m));
    let coat = material.eta.filter(|_| material.is_coated()).map_or(1.0, |eta| coat_transmittance(eta.into()));
    let map = |map: Option<u32>| map.unwrap_or(layout::NONE);
    let maps = material.maps;
    let transmission = if material.eta.is_some() { material.transmission } else { Vec3::ZERO };
    layout::Material {
        ambient: material.ambient.to_array(),
        normalisation: normalisation as f32,
        lambert: material.lambert.to_array(),
        impulse_probability: material.impulse_probability.unwrap_or(layout::BY_ALBEDOS),
        glossy: material.glossy.to_array(),
        exponent: material.exponent,
        emission: material.emission.to_array(),
        area_density: table.area_density[index] as f32,
        reflection: material.reflection.to_array(),
        eta: material.eta.unwrap_or(layout::MIRROR),
        transmission: transmission.to_array(),
        opacity: material.opacity,
        ambient_map: map(maps.ambient),
        lambert_map: map(maps.lambert),
        glossy_map: map(maps.glossy),
        emission_map: map(maps.emission),
        opacity_map: map(maps.opacity),
        one_sided: u32::from(material.one_sided),
        kind: u32::from(material.is_sheet()) + 2 * physical,
        coat_transmittance: coat as f32,
        normal_map: map(material.normal_map.map(|map| map.texture)),
        normal_scale: material.normal_map.map_or(1.0, |map| map.scale),
        bump_map: map(material.bump_map.map(|map| map.texture)),
        bump_scale: material.bump_map.map_or(1.0, |map| map.scale),
    }
}
