//! Cases of `luminaires.json`: light of photometric files.
//!
//! A case writes the text of an IES or EULUMDAT file from the formula of a lamp, reads it as the file of a maker would be
//! read, and places the luminaire in a black scene. So an answer tests the whole way from the numbers in a file to the
//! light at a surface. The case of glare has an eye in a sphere that reflects.

mod file;
mod file_kind;
mod glare;
mod lamp;
#[cfg(test)]
mod rectangle;
mod setup;
mod trials;

pub(crate) use glare::glare;
pub(crate) use trials::luminaires;
