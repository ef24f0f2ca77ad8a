//! The materials of a model as tables, in comments: uncommented, they change nothing, but where several materials have one name.

use super::maps::map_line;
use super::physical;
use super::relief;
use super::words::{number, quoted, triple};
use crate::Result;
use crate::scene::load::material_draft::{Draft, MapDraft};
use crate::scene::{Material, Scene};
use glam::Vec3;
use std::collections::HashMap;
use std::path::Path;

/// What the keys mean.
const KEYS: &str = "\
# Materials. Each is listed with what it is now; the MTL file goes on counting for what no table says. To change one, remove the `#` from
# its `[[material]]`, its `name` and the keys that are meant.
#   diffuse             diffuse albedo, RGB from 0 to 1
#   glossy, exponent    albedo of a Blinn-Phong lobe at normal incidence, RGB, and its exponent, 0 to 1e8; without them 0 and 10
#   emission            emitted radiance, RGB of 0 or more: a lamp; `one_sided = true`: only its outward side emits
#   reflection          albedo of a mirror, RGB from 0 to 1; with `eta` it lies over the rest, as varnish does
#   transmission, eta   albedo of what passes into glass, and its index of refraction, 0.01 to 100; `thin = true`: a pane, which bends nothing
#   opacity             share of light that meets the surface at all, 0 (a hole) to 1; without it 1
#   normal_map, normal_scale
#                       an image of normals in tangent space (OpenGL's: green is up), and a factor to what they have along the surface; without it 1
#   bump_map, bump_scale
#                       an image of heights, and the length of a height of 1; without it 1
#   ambient             albedo for the ambient term of the simple ray tracer
#   impulse_probability above 0 and below 1: how often a path takes the mirror or glass; changes the noise, never the mean
#   diffuse_map, glossy_map, emission_map, ambient_map, opacity_map
#                       an image that multiplies the number: \"FILE\", or { image = \"FILE\", scale = [2, 2], offset = [0.5, 0] }; \"\" removes it
# In place of diffuse, glossy, exponent, reflection, transmission, eta and impulse_probability, a metallic-roughness surface, as glTF describes it, has:
#   base_colour         colour of what is diffuse, of metal, and of what passes, RGB from 0 to 1; without it 0.8, with a map 1
#   metallic            how much of it is metal, 0 to 1; without it 0, with `conductor` 1
#   roughness           how rough it is, 0 (smooth) to 1; without it 0.5
#   ior                 index of refraction, 1 to 100, by which it reflects where it is no metal, without it 1.5; 0: it reflects all of `specular_colour`
#   specular, specular_colour
#                       factors to that reflection: everywhere, 0 to 1, and seen from straight above, RGB of 0 or more; without them 1
#   conductor           \"aluminium\", \"chromium\", \"copper\", \"gold\", \"mercury\", \"nickel\", \"silver\", \"tungsten\", or { eta = [r, g, b], k = [r, g, b] }: a metal by
#                       its index of refraction and its extinction coefficient, in place of the base colour
#   transmission        share of light that passes in place of being scattered, 0 to 1; without it 0; `thin = true` as above
#   attenuation_colour, attenuation_distance
#                       what is left of white light behind so long a way within, RGB above 0, at most 1, and the way, above 0; without them it is clear
#   clearcoat, clearcoat_roughness
#                       strength and roughness of a varnish of index 1.5, 0 to 1; without them 0
#   anisotropy, anisotropy_rotation
#                       how much rougher it is in one direction, 0 to 1, and that direction in degrees, counter-clockwise from the tangent; without them 0;
#                       for a mesh with texture coordinates, along which the grain lies
#   model               \"metallic-roughness\" or \"blinn-phong\": which of both it is, where no other key says it
#   base_colour_map, metallic_map, roughness_map, specular_map, specular_colour_map, transmission_map, clearcoat_map, clearcoat_roughness_map, anisotropy_map
#                       images, as above (of anisotropy red and green are a direction, blue is the strength); that of a number may say which channel it is:
#                       { image = \"FILE\", channel = \"g\" }, \"r\", \"g\", \"b\", \"a\" or \"luminance\"; without it the luminance
# Read, and not traced, which a warning says:
#   sheen_colour, sheen_roughness
#                       what fibres above it reflect, RGB from 0 to 1, and their roughness, 0 to 1; without them 0
#   iridescence, iridescence_ior, iridescence_thickness
#                       strength of a thin film, 0 to 1; its index, 1 to 100; its thickness in nanometres, or [least, greatest]; without them 0, 1.3, [100, 400]
#   dispersion          20 over Abbe's number, 0 or more; without it 0
#   sheen_colour_map, sheen_roughness_map, iridescence_map, iridescence_thickness_map
#                       their images
";

/// A commented table for each material that the model names or shows; `drafts` are what the first materials of the scene are made of. Files are named as
/// seen from `folder`.
pub(super) fn tables(scene: &Scene, drafts: &[Draft], folder: &Path) -> Result<String> {
    let mut shown = vec![0u64; scene.materials.len()];
    for (index, object) in (0..).zip(&scene.objects) {
        if scene.ground != Some(index) {
            for triangle in &scene.meshes[object.mesh as usize].triangles {
                shown[object.material.unwrap_or(triangle.material) as usize] += 1;
            }
        }
    }
    // Of one name there is one table, which changes all materials of that name.
    let mut by_name: HashMap<&str, usize> = HashMap::new();
    let mut order = Vec::new();
    for (index, draft) in drafts.iter().enumerate() {
        // The built-in one, where nothing shows it.
        if index == 0 && shown[0] == 0 {
            continue;
        }
        let known = *by_name.entry(&draft.name).or_insert(order.len());
        if known == order.len() {
            order.push(index);
        } else if shown[order[known]] == 0 {
            order[known] = index;
        }
    }
    let mut text = String::from(KEYS);
    for index in order {
        let said = match shown[index] {
            0 => "no triangle".into(),
            1 => "1 triangle".into(),
            count => format!("{count} triangles"),
        };
        let of_one_name =
            drafts.iter().enumerate().filter(|(other, draft)| shown[*other] > 0 && draft.name == drafts[index].name);
        let others = match of_one_name.count() {
            0 | 1 => String::new(),
            count => format!(
                "; {count} materials have this name, these are the numbers of the first, and a table changes all"
            ),
        };
        text += &format!("\n# [[material]]\n# name = {}  # {said}{others}\n", quoted(&drafts[index].name));
        text += &table(&scene.materials[index], &drafts[index], folder)?;
    }
    Ok(text)
}

/// The keys of one material that mean something for it.
fn table(material: &Material, draft: &Draft, folder: &Path) -> Result<String> {
    if let (Some(surface), Some(physical)) = (&material.physical, &draft.physical) {
        return physical::table(material, surface, draft, physical, folder);
    }
    let m = material;
    let mut text = String::new();
    let mut key = |name: &str, value: String| text += &format!("# {name} = {value}\n");
    key("diffuse", triple(m.lambert));
    key("glossy", triple(m.glossy));
    if m.glossy != Vec3::ZERO {
        key("exponent", number(m.exponent));
    }
    key("emission", triple(m.emission));
    if m.emission != Vec3::ZERO {
        key("one_sided", m.one_sided.to_string());
    }
    let (mirror, glass) = (m.reflection != Vec3::ZERO, m.transmission != Vec3::ZERO);
    if mirror || glass {
        key("reflection", triple(m.reflection));
    }
    if glass {
        key("transmission", triple(m.transmission));
        key("thin", m.thin.to_string());
    }
    if let Some(eta) = m.eta.filter(|_| mirror || glass) {
        key("eta", number(eta));
    }
    if let Some(probability) = m.impulse_probability {
        key("impulse_probability", number(probability));
    }
    if (m.ambient, m.maps.ambient) != (m.lambert, m.maps.lambert) {
        key("ambient", triple(m.ambient));
    }
    key("opacity", number(m.opacity));
    // What has no albedo of its own here has the diffuse one, with its map.
    let ambient_map = match (&draft.maps.ambient, draft.ambient, m.maps.ambient) {
        (MapDraft::Unstated, None, Some(_)) if m.ambient != m.lambert => &draft.maps.diffuse,
        (own, ..) => own,
    };
    let maps = [
        ("diffuse_map", &draft.maps.diffuse),
        ("glossy_map", &draft.maps.glossy),
        ("emission_map", &draft.maps.emission),
        ("ambient_map", ambient_map),
        ("opacity_map", &draft.maps.opacity),
    ];
    for (name, map) in maps {
        if let MapDraft::File(map) = map {
            text += &map_line(name, map, name == "opacity_map", folder)?;
        }
    }
    Ok(text + &relief::lines(m, draft, folder)?)
}
