//! The maps of materials as keys.

use super::words::{number, path, quoted};
use crate::Result;
use crate::scene::load::map_file::{Channel, MapFile, MapSource};
use glam::Vec2;
use std::path::Path;

/// The line of a map, which is of a single number or not. What a scene file cannot say of it is no key.
pub(super) fn map_line(name: &str, map: &MapFile, of_a_number: bool, folder: &Path) -> Result<String> {
    if let MapSource::Bytes { name: picture, .. } = &map.source {
        return Ok(format!("#   {name}: {}, which is within the model's file\n", quoted(picture)));
    }
    let Some(file) = map.path() else {
        return Ok(format!("#   {name}: {}, which is not there\n", quoted(map.written())));
    };
    let file = quoted(&path(&file, folder)?);
    let has_keys = !map.clamp && map.base == 0.0 && map.gain == 1.0 && !map.stored;
    let Some((scale, offset)) =
        map.scale_and_offset().filter(|_| has_keys && (map.channel == Channel::Any || of_a_number))
    else {
        return Ok(format!("#   {name}: {file}, with options of the MTL file that a scene file has no keys for\n"));
    };
    let pair = |v: Vec2| format!("[{}, {}]", number(v.x), number(v.y));
    let mut keys = Vec::new();
    if (scale, offset) != (Vec2::ONE, Vec2::ZERO) {
        keys.extend([format!("scale = {}", pair(scale)), format!("offset = {}", pair(offset))]);
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
