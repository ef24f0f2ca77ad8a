//! A lock beside a file that only one process at a time may go on with.

use super::place::Place;
use crate::{Error, Result};
use fs4::{FileExt, TryLockError};
use same_file::Handle;
use std::fs::File;
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

/// What the text of a lock file begins with.
const MARK: &str = "luminaire";
/// More than this is no text of ours.
const MOST_BYTES: u64 = 4096;
/// A holder that ends removes its file, so that the next one has to look again; nobody is that unlucky so often.
const TRIES: usize = 100;

/// Held until it is dropped. The system lets go of it when the process ends, however that happens: what a killed process leaves is a file that nobody holds, and
/// that the next one takes.
#[derive(Debug)]
pub struct Lock {
    /// `FILE.lock`.
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Takes the lock of the file `path`, by whatever name: `FILE.lock` beside it. None where the file system has no locks.
    ///
    /// # Errors
    /// [`Error::Write`] if another process holds it, with what is known of that one; if the lock cannot be created; or if a file is in its place that was not made
    /// for this.
    pub fn of(path: &Path) -> Result<Option<Self>> {
        let mut name = Place::of(path).whole().unwrap_or(path).as_os_str().to_owned();
        name.push(".lock");
        let beside = PathBuf::from(name);
        let refused = |reason: String| Error::write(path, reason);
        let failed = |e: std::io::Error| refused(format!("its lock {} cannot be used ({e})", beside.display()));
        for _ in 0..TRIES {
            // A pipe would have to be waited for.
            if beside.exists() && !beside.is_file() {
                return Err(refused(format!(
                    "in the place of its lock, {}, is something that is not a file",
                    beside.display()
                )));
            }
            let mut file =
                File::options().read(true).write(true).create(true).truncate(false).open(&beside).map_err(failed)?;
            let locked = match FileExt::try_lock(&file) {
                Ok(()) => true,
                Err(TryLockError::WouldBlock) => false,
                // Some network file systems.
                Err(TryLockError::Error(_)) => {
                    let empty = file.metadata().is_ok_and(|about| about.len() == 0);
                    if empty {
                        let _ = std::fs::remove_file(&beside);
                    }
                    return Ok(None);
                }
            };
            let mut text = String::new();
            let read = (&mut file).take(MOST_BYTES).read_to_string(&mut text);
            if !locked {
                let holder = text.trim().strip_prefix(MARK).map_or("another process", str::trim);
                return Err(refused(format!(
                    "{holder} is at work on it, and two would undo each other's work (it holds {}): wait until it ends, or give another name",
                    beside.display()
                )));
            }
            // The last holder has removed what was opened, and somebody may have made another one.
            let same = Handle::from_path(&beside).ok().zip(file.try_clone().and_then(Handle::from_file).ok());
            if same.is_none_or(|(there, ours)| there != ours) {
                continue;
            }
            if read.is_err() || !(text.is_empty() || text.starts_with(MARK)) {
                return Err(refused(format!(
                    "{} is in the place of its lock, but was not made for that: rename it",
                    beside.display()
                )));
            }
            let host = gethostname::gethostname().to_string_lossy().into_owned();
            let about = format!("{MARK} process {} on {host}\n", std::process::id());
            file.set_len(0)
                .and_then(|()| file.rewind())
                .and_then(|()| file.write_all(about.as_bytes()))
                .map_err(failed)?;
            return Ok(Some(Lock { path: beside, file }));
        }
        Err(refused(format!("others take and leave its lock {} all the time", beside.display())))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Removed while it is held, so that it cannot be another's. If it stays, it is in nobody's way.
        let _ = std::fs::remove_file(&self.path);
        let _ = FileExt::unlock(&self.file);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time_and_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        let (path, other) = (folder.path().join("c.exr"), folder.path().join("a/../c.exr"));
        let lock = Lock::of(&path).unwrap().unwrap();
        for name in [&path, &other] {
            let error = Lock::of(name).unwrap_err();
            let process = format!("process {} on ", std::process::id());
            assert!(error.exit_code() == 1 && error.to_string().contains(&process), "{error}");
        }
        drop(lock);
        assert!(!folder.path().join("c.exr.lock").exists());
        // As a process leaves it that is killed.
        std::fs::write(folder.path().join("c.exr.lock"), "luminaire process 1 on nowhere\n").unwrap();
        assert!(Lock::of(&other).unwrap().is_some());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_of_somebody_elses_is_no_lock() {
        let folder = tempfile::tempdir().unwrap();
        let beside = folder.path().join("c.exr.lock");
        for text in ["precious", "\u{0}"] {
            std::fs::write(&beside, text).unwrap();
            let error = Lock::of(&folder.path().join("c.exr")).unwrap_err().to_string();
            assert!(error.contains("was not made for that"), "{error}");
            assert_eq!(std::fs::read_to_string(&beside).unwrap(), text);
        }
    }
}
