//! The images that an MTL file names, whether or not anything makes use of them.

use super::map_options;
use crate::scene::load::text_file::read_text;
use std::path::{Path, PathBuf};

/// Keywords of images besides those that begin with `map_`.
const KEYWORDS: [&str; 5] = ["bump", "disp", "decal", "norm", "refl"];

/// Every image that the file names and that is there, also those of materials that nothing shows and of maps that nothing models: whoever writes over one of them
/// harms the model. None if the file cannot be read, of which its reader warns.
pub(in crate::scene::load) fn named_files(path: &Path) -> Vec<PathBuf> {
    let Ok(text) = read_text(path) else { return Vec::new() };
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = Vec::new();
    for line in text.lines().map(str::trim) {
        let (keyword, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
        let keyword = keyword.to_ascii_lowercase();
        if !(keyword.starts_with("map_") || KEYWORDS.contains(&&*keyword)) {
            continue;
        }
        // Maps that nothing models have options of their own, so the last word is tried as well.
        if let Ok(statement) = map_options::parse(rest, folder, String::new()) {
            files.extend(statement.map.path());
        }
        if let Some(last) = rest.split_ascii_whitespace().last() {
            files.extend(Some(folder.join(last.replace('\\', "/"))).filter(|path| path.is_file()));
        }
    }
    files
}
