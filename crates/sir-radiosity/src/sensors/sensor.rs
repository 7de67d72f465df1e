//! Points at which light is measured, and how carefully.

use glam::DVec3;

/// Independent sets of rays of a sensor.
pub const REPLICATIONS: u64 = 32;

/// A point, and the direction in which it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    position: DVec3,
    direction: DVec3,
}

/// How carefully is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSettings {
    /// Most rays of a sensor over its hemisphere, rounded up to a multiple of [`REPLICATIONS`]; as many are aimed at emitting
    /// surfaces, if there are any.
    pub rays: u64,
    /// Relative standard error of the luminance-weighted irradiance by the choice of rays at which fewer rays are enough; 0 for never.
    pub error: f64,
}

impl Sensor {
    /// A sensor at `position` that measures the irradiance of a surface with the normal `direction`, of any length.
    ///
    /// `None` if `direction` has no length, or a number is not finite.
    #[must_use]
    pub fn new(position: DVec3, direction: DVec3) -> Option<Self> {
        let direction = direction.try_normalize()?;
        position.is_finite().then_some(Self { position, direction })
    }

    /// Where it is.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Where it looks, of unit length.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }
}
