//! Who imports whom: the arrows of the house, read from its sources.

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
pub struct File {
    /// From the root of the repository.
    pub path: String,
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
pub struct House {
    pub files: Vec<File>,
    of_module: BTreeMap<Module, usize>,
}

impl House {
    pub fn new(root: &Path) -> Self {
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
    pub fn arrows(&self) -> Vec<BTreeSet<usize>> {
        let arrow = |(index, file): (usize, &File)| {
            let to = file.imports.iter().filter_map(|path| self.holder(path, 0));
            to.filter(|to| *to != index).collect()
        };
        self.files.iter().enumerate().map(arrow).collect()
    }
}
