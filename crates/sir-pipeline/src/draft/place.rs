//! The path by which a drafted pipeline names its scene.

use std::path::{Component, Path, PathBuf};

use crate::run::directory::absolute;

/// Returns the path of a scene for a pipeline in a directory that need not exist yet: relative if both are in the working
/// directory, so that it can be moved; otherwise absolute.
pub(super) fn path_from(directory: &Path, scene: &Path) -> String {
    let path = relative(directory, scene).unwrap_or_else(|| absolute(scene));
    let text = path.to_string_lossy();
    // Forward slashes work everywhere.
    if cfg!(windows) { text.replace('\\', "/") } else { text.into_owned() }
}

fn relative(directory: &Path, scene: &Path) -> Option<PathBuf> {
    // Real paths, because `..` leaves the target of a link and not the link.
    let home = std::env::current_dir().ok()?.canonicalize().ok()?;
    let scene = scene.canonicalize().ok()?;
    let directory = real(directory)?;
    let depth = directory.strip_prefix(&home).ok()?.components().count();
    let mut path: PathBuf = std::iter::repeat_n(Component::ParentDir, depth).collect();
    path.push(scene.strip_prefix(&home).ok()?);
    Some(path)
}

/// Returns the real path of a directory of which only the first part exists.
fn real(directory: &Path) -> Option<PathBuf> {
    let directory = absolute(directory);
    let (existing, start) = directory.ancestors().find_map(|part| Some((part, part.canonicalize().ok()?)))?;
    Some(start.join(directory.strip_prefix(existing).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_in_the_working_directory_are_named_relative_to_the_pipeline() {
        // Tests run in the folder of the package.
        let path = |directory: &str, scene: &str| path_from(Path::new(directory), Path::new(scene));
        assert_eq!(path("results/room", "Cargo.toml"), "../../Cargo.toml");
        assert_eq!(path(".", "src/lib.rs"), "src/lib.rs");
        let elsewhere = tempfile::tempdir().unwrap();
        let absolute = absolute(Path::new("Cargo.toml"));
        assert_eq!(Path::new(&path_from(elsewhere.path(), Path::new("Cargo.toml"))), absolute);
    }
}
