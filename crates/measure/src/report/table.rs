//! A table of texts.

use super::{csv, html, markdown};

/// Cells of text.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Table {
    /// Heading of every column.
    pub columns: Vec<String>,
    /// As many cells in every row as there are columns.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table under these headings, without a row.
    pub fn new<T: Into<String>>(columns: impl IntoIterator<Item = T>) -> Self {
        Table { columns: columns.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// The same headings above these rows.
    pub fn with_rows(self, rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        Table { rows: rows.into_iter().collect(), ..self }
    }

    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        markdown::head(&self.columns) + &self.rows.iter().map(|cells| markdown::row(cells)).collect::<String>()
    }

    /// As comma-separated values, the columns' names first.
    pub fn csv(&self) -> String {
        let line = |cells: &Vec<String>| cells.iter().map(|cell| csv::field(cell)).collect::<Vec<_>>().join(",") + "\n";
        std::iter::once(&self.columns).chain(&self.rows).map(line).collect()
    }

    /// The table as an element of HTML, which scrolls where it is too wide.
    pub fn html(&self) -> String {
        let row = |cells: &[String], tag: &str| -> String {
            let cells: String = cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", html::escaped(cell))).collect();
            format!("<tr>{cells}</tr>\n")
        };
        let rows: String = self.rows.iter().map(|cells| row(cells, "td")).collect();
        format!(
            "<div class=\"table\"><table>\n<thead>{}</thead>\n<tbody>\n{rows}</tbody></table></div>\n",
            row(&self.columns, "th")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_written() {
        let table = Table::new(["a", "b"]).with_rows([vec!["1 < 2".into(), "x|y".into()]]);
        assert_eq!(table.markdown(), "| a | b |\n|---|---|\n| 1 < 2 | x\\|y |\n");
        assert_eq!(table.csv(), "a,b\n1 < 2,x|y\n");
        let html = table.html();
        assert!(html.contains("<th>a</th><th>b</th>") && html.contains("<td>1 &lt; 2</td><td>x|y</td>"), "{html}");
    }
}
