//! Modules of a crate, resolved as the compiler does.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use syn::{Attribute, Expr, ExprLit, Item, Lit, Meta};

/// Text of each file of a crate, by its path below `src`.
pub(crate) type Sources = BTreeMap<String, String>;

/// Module with its file and its items, except test code.
pub(crate) struct Module {
    pub(crate) file: String,
    pub(crate) items: Vec<Item>,
}

/// Target of a package: a library or a program.
pub(crate) struct Target {
    /// Modules by their paths; the path of the root is empty.
    pub(crate) modules: BTreeMap<Vec<String>, Module>,
    /// All files, including those for tests.
    pub(crate) files: BTreeSet<String>,
}

/// Reads all files below a folder.
pub(crate) fn read_sources(src: &Path) -> Sources {
    let mut sources = Sources::new();
    let mut folders = vec![src.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path.strip_prefix(src).unwrap().to_str().unwrap().replace('\\', "/");
                sources.insert(name, fs::read_to_string(&path).unwrap());
            }
        }
    }
    sources
}

/// Returns the targets of a package: its library and its programs.
pub(crate) fn targets(sources: &Sources) -> Vec<Target> {
    let is_root = |name: &str| {
        ["lib.rs", "main.rs"].contains(&name)
            || name.strip_prefix("bin/").is_some_and(|rest| !rest.contains('/') || rest.ends_with("/main.rs"))
    };
    sources.keys().filter(|name| is_root(name)).map(|root| Target::new(sources, root)).collect()
}

impl Target {
    fn new(sources: &Sources, root: &str) -> Self {
        let mut target = Self { modules: BTreeMap::new(), files: BTreeSet::new() };
        target.add_file(sources, root, folder_of(root), Vec::new(), true);
        target
    }

    /// Adds a file and the modules that it declares, whose files are in `folder`. `counts` is false for test code.
    fn add_file(&mut self, sources: &Sources, file: &str, folder: String, path: Vec<String>, counts: bool) {
        let text =
            sources.get(file).unwrap_or_else(|| panic!("no file {file} for module {}", path.join("::")));
        let parsed = syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"));
        self.files.insert(file.to_owned());
        let counts = counts && !parsed.attrs.iter().any(is_for_tests);
        self.add_items(sources, file, &folder, &path, parsed.items, counts);
    }

    fn add_items(
        &mut self,
        sources: &Sources,
        file: &str,
        folder: &str,
        path: &[String],
        items: Vec<Item>,
        counts: bool,
    ) {
        let mut kept = Vec::new();
        for item in items {
            let Item::Mod(module) = item else {
                kept.push(item);
                continue;
            };
            let name = module.ident.to_string();
            let counts = counts && !module.attrs.iter().any(is_for_tests);
            let path = [path, std::slice::from_ref(&name)].concat();
            let inner = format!("{folder}{name}/");
            match module.content {
                Some((_, items)) => self.add_items(sources, file, &inner, &path, items, counts),
                None => {
                    let candidates = match module.attrs.iter().find_map(path_attribute) {
                        Some(given) => vec![normal(&(folder_of(file) + &given))],
                        None => vec![format!("{folder}{name}.rs"), format!("{inner}mod.rs")],
                    };
                    // A test file may be shared with other packages.
                    let Some(found) = candidates.iter().find(|candidate| sources.contains_key(*candidate))
                    else {
                        assert!(!counts, "{file}: no file for module {name}");
                        continue;
                    };
                    self.add_file(sources, found, inner, path, counts);
                }
            }
        }
        if counts {
            self.modules.insert(path.to_vec(), Module { file: file.to_owned(), items: kept });
        }
    }
}

/// Returns the folder of a file, with a trailing slash.
fn folder_of(file: &str) -> String {
    file.rfind('/').map_or_else(String::new, |slash| file[..=slash].to_owned())
}

/// Returns the file named by `#[path = "…"]`.
fn path_attribute(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else { return None };
    let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &pair.value else { return None };
    pair.path.is_ident("path").then(|| text.value())
}

/// Removes `..` from a path where possible.
fn normal(path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split('/') {
        if part == ".." && parts.last().is_some_and(|last| *last != "..") {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}

/// Returns true for `#[cfg(test)]` and `#[cfg(all(test, …))]`.
pub(crate) fn is_for_tests(attribute: &Attribute) -> bool {
    let Meta::List(list) = &attribute.meta else { return false };
    let condition = list.tokens.to_string().replace(' ', "");
    list.path.is_ident("cfg") && (condition == "test" || condition.starts_with("all(test,"))
}
