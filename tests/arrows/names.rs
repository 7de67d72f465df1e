//! Dependencies between files, found by the paths that stand in them.

use std::collections::BTreeMap;

use proc_macro2::{Span, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, ItemUse, Macro, Meta, Path, TraitItem, UseTree, Visibility};

use crate::modules::{Target, is_for_tests};

/// First line on which a file names an item of another file, by the names of both.
pub(crate) type Arrows = BTreeMap<(String, String), usize>;

/// Returns the dependencies (arrows) between the files of a target.
///
/// A file depends on another if it contains a path to a module in that file: in a `use`, a type, an expression, an
/// attribute or the arguments of a macro. Re-exports belong to the module that re-exports: `crate::Scene` leads to
/// `lib.rs`, and `lib.rs` depends on the file that defines it. Module declarations, method calls and test code are
/// ignored.
pub(crate) fn arrows(target: &Target) -> Arrows {
    let mut mentions = BTreeMap::new();
    for (path, module) in &target.modules {
        let mut found = Mentions::default();
        module.items.iter().for_each(|item| found.visit_item(item));
        mentions.insert(path.clone(), found);
    }
    let mut arrows = Arrows::new();
    for (path, found) in &mentions {
        let from = &target.modules[path].file;
        for (segments, line) in &found.paths {
            let Some(segments) = absolute(target, &mentions, path, segments, 0) else { continue };
            let known = (0..=segments.len()).rev().find_map(|n| target.modules.get(&segments[..n]));
            if let Some(to) = known.map(|module| &module.file).filter(|to| *to != from) {
                let first = arrows.entry((from.clone(), to.clone())).or_insert(*line);
                *first = (*first).min(*line);
            }
        }
    }
    arrows
}

/// Resolves a path to one from the root of the target. Returns `None` if the path leads outside of the target.
fn absolute(
    target: &Target,
    mentions: &BTreeMap<Vec<String>, Mentions>,
    module: &[String],
    segments: &[String],
    depth: usize,
) -> Option<Vec<String>> {
    let (first, rest) = segments.split_first()?;
    let child = [module, &segments[..1]].concat();
    match first.as_str() {
        "crate" => Some(rest.to_vec()),
        "self" => Some([module, rest].concat()),
        "super" => {
            let up = rest.iter().take_while(|segment| *segment == "super").count();
            Some([&module[..module.len().checked_sub(1 + up)?], &rest[up..]].concat())
        }
        _ if target.modules.contains_key(&child) => Some([module, segments].concat()),
        _ => {
            let imported = mentions[module].imports.get(first).filter(|path| path.first() != Some(first))?;
            let start = if depth < 8 {
                absolute(target, mentions, module, imported, depth + 1)?
            } else {
                return None;
            };
            Some([start.as_slice(), rest].concat())
        }
    }
}

/// Paths in a module, each with its line, and the names that the module imports.
#[derive(Default)]
struct Mentions {
    paths: Vec<(Vec<String>, usize)>,
    imports: BTreeMap<String, Vec<String>>,
}

impl Mentions {
    fn add(&mut self, segments: Vec<String>, span: Span) {
        // A single name is imported or local and adds no dependency.
        if segments.len() > 1 {
            self.paths.push((segments, span.start().line));
        }
    }

    fn add_use(&mut self, tree: &UseTree, before: &[String]) {
        match tree {
            UseTree::Path(path) => {
                self.add_use(&path.tree, &[before, &[path.ident.to_string()]].concat());
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_use(tree, before)),
            UseTree::Glob(glob) => {
                let everything = [before, &["*".to_owned()]].concat();
                self.add(everything, glob.star_token.spans[0]);
            }
            UseTree::Name(name) => self.add_import(before, &name.ident.to_string(), None, name.ident.span()),
            UseTree::Rename(as_name) => {
                let known_as = Some(as_name.rename.to_string());
                self.add_import(before, &as_name.ident.to_string(), known_as, as_name.ident.span());
            }
        }
    }

    fn add_import(&mut self, before: &[String], name: &str, known_as: Option<String>, span: Span) {
        let mut path = before.to_vec();
        if name != "self" || before.is_empty() {
            path.push(name.to_owned());
        }
        let known_as = known_as.or_else(|| path.last().cloned());
        if let Some(known_as) = known_as {
            self.imports.insert(known_as, path.clone());
        }
        self.add(path, span);
    }

    /// Adds the paths in a token stream, such as the arguments of a macro.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let is = |i: usize, c: char| matches!(tokens.get(i), Some(TokenTree::Punct(p)) if p.as_char() == c);
        let mut i = 0;
        while i < tokens.len() {
            match &tokens[i] {
                TokenTree::Group(group) => self.add_tokens(group.stream()),
                TokenTree::Ident(first) => {
                    // Paths that begin with `::` lead to other crates. Segments after generic arguments continue a
                    // path.
                    let begins = !(i >= 2 && is(i - 1, ':') && is(i - 2, ':'));
                    let mut segments = vec![first.to_string()];
                    while is(i + 1, ':')
                        && is(i + 2, ':')
                        && let Some(TokenTree::Ident(next)) = tokens.get(i + 3)
                    {
                        segments.push(next.to_string());
                        i += 3;
                    }
                    if begins {
                        self.add(segments, first.span());
                    }
                }
                _ => {}
            }
            i += 1;
        }
    }
}

impl<'ast> Visit<'ast> for Mentions {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes: &[Attribute] = match item {
            Item::Const(item) => &item.attrs,
            Item::Enum(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            Item::Macro(item) => &item.attrs,
            Item::Static(item) => &item.attrs,
            Item::Struct(item) => &item.attrs,
            Item::Trait(item) => &item.attrs,
            Item::Type(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            _ => &[],
        };
        if !attributes.iter().any(is_for_tests) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !matches!(item, ImplItem::Fn(method) if method.attrs.iter().any(is_for_tests)) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_trait_item(&mut self, item: &'ast TraitItem) {
        if !matches!(item, TraitItem::Fn(method) if method.attrs.iter().any(is_for_tests)) {
            visit::visit_trait_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        if item.leading_colon.is_none() {
            self.add_use(&item.tree, &[]);
        }
    }

    fn visit_path(&mut self, path: &'ast Path) {
        if let Some(first) = path.segments.first().filter(|_| path.leading_colon.is_none()) {
            let segments = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            self.add(segments, first.ident.span());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        visit::visit_macro(self, call);
        self.add_tokens(call.tokens.clone());
    }

    /// Adds paths in attributes. Those of derive macros may be strings: `#[serde(with = "crate::units")]`.
    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if let Meta::List(list) = &attribute.meta {
            self.add_tokens(list.tokens.clone());
            for token in list.tokens.clone() {
                if let TokenTree::Literal(literal) = token
                    && let Ok(text) = syn::parse_str::<syn::LitStr>(&literal.to_string())
                    && let Ok(path) = text.parse::<Path>()
                {
                    let segments = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
                    self.add(segments, literal.span());
                }
            }
        }
    }

    /// Ignores visibilities: `pub(in crate::a)` is no dependency.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}
}
