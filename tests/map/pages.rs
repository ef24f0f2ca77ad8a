//! Files and tests that pages name are there.

use super::root;

/// Pages name files; those that begin at the root of the repository have to be there.
#[test]
fn files_that_pages_name_are_there() {
    let root = root();
    let pages = std::fs::read_dir(root.join("docs")).expect("docs").map(|entry| entry.expect("an entry").path());
    let pages = pages.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let beside = ["README.md", "CONTRIBUTING.md", "scenes/README.md", "src/lib.rs"].map(|name| root.join(name));
    let mut missing = Vec::new();
    let mut named = 0;
    for page in pages.chain(beside) {
        let text = std::fs::read_to_string(&page).expect("a page is text");
        // Code in blocks is somebody else's.
        for quoted in text.split("```").step_by(2).flat_map(|prose| prose.split('`').skip(1).step_by(2)) {
            let first = quoted.split('/').next().unwrap_or_default();
            let is_ours = ["src", "crates", "shaders", "tests", "examples", "scenes", "scripts", "docs", "fuzz", ".ci"]
                .contains(&first);
            // What the fuzzer finds is not kept.
            let kept = !quoted.starts_with("fuzz/artifacts");
            if !is_ours || !kept || quoted == first || quoted.contains(['*', ' ', '<', '{']) {
                continue;
            }
            named += 1;
            // `tests/gpu` and `tests/sampling` may mean a folder or a file of Rust.
            if !root.join(quoted).exists() && !root.join(format!("{quoted}.rs")).exists() {
                missing.push(format!("{}: {quoted}", page.strip_prefix(&root).unwrap_or(&page).display()));
            }
        }
    }
    assert!(named > 50, "only {named} files are named");
    assert!(missing.is_empty(), "these are not there:\n{}", missing.join("\n"));
}

/// The front page's table names tests as `gpu::features` or `reference::light::name`: each has to be there.
#[test]
fn tests_that_the_front_page_names_are_there() {
    let page = std::fs::read_to_string(root().join("src/lib.rs")).expect("the front page");
    let mut named = 0;
    // Number, slide, functions, tests, scene.
    let cells = page.lines().filter(|line| line.starts_with("//! | ")).filter_map(|line| line.split(" | ").nth(4));
    for quoted in cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)) {
        let parts: Vec<&str> = quoted.split("::").collect();
        let (["gpu" | "reference", file] | ["gpu" | "reference", file, _]) = parts[..] else { continue };
        named += 1;
        let path = root().join("tests").join(parts[0]).join(file).with_extension("rs");
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("`{quoted}`: {}: {e}", path.display()));
        let function = parts.get(2).map(|name| format!("fn {name}("));
        assert!(function.is_none_or(|function| text.contains(&function)), "`{quoted}` is not there");
    }
    assert!(named > 15, "only {named} tests are named");
}
