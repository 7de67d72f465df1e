//! Irradiance where there is no patch: at points, by rays from there.
//!
//! Lights without a surface are exact, with one shadow ray each. Emitting surfaces are found in two ways, by rays aimed at them
//! and by rays of the cosine distribution over the hemisphere, which also gather what patches reflect and the light of the sky. The
//! rays come in [`REPLICATIONS`] sets, each of which is spread evenly ([`sir_lines::R2Sequence`]), and which are independent of each
//! other: their differences tell the error.

mod emitters;
mod gatherer;
mod measurement;
mod replication;
mod sensor;
mod stage;
mod tree;

pub use gatherer::{Gatherer, SENSOR_OFFSET};
pub use measurement::Measurement;
pub use sensor::{REPLICATIONS, Sensor, SensorSettings};
pub use stage::{SensorStage, SensorTask};
