//! Files that we made ourselves, and their light: fluxes against closed forms, directions against the definitions of the
//! standards, samples against their density.

#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod errors;
mod files;
mod flux;
mod hostile;
mod lamps;
mod mistakes;
mod openings;
mod orientation;
mod sampling;
mod table;
