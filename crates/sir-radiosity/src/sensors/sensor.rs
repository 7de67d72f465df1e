//! Sensors and the settings of their measurement.

use glam::DVec3;

/// Number of independent sets of rays per sensor.
pub const REPLICATIONS: u64 = 32;

/// A point at which irradiance is measured, with the direction in which the sensor looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    position: DVec3,
    direction: DVec3,
}

/// Settings of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSettings {
    /// Largest number of rays of a sensor over its hemisphere, rounded up to a multiple of [`REPLICATIONS`]. The same
    /// number is aimed at emitting surfaces, if there are any.
    pub rays: u64,
    /// Relative sampling error of the luminance-weighted irradiance at which a sensor stops early; 0 for never.
    pub error: f64,
}

impl Sensor {
    /// Returns a sensor at `position` that measures the irradiance of a surface with the normal `direction`, of any
    /// length.
    ///
    /// Returns `None` if `direction` has no length, or a number is not finite.
    #[must_use]
    pub fn new(position: DVec3, direction: DVec3) -> Option<Self> {
        let direction = direction.try_normalize()?;
        position.is_finite().then_some(Self { position, direction })
    }

    /// Returns the position.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Returns the direction in which the sensor looks, a unit vector.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }
}
