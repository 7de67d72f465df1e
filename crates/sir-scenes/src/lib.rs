//! The project's own scenes, and a writer that stores any [`Scene`](sir_geom::Scene) as glTF.
//!
//! Every scene is a function of a few numbers, so that its exact dimensions can be read in one place and its file
//! can be made again, byte for byte, by `cargo run -p sir-scenes --example make_scenes`.
//!
//! * [`furnace`] and [`concentric_spheres`] have a known answer: they tell whether a solver is right.
//! * [`cornell_box`] was measured in reality: it is the common yardstick of the field.
//! * [`reading_room`] is a furnished interior lit mostly by light that has been reflected: it is there to be looked
//!   at.
//! * [`airplane_cabin`] has many small things, and light that is hidden almost everywhere: it is there to be looked at,
//!   and to be computed by many processors.
//! * [`museum_stairs`] is a large hall full of sculpture, likewise to be looked at.
//!
//! All lengths are meters, `y` is up, and no scene has light that can leave it, but for the Cornell box, which is open
//! at the front.

mod airplane_cabin;
mod cornell_box;
mod error;
mod exact;
mod gltf;
mod model;
mod museum_stairs;
mod random;
mod reading_room;
mod spectrum;
mod stored;

pub use airplane_cabin::airplane_cabin;
pub use cornell_box::cornell_box;
pub use error::Error;
pub use exact::{SphereShell, concentric_spheres, concentric_spheres_answer, furnace, furnace_answer};
pub use gltf::write_gltf;
pub use museum_stairs::museum_stairs;
pub use reading_room::reading_room;
pub use stored::{FURNACE_EXITANCE, FURNACE_REFLECTANCE, INNER_SPHERE, OUTER_SPHERE, Stored, stored};
