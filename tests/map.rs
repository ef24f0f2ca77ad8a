//! The map of CONTRIBUTING.md, held against the code's own imports: an arrow that the map does not have fails, one that the code does not
//! have fails, and so does a circle of files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};

/// A package of the workspace: the name that others import it by, and its folder of sources.
const PACKAGES: [(&str, &str); 4] = [
    ("luminaire", "src"),
    ("luminaire_measure", "crates/measure/src"),
    ("luminaire_view", "crates/view/src"),
    ("luminaire_cli", "crates/cli/src"),
];

/// A module's full path, the package first.
type Module = Vec<String>;

/// One source file.
struct File {
    /// From the root of the repository.
    path: String,
    module: Module,
    /// Where its imports lead: full paths, without what tests import.
    imports: BTreeSet<Module>,
    /// Names that it knows by `use`, and whence (`*` for all of a module). Others find those that are public, and its children all of them.
    names: Vec<(String, Module)>,
}

/// Gathers the paths of a file that is not about tests.
struct Paths<'a> {
    module: &'a [String],
    /// Modules within the file, as deep as the visit is.
    inner: Vec<String>,
    imports: BTreeSet<Module>,
    names: Vec<(String, Module)>,
}

impl Paths<'_> {
    /// The full path, if it begins in this workspace.
    fn full(&self, segments: &[String]) -> Option<Module> {
        let here: Module = self.module.iter().chain(&self.inner).cloned().collect();
        let mut base = match segments.first()?.as_str() {
            "crate" => vec![here[0].clone()],
            "self" => here,
            "super" => here[..here.len() - 1].to_vec(),
            // Within a package its own name is that of a module, if of anything.
            package if package != here[0] && PACKAGES.iter().any(|(name, _)| *name == package) => {
                vec![package.to_owned()]
            }
            _ => return None,
        };
        for segment in &segments[1..] {
            if segment == "super" {
                base.pop();
            } else {
                base.push(segment.clone());
            }
        }
        Some(base)
    }

    fn import(&mut self, segments: &[String]) {
        let [first, rest @ ..] = segments else { return };
        if rest.is_empty() {
            return;
        }
        // `module::function` after `use somewhere::module`.
        let used = || self.names.iter().find(|(name, _)| name == first).map(|(_, whence)| [&whence[..], rest].concat());
        let path = self.full(segments).or_else(used).unwrap_or_else(|| self.own(segments));
        self.imports.insert(path);
    }

    fn use_tree(&mut self, before: &[String], tree: &syn::UseTree, handed_on: bool) {
        let with = |name: &syn::Ident| before.iter().cloned().chain([name.to_string()]).collect::<Vec<_>>();
        let mut leaf = |path: &[String], name: String| {
            let path = self.full(path).unwrap_or_else(|| self.own(path));
            // What a folder's file hands on of its own folder is no import: it is the folder's face.
            if !handed_on || !path.starts_with(self.module) {
                self.imports.insert(path.clone());
            }
            self.names.push((name, path));
        };
        match tree {
            syn::UseTree::Path(path) => self.use_tree(&with(&path.ident), &path.tree, handed_on),
            syn::UseTree::Group(group) => group.items.iter().for_each(|item| self.use_tree(before, item, handed_on)),
            syn::UseTree::Name(name) if name.ident == "self" => {
                leaf(before, before.last().cloned().unwrap_or_default());
            }
            syn::UseTree::Name(name) => leaf(&with(&name.ident), name.ident.to_string()),
            syn::UseTree::Rename(rename) => leaf(&with(&rename.ident), rename.rename.to_string()),
            syn::UseTree::Glob(_) => leaf(before, "*".into()),
        }
    }

    /// `child::Name`, as the file of a folder says it. What is of another crate then seems to be of this very file, which is no import.
    fn own(&self, segments: &[String]) -> Module {
        self.module.iter().chain(&self.inner).chain(segments).cloned().collect()
    }
}

fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Path>().is_ok_and(|condition| condition.is_ident("test"))
    })
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_for_tests(&item.attrs) {
            self.inner.push(item.ident.to_string());
            visit::visit_item_mod(self, item);
            self.inner.pop();
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if !is_for_tests(&item.attrs) && item.leading_colon.is_none() {
            self.use_tree(&[], &item.tree, !matches!(item.vis, syn::Visibility::Inherited));
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments: Vec<_> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.import(&segments);
        visit::visit_path(self, path);
    }

    /// What stands in a macro is no path yet.
    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.tokens(call.tokens.clone());
        visit::visit_macro(self, call);
    }

    /// Nor what stands in an attribute.
    fn visit_attribute(&mut self, attribute: &'ast syn::Attribute) {
        if let syn::Meta::List(list) = &attribute.meta {
            self.tokens(list.tokens.clone());
        }
    }

    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {
        // `pub(in crate::x)` imports nothing.
    }
}

impl Paths<'_> {
    fn tokens(&mut self, tokens: proc_macro2::TokenStream) {
        let mut segments: Vec<String> = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                proc_macro2::TokenTree::Ident(name) => {
                    if colons != 2 {
                        self.import(&std::mem::take(&mut segments));
                    }
                    segments.push(name.to_string());
                    colons = 0;
                }
                proc_macro2::TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                other => {
                    self.import(&std::mem::take(&mut segments));
                    colons = 0;
                    if let proc_macro2::TokenTree::Group(group) = other {
                        self.tokens(group.stream());
                    }
                }
            }
        }
        self.import(&segments);
    }
}

/// Every source file of the workspace.
fn files(root: &Path) -> Vec<File> {
    let mut files = Vec::new();
    for (package, folder) in PACKAGES {
        let mut folders: Vec<(PathBuf, Module)> = vec![(root.join(folder), vec![package.to_owned()])];
        while let Some((folder, module)) = folders.pop() {
            for entry in std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
                let path = entry.expect("an entry").path();
                let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
                if path.is_dir() {
                    folders.push((path, module.iter().cloned().chain([name]).collect()));
                } else if path.extension().is_some_and(|ending| ending == "rs") && !is_of_tests(&path) {
                    let module = if ["mod", "lib", "main"].contains(&&*name) {
                        module.clone()
                    } else {
                        module.iter().cloned().chain([name]).collect()
                    };
                    files.push(read(root, &path, module));
                }
            }
        }
    }
    files
}

/// A file `tests.rs` whose parent declares it for tests alone.
fn is_of_tests(path: &Path) -> bool {
    let declared = |parent: &str| {
        let text = std::fs::read_to_string(path.with_file_name(parent)).unwrap_or_default();
        text.contains("#[cfg(test)]\nmod tests;")
    };
    path.ends_with("tests.rs") && ["mod.rs", "lib.rs", "main.rs"].into_iter().any(declared)
}

fn read(root: &Path, path: &Path, module: Module) -> File {
    let text = std::fs::read_to_string(path).expect("a source file is text");
    let syntax = syn::parse_file(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut paths = Paths { module: &module, inner: Vec::new(), imports: BTreeSet::new(), names: Vec::new() };
    // First the names, which the rest may use.
    syntax.items.iter().filter(|item| matches!(item, syn::Item::Use(_))).for_each(|item| paths.visit_item(item));
    syntax.items.iter().filter(|item| !matches!(item, syn::Item::Use(_))).for_each(|item| paths.visit_item(item));
    let (imports, names) = (paths.imports, paths.names);
    let path = path.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
    File { path, module, imports, names }
}

/// The workspace: who imports whom.
struct House {
    files: Vec<File>,
    of_module: BTreeMap<Module, usize>,
}

impl House {
    fn new(root: &Path) -> Self {
        let files = files(root);
        let of_module = files.iter().enumerate().map(|(index, file)| (file.module.clone(), index)).collect();
        House { files, of_module }
    }

    /// The file that holds what a path names, through whoever hands it on.
    fn holder(&self, path: &[String], depth: usize) -> Option<usize> {
        assert!(depth < 20, "{path:?} is handed on in a circle");
        let known = (1..=path.len()).rev().find(|length| self.of_module.contains_key(&path[..*length]))?;
        let file = self.of_module[&path[..known]];
        let Some(name) = path.get(known) else { return Some(file) };
        // What is handed on under the path that it has already is of another crate.
        let whence = |(_, from): &(String, Module), rest: &[String]| -> Option<usize> {
            let whence: Module = from.iter().chain(rest).cloned().collect();
            if whence == path { Some(file) } else { self.holder(&whence, depth + 1) }
        };
        let names = &self.files[file].names;
        if let Some(named) = names.iter().find(|(known, _)| known == name) {
            return whence(named, &path[known + 1..]);
        }
        let globs = names.iter().filter(|(known, whence)| known == "*" && self.of_module.contains_key(whence));
        globs.filter_map(|glob| whence(glob, &path[known..])).find(|found| *found != file).or(Some(file))
    }

    /// For every file, the files that it imports from.
    fn arrows(&self) -> Vec<BTreeSet<usize>> {
        let arrow = |(index, file): (usize, &File)| {
            let to = file.imports.iter().filter_map(|path| self.holder(path, 0));
            to.filter(|to| *to != index).collect()
        };
        self.files.iter().enumerate().map(arrow).collect()
    }
}

/// A row of the map: what lies at a path, and on what it stands.
struct Room {
    path: String,
    /// As other rows name it: `scene` for `src/scene/`, `crates/view` for `crates/view/src/`, `error` for `src/error.rs`.
    name: String,
    stands_on: BTreeSet<String>,
}

/// The rooms of the table in CONTRIBUTING.md: rows of `| path | what | stands on |`, paths in backticks.
fn rooms(root: &Path) -> Vec<Room> {
    let text = std::fs::read_to_string(root.join("CONTRIBUTING.md")).expect("the map");
    let quoted = |cell: &str| -> Vec<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let mut rooms = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("| `src/") || line.starts_with("| `crates/")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').collect();
        let [paths, _, stands_on] = cells[..] else { panic!("a row of the map has not three cells: {line}") };
        for path in quoted(paths) {
            let name = path.trim_end_matches(".rs").trim_end_matches('/').trim_end_matches("/src");
            let name = name.strip_prefix("src/").unwrap_or(name).to_owned();
            rooms.push(Room { path, name, stands_on: quoted(stands_on).into_iter().collect() });
        }
    }
    assert!(rooms.len() > 8, "the table of CONTRIBUTING.md has only {} rooms", rooms.len());
    rooms
}

/// Rooms that share the longest beginning with a file's path.
fn room_of<'a>(rooms: &'a [Room], file: &str) -> Option<&'a Room> {
    rooms.iter().filter(|room| file.starts_with(&room.path)).max_by_key(|room| room.path.len())
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_map_has_every_arrow_and_no_other() {
    let (house, rooms) = (House::new(&root()), rooms(&root()));
    let mut wrong = Vec::new();
    let mut used: BTreeSet<(&str, &str)> = BTreeSet::new();
    for (file, arrows) in house.files.iter().zip(house.arrows()) {
        let Some(room) = room_of(&rooms, &file.path) else {
            wrong.push(format!("{} lies in no room of the map", file.path));
            continue;
        };
        for to in arrows.into_iter().map(|to| &house.files[to].path) {
            let Some(other) = room_of(&rooms, to).filter(|other| other.path != room.path) else { continue };
            // `src` is the whole library.
            let named =
                room.stands_on.iter().find(|on| **on == other.name || *on == "src" && other.path.starts_with("src/"));
            match named {
                Some(named) => drop(used.insert((&room.path, named))),
                None => wrong.push(format!(
                    "{} imports from {to}, but {} does not stand on {}",
                    file.path, room.name, other.name
                )),
            }
        }
    }
    for room in &rooms {
        assert!(root().join(&room.path).exists(), "the map names {}, which is not there", room.path);
        let unused = room.stands_on.iter().filter(|on| !used.contains(&(room.path.as_str(), on.as_str())));
        wrong.extend(
            unused.map(|on| format!("the map says that {} stands on {on}, but nothing there imports it", room.path)),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other() {
    let house = House::new(&root());
    let arrows = house.arrows();
    let reaches = |from: usize| {
        let mut seen = BTreeSet::new();
        let mut open: Vec<usize> = arrows[from].iter().copied().collect();
        while let Some(next) = open.pop() {
            if seen.insert(next) {
                open.extend(&arrows[next]);
            }
        }
        seen
    };
    let reached: Vec<BTreeSet<usize>> = (0..arrows.len()).map(reaches).collect();
    let mut circles = Vec::new();
    for (from, to) in arrows.iter().enumerate().flat_map(|(from, to)| to.iter().map(move |to| (from, *to))) {
        if reached[to].contains(&from) {
            circles.push(format!("{} -> {}", house.files[from].path, house.files[to].path));
        }
    }
    assert!(circles.is_empty(), "these imports lie on circles:\n{}", circles.join("\n"));
}

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
