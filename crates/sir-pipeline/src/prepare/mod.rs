//! Preparation of a run: everything that must succeed before the first line is traced.

pub(crate) mod cameras;
mod daylight;
mod glare;
pub(crate) mod layout;
pub(crate) mod light_groups;
mod outside;
pub(crate) mod prepared;
pub(crate) mod probe_grid;
pub(crate) mod sources;
mod standard_grid;
pub(crate) mod up;

pub use layout::{Cells, Layout, Placed};
pub use light_groups::LightGroup;
pub use prepared::{Prepared, prepare};
pub use probe_grid::ProbeGrid;
pub use sources::kinds;
pub use up::name as direction_name;
