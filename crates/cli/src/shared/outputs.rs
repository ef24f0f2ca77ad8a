//! The files that a run will write: declared with the options that name them, and checked before anything is computed.

use luminaire::files::{Place, check_writable};
use luminaire::{Error, Result};
use std::io::Read;
use std::path::{Path, PathBuf};

/// By what the program knows the files that it has written: one of these is among their first bytes.
const MARKS: [&str; 8] = [
    // PNG.
    "Software\0luminaire",
    // Charts, and the pages and numbers of `bench` and `stability`.
    "<!-- made by luminaire -->",
    "<title>luminaire: benchmark</title>",
    "\"command\": \"luminaire bench",
    "section,of,quantity,unit,median,least,most,rounds\n",
    "chart,method,x,y,error\n",
    "# Where methods fail\n",
    // Manual pages, whose title says of what program they are.
    " 1  \"luminaire ",
];
/// They are looked for in so many bytes.
const MOST_BYTES: u64 = 1 << 12;

/// A file that will be written.
struct Output {
    /// The option with the name, for messages.
    said: String,
    place: Place,
    /// The option that would name another file, where no option has named this one.
    default: Option<&'static str>,
    path: PathBuf,
}

/// All files that a run will write.
#[derive(Default)]
pub struct Outputs(Vec<Output>);

impl Outputs {
    /// Declares a file that an option names.
    ///
    /// # Errors
    /// A usage error if it is one of those before, by whatever name; [`Error::Write`] if it cannot be written.
    pub fn add(&mut self, option: &str, path: &Path) -> Result<()> {
        self.push(format!("{option} {}", path.display()), path, None)
    }

    /// Declares a file that has its name because no `option` gives it another one. A file that somebody else has written is not replaced by it
    /// ([`Outputs::check`]).
    ///
    /// # Errors
    /// As for [`Outputs::add`].
    pub fn add_default(&mut self, option: &'static str, path: &Path) -> Result<()> {
        self.push(path.display().to_string(), path, Some(option))
    }

    /// Declares those files of a folder that are there and have one of the names that may be written, as by [`Outputs::add_default`].
    ///
    /// # Errors
    /// As for [`Outputs::add`]; also if a file that was declared before has one of these names, there or not.
    pub fn add_those_in(
        &mut self,
        folder: &Path,
        default: &'static str,
        may_be_written: impl Fn(&str) -> bool,
    ) -> Result<()> {
        let whole = std::fs::canonicalize(folder).ok();
        let taken = |output: &&Output| {
            let Some(path) = output.place.whole() else { return false };
            path.parent() == whole.as_deref()
                && path.file_name().and_then(|name| name.to_str()).is_some_and(&may_be_written)
        };
        if let Some(output) = self.0.iter().find(taken) {
            return Err(Error::Usage(format!(
                "{}: that is a name of the files that are written to {}: give another name",
                output.said,
                folder.display()
            )));
        }
        let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
        for entry in entries.flatten() {
            if entry.file_name().to_str().is_some_and(&may_be_written) {
                let path = folder.join(entry.file_name());
                self.push(path.display().to_string(), &path, Some(default))?;
            }
        }
        Ok(())
    }

    fn push(&mut self, said: String, path: &Path, default: Option<&'static str>) -> Result<()> {
        let place = Place::of(path);
        if let Some(other) = self.0.iter().find(|other| other.place.is(&place)) {
            return Err(Error::Usage(format!(
                "{} and {said} are the same file, which would be written twice: give one of them another name",
                other.said
            )));
        }
        check_writable(path)?;
        self.0.push(Output { said, place, default, path: path.to_owned() });
        Ok(())
    }

    /// Refuses to write over what the run reads, and over what somebody else has written where nobody has asked for that. `inputs` are files with what they are:
    /// `a file of the scene`.
    ///
    /// # Errors
    /// A usage error with both names.
    pub fn check<'a>(&self, inputs: impl IntoIterator<Item = (&'a str, &'a Path)>) -> Result<()> {
        for (what, path) in inputs {
            let input = Place::of(path);
            if let Some(output) = self.0.iter().find(|output| output.place.is(&input)) {
                return Err(Error::Usage(format!(
                    "{}: that is {}, {what}, which would be lost: give another name{}",
                    output.said,
                    path.display(),
                    output.default.map(|option| format!(" by {option}")).unwrap_or_default()
                )));
            }
        }
        for Output { path, default, .. } in &self.0 {
            let Some(option) = default else { continue };
            if path.exists() && !is_ours(path) {
                return Err(Error::Usage(format!(
                    "{}: there is a file of this name that luminaire has not written, and that nobody has named to be replaced: give another place \
                     by {option}, or move the file away",
                    path.display()
                )));
            }
        }
        Ok(())
    }
}

/// Whether the program has written a file. One that cannot be read is another's.
fn is_ours(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(MOST_BYTES).read_to_end(&mut start));
    let holds = |mark: &str| start.windows(mark.len()).any(|bytes| bytes == mark.as_bytes());
    read.is_ok() && MARKS.into_iter().any(holds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nobody_asked_for_spares_the_files_of_others() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let check = |default: bool| {
            let mut outputs = Outputs::default();
            if default { outputs.add_default("-o", &path) } else { outputs.add("-o", &path) }.unwrap();
            outputs.check([]).map_err(|error| (error.exit_code(), error.to_string()))
        };
        assert!(check(true).is_ok() && check(false).is_ok());
        std::fs::write(&path, "precious").unwrap();
        assert!(check(false).is_ok());
        let (code, said) = check(true).unwrap_err();
        assert!(code == 2 && said.contains("a.png") && said.contains("by -o"), "{said}");
        luminaire::picture::save_linear(&path, 1, 1, &[0.0; 3], 0.0).unwrap();
        assert!(check(true).is_ok() && check(false).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text_spare_the_files_of_others_too() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(std::ffi::OsStr::from_bytes(b"caf\xe9.png"));
        // Not every file system takes such names.
        if std::fs::write(&path, "precious").is_err() {
            return;
        }
        let mut outputs = Outputs::default();
        outputs.add_default("-o", &path).unwrap();
        assert_eq!(outputs.check([]).unwrap_err().exit_code(), 2);
        luminaire::picture::save_linear(&path, 1, 1, &[0.0; 3], 0.0).unwrap();
        assert!(outputs.check([]).is_ok());
    }

    #[test]
    fn outputs_are_held_against_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let mut outputs = Outputs::default();
        outputs.add("-o", &folder.path().join("a.png")).unwrap();
        let error = outputs.add("--error-map", &folder.path().join("./a.png")).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("--error-map"), "{error}");
        outputs.add("--error-map", &folder.path().join("b.png")).unwrap();
        let input = folder.path().join("../").join(folder.path().file_name().unwrap()).join("b.png");
        let error = outputs.check([("a file of the scene", &*input)]).unwrap_err().to_string();
        assert!(error.contains("--error-map") && error.contains("a file of the scene"), "{error}");
    }
}
