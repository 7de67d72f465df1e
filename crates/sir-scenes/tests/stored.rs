//! The files under `scenes/` are what the generator makes.

use std::{fs, path::Path};

use sir_scenes::{stored, write_gltf};

#[test]
fn files_are_what_the_generator_makes() {
    let repository = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let folder = tempfile::tempdir().unwrap();
    for stored in stored().unwrap() {
        let name = Path::new(stored.path).file_name().unwrap();
        let path = folder.path().join(name);
        write_gltf(&stored.scene, &path).unwrap();
        let committed = fs::read(repository.join(stored.path)).unwrap();
        assert!(
            fs::read(&path).unwrap() == committed,
            "{} is not what the generator makes; run `cargo run -p sir-scenes --example make_scenes`",
            stored.path
        );
    }
}
