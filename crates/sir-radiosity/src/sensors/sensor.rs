//! Sensors and the settings of their measurement.

use glam::DVec3;

use crate::sensors::response::Response;

/// Number of independent sets of rays per sensor.
pub const REPLICATIONS: u64 = 32;

/// A point at which irradiance is measured, with the direction in which the sensor looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    position: DVec3,
    response: Response,
}

/// Settings of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSettings {
    /// Largest number of rays of a sensor over each of its hemispheres, rounded up to a multiple of the number of replications. The
    /// same number is aimed at emitting surfaces, if there are any.
    pub rays: u64,
    /// Relative sampling error of the luminance-weighted irradiance at which a sensor stops early; 0 for never.
    pub error: f64,
    /// Number of independent sets of rays, at least 2 and at most [`REPLICATIONS`].
    pub replications: u64,
    /// Rays of all replications before the first check of the error.
    pub first: u64,
}

/// Rays of all replications and repeats before the first check of the error.
const FIRST: u64 = 2048;

/// Replications of each of several repeats, if sensors stop early.
const REPLICATIONS_TO_STOP: u64 = 8;

impl SensorSettings {
    /// Returns the settings for this number of rays and this relative error.
    #[must_use]
    pub const fn new(rays: u64, error: f64) -> Self {
        Self { rays, error, replications: REPLICATIONS, first: FIRST }
    }

    /// Returns the settings for one of several repeats, which share the rays. The mean of their measurements has about
    /// the error of a single one with all rays.
    #[must_use]
    pub fn shared(self, repeats: u64) -> Self {
        if repeats <= 1 {
            return self;
        }
        let stops = self.error > 0.0;
        let replications = if stops { REPLICATIONS_TO_STOP } else { (REPLICATIONS / repeats).max(2) };
        Self {
            rays: self.rays.div_ceil(repeats),
            error: self.error * (repeats as f64).sqrt(),
            replications,
            first: FIRST.div_ceil(repeats),
        }
    }
}

impl Sensor {
    /// Returns a sensor at `position` that measures the irradiance of a surface with the normal `direction`, of any
    /// length.
    ///
    /// Returns `None` if `direction` has no length, or a number is not finite.
    #[must_use]
    pub fn new(position: DVec3, direction: DVec3) -> Option<Self> {
        let normal = direction.try_normalize()?;
        Self::of(position, Response::Planar { normal })
    }

    /// Returns a sensor at `position` that measures the mean irradiance of the lateral surface of a small cylinder around
    /// `axis`, of any length: for an upright one the *cylindrical illuminance* of EN 12665, the mean of all vertical
    /// illuminances, `E_z = (1/π) ∫ L sin ε dω` for the angle `ε` to the axis.
    ///
    /// Returns `None` if `axis` has no length, or a number is not finite.
    #[must_use]
    pub fn cylindrical(position: DVec3, axis: DVec3) -> Option<Self> {
        let axis = axis.try_normalize()?;
        Self::of(position, Response::Cylindrical { axis })
    }

    /// Returns a sensor at `position` that measures the mean irradiance of the curved surface of a small half cylinder
    /// around `axis`, which faces `direction`: for an upright one the *semi-cylindrical illuminance* of EN 13201-3, `E_sc =
    /// (1/π) ∫ L sin ε (1 + cos α) dω` for the angle `α` of the light to `direction` across the axis. Only the part of
    /// `direction` across the axis counts.
    ///
    /// Returns `None` if `axis` and `direction` are parallel or without length, or a number is not finite.
    #[must_use]
    pub fn semi_cylindrical(position: DVec3, axis: DVec3, direction: DVec3) -> Option<Self> {
        let (axis, direction) = (axis.try_normalize()?, direction.try_normalize()?);
        let across = direction.reject_from_normalized(axis);
        // Nearly parallel vectors have a difference of rounding errors.
        let direction = across.try_normalize().filter(|_| across.length() > 1e-6)?;
        Self::of(position, Response::SemiCylindrical { axis, direction })
    }

    fn of(position: DVec3, response: Response) -> Option<Self> {
        position.is_finite().then_some(Self { position, response })
    }

    /// Returns the position.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Returns the direction in which the sensor looks, a unit vector; for a cylinder, its axis.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.response.direction()
    }

    /// Returns the number of hemispheres over which the sensor has rays: four for cylinders, otherwise one.
    #[must_use]
    pub fn hemispheres(&self) -> u64 {
        self.response.facet_count()
    }

    /// Returns the weight of light by direction.
    pub(super) fn response(&self) -> Response {
        self.response
    }
}
