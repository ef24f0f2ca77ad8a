//! Rows of tables, and images, as Markdown.

/// The first two lines of a table: the headings of its columns, and the line below them.
pub fn head<T: AsRef<str>>(columns: &[T]) -> String {
    format!("{}|{}\n", row(columns), "---|".repeat(columns.len()))
}

/// A row of a table.
pub fn row<T: AsRef<str>>(cells: &[T]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| cell.as_ref().replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// A row that is a heading within a table of `columns` columns.
pub fn band(words: &str, columns: usize) -> String {
    format!("| **{words}** |{}\n", " |".repeat(columns - 1))
}

/// A picture in a folder, as seen from the page and without a slash at its end. `words` are for readers who do not see it.
pub fn image(words: &str, folder: &str, file: &str) -> String {
    // A bracket would end the words.
    format!("![{}](<{folder}/{file}>)\n\n", words.replace(['[', ']'], ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_as_many_cells_as_columns() {
        assert_eq!(head(&["a", "b|c"]), "| a | b\\|c |\n|---|---|\n");
        assert_eq!(row(&["1", ""]), "| 1 |  |\n");
        assert_eq!(band("all", 3), "| **all** | | |\n");
    }

    #[test]
    fn images_keep_their_brackets() {
        assert_eq!(image("a [b]", "folder", "c d.svg"), "![a b](<folder/c d.svg>)\n\n");
    }
}
