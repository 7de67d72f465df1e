//! Preparation of a run: everything that must succeed before the first line is traced.

pub(crate) mod cameras;
pub(crate) mod layout;
pub(crate) mod prepared;
pub(crate) mod sources;

pub use layout::{Cells, Layout};
pub use prepared::{Prepared, prepare};
pub use sources::kinds;
