//! The numbers of a metallic-roughness surface at a point: its maps, the colours of the vertices, and which way it is brushed.

use super::normal_map::Tangent;
use super::physical::PhysicalSurface;
use super::prepared_scene::Reference;
use crate::scene::ChannelMap;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

impl Reference {
    /// What the material's metallic-roughness surface is at a point, if it has one. `outward` is the unit normal; `unbent`, on the side of `wo`, that before
    /// maps bent it, which is that of a coat (`KHR_materials_clearcoat`).
    pub(super) fn physical_surface(
        &self,
        material: usize,
        uv: DVec2,
        colour: DVec3,
        tangent: Option<Tangent>,
        outward: DVec3,
        unbent: DVec3,
    ) -> Option<PhysicalSurface> {
        let p = self.scene.materials[material].physical.as_ref()?;
        let maps = &p.maps;
        let number = |map: Option<ChannelMap>| {
            map.map_or(1.0, |map| self.map(Some(map.texture), uv).to_array()[usize::from(map.channel)])
        };
        let tint = |map: Option<u32>| self.map(map, uv).truncate();
        let (mut anisotropy, mut turn) = (f64::from(p.anisotropy), f64::from(p.anisotropy_rotation));
        if anisotropy > 0.0 && maps.anisotropy.is_some() {
            let texel = self.map(maps.anisotropy, uv);
            anisotropy *= texel.z;
            turn += (2.0 * texel.y - 1.0).atan2(2.0 * texel.x - 1.0);
        }
        let (sin, cos) = turn.rem_euclid(TAU).sin_cos();
        let along = |tangent: Tangent| cos * tangent.direction + sin * tangent.bitangent(outward);
        let own = self.surfaces[material]?;
        Some(PhysicalSurface {
            base: own.base * tint(maps.base_color) * colour,
            metallic: own.metallic * number(maps.metallic),
            roughness: own.roughness * number(maps.roughness),
            anisotropy,
            tangent: tangent.map_or(DVec3::ZERO, along),
            specular: own.specular * number(maps.specular),
            specular_color: own.specular_color * tint(maps.specular_color),
            transmission: own.transmission * number(maps.transmission),
            clearcoat: own.clearcoat * number(maps.clearcoat),
            clearcoat_roughness: own.clearcoat_roughness * number(maps.clearcoat_roughness),
            coat_normal: if self.scene.materials[material].bends_normal() { unbent } else { DVec3::ZERO },
            ..own
        })
    }
}
