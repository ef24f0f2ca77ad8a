//! Long tables become CSV beside the page; the page has what they say.

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

    /// Writes a table of Markdown as CSV, under a name without an ending.
    pub fn save(&self, name: &str, markdown: &str) -> std::io::Result<()> {
        std::fs::write(self.path.join(name).with_extension("csv"), csv(markdown))
    }
}

/// A table of Markdown as CSV. A row with nothing but a bold first cell names the group of the rows below it, which becomes their first column.
fn csv(markdown: &str) -> String {
    let rows = markdown.lines().filter(|line| line.starts_with('|') && !line.starts_with("|---"));
    let cells =
        |line: &str| -> Vec<String> { line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect() };
    let rows: Vec<Vec<String>> = rows.map(cells).collect();
    let group = |row: &[String]| match row {
        [name, rest @ ..] if rest.iter().all(String::is_empty) => {
            name.strip_prefix("**")?.strip_suffix("**").map(str::to_owned)
        }
        _ => None,
    };
    let grouped = rows.iter().any(|row| group(row).is_some());
    let mut name = String::from("subject");
    let mut text = String::new();
    for row in &rows {
        if let Some(group) = group(row) {
            name = group;
            continue;
        }
        let first = grouped.then_some(&name);
        let fields: Vec<_> = first.into_iter().chain(row).map(|cell| field(cell)).collect();
        text += &format!("{}\n", fields.join(","));
    }
    text
}

fn field(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_table_becomes_csv() {
        let table = "| case | z |\n|---|---|\n| **light** | |\n| one, \"two\" | -1 |\n| **glass** | |\n| three | 2 |\n";
        assert_eq!(super::csv(table), "subject,case,z\nlight,\"one, \"\"two\"\"\",-1\nglass,three,2\n");
        assert_eq!(super::csv("| a | b |\n|---|---|\n| 1 | |\n"), "a,b\n1,\n");
    }
}
