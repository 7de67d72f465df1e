//! Sets `SIR_VERSION`: the version of this package and, if its sources are those of a checkout, their hash.
//!
//! Two builds of one version may come from different sources, and then give different results. Packages from a registry
//! need no hash: the sources of a published version never change, and the dependencies between the packages of this
//! project state an exact version.

#![allow(clippy::print_stdout, reason = "Cargo reads the output")]

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Number of bytes of the hash in the version: enough to tell builds apart.
const SHOWN: usize = 6;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (version, package) = (env::var("CARGO_PKG_VERSION")?, env::var("CARGO_PKG_NAME")?);
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let mut packages = BTreeSet::new();
    println!("cargo::rerun-if-changed=build.rs");
    let version = match here.parent() {
        Some(folder) if add_with_dependencies(folder, &package, &mut packages) => {
            let hash = hash(folder, &packages)?;
            let digits: String = hash[..SHOWN].iter().map(|byte| format!("{byte:02x}")).collect();
            format!("{version} (sources {digits})")
        }
        _ => version,
    };
    println!("cargo::rustc-env=SIR_VERSION={version}");
    Ok(())
}

/// Adds a package and the packages of this project that it depends on. Returns false if one of them is not in `folder`.
fn add_with_dependencies(folder: &Path, package: &str, found: &mut BTreeSet<String>) -> bool {
    if !found.insert(package.to_owned()) {
        return true;
    }
    let Ok(manifest) = fs::read_to_string(folder.join(package).join("Cargo.toml")) else { return false };
    let sections = manifest.split("\n[").filter_map(|section| section.strip_prefix("dependencies]"));
    let lines = sections.flat_map(str::lines).filter(|line| line.starts_with("sir-"));
    let mut names = lines.filter_map(|line| line.split(['.', ' ', '=']).next());
    names.all(|name| add_with_dependencies(folder, name, found))
}

/// Returns the hash of the sources of packages, and of the files of the workspace that choose the libraries.
fn hash(folder: &Path, packages: &BTreeSet<String>) -> io::Result<Vec<u8>> {
    let mut files = BTreeSet::new();
    for package in packages {
        add_files(&folder.join(package).join("src"), &mut files)?;
        files.insert(folder.join(package).join("Cargo.toml"));
    }
    let workspace = folder.parent().unwrap_or(folder);
    files.extend(
        ["Cargo.toml", "Cargo.lock"].map(|name| workspace.join(name)).into_iter().filter(|f| f.exists()),
    );
    let mut hash = Sha256::new();
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        let name = file.strip_prefix(workspace).unwrap_or(file);
        let name: Vec<_> = name.components().map(|part| part.as_os_str().to_string_lossy()).collect();
        let content = fs::read(file)?;
        hash.update(format!("{} {}\n", name.join("/"), content.len()));
        hash.update(content);
    }
    Ok(hash.finalize().to_vec())
}

/// Adds all files in a folder, except hidden ones, which editors leave.
fn add_files(folder: &Path, files: &mut BTreeSet<PathBuf>) -> io::Result<()> {
    // The folder itself, too, so that a new file is noticed.
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if path.is_dir() {
            add_files(&path, files)?;
        } else if !is_hidden {
            files.insert(path);
        }
    }
    Ok(())
}
