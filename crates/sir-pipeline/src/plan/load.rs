//! The stage `Load`.

use std::path::PathBuf;

use sir_geom::SidesPolicy;

use crate::text::field::Format as _;
use crate::text::formats::Choice;
use crate::text::paths::SceneFile;
use crate::text::record::record;

const SIDES: Choice<SidesPolicy> = Choice(&[
    ("AsAuthored", SidesPolicy::AsAuthored),
    ("Both", SidesPolicy::Both),
    ("Front", SidesPolicy::Front),
]);

record! {
    /// Reads a scene.
    pub struct Load {
        /// The scene: a `.gltf`, `.glb` or `.obj` file. Relative to the folder of the pipeline file.
        pub path: PathBuf = SceneFile.required();
        /// Which sides of surfaces reflect: those that the file says (`doubleSided` in glTF; both in OBJ, which cannot say), both
        /// sides of all, or only the fronts. The back of a one-sided surface absorbs what falls on it.
        pub sides: SidesPolicy = SIDES.or(SidesPolicy::default());
    }
}
