//! Dependencies between the files of a crate have no cycles.

use std::fs;
use std::path::Path;

use crate::circles::{circles, describe};
use crate::modules::{Sources, read_sources, targets};
use crate::names::arrows;

/// Advice for removing a cycle.
const REMEDY: &str = "Name items by the module that defines them (crate::tree::Tree, not crate::Tree); \
    move what both files need into a file that needs neither; leave only docs, `mod` and `pub use` in a lib.rs or mod.rs \
    whose modules name it.";

/// Returns the cycles of a package, one sentence each.
fn problems(folder: &str, sources: &Sources) -> Vec<String> {
    let mut problems = Vec::new();
    for target in targets(sources) {
        let arrows = arrows(&target);
        problems.extend(circles(&arrows).iter().map(|circle| describe(folder, &arrows, circle)));
    }
    problems
}

/// Returns the names of all packages, with the folders of their sources below the root of the workspace.
fn packages() -> Vec<(String, String)> {
    let mut packages = vec![("sir".to_owned(), "src/".to_owned())];
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let src = format!("crates/{name}/src/");
        if root().join(&src).is_dir() {
            packages.push((name, src));
        }
    }
    packages.sort();
    packages
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn files_have_no_circles() {
    let packages = packages();
    assert!(packages.len() > 10, "{packages:?}");
    let mut found = Vec::new();
    for (_, folder) in packages {
        found.extend(problems(&folder, &read_sources(&root().join(&folder))));
    }
    assert!(found.is_empty(), "{} cycles between files:\n{}\n{REMEDY}", found.len(), found.join("\n"));
}

#[test]
fn all_files_are_looked_at() {
    for (name, folder) in packages() {
        let sources = read_sources(&root().join(&folder));
        let targets = targets(&sources);
        for file in sources.keys() {
            let known = targets.iter().any(|target| target.files.contains(file));
            assert!(known, "{folder}{file} is not a module of {name}");
        }
    }
}

/// Returns the cycles of a synthetic crate.
fn made_up(files: &[(&str, &str)]) -> Vec<String> {
    problems("", &files.iter().map(|&(name, text)| (name.to_owned(), text.to_owned())).collect())
}

#[test]
fn circles_are_found() {
    let direct =
        [("lib.rs", "mod a; mod b;"), ("a.rs", "\nuse crate::b::B;"), ("b.rs", "fn f() -> crate::a::A {}")];
    assert_eq!(made_up(&direct), ["a.rs:2 uses b.rs, b.rs:1 uses a.rs"]);
    let of_three = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::{b::{self, B}, d};"),
        ("b.rs", "fn f() { super::c::g() }"),
        ("c.rs", "fn g(x: Vec<crate::a::A>) {}"),
    ];
    assert_eq!(made_up(&of_three), ["a.rs:1 uses b.rs, b.rs:1 uses c.rs, c.rs:1 uses a.rs"]);
    let through_the_root = [("lib.rs", "mod a;\npub use a::A;\npub struct B;"), ("a.rs", "use crate::B;")];
    assert_eq!(made_up(&through_the_root), ["a.rs:1 uses lib.rs, lib.rs:2 uses a.rs"]);
    let through_a_re_export = [
        ("lib.rs", "mod a; mod b; pub use a::A; pub use b::B;"),
        ("a.rs", ""),
        ("b.rs", "struct B(crate::A);"),
    ];
    assert_eq!(made_up(&through_a_re_export), ["b.rs:1 uses lib.rs, lib.rs:1 uses b.rs"]);
    let through_super = [
        ("lib.rs", "mod a;"),
        ("a/mod.rs", "mod b; mod c; fn f() { c::g() }"),
        ("a/b.rs", "use super::*;"),
        ("a/c.rs", "use super::b::B;"),
    ];
    assert_eq!(
        made_up(&through_super),
        ["a/b.rs:1 uses a/mod.rs, a/mod.rs:1 uses a/c.rs, a/c.rs:1 uses a/b.rs"]
    );
}

#[test]
fn circles_are_found_wherever_names_stand() {
    for uses_a in [
        "fn f() { vec![1, crate::a::one()]; }",
        "fn f() { println!(\"{}\", super::a::A) }",
        "#[derive(Deserialize)] struct B { #[serde(default = \"crate::a::one\")] x: f64 }",
        "impl crate::a::Trait for B {}",
        "use crate::a; fn f(x: a::A) {}",
        "use super as root; fn f() { root::a::one() }",
        "mod inner { fn f() { super::super::a::one() } }",
        "fn f() { use crate::a::one; one() }",
        "fn f(x: X) { match x { crate::a::X::Y => {} } }",
        "macro_rules! m { () => { $crate::a::one() } }",
    ] {
        let files = [("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b::B;"), ("b.rs", uses_a)];
        assert_eq!(made_up(&files), ["a.rs:1 uses b.rs, b.rs:1 uses a.rs"], "{uses_a}");
    }
}

#[test]
fn no_circles_are_invented() {
    for no_use_of_a in [
        "",
        "//! See [`crate::a::A`].\n/// As [`A`](crate::a::A) has it.\nfn f() {} // crate::a::A",
        "fn f() { let text = \"crate::a::A\"; }",
        "#[cfg(test)]\nmod tests { use crate::a::A; fn f() { crate::a::one() } }",
        "#[cfg(test)]\nuse crate::a::A;",
        "pub(in crate::a) struct B;",
        "use other::a::A; use ::a::A; fn f() { other::crate_::a::A; }",
        "fn f(a: A) { a.b::<u8>(); Self::a(); }",
        "mod a { pub fn one() {} }\nfn f() { a::one() }",
    ] {
        let files =
            [("lib.rs", "mod a; mod b; pub use b::B;"), ("a.rs", "use crate::b::B;"), ("b.rs", no_use_of_a)];
        assert_eq!(made_up(&files), [""; 0], "{no_use_of_a}");
    }
    let tests_in_a_file = [
        ("lib.rs", "mod a; pub use a::A;"),
        ("a/mod.rs", "#[cfg(test)] mod tests;"),
        ("a/tests.rs", "use super::*; use crate::A;"),
    ];
    assert_eq!(made_up(&tests_in_a_file), [""; 0]);
}
