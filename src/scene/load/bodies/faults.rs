//! What is wrong with the glass of an object, as a warning.

use super::glass::Use;
use super::seams::Faults;
use crate::scene::Scene;
use crate::scene::load::loader::listed;
use std::collections::HashSet;

/// Who has the glass of a use: the first of these objects, with how many more, and the file.
pub(super) fn who(scene: &Scene, objects: &[usize]) -> String {
    let object = &scene.objects[objects[0]];
    let file = &scene.meshes[object.mesh as usize].name;
    let more = objects.len() - 1;
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("object `{}`{more} ({file})", object.name)
}

/// The names of materials, for a message.
pub(super) fn names(scene: &Scene, materials: Vec<u32>) -> String {
    let names: Vec<_> =
        materials.into_iter().map(|material| scene.materials[material as usize].name.as_str()).collect();
    listed(names.into_iter())
}

/// What is wrong with the edges and faces of a use, if anything is.
pub(super) fn sentence(scene: &Scene, uses: &[Use], of: &Use, faults: &Faults) -> Option<String> {
    let glass = &of.glass;
    let Faults { objects, open, wrong, with, sheets } = faults;
    if objects.is_empty() {
        return None;
    }
    let mut parts = Vec::new();
    let mut count = |number: usize, one: &str, many: &str| match number {
        0 => {}
        1 => parts.push(format!("1 {one}")),
        _ => parts.push(format!("{number} {many}")),
    };
    count(open.len(), "open edge", "open edges");
    count(
        wrong.len(),
        "edge between faces that are wound, or have vertex normals, against each other",
        "edges between faces that are wound, or have vertex normals, against each other",
    );
    count(glass.doubled, "face that lies on another", "faces that lie on each other");
    if parts.is_empty() {
        parts.push("a flat sheet whose edges others share".into());
    }
    let faulty: HashSet<u32> = open.iter().chain(wrong).map(|(_, surface)| *surface).collect();
    let all = faulty.is_empty() && sheets.is_empty();
    let in_question = |surface: u32| all || faulty.contains(&surface) || sheets.contains(&surface);
    let mut materials = glass.materials((0..glass.faces.len()).filter(|face| in_question(glass.faces[*face].surface)));
    let mut others = Vec::new();
    for &(object, of, surface) in with {
        let glass = &uses[of].glass;
        let more = glass.materials((0..glass.faces.len()).filter(|face| glass.faces[*face].surface == surface));
        materials.extend(more.into_iter().filter(|material| !materials.contains(material)).collect::<Vec<_>>());
        let name = scene.objects[object].name.as_str();
        if !others.contains(&name) {
            others.push(name);
        }
    }
    let materials = names(scene, materials);
    let others = match others.is_empty() {
        true => String::new(),
        false => format!(", with {}", listed(others.into_iter())),
    };
    let place = open.iter().chain(wrong).next().map(|(place, _)| glass.places[*place as usize]);
    let place = place.map_or(String::new(), |p| format!(", the first at {} {} {}", p.x, p.y, p.z));
    let only_sheets = glass.doubled == 0 && faulty.iter().all(|surface| sheets.contains(surface));
    let advice = match (sheets.is_empty(), only_sheets) {
        (false, true) => "if it is a pane, state `thin = true` in its [[material]]; else close it",
        (false, false) => {
            "close it and turn all faces outwards, once each; flat panes want `thin = true` in their [[material]]"
        }
        (true, _) => {
            "close it and turn all faces outwards, once each (thin sheets want `thin = true` in their [[material]])"
        }
    };
    Some(format!(
        "{}{others}: the glass of material {materials} is not a closed body ({}{place}): unless walls close it, light that passes is too \
         bright or too dark by the square of its index of refraction; {advice}",
        who(scene, objects),
        parts.join(", ")
    ))
}
