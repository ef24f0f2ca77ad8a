//! A lock beside a file that only one process at a time may go on with.

use super::place::Place;
use crate::{Error, Result};
use fs4::{FileExt, TryLockError};
use same_file::Handle;
use std::fs::File;
use std::io::{ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// What the text of a lock file begins with; the number of a process and [`ON`] follow.
const MARK: &str = "luminaire process ";
/// Between the number and the name of the machine.
const ON: &str = " on ";
/// More than this is no text of ours.
const MOST_BYTES: u64 = 4096;
/// A holder that ends removes its file, so that the next one has to look again; nobody is that unlucky so often.
const TRIES: usize = 100;

/// The lock files that this process holds and will remove.
static HELD: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

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
            // A pipe would have to be waited for, and a link leads to a file of somebody else's.
            if beside.symlink_metadata().is_ok_and(|about| !about.is_file()) {
                return Err(refused(format!(
                    "in the place of its lock, {}, is something that is not a file: rename it",
                    beside.display()
                )));
            }
            let opened = match open(&beside) {
                // Its holder has just removed it.
                Err(error) if error.kind() == ErrorKind::NotFound && beside.symlink_metadata().is_ok() => continue,
                Err(error) if error.kind() == ErrorKind::PermissionDenied && beside.exists() => {
                    return Err(refused(format!(
                        "its lock {} is a file of another user{}, which cannot be opened ({error}): if no job is at work on it, have it removed; or give \
                         another name",
                        beside.display(),
                        owner(&beside)
                    )));
                }
                other => other.map_err(failed)?,
            };
            let Opened { mut file, new, writable } = opened;
            let locked = match FileExt::try_lock(&file) {
                Ok(()) => true,
                Err(TryLockError::WouldBlock) => false,
                // Some network file systems.
                Err(TryLockError::Error(_)) => {
                    if new {
                        let _ = std::fs::remove_file(&beside);
                    }
                    return Ok(None);
                }
            };
            let mut text = String::new();
            let read = (&mut file).take(MOST_BYTES).read_to_string(&mut text);
            if !locked {
                let holder = holder(&text).unwrap_or("another process");
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
            if read.is_err() || !(text.is_empty() || holder(&text).is_some()) {
                return Err(refused(format!(
                    "{} is in the place of its lock, but was not made for that: rename it",
                    beside.display()
                )));
            }
            if text.is_empty() && !new {
                // Somebody else's file, or one of a process that ended before it had written its text: held, and left as it is.
                return Ok(Some(Lock { path: beside, file }));
            }
            if !writable {
                // What a job of another user left. Where the folder keeps it, it is held as it is.
                if std::fs::remove_file(&beside).is_ok() {
                    continue;
                }
                return Ok(Some(Lock { path: beside, file }));
            }
            hold(&beside);
            let lock = Lock { path: beside.clone(), file };
            let host = gethostname::gethostname().to_string_lossy().into_owned();
            let about = format!("{MARK}{}{ON}{host}\n", std::process::id());
            lock.file
                .set_len(0)
                .and_then(|()| (&lock.file).rewind())
                .and_then(|()| (&lock.file).write_all(about.as_bytes()))
                .map_err(failed)?;
            return Ok(Some(lock));
        }
        Err(refused(format!("others take and leave its lock {} all the time", beside.display())))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(index) = held.iter().position(|path| *path == self.path) {
            held.swap_remove(index);
            // Removed while it is held, so that it cannot be another's. If it stays, it is in nobody's way.
            let _ = std::fs::remove_file(&self.path);
        }
        let _ = FileExt::unlock(&self.file);
    }
}

/// Removes the files of all locks that this process holds, which must end then: what an end without clean-up would leave.
pub fn let_go_of_all() {
    let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    held.drain(..).for_each(|path| {
        let _ = std::fs::remove_file(path);
    });
}

/// The file of a lock is to be removed in the end.
fn hold(path: &Path) {
    HELD.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
}

/// A lock file.
struct Opened {
    file: File,
    /// Whether it was made now.
    new: bool,
    /// Another user's can be locked, and no more.
    writable: bool,
}

fn open(path: &Path) -> std::io::Result<Opened> {
    match File::options().read(true).write(true).create_new(true).open(path) {
        Ok(file) => {
            // Whoever may write the folder may take what this process could leave, whatever it keeps from others otherwise. If that fails, only the text is lost.
            #[cfg(unix)]
            let _ = file.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            return Ok(Opened { file, new: true, writable: true });
        }
        Err(error) if error.kind() != ErrorKind::AlreadyExists => return Err(error),
        Err(_) => {}
    }
    match File::options().read(true).write(true).open(path) {
        Ok(file) => Ok(Opened { file, new: false, writable: true }),
        Err(error) if error.kind() != ErrorKind::PermissionDenied => Err(error),
        Err(_) => Ok(Opened { file: File::open(path)?, new: false, writable: false }),
    }
}

/// Who holds a lock with this text; none if it is not whole, or not of ours.
fn holder(text: &str) -> Option<&str> {
    let (number, machine) = text.strip_prefix(MARK)?.split_once(ON)?;
    let whole = number.parse::<u32>().is_ok() && !machine.trim_end().contains('\n') && machine.ends_with('\n');
    whole.then(|| text["luminaire ".len()..].trim_end())
}

/// The number of the user to whom a file belongs, for a message.
fn owner(path: &Path) -> String {
    #[cfg(unix)]
    if let Ok(about) = path.symlink_metadata() {
        return format!(" (number {})", std::os::unix::fs::MetadataExt::uid(&about));
    }
    let _ = path;
    String::new()
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
        for text in [
            "precious",
            "\u{0}",
            "luminaire is what I write about",
            "luminaire process 1",
            "luminaire process 1 on a\nb\n",
        ] {
            std::fs::write(&beside, text).unwrap();
            let error = Lock::of(&folder.path().join("c.exr")).unwrap_err().to_string();
            assert!(error.contains("was not made for that"), "{error}");
            assert_eq!(std::fs::read_to_string(&beside).unwrap(), text);
        }
    }
    #[test]
    fn an_empty_file_is_held_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (path, beside) = (folder.path().join("c.exr"), folder.path().join("c.exr.lock"));
        std::fs::write(&beside, "").unwrap();
        let lock = Lock::of(&path).unwrap().unwrap();
        assert!(Lock::of(&path).unwrap_err().to_string().contains("another process"));
        drop(lock);
        assert_eq!(std::fs::read(&beside).unwrap(), b"");
    }

    #[cfg(unix)]
    #[test]
    fn what_a_job_of_another_user_left_is_taken() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, beside) = (folder.path().join("c.exr"), folder.path().join("c.exr.lock"));
        std::fs::write(&beside, "luminaire process 1 on nowhere\n").unwrap();
        // As it would be with another owner (the superuser may write it nevertheless).
        std::fs::set_permissions(&beside, PermissionsExt::from_mode(0o444)).unwrap();
        let lock = Lock::of(&path).unwrap().unwrap();
        let text = std::fs::read_to_string(&beside).unwrap();
        assert!(text.contains(&std::process::id().to_string()), "{text}");
        drop(lock);
        assert!(!beside.exists());
        let lock = Lock::of(&path).unwrap().unwrap();
        assert_eq!(beside.metadata().unwrap().permissions().mode() & 0o777, 0o666);
        drop(lock);
    }

    #[cfg(unix)]
    #[test]
    fn links_lead_to_the_lock_of_what_is_written_and_are_none_themselves() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("far")).unwrap();
        for name in ["live.exr", "dangling.exr"] {
            let real = at("far").join(name);
            if name == "live.exr" {
                std::fs::write(&real, "old").unwrap();
            }
            symlink(&real, at(name)).unwrap();
            let lock = Lock::of(&at(name)).unwrap().unwrap();
            // However often it is written, both names have one lock.
            crate::files::save_text(&at(name), "new").unwrap();
            assert!(Lock::of(&real).is_err() && Lock::of(&at(name)).is_err());
            drop(lock);
        }
        std::fs::write(at("precious"), "luminaire process 1 on nowhere\n").unwrap();
        for to in ["precious", "nothing"] {
            symlink(to, at("c.exr.lock")).unwrap();
            assert!(Lock::of(&at("c.exr")).unwrap_err().to_string().contains("not a file"));
            std::fs::remove_file(at("c.exr.lock")).unwrap();
        }
        assert!(at("precious").exists() && !at("nothing").exists());
    }
}
