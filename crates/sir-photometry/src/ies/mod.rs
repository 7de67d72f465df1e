//! Reader of IES LM-63, versions 1986 to 2019.

mod angles;
mod file;
mod header;
mod shape;
mod tilt;
mod version;

pub(crate) use file::read;
pub(crate) use header::tilt_value;
