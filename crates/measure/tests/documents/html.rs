//! Pages as tests read them.

/// A page must be a document that loads nothing: no script, no address, no picture but its own.
pub fn check_page(page: &str) {
    for outside in ["http:", "https:", "<script", "<link", "<img", "src=", "url(", "@import"] {
        assert!(!page.contains(outside), "the page has {outside:?}");
    }
    let body = page.strip_prefix("<!DOCTYPE html>\n").expect("a document type");
    let document = roxmltree::Document::parse(body).expect("well-formed");
    for table in document.descendants().filter(|node| node.has_tag_name("table")) {
        let cells = |row: roxmltree::Node| row.children().filter(|cell| cell.is_element()).count();
        let rows: Vec<_> = table.descendants().filter(|node| node.has_tag_name("tr")).map(cells).collect();
        assert!(rows.len() > 1 && rows.iter().all(|count| *count == rows[0]), "{rows:?}");
    }
}
