//! How much faster more workers are: `sir scaling`.
//!
//! As Martínez, Forés and Martín (2009) do, the speed-up `S(p) = T(1) / T(p)` and the efficiency
//! `E(p) = S(p) / p` of `p` workers are reported for the first shot, for multipath, and for the whole run.
//!
//! The program runs *itself*, once per measurement, and reads the report of the run: memory that an earlier
//! run left warm, or threads that it left behind, cannot help or hinder a later one, and ranks are started as
//! they always are. As every run makes the same result, bit by bit, a measurement is a test, too: it fails if
//! one does not.
//!
//! * [`scaling`]: the whole of it. [`Plan`]: which combinations of ranks and threads, and in which order.
//! * [`measure`]: makes the runs, by a function that is given to it.
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
