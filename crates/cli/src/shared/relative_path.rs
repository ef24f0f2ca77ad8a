//! The relative path by which a page links to a folder.

use std::path::{Component, Path};

/// The path of `folder` relative to the folder of `page`, with slashes: the link still works when both are moved together.
pub fn seen_from(page: &Path, folder: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (page, folder) = (absolute(page), absolute(folder));
    let here = page.parent().unwrap_or(Path::new("/"));
    let parts = |path: &Path| -> Vec<String> {
        let named = path.components().filter(|part| *part != Component::CurDir);
        named.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    };
    let (here, there) = (parts(here), parts(&folder));
    let shared = here.iter().zip(&there).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..", here.len() - shared).map(str::to_owned);
    let way: Vec<String> = up.chain(there[shared..].iter().cloned()).collect();
    if way.is_empty() { ".".into() } else { way.join("/") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_find_their_charts() {
        let seen = |page: &str, folder: &str| seen_from(Path::new(page), Path::new(folder));
        assert_eq!(seen("docs/stability.md", "docs/stability"), "stability");
        assert_eq!(seen("stability/README.md", "stability"), ".");
        assert_eq!(seen("a/b/page.md", "c/d"), "../../c/d");
        assert_eq!(seen("./page.md", "./d/"), "d");
        assert_eq!(seen("/x/page.md", "/y"), "../y");
    }
}
