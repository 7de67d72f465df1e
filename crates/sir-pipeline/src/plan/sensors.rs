//! The stage `Sensors`: irradiance at points and on grids.

use std::ops::Range;
use std::path::PathBuf;

use glam::DVec3;
use sir_radiosity::{Sensor, SensorSettings};

/// Where irradiance is measured, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// Their table, in the run directory.
    pub table: PathBuf,
    /// Their picture in false colours, if they are on a grid.
    pub map: Option<PathBuf>,
    /// What they are called.
    pub name: String,
    /// Where they are.
    pub at: Place,
    /// How carefully is measured. Default: 16,384 rays, whatever the error.
    pub settings: SensorSettings,
    /// Bytes of the pipeline's text that say where they are.
    pub span: Range<usize>,
}

/// Where sensors are.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// At points that the pipeline or a file lists: at least one.
    Points(Vec<Sensor>),
    /// In the middle of the cells of a parallelogram.
    Grid(Grid),
    /// In the middle of the cells of a horizontal plane through a room.
    Plane(Plane),
}

/// A parallelogram, cut into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// One of its corners.
    pub corner: DVec3,
    /// The edge from there that is shown from left to right.
    pub along: DVec3,
    /// The edge from there that is shown from the bottom to the top.
    pub across: DVec3,
    /// About the distance of neighbouring sensors \[m\]: edges are cut into whole cells.
    pub spacing: f64,
    /// Where the sensors look. Default: the normal from which the picture is seen.
    pub direction: DVec3,
}

/// The work plane of a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Height above the lowest point of the scene \[m\].
    pub height: f64,
    /// About the distance of neighbouring sensors \[m\].
    pub spacing: f64,
    /// Distance that is kept from the outline of the scene \[m\]. Default 0.
    pub border: f64,
    /// Which way is up, where the sensors look. Default: what is up in the scene.
    pub up: Option<DVec3>,
}
