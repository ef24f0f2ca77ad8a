//! The maps of materials as keys.

use super::words::{number, path, quoted};
use crate::Result;
use crate::scene::load::texture::{Channel, MapFile};
use glam::Vec2;
use std::path::Path;

/// The line of a map, which is of a single number or not. What a scene file cannot say of it is no key.
pub(super) fn map_line(name: &str, map: &MapFile, of_a_number: bool, folder: &Path) -> Result<String> {
    let Some(file) = map.path() else {
        let named = map.names.first().map_or("", String::as_str);
        return Ok(format!("#   {name}: {}, which is not there\n", quoted(named)));
    };
    let file = quoted(&path(&file, folder)?);
    let has_keys = !map.clamp && map.base == 0.0 && map.gain == 1.0 && !map.stored;
    if !has_keys || map.channel != Channel::Any && !of_a_number {
        return Ok(format!("#   {name}: {file}, with options of the MTL file that a scene file has no keys for\n"));
    }
    let pair = |v: Vec2| format!("[{}, {}]", number(v.x), number(v.y));
    let mut keys = Vec::new();
    if (map.scale, map.offset) != (Vec2::ONE, Vec2::ZERO) {
        keys.extend([format!("scale = {}", pair(map.scale)), format!("offset = {}", pair(map.offset))]);
    }
    if map.channel != Channel::Any {
        let channel = match map.channel {
            Channel::One(index) => ["r", "g", "b", "a"][usize::from(index)],
            Channel::Any | Channel::Luminance => "luminance",
        };
        keys.push(format!("channel = {}", quoted(channel)));
    }
    Ok(match &keys[..] {
        [] => format!("# {name} = {file}\n"),
        keys => format!("# {name} = {{ image = {file}, {} }}\n", keys.join(", ")),
    })
}
