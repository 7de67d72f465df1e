//! Reader of EULUMDAT (Stockmar 1990).

mod fields;
mod file;
mod header;
mod lamps;
mod table;

pub(crate) use file::{is_eulumdat, read};
