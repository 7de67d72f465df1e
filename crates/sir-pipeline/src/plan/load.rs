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
    /// Stage that reads a scene.
    pub struct Load {
        /// Scene file: `.gltf`, `.glb` or `.obj`. The path is relative to the folder of the pipeline file.
        pub path: PathBuf = SceneFile.required();
        /// Sides of surfaces that reflect: those that the file specifies (`doubleSided` in glTF; both in OBJ, which
        /// cannot specify them), both sides of all surfaces, or only the fronts. The back of a one-sided surface
        /// absorbs all light.
        pub sides: SidesPolicy = SIDES.or(SidesPolicy::default());
    }
}
