//! The name that was probably meant, where one that is written is not known.

use std::path::Path;

/// The one of `names` that is the most like `word`; none if none is like it.
pub(super) fn near_name<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let length = word.chars().count();
    // One slip in a word of three letters, two in six; an added or left out part counts as one slip a letter. Any two single letters are one slip apart.
    let most = if length < 2 { 0 } else { 1.max(length / 3) };
    let slips = |name: &str| strsim::osa_distance(&word.to_lowercase(), &name.to_lowercase());
    let begins = |name: &str| length >= 4 && (name.starts_with(word) || word.starts_with(name) && name.len() >= 4);
    names.map(|name| (slips(name), name)).filter(|(slips, name)| *slips <= most || begins(name)).min().map(|(_, n)| n)
}

/// Where a file is missing, what is there instead: ` (...)`, or nothing.
pub(super) fn instead_of(path: &Path) -> String {
    let text = path.to_string_lossy();
    if path.exists() || text.is_empty() {
        return String::new();
    }
    let slashes = text.replace('\\', "/");
    if slashes != text && Path::new(&slashes).exists() {
        return format!(" (there is {slashes}: write paths with /)");
    }
    let folder = match path.parent() {
        Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
        Some(folder) => folder,
        None => return String::new(),
    };
    if !folder.exists() {
        return format!(" (there is no folder {})", folder.display());
    }
    let Some(name) = path.file_name().map(|name| name.to_string_lossy()) else { return String::new() };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let ending = |name: &str| Path::new(name).extension().map(|ending| ending.to_ascii_lowercase());
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|other| ending(other) == ending(&name));
    names.sort();
    near_name(&name, names.iter().map(String::as_str)).map(|near| format!(" (there is {near})")).unwrap_or_default()
}
