//! Metallic-roughness surfaces and the tables that they go by, as the kernel has them.

use crate::gpu::layout::{self, NONE};
use crate::scene::albedo_table::{ROUGH, STEEP, TABLE};
use crate::scene::brushed_table::{ALONG, AROUND, BRUSHED, MEANS_ALONG, MEANS_RATIOS, RATIOS, TILTS};
use crate::scene::{COAT_INDEX, ChannelMap, Material, Physical, Scene, conductor_average};
use half::f16;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// All surfaces of a scene behind the tables of their indices, and for each material the texel of its own; 0 where it has none.
pub(in crate::gpu) fn physical(scene: &Scene) -> (Vec<[u32; 4]>, Vec<u32>) {
    let mut places = vec![0; scene.materials.len()];
    if scene.materials.iter().all(|material| material.physical.is_none()) {
        return (vec![], places);
    }
    let bits = |numbers: [f64; 4]| numbers.map(|number| (number as f32).to_bits());
    // Each cell with its corners, so that one fetch is enough.
    let mut texels = vec![];
    for i in 0..ROUGH - 1 {
        for j in 0..STEEP - 1 {
            let at = |i: usize, j: usize| TABLE.missing[i * STEEP + j];
            texels.push(bits([at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]));
        }
    }
    texels.extend(TABLE.missing_average.windows(2).map(|pair| bits([pair[0], pair[1], 0.0, 0.0])));
    let brushes = scene.materials.iter().any(|m| m.physical.as_ref().is_some_and(|p| p.anisotropy > 0.0));
    let mut rows = HashMap::new();
    let mut rows_of = |texels: &mut Vec<[u32; 4]>, ior: f32| -> u32 {
        // An infinite index goes by any table.
        let ior = if ior == 0.0 { COAT_INDEX as f32 } else { ior };
        *rows.entry(ior.to_bits()).or_insert_with(|| {
            let first = texels.len() as u32;
            texels.extend(TABLE.dielectric_rows(ior.into()).into_iter().map(bits));
            if brushes {
                texels.extend(BRUSHED.dielectric_row(ior.into()).into_iter().map(bits));
            }
            first
        })
    };
    // Coats come first.
    rows_of(&mut texels, COAT_INDEX as f32);
    if brushes {
        brushed(&mut texels);
    }
    for (material, place) in scene.materials.iter().zip(&mut places) {
        if let Some(physical) = &material.physical {
            let surface = surface(material, physical, rows_of(&mut texels, physical.ior));
            *place = texels.len() as u32;
            texels.extend(bytemuck::cast::<layout::Physical, [[u32; 4]; 10]>(surface));
        }
    }
    (texels, places)
}

/// The tables of brushed lobes, each cell with its corners: of what is missing all but those along the first axis, in half floats.
fn brushed(texels: &mut Vec<[u32; 4]>) {
    for i in 0..ALONG {
        for (j, k) in (0..RATIOS - 1).flat_map(|j| (0..AROUND - 1).map(move |k| (j, k))) {
            for l in 0..TILTS - 1 {
                let pair = |j: usize, k: usize| {
                    let at = ((i * RATIOS + j) * AROUND + k) * TILTS + l;
                    let half = |number: f64| u32::from(f16::from_f64(number).to_bits());
                    half(BRUSHED.missing[at]) | half(BRUSHED.missing[at + 1]) << 16
                };
                texels.push([pair(j, k), pair(j, k + 1), pair(j + 1, k), pair(j + 1, k + 1)]);
            }
        }
    }
    for i in 0..MEANS_ALONG - 1 {
        for j in 0..MEANS_RATIOS - 1 {
            let at = |i: usize, j: usize| (BRUSHED.missing_average[i * MEANS_RATIOS + j] as f32).to_bits();
            texels.push([at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]);
        }
    }
}

fn surface(material: &Material, p: &Physical, rows: u32) -> layout::Physical {
    let number = |map: Option<ChannelMap>| map.map_or(NONE, |map| 4 * map.texture + u32::from(map.channel));
    let colour = |map: Option<u32>| map.unwrap_or(NONE);
    let [eta, k] = p.conductor.unwrap_or_default();
    let average = [0, 1, 2].map(|i| conductor_average(eta[i].into(), k[i].into()) as f32);
    let maps = &p.maps;
    layout::Physical {
        base: p.base_color.to_array(),
        metallic: p.metallic,
        specular_color: p.specular_color.to_array(),
        specular: p.specular,
        absorption: p.absorption().as_vec3().to_array(),
        roughness: p.roughness,
        conductor_eta: eta.to_array(),
        anisotropy: p.anisotropy,
        conductor_k: k.to_array(),
        anisotropy_rotation: (f64::from(p.anisotropy_rotation) / TAU) as f32,
        conductor_average: if p.conductor.is_some() { average } else { [0.0; 3] },
        ior: p.ior,
        transmission: p.transmission,
        clearcoat: p.clearcoat,
        clearcoat_roughness: p.clearcoat_roughness,
        rows,
        base_map: colour(maps.base_color),
        metallic_map: number(maps.metallic),
        roughness_map: number(maps.roughness),
        anisotropy_map: colour(maps.anisotropy),
        specular_map: number(maps.specular),
        specular_color_map: colour(maps.specular_color),
        transmission_map: number(maps.transmission),
        clearcoat_map: number(maps.clearcoat),
        clearcoat_roughness_map: number(maps.clearcoat_roughness),
        conductor: u32::from(p.conductor.is_some()),
        body: u32::from(material.is_body()),
        padding: 0,
    }
}
