//! Photometric files of luminaires, and the luminous intensity that they describe.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod distribution;
mod emission;
mod error;
mod eulumdat;
mod faces;
mod ies;
mod opening;
mod photometry;
mod planes;
mod read;
mod text;
mod tilt;

pub use distribution::{Coordinates, IntensityDistribution};
pub use emission::OpeningLight;
pub use error::{PhotometryError, TableError};
pub use faces::OpeningFace;
pub use opening::{Along, Opening, Outline};
pub use photometry::Photometry;
pub use read::PhotometryOptions;
pub use tilt::{LampGeometry, Tilt};
