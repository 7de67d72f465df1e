//! Measurements of a stage `Sensors` in all repeats.

use sir_radiosity::{RepeatedMeasurements, RepeatedProbes, Visitor};

use crate::prepare::layout::Placed;

/// Measurements at the sensors or probes of a stage in all repeats so far.
pub(super) enum Measured {
    Sensors(RepeatedMeasurements),
    Probes(RepeatedProbes),
}

impl Measured {
    /// Returns the sums over no repeats.
    pub(super) fn new(placed: &Placed) -> Self {
        match placed {
            Placed::Sensors(layout) => Self::Sensors(RepeatedMeasurements::new(layout.sensors.len())),
            Placed::Probes(grid) => Self::Probes(RepeatedProbes::new(grid.valid.len())),
        }
    }

    /// Visits the sums.
    pub(super) fn visit(&mut self, visitor: &mut dyn Visitor) {
        match self {
            Self::Sensors(measured) => measured.visit(visitor),
            Self::Probes(measured) => measured.visit(visitor),
        }
    }
}
