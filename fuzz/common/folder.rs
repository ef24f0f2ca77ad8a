//! A folder for the files of one fuzzing process.

use std::path::PathBuf;
use std::sync::OnceLock;
use tempfile::TempDir;

static FOLDER: OnceLock<TempDir> = OnceLock::new();

/// Where a file of this name is; the folder is made on the first call, in memory where the system has such a place.
pub fn file(name: &str) -> PathBuf {
    let memory = std::path::Path::new("/dev/shm");
    let parent = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    let folder = FOLDER.get_or_init(|| tempfile::tempdir_in(parent).expect("a temporary folder"));
    folder.path().join(name)
}

/// Writes a file.
pub fn write(name: &str, content: &[u8]) -> PathBuf {
    let path = file(name);
    std::fs::write(&path, content).expect("a file");
    path
}
