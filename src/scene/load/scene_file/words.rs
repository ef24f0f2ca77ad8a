//! Numbers, names, paths and lines as a scene file has them: read again, they are the same to the last bit.

use crate::{Error, Result};
use glam::{DVec3, Vec3};
use std::path::{Component, Path, PathBuf};

/// A number in single precision.
pub(super) fn number(x: f32) -> String {
    let short = format!("{x:?}");
    // Readers go through double precision, which may round the shortest digits to a neighbour.
    if short.parse::<f64>().is_ok_and(|read| read as f32 == x) { short } else { exact(x.into()) }
}

/// A number in double precision.
pub(super) fn exact(x: f64) -> String {
    format!("{x:?}")
}

/// Three numbers in single precision.
pub(super) fn triple(v: Vec3) -> String {
    format!("[{}, {}, {}]", number(v.x), number(v.y), number(v.z))
}

/// A point of a scene with this origin, in the coordinates of the files.
pub(super) fn point(p: Vec3, origin: DVec3) -> String {
    if origin == DVec3::ZERO {
        return triple(p);
    }
    let DVec3 { x, y, z } = p.as_dvec3() + origin;
    format!("[{}, {}, {}]", exact(x), exact(y), exact(z))
}

/// A name between quotes, in one line whatever it holds.
pub(super) fn quoted(name: &str) -> String {
    let mut text = String::from("\"");
    for c in name.chars() {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            c if c.is_control() => text += &format!("\\u{:04X}", c as u32),
            c => text.push(c),
        }
    }
    text + "\""
}

/// Lines of keys with their meaning, the latter in one column.
pub(super) fn keys(lines: &[(&str, String, &str)]) -> String {
    let lines = lines.iter().map(|(key, value, meaning)| {
        let said = format!("{key} = {value}");
        format!("{said:39}  # {meaning}").trim_end().trim_end_matches("  #").trim_end().to_owned() + "\n"
    });
    lines.collect()
}

/// The path of a file as a scene file in `folder` names it.
///
/// # Errors
/// If it is no text: a scene file is.
pub(super) fn path(file: &Path, folder: &Path) -> Result<String> {
    let seen = seen_from(folder, file).unwrap_or_else(|| file.to_owned());
    seen.to_str().map(str::to_owned).ok_or_else(|| {
        Error::scene(file, "its name is no UTF-8 text, and a scene file can only hold such names: rename it")
    })
}

/// The way from a folder to a file, where it is another one than from the current folder. Of symbolic links to folders it takes the folders, as `..` does.
fn seen_from(folder: &Path, file: &Path) -> Option<PathBuf> {
    let here = |path: &Path| if path.as_os_str().is_empty() { PathBuf::from(".") } else { path.to_owned() };
    let whole = |path: &Path| std::fs::canonicalize(here(path)).ok();
    let folder = whole(folder)?;
    if file.is_absolute() || folder == whole(Path::new("."))? {
        return None;
    }
    let place = whole(file.parent()?)?;
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), place.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if from[shared..].iter().any(|part| matches!(part, Component::Prefix(_))) {
        return Some(place.join(file.file_name()?));
    }
    let mut way: PathBuf = std::iter::repeat_n("..", from.len() - shared).collect();
    way.extend(&to[shared..]);
    way.push(file.file_name()?);
    Some(way)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_were() {
        let mut bits = 1u32;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let x = f32::from_bits(bits);
            if x.is_finite() {
                let read: f64 = number(x).parse().unwrap();
                assert_eq!((read as f32).to_bits(), bits, "{x:?}");
            }
        }
        assert_eq!(triple(Vec3::new(0.1, 1.0, 1e20)), "[0.1, 1.0, 1e20]");
    }

    #[test]
    fn names_of_all_kinds_are_one_line() {
        for name in ["plain", "two words", "a \"b\" \\c", "gr\u{fc}n", "a\nb\tc\u{7f}\u{85}", "", "# no comment"] {
            let text = format!("name = {}\n", quoted(name));
            assert_eq!(text.lines().count(), 1);
            let table: ::toml::Table = ::toml::from_str(&text).unwrap();
            assert_eq!(table["name"].as_str(), Some(name));
        }
    }
}
