//! The stage `Load`.

use std::path::PathBuf;

use glam::DVec3;
use sir_geom::SidesPolicy;

use crate::text::field::Format as _;
use crate::text::formats::{Choice, Direction, positive};
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
        /// Length of a unit of the file: `0.001` if it is in millimeters, `0.3048` if it is in feet. All lengths in the
        /// file are multiplied by it; emission per area and intensities of lights stay. Lengths in the pipeline are
        /// always in meters.
        pub scale: f64 = positive(0.001).or(1.0).unit("m");
        /// Up direction of the scene, for pictures, planes of sensors and lit scenes; see below.
        pub up: Option<DVec3> = Direction([0.0, 0.0, 1.0]).optional("from the file");
    }
}
