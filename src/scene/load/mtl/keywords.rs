//! Keywords of MTL: what is meant by those that it has not.

use crate::scene::load::near_name::near_name;

/// Those that are read, but for maps.
const KEYWORDS: [&str; 26] = [
    "newmtl",
    "Ka",
    "Kd",
    "Ks",
    "Ke",
    "Km",
    "Kt",
    "Ns",
    "Ni",
    "Tf",
    "Tr",
    "d",
    "illum",
    "sharpness",
    "Pr",
    "Pm",
    "Ps",
    "Pc",
    "Pcr",
    "aniso",
    "anisor",
    "bump",
    "norm",
    "disp",
    "decal",
    "refl",
];

/// Other names, in small letters, for numbers.
const OTHERS: [(&str, &[&str]); 8] = [
    ("Pr", &["roughness"]),
    ("Pm", &["metallic", "metalness", "metal"]),
    ("Pc", &["clearcoat", "coat"]),
    ("Pcr", &["clearcoat_roughness", "clearcoatroughness"]),
    ("Ps", &["sheen"]),
    ("aniso", &["anisotropy"]),
    ("Ke", &["emission", "emissive"]),
    ("d", &["alpha", "opacity"]),
];

/// Other names, in small letters, for maps.
const MAPS: [(&str, &[&str]); 9] = [
    ("norm", &["map_normal", "map_normals", "map_norm", "map_nrm", "map_n"]),
    ("map_Bump", &["map_height", "map_bmp"]),
    ("map_Pr", &["map_roughness", "map_rough"]),
    ("map_Pm", &["map_metallic", "map_metalness", "map_metal"]),
    ("map_ORM", &["map_arm", "map_rma", "map_metallicroughness"]),
    ("map_Kd", &["map_diffuse", "map_basecolor", "map_base_color", "map_albedo", "map_color", "map_colour"]),
    ("map_Ke", &["map_emission", "map_emissive", "map_emit"]),
    ("map_Ks", &["map_specular", "map_spec"]),
    ("map_d", &["map_opacity", "map_alpha"]),
];

/// The keyword that is probably meant by one that is none.
pub(super) fn instead_of(keyword: &str) -> Option<&'static str> {
    let small = keyword.to_ascii_lowercase();
    let same = KEYWORDS.iter().find(|known| known.to_ascii_lowercase() == small).copied();
    same.or_else(|| named(&OTHERS, &small)).or_else(|| {
        // Of words so short any two are alike.
        let long = KEYWORDS.iter().copied().filter(|known| known.len() >= 4 && small.len() >= 4);
        near_name(&small, long)
    })
}

/// The keyword of a map, by one in small letters that is none.
pub(super) fn map_instead_of(keyword: &str) -> Option<&'static str> {
    named(&MAPS, keyword)
}

fn named(table: &[(&'static str, &[&str])], word: &str) -> Option<&'static str> {
    table.iter().find(|(_, others)| others.contains(&word)).map(|(known, _)| *known)
}

/// Whether a map, by its keyword in small letters, is of one number, so that a channel of it may be chosen.
pub(super) fn of_a_number(keyword: &str) -> bool {
    ["map_d", "map_bump", "bump", "map_pr", "map_pm", "map_pc", "map_pcr", "map_ns", "map_refl"].contains(&keyword)
}
