//! What a model consists of, by the names of its file: who changes materials may know its parts by these.

use super::words::quoted;
use crate::Result;
use crate::scene::Scene;
use crate::scene::load::text_file::{logical_lines, read_text};
use std::path::Path;

/// So many are listed.
const MOST: usize = 40;

/// Comments with the objects and groups of an OBJ file, for which luminaire has one object: the number of faces of each, and the materials they use; empty where the file
/// names none.
pub(super) fn of_obj(path: &Path) -> Result<String> {
    // What is odd in the file was said when it was loaded.
    let text = read_text(path, &mut Vec::new())?;
    let mut groups: Vec<Group> = Vec::new();
    let mut material: Option<&str> = None;
    let lines: Vec<_> = logical_lines(&text).collect();
    for (_, line) in &lines {
        let line = line.trim();
        let keyword = line.split_ascii_whitespace().next().unwrap_or_default();
        let rest = line[keyword.len()..].trim();
        match keyword {
            "o" | "g" => groups.push(Group { keyword, name: rest, faces: 0, materials: Vec::new() }),
            "usemtl" => material = Some(rest),
            "f" | "fo" => {
                if let Some(group) = groups.last_mut() {
                    group.faces += 1;
                    if let Some(material) = material
                        && !group.materials.contains(&material)
                        && group.materials.len() < MOST
                    {
                        group.materials.push(material);
                    }
                }
            }
            _ => {}
        }
    }
    groups.retain(|group| group.faces > 0);
    if groups.is_empty() {
        return Ok(String::new());
    }
    let mut said = String::from(
        "# The file's objects (o) and groups (g), which are one mesh here, with their faces and materials:\n",
    );
    for Group { keyword, name, faces, materials } in groups.iter().take(MOST) {
        let materials = materials.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        let of = if materials.is_empty() { String::new() } else { format!(", {materials}") };
        said += &format!("#   {keyword} {}: {faces}{of}\n", quoted(name));
    }
    if groups.len() > MOST {
        said += &format!("#   and {} more\n", groups.len() - MOST);
    }
    Ok(said)
}

/// Comments with the objects of any other model: the number of triangles of each, and the materials they use.
pub(super) fn of_objects(scene: &Scene) -> String {
    let own = (0..).zip(&scene.objects).filter(|(index, _)| scene.ground != Some(*index));
    let mut said =
        String::from("# What stands in the file, with its triangles and materials; this [[object]] is all of it:\n");
    let mut count = 0;
    for (_, object) in own {
        count += 1;
        if count > MOST {
            continue;
        }
        let triangles = &scene.meshes[object.mesh as usize].triangles;
        let mut materials: Vec<&str> = Vec::new();
        for triangle in triangles {
            let name = &*scene.material_of(object, triangle).name;
            if materials.len() < MOST && !materials.contains(&name) {
                materials.push(name);
            }
        }
        let materials = materials.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        said += &format!("#   {}: {}, {materials}\n", quoted(&object.name), triangles.len());
    }
    if count > MOST {
        said += &format!("#   and {} more\n", count - MOST);
    }
    said
}

/// What follows an `o` or a `g`.
struct Group<'a> {
    keyword: &'a str,
    name: &'a str,
    faces: u64,
    materials: Vec<&'a str>,
}
