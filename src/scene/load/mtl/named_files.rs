//! The images that an MTL file names, whether or not anything makes use of them.

use super::map_options;
use crate::scene::load::text_file::{logical_lines, read_text};
use std::path::{Path, PathBuf};

/// Keywords of images besides those that begin with `map_`.
const KEYWORDS: [&str; 5] = ["bump", "disp", "decal", "norm", "refl"];

/// A name is looked for in so many words from the end.
const MOST_WORDS: usize = 64;

/// Every image that the file names and that is there, also those of materials that nothing shows and of maps that nothing models: whoever writes over one of them
/// harms the model. None if the file cannot be read, of which its reader warns.
pub(in crate::scene::load) fn named_files(path: &Path) -> Vec<PathBuf> {
    let Ok(text) = read_text(path, &mut Vec::new()) else { return Vec::new() };
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = Vec::new();
    for (_, line) in logical_lines(&text) {
        let (keyword, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((&line, ""));
        let keyword = keyword.to_ascii_lowercase();
        if keyword.starts_with("map_") || KEYWORDS.contains(&&*keyword) {
            files.extend(candidates(rest, folder));
        }
    }
    files
}

/// Every file that a statement may mean. Maps that nothing models have options of their own, and names may hold blanks: where the name begins is not known,
/// so that it is tried from each of the last words on.
fn candidates(rest: &str, folder: &Path) -> Vec<PathBuf> {
    let rest = rest.trim();
    let words = rest.match_indices(char::is_whitespace).map(|(at, blank)| at + blank.len());
    let mut starts: Vec<usize> = words.filter(|at| !rest[*at..].starts_with(char::is_whitespace)).collect();
    starts.drain(..starts.len().saturating_sub(MOST_WORDS));
    starts.push(0);
    let file = |start: usize| map_options::parse(&rest[start..], folder, String::new()).ok()?.map.path();
    let mut files: Vec<PathBuf> = starts.into_iter().filter_map(file).collect();
    files.sort();
    files.dedup();
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_behind_options_that_nobody_knows_is_found() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["my tex.png", "tex-2.png", "MY other tex.png"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        for (statement, file) in [
            ("refl -type sphere my tex.png", Some("my tex.png")),
            ("bump -type foo MY tex.png", Some("my tex.png")),
            ("refl -type cube_top -mm 0 1 my   other tex.png # new", None),
            ("refl -type cube_top -mm 0 1 my other tex.png # new", Some("MY other tex.png")),
            ("norm -foo \"my tex.png\"", Some("my tex.png")),
            ("map_Kd \\\nmy tex.png", Some("my tex.png")),
            ("map_Kd my\\ tex.png", Some("my tex.png")),
            ("map_Bump -bm 1 C:\\maps\\TEX-2.png", Some("tex-2.png")),
            ("disp", None),
            ("# map_Kd my tex.png", None),
        ] {
            let path = folder.path().join("a.mtl");
            std::fs::write(&path, format!("newmtl m\n{statement}\n")).unwrap();
            let expected: Vec<PathBuf> = file.map(|file| folder.path().join(file)).into_iter().collect();
            assert_eq!(named_files(&path), expected, "{statement}");
        }
    }
}
