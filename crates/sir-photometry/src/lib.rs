//! Photometric files of luminaires, and the luminous intensity that they describe.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod distribution;
mod emission;
mod error;
mod faces;
mod opening;
mod photometry;

pub use distribution::{Coordinates, IntensityDistribution};
pub use emission::OpeningLight;
pub use error::TableError;
pub use faces::OpeningFace;
pub use opening::{Opening, Outline};
pub use photometry::Photometry;
