//! The keys of what bends normals.

use super::maps::map_line;
use super::words::number;
use crate::Result;
use crate::scene::Material;
use crate::scene::load::material_draft::{Draft, MapDraft};
use std::path::Path;

/// The lines of both maps that count, with their scales.
pub(super) fn lines(m: &Material, draft: &Draft, folder: &Path) -> Result<String> {
    // The word of MTL files for heights may have turned out to mean normals.
    let normals = if draft.maps.normal.file().is_some() { &draft.maps.normal } else { &draft.maps.bump };
    let kinds = [
        ("normal", m.normal_map.map(|map| map.scale), normals, false),
        ("bump", m.bump_map.map(|map| map.scale), &draft.maps.bump, true),
    ];
    let mut text = String::new();
    for (kind, scale, map, of_a_number) in kinds {
        if let (Some(scale), MapDraft::File(map)) = (scale, map) {
            text += &map_line(&format!("{kind}_map"), map, of_a_number, folder)?;
            text += &format!("# {kind}_scale = {}\n", number(scale));
        }
    }
    Ok(text)
}
