//! **SIR**: parallel global-line Monte Carlo radiosity.
//!
//! This package only gathers the crates that do the work; each is useful by itself.

pub use sir_accel as accel;
pub use sir_cli as cli;
pub use sir_geom as geom;
pub use sir_lines as lines;
pub use sir_mesh as mesh;
pub use sir_parallel as parallel;
pub use sir_pipeline as pipeline;
pub use sir_radiosity as radiosity;
pub use sir_scenes as scenes;
pub use sir_view as view;
