//! Files on disk: whole or absent.
//!
//! Every file is written beside its final place and renamed, so that nobody ever sees half of one. That place is where symbolic links lead: they stay.

mod lock;
mod place;

pub use lock::{Lock, let_go_of_all};
pub use place::{Place, same_file};

use crate::{Error, Result};
use fs4::FileExt;
use place::folder_of;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Checks that a file can be created at `path` or replaced there.
///
/// # Errors
/// [`Error::Write`] if the folder is missing or not writable, or `path` is itself a folder.
pub fn check_writable(path: &Path) -> Result<()> {
    if path.is_dir() {
        return Err(Error::write(path, "it is a folder; give a file name"));
    }
    if path.as_os_str().as_encoded_bytes().last().is_some_and(|b| std::path::is_separator(char::from(*b))) {
        return Err(Error::write(path, "it is the name of a folder; give a file name"));
    }
    if std::fs::metadata(path).is_ok_and(|about| !about.is_file()) {
        return Err(Error::write(path, "there is something that is not a file; give another name"));
    }
    // A rename would replace what somebody has protected.
    if std::fs::metadata(path).is_ok_and(|about| about.permissions().readonly()) {
        return Err(Error::write(path, "it is read-only; make it writable, or give another name"));
    }
    // Permission bits say nothing of read-only file systems, so one is really created (and removed).
    create_beside(&target(path)?).map(drop)
}

/// Where a file of this name is written: where its symbolic links lead, even if nothing is there yet. A rename over a link would destroy it, and the file would
/// not be the one that its lock is of.
fn target(path: &Path) -> Result<PathBuf> {
    if let Some(whole) = Place::of(path).whole() {
        return Ok(whole.to_owned());
    }
    let folder = folder_of(path);
    Err(Error::write(
        path,
        if folder.is_dir() {
            "it is a symbolic link that leads nowhere: remove it, or give another name".into()
        } else {
            format!("the folder {} does not exist; create it first", folder.display())
        },
    ))
}

/// Writes `text` to `path`.
///
/// # Errors
/// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub fn save_text(path: &Path, text: &str) -> Result<()> {
    write_atomically(path, |out| out.write_all(text.as_bytes()))
}

/// How the names of the files end that are renamed once they are complete.
const TEMPORARY_SUFFIX: &str = ".luminaire.tmp";

/// How the names of those begin that are to become `path`. Short enough for a file system where the name itself is.
fn temporary_prefix(path: &Path) -> String {
    let name: String = path.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    format!(".{name}.")
}

/// Removes what a process left that was killed while it wrote `path`.
pub fn remove_left_over(path: &Path) {
    let Ok(path) = target(path) else { return };
    let prefix = temporary_prefix(&path);
    let Ok(entries) = std::fs::read_dir(folder_of(&path)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        // What remains in the middle is the random part: without it, other files of similar names would match.
        let middle = name.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(TEMPORARY_SUFFIX));
        if middle.is_some_and(|middle| middle.len() == 6 && middle.chars().all(char::is_alphanumeric)) {
            // Whoever still writes it holds it.
            let Ok(file) = File::options().write(true).open(entry.path()) else { continue };
            if FileExt::try_lock(&file).is_ok() {
                // Nobody waits for it: if it stays, it only takes room.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

/// A new file in the folder of `path`, removed when dropped.
fn create_beside(path: &Path) -> Result<tempfile::NamedTempFile> {
    create_temporary(path, TEMPORARY_SUFFIX)
}

/// The same, its name ending with `suffix`.
fn create_temporary(path: &Path, suffix: &str) -> Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    let prefix = temporary_prefix(path);
    builder.prefix(&prefix).suffix(suffix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any new file gets, less the umask; a temporary file would be its owner's alone.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder_of(path)).map_err(|e| {
        Error::write(path, format!("the folder {} cannot be written to ({e})", folder_of(path).display()))
    })?;
    // So that nobody takes it for a left-over meanwhile. Where there are no locks, there is nothing to be done.
    let _ = FileExt::try_lock(file.as_file());
    Ok(file)
}

/// Lets `fill` write a temporary file, and moves that to `path` once it is complete on the disk.
pub(crate) fn write_atomically<E: ToString>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::result::Result<(), E>,
) -> Result<()> {
    write_file_atomically(path, |file| {
        let mut out = BufWriter::new(file);
        fill(&mut out).map_err(|e| e.to_string())?;
        out.flush().map_err(|e| e.to_string())
    })
}

/// The same for what does not write from the beginning to the end.
pub(crate) fn write_file_atomically<E: ToString>(
    path: &Path,
    fill: impl FnOnce(&mut File) -> std::result::Result<(), E>,
) -> Result<()> {
    let target = target(path)?;
    let mut file = create_beside(&target)?;
    fill(file.as_file_mut()).map_err(|e| Error::write(path, e))?;
    file.as_file().sync_all().map_err(|e| Error::write(path, e))?;
    file.persist(&target).map_err(|e| Error::write(path, e.error))?;
    Ok(())
}

/// Lets `save` write a file, and gives it the first name that nothing has: `name(1)`, `name(2)` and so on, all in one folder and with one ending. Returns that name.
/// Nothing is ever replaced, not even what another process has just written.
///
/// # Errors
/// Those of `save`, and [`Error::Write`] if the system refuses.
pub fn save_numbered(name: impl Fn(u64) -> PathBuf, save: impl FnOnce(&Path) -> Result<()>) -> Result<PathBuf> {
    let mut path = name(1);
    // `save` may go by the ending.
    let ending = path.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
    let mut file = create_temporary(&path, &(TEMPORARY_SUFFIX.to_owned() + &ending))?.into_temp_path();
    save(&file).map_err(|error| match error {
        Error::Write { reason, .. } => Error::write(&path, reason),
        other => other,
    })?;
    for number in 1.. {
        path = name(number);
        // Cheaper than to try; a symbolic link that leads nowhere is something, too.
        if path.symlink_metadata().is_ok() {
            continue;
        }
        match file.persist_noclobber(&path) {
            Ok(()) => break,
            // Another process was faster.
            Err(failed) if path.symlink_metadata().is_ok() => file = failed.path,
            Err(failed) => return Err(Error::write(&path, failed.error)),
        }
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        save_text(&path, "old").unwrap();
        let failed = write_atomically(&path, |out| {
            out.write_all(b"half").unwrap();
            Err("the disk is full")
        });
        assert!(failed.unwrap_err().to_string().contains("the disk is full"));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        save_text(&path, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_what_it_leads_to_is_written() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("far")).unwrap();
        std::fs::write(at("far/live.json"), "old").unwrap();
        for name in ["live.json", "dangling.json"] {
            symlink(Path::new("far").join(name), at(name)).unwrap();
            check_writable(&at(name)).unwrap();
            save_text(&at(name), "new").unwrap();
            assert!(at(name).is_symlink(), "{name}");
            assert_eq!(std::fs::read_to_string(at("far").join(name)).unwrap(), "new");
        }
        assert_eq!(std::fs::read_dir(at("far")).unwrap().count(), 2);
        // What a killed process leaves lies where it wrote.
        std::fs::write(at("far/.live.json.abcdef.luminaire.tmp"), "half").unwrap();
        remove_left_over(&at("live.json"));
        assert_eq!(std::fs::read_dir(at("far")).unwrap().count(), 2);
        for (to, name) in [("round.json", "round.json"), ("none/a.json", "nowhere.json")] {
            symlink(to, at(name)).unwrap();
            assert!(check_writable(&at(name)).unwrap_err().to_string().contains("leads nowhere"));
            assert!(save_text(&at(name), "new").is_err() && at(name).is_symlink());
        }
    }

    #[test]
    fn a_numbered_file_replaces_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let name = |number: u64| folder.path().join(format!("a-{number}.json"));
        let save = |path: &Path| save_text(path, "x");
        assert_eq!(save_numbered(name, save).unwrap(), name(1));
        // Another process takes the next name while this one writes.
        let path = save_numbered(name, |path| {
            std::fs::write(name(2), "precious").unwrap();
            save(path)
        });
        assert_eq!(path.unwrap(), name(3));
        assert_eq!(std::fs::read_to_string(name(2)).unwrap(), "precious");
        let failed = save_numbered(name, |path| Err(Error::write(path, "the disk is full"))).unwrap_err().to_string();
        assert!(failed.contains("a-1.json") && failed.contains("the disk is full"), "{failed}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[cfg(unix)]
    #[test]
    fn files_get_ordinary_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("a.json"), folder.path().join("b"));
        save_text(&ours, "x").unwrap();
        std::fs::write(&plain, "x").unwrap();
        let mode = |p: &Path| p.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
