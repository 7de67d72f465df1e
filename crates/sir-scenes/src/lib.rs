//! The project's own scenes, and a writer that stores any [`Scene`](sir_geom::Scene) as glTF.
//!
//! Each scene is a function of a few numbers. Its exact dimensions therefore stand in one place, and
//! `cargo run -p sir-scenes --example make_scenes` reproduces its file byte for byte.
//!
//! * [`furnace`] and [`concentric_spheres`] have analytic solutions and test the correctness of a solver.
//! * [`cornell_box`] reproduces a measured box, the standard test scene of the field.
//! * [`reading_room`] is a furnished interior lit mostly by reflected light, made for pictures.
//! * [`airplane_cabin`] has many small objects, and almost all of its lamps are hidden. It is made for pictures and for
//!   runs on many processors.
//! * [`museum_stairs`] is a large hall full of sculpture, also made for pictures.
//! * [`office`] is an open-plan office for the work of a lighting designer, with photometric files of its luminaires.
//!
//! All lengths are in meters, and `y` points up. All scenes are closed, so that no light escapes, except the Cornell
//! box, which is open at the front, and the office, which has windows.

mod airplane_cabin;
mod cornell_box;
mod error;
mod exact;
mod gltf;
mod model;
mod museum_stairs;
mod office;
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
pub use office::{DOWNLIGHT_FLUX, RECESSED_FLUX, TASK_FLUX, office};
pub use reading_room::reading_room;
pub use stored::{
    FURNACE_EXITANCE, FURNACE_REFLECTANCE, INNER_SPHERE, OUTER_SPHERE, Stored, StoredText, stored,
    stored_texts,
};
