//! Long tables become CSV beside the page; the page has what they say.

use luminaire_measure::report::table::Table;
use std::path::{Path, PathBuf};

/// Where the long tables go.
pub struct Folder {
    path: PathBuf,
    /// Its name as the page links it.
    pub name: String,
}

impl Folder {
    /// The folder of a page: its name without the ending.
    pub fn beside(page: &Path) -> std::io::Result<Self> {
        let path = page.with_extension("");
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        std::fs::create_dir_all(&path)?;
        Ok(Folder { path, name })
    }

    /// Writes a table, under a name without an ending.
    pub fn save(&self, name: &str, table: &Table) -> std::io::Result<()> {
        std::fs::write(self.path.join(name).with_extension("csv"), table.csv())
    }
}
