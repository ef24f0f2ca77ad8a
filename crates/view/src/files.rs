//! Names of the files that the window writes: numbered, so that none replaces another.

use std::path::{Path, PathBuf};

/// The first of `STEM-KIND-1.ENDING`, `STEM-KIND-2.ENDING`, ... in `folder` that does not exist yet.
pub fn free_name(folder: &Path, stem: &str, kind: &str, ending: &str) -> PathBuf {
    let names = (1u64..).map(|number| folder.join(format!("{stem}-{kind}-{number}.{ending}")));
    // A link to nowhere is somebody's, too.
    let mut free = names.filter(|path| path.symlink_metadata().is_err());
    free.next().expect("numbers do not end before names do")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_numbered() {
        let folder = tempfile::tempdir().unwrap();
        let name = |number| folder.path().join(format!("a-view-{number}.png"));
        for number in 1..4 {
            assert_eq!(free_name(folder.path(), "a", "view", "png"), name(number));
            std::fs::write(name(number), "").unwrap();
        }
        std::fs::remove_file(name(2)).unwrap();
        assert_eq!(free_name(folder.path(), "a", "view", "png"), name(2));
    }
}
