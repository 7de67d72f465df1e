//! Irradiance at points that need not be on a patch, by rays that start there.
//!
//! Lights without a surface are exact, with one shadow ray each. Emitting surfaces are sampled in two ways, by rays
//! aimed at them and by cosine-weighted rays over the hemisphere. The latter also gather the light that patches reflect
//! and the light of the sky. The rays form [`REPLICATIONS`] sets. Each set is low-discrepancy
//! ([`sir_lines::R2Sequence`]), and the sets are independent of each other, so that their spread gives the error.

mod gatherer;
mod measurement;
mod ray_set;
mod repeated;
mod replication;
mod response;
mod sensor;
mod stage;
mod start;
mod unmet;

pub(crate) use ray_set::{Gathering, RayLight, RaySet};
pub(crate) use repeated::Spread;
pub(crate) use unmet::{Brightness, Extremes, Squares};

pub use gatherer::Gatherer;
pub use measurement::Measurement;
pub use repeated::{RepeatedMeasurements, SpreadOfMean};
pub use sensor::{REPLICATIONS, Sensor, SensorSettings};
pub use stage::{SensorStage, SensorTask};
pub use start::SensorStart;
