//! A metallic-roughness surface in words.

use luminaire::glam::Vec3;
use luminaire::scene::{ChannelMap, Physical, Scene, metal_name};

/// Its numbers as far as they mean something, and its maps; `thin`: it is a sheet.
pub(super) fn words(scene: &Scene, p: &Physical, thin: bool) -> Vec<String> {
    let rgb = |v: Vec3| format!("({} {} {})", v.x, v.y, v.z);
    // Neither a whole metal's index means anything nor, with numbers of its own, its colour.
    let metal = p.metallic == 1.0 && p.maps.metallic.is_none();
    let kind = match p.conductor {
        Some(_) if metal => "metallic-roughness: metallic 1".to_owned(),
        _ => format!("metallic-roughness: base colour {}, metallic {}", rgb(p.base_color), p.metallic),
    };
    let index = if metal { String::new() } else { format!(", index {}", p.ior) };
    let mut parts = vec![format!("{kind}, roughness {}{index}", p.roughness)];
    let mut part = |said: bool, words: String| {
        if said {
            parts.push(words);
        }
    };
    part(!metal && p.specular != 1.0, format!("specular {}", p.specular));
    part(!metal && p.specular_color != Vec3::ONE, format!("specular colour {}", rgb(p.specular_color)));
    if let Some([eta, k]) = p.conductor {
        let numbers = || format!("of index {}, extinction {}", rgb(eta), rgb(k));
        part(true, format!("conductor {}", metal_name([eta, k]).map_or_else(numbers, str::to_owned)));
    }
    part(
        p.transmission > 0.0,
        format!("transmission {}{}", p.transmission, if thin { " of a thin sheet" } else { "" }),
    );
    let depth = format!("{} behind a length of {}", rgb(p.attenuation_color), p.attenuation_distance);
    part(p.attenuation_distance.is_finite(), depth);
    part(p.clearcoat > 0.0, format!("clearcoat {} of roughness {}", p.clearcoat, p.clearcoat_roughness));
    part(p.sheen_color != Vec3::ZERO, format!("sheen {} of roughness {}", rgb(p.sheen_color), p.sheen_roughness));
    let turned = p.anisotropy_rotation.to_degrees();
    part(p.anisotropy > 0.0, format!("anisotropy {} turned by {turned} degrees", p.anisotropy));
    let [least, greatest] = p.iridescence_thickness;
    let film =
        format!("iridescence {} by a film of index {}, {least} to {greatest} nm", p.iridescence, p.iridescence_ior);
    part(p.iridescence > 0.0, film);
    part(p.dispersion > 0.0, format!("dispersion {}", p.dispersion));
    let missing = p.not_modelled();
    part(!missing.is_empty(), format!("not modelled: {}", missing.join(", ")));
    let maps = &p.maps;
    for (map, name) in [
        (maps.base_color, "base colour"),
        (maps.specular_color, "specular colour"),
        (maps.sheen_color, "sheen colour"),
        (maps.anisotropy, "anisotropy"),
    ] {
        if let Some(map) = map {
            part(true, format!("{name} map {}", scene.textures[map as usize].name));
        }
    }
    for (map, name) in [
        (maps.metallic, "metallic"),
        (maps.roughness, "roughness"),
        (maps.specular, "specular"),
        (maps.transmission, "transmission"),
        (maps.clearcoat, "clearcoat"),
        (maps.clearcoat_roughness, "clearcoat roughness"),
        (maps.sheen_roughness, "sheen roughness"),
        (maps.iridescence, "iridescence"),
        (maps.iridescence_thickness, "film thickness"),
    ] {
        if let Some(ChannelMap { texture, channel }) = map {
            let channel = ["red", "green", "blue", "alpha"][usize::from(channel)];
            part(true, format!("{name} map {}, {channel}", scene.textures[texture as usize].name));
        }
    }
    parts
}
