//! A folder with a small scene in which a test runs the program.
#![allow(dead_code)] // Each test binary uses a part of it.

pub mod running;

use std::path::Path;
use std::process::{Command, Output};

/// A folder of one test, with a scene that is sound: one triangle that emits.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// With `good.obj` and `good.mtl`.
    pub fn new() -> Self {
        let folder = Folder(tempfile::tempdir().unwrap());
        folder.write("good.mtl", "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
        folder.write("good.obj", "mtllib good.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n");
        folder
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// Writes a file.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path().join(name), text).unwrap();
    }

    /// `luminaire` with these arguments, to be run in the folder.
    pub fn luminaire(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
        command.current_dir(self.path()).args(words);
        command
    }

    /// The names of all files, sorted.
    pub fn names(&self) -> Vec<String> {
        names(self.path())
    }
}

/// The names of all files in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// What a run wrote to stderr.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
