//! Files that an OBJ or an MTL names, as other systems and other machines write their names.

use std::path::{Path, PathBuf};

/// How a name may be meant: as it is, with a backslash before each blank that belongs to it, with backslashes as separators.
fn spellings(name: &str) -> [String; 3] {
    let blanks = name.replace("\\ ", " ");
    let both = blanks.replace('\\', "/");
    [name.to_owned(), blanks, both]
}

/// The file of this very name.
pub(super) fn exactly(folder: &Path, name: &str) -> Option<PathBuf> {
    spellings(name).map(|name| folder.join(name)).into_iter().find(|path| path.is_file())
}

/// A file of nearly this name: other cases of letters, or the bare name beside the file where the path is that of another machine.
pub(super) fn nearly(folder: &Path, name: &str) -> Option<PathBuf> {
    let [.., name] = spellings(name);
    let bare = name.rsplit('/').next().unwrap_or(&name);
    let beside = || Some(folder.join(bare)).filter(|path| path.is_file());
    without_case(folder, &name).or_else(beside).or_else(|| without_case(folder, bare))
}

/// A file whose path differs from `name` only in the case of its letters; the first one in alphabetical order.
pub(super) fn without_case(folder: &Path, name: &str) -> Option<PathBuf> {
    let mut path = folder.to_owned();
    for part in name.split('/').filter(|part| !part.is_empty() && *part != ".") {
        let exact = path.join(part);
        if exact.exists() {
            path = exact;
            continue;
        }
        // A folder without a name is the one that one is in.
        let here = if path.as_os_str().is_empty() { Path::new(".") } else { &path };
        let mut names: Vec<_> = std::fs::read_dir(here)
            .ok()?
            .filter_map(|entry| Some(entry.ok()?.file_name()))
            .filter(|name| name.to_string_lossy().to_lowercase() == part.to_lowercase())
            .collect();
        names.sort();
        path.push(names.first()?);
    }
    path.is_file().then_some(path)
}

/// The file names on an `mtllib` line, each with the file that is meant where it is another one. Names may hold blanks and a line may hold several
/// names, so the whole line is tried first, then the pieces that end in `.mtl`.
pub(super) fn libraries(folder: &Path, line: &str) -> Vec<(PathBuf, Option<String>)> {
    if let Some(path) = exactly(folder, line) {
        return vec![(path, None)];
    }
    let [.., plain] = spellings(line);
    if let Some(path) = without_case(folder, &plain) {
        return vec![guessed(folder, line, path)];
    }
    let mut names = Vec::new();
    let mut name = String::new();
    for word in line.split_whitespace() {
        if !name.is_empty() {
            name.push(' ');
        }
        name.push_str(word);
        if word.to_ascii_lowercase().ends_with(".mtl") {
            names.push(std::mem::take(&mut name));
        }
    }
    if !name.is_empty() {
        names.push(name);
    }
    let file = |name: &String| {
        let [.., plain] = spellings(name);
        match (exactly(folder, name), nearly(folder, name)) {
            (Some(path), _) => (path, None),
            (None, Some(path)) => guessed(folder, name, path),
            (None, None) => (folder.join(plain), None),
        }
    };
    names.iter().map(file).collect()
}

fn guessed(folder: &Path, written: &str, path: PathBuf) -> (PathBuf, Option<String>) {
    let warning = instead(folder, written, &path);
    (path, Some(warning))
}

/// What is said of a file that is taken for another one.
pub(super) fn instead(folder: &Path, written: &str, path: &Path) -> String {
    format!("`{written}` is not there; `{}` is used", path.strip_prefix(folder).unwrap_or(path).display())
}
