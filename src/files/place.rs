//! Which file a name leads to.

use same_file::Handle;
use std::path::{Path, PathBuf};

/// So many symbolic links are followed, as the system does.
const MOST_LINKS: usize = 40;

/// The file that a name leads to, or will lead to once it is written: to be compared with others.
#[derive(Debug)]
pub struct Place {
    /// As it was named.
    path: PathBuf,
    /// Without links and `..`; none if its folder does not exist.
    whole: Option<PathBuf>,
    /// What is there.
    there: Option<Handle>,
}

impl Place {
    /// Looks where `path` leads to.
    pub fn of(path: &Path) -> Self {
        // A pipe would have to be waited for.
        let there = if path.is_file() { Handle::from_path(path).ok() } else { None };
        Place { path: path.to_owned(), whole: whole(path), there }
    }

    /// Whether both are one file, by whatever names: through links of either kind, folders, or another case of the letters where the file system makes no
    /// difference.
    pub fn is(&self, other: &Place) -> bool {
        if self.path == other.path || self.there.is_some() && self.there == other.there {
            return true;
        }
        let (Some(a), Some(b)) = (&self.whole, &other.whole) else { return false };
        let lower = |path: &Path| path.file_name().map(|name| name.to_string_lossy().to_lowercase());
        // What exists has been compared already: only names of files to come may differ in their case.
        let may_be =
            a.parent() == b.parent() && lower(a) == lower(b) && (self.there.is_none() || other.there.is_none());
        a == b || may_be && ignores_case(&folder_of(a))
    }

    /// The name without links and `..`, if its folder exists.
    pub fn whole(&self) -> Option<&Path> {
        self.whole.as_deref()
    }
}

/// Whether two names lead to one file, or would once it is written.
pub fn same_file(a: &Path, b: &Path) -> bool {
    Place::of(a).is(&Place::of(b))
}

/// Where a name leads, even if nothing is there yet.
fn whole(path: &Path) -> Option<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(whole) = std::fs::canonicalize(&path) {
            return Some(whole);
        }
        match std::fs::read_link(&path) {
            // A link that leads nowhere.
            Ok(target) => path = folder_of(&path).join(target),
            Err(_) => return Some(std::fs::canonicalize(folder_of(&path)).ok()?.join(path.file_name()?)),
        }
    }
    None
}

/// Whether the file system takes upper and lower case for the same. Tried with a file, which is removed again.
fn ignores_case(folder: &Path) -> bool {
    let Ok(file) = tempfile::Builder::new().prefix(".case-").suffix(".luminaire.tmp").tempfile_in(folder) else {
        return false;
    };
    let name = file.path().file_name().unwrap_or_default().to_string_lossy().to_uppercase();
    folder.join(name).exists()
}

/// The folder in which `path` lies.
pub(super) fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => PathBuf::from("."),
        Some(parent) => parent.to_owned(),
        None => PathBuf::from("/"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_has_many_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(at("a/b")).unwrap();
        std::fs::write(at("a/there.png"), "x").unwrap();
        std::fs::write(at("a/other.png"), "x").unwrap();
        let there = at("a/there.png");
        for name in ["a/there.png", "a/../a/there.png", "a/./there.png", "a/b/../there.png", "a//there.png"] {
            assert!(same_file(&there, &at(name)), "{name}");
        }
        for name in ["a/other.png", "a/THERE.png", "there.png", "none/there.png"] {
            assert!(!same_file(&there, &at(name)), "{name}");
        }
        // Nothing is there yet.
        assert!(same_file(&at("a/new.png"), &at("a/b/../new.png")));
        assert!(!same_file(&at("a/new.png"), &at("a/New.png")));
        std::fs::hard_link(&there, at("hard.png")).unwrap();
        assert!(same_file(&there, &at("hard.png")));
        assert_eq!(std::fs::read_dir(at("a")).unwrap().count(), 3, "nothing stays of what was tried");
    }

    #[cfg(unix)]
    #[test]
    fn symbolic_links_are_followed_even_where_nothing_is_yet() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("a")).unwrap();
        symlink("a", at("link-to-a")).unwrap();
        symlink("link-to-a/new.png", at("dangling.png")).unwrap();
        symlink("dangling.png", at("dangling-twice.png")).unwrap();
        symlink("round.png", at("round.png")).unwrap();
        for name in ["link-to-a/new.png", "dangling.png", "dangling-twice.png"] {
            assert!(same_file(&at("a/new.png"), &at(name)), "{name}");
        }
        assert!(!same_file(&at("round.png"), &at("a/new.png")) && same_file(&at("round.png"), &at("round.png")));
        std::fs::write(at("a/new.png"), "x").unwrap();
        assert!(same_file(&at("a/new.png"), &at("dangling-twice.png")));
    }
}
