//! The keys of a metallic-roughness material.

use super::maps::map_line;
use super::relief;
use super::words::{exact, number, quoted, triple};
use crate::Result;
use crate::scene::load::material_draft::{Draft, MapDraft};
use crate::scene::load::metals;
use crate::scene::load::physical_draft::PhysicalDraft;
use crate::scene::{Material, Physical};
use glam::Vec3;
use std::path::Path;

/// Those that mean something for it; what holds without being said only where people look for it.
pub(super) fn table(
    material: &Material,
    surface: &Physical,
    draft: &Draft,
    physical: &PhysicalDraft,
    folder: &Path,
) -> Result<String> {
    let (m, p, default) = (material, surface, Physical::default());
    let mut keys: Vec<(&str, String)> = vec![
        ("model", quoted("metallic-roughness")),
        ("base_colour", triple(p.base_color)),
        ("metallic", number(p.metallic)),
        ("roughness", number(p.roughness)),
        ("ior", number(p.ior)),
    ];
    let mut key = |name, differs: bool, value: String| {
        if differs {
            keys.push((name, value));
        }
    };
    let transmits = p.transmission > 0.0;
    key("specular", p.specular != default.specular, number(p.specular));
    key("specular_colour", p.specular_color != default.specular_color, triple(p.specular_color));
    if let Some([eta, k]) = p.conductor {
        let numbers = || format!("{{ eta = {}, k = {} }}", triple(eta), triple(k));
        key("conductor", true, metals::metal_name([eta, k]).map_or_else(numbers, quoted));
    }
    key("transmission", transmits, number(p.transmission));
    key("thin", transmits, m.thin.to_string());
    let bounded = p.attenuation_distance.is_finite();
    key("attenuation_colour", bounded, triple(p.attenuation_color));
    key("attenuation_distance", bounded, number(p.attenuation_distance));
    key("clearcoat", p.clearcoat > 0.0, number(p.clearcoat));
    key("clearcoat_roughness", p.clearcoat > 0.0, number(p.clearcoat_roughness));
    key("sheen_colour", p.sheen_color != Vec3::ZERO, triple(p.sheen_color));
    key("sheen_roughness", p.sheen_color != Vec3::ZERO, number(p.sheen_roughness));
    key("anisotropy", p.anisotropy > 0.0, number(p.anisotropy));
    key("anisotropy_rotation", p.anisotropy_rotation != 0.0, exact(f64::from(p.anisotropy_rotation).to_degrees()));
    key("iridescence", p.iridescence > 0.0, number(p.iridescence));
    key("iridescence_ior", p.iridescence > 0.0, number(p.iridescence_ior));
    let [least, greatest] = p.iridescence_thickness.map(number);
    key("iridescence_thickness", p.iridescence > 0.0, format!("[{least}, {greatest}]"));
    key("dispersion", p.dispersion > 0.0, number(p.dispersion));
    key("emission", true, triple(m.emission));
    key("one_sided", m.emission != Vec3::ZERO, m.one_sided.to_string());
    key("ambient", (m.ambient, m.maps.ambient) != (p.base_color, p.maps.base_color), triple(m.ambient));
    key("opacity", true, number(m.opacity));
    let mut text: String = keys.iter().map(|(name, value)| format!("# {name} = {value}\n")).collect();
    // Whether it is of one number.
    let maps = [
        ("base_colour_map", &draft.maps.diffuse, false),
        ("metallic_map", &physical.maps.metallic, true),
        ("roughness_map", &physical.maps.roughness, true),
        ("specular_map", &physical.maps.specular, true),
        ("specular_colour_map", &physical.maps.specular_color, false),
        ("transmission_map", &physical.maps.transmission, true),
        ("clearcoat_map", &physical.maps.clearcoat, true),
        ("clearcoat_roughness_map", &physical.maps.clearcoat_roughness, true),
        ("sheen_colour_map", &physical.maps.sheen_color, false),
        ("sheen_roughness_map", &physical.maps.sheen_roughness, true),
        ("anisotropy_map", &physical.maps.anisotropy, false),
        ("iridescence_map", &physical.maps.iridescence, true),
        ("iridescence_thickness_map", &physical.maps.iridescence_thickness, true),
        ("emission_map", &draft.maps.emission, false),
        ("ambient_map", &draft.maps.ambient, false),
        ("opacity_map", &draft.maps.opacity, true),
    ];
    for (name, map, of_a_number) in maps {
        if let MapDraft::File(map) = map {
            text += &map_line(name, map, of_a_number, folder)?;
        }
    }
    Ok(text + &relief::lines(m, draft, folder)?)
}
