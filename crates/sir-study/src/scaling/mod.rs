//! Speed-up by more threads and ranks: `sir scaling`.
//!
//! As in Martínez, Forés and Martín (2009), the speed-up `S(p) = T(1) / T(p)` and the efficiency `E(p) = S(p) / p` of
//! `p` workers are reported for the first shot, for multipath, and for the whole run.
//!
//! The program runs *itself* once per measurement and reads the report of the run. Warm memory or threads left by an
//! earlier run neither help nor hinder a later one, and ranks are started as usual. Since every run must give the same
//! result, bit by bit, a measurement is also a test: it fails if a result differs.
//!
//! * [`scaling`]: the whole measurement. [`Plan`]: the combinations of ranks and threads, and their order.
//! * [`measure`]: makes the runs by calling a function.
//! * [`Study`]: times, speed-ups and efficiencies, as [`text`], [`markdown`], [`csv`], [`json`] and [`svg`].

pub(crate) mod axis;
mod command;
pub(crate) mod error;
mod files;
pub(crate) mod launch;
pub(crate) mod legend;
pub(crate) mod measure;
mod options;
pub(crate) mod plot;
mod same;
mod series;
pub(crate) mod statistics;
pub(crate) mod study;
pub(crate) mod table;
pub(crate) mod workers;

pub use command::{Measured, scaling};
pub use error::ScalingError;
pub use files::{csv, json, write};
pub use measure::measure;
pub use options::{MPIRUN, ScalingOptions};
pub use plot::{svg, svg_beside};
pub use statistics::{Overhead, Part, Spread};
pub use study::{Row, Study, Timing, VERSION};
pub use table::{markdown, text};
pub use workers::{Plan, Workers};
