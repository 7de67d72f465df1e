//! Kind of irradiance that sensors measure.

use glam::DVec3;

use crate::text::field::Format as _;
use crate::text::formats::Direction;
use crate::text::record::{choice, record};

choice! {
    /// Kind of irradiance that sensors measure.
    pub enum Measure as "measure" {
        /// Irradiance of a plane.
        Planar,
        /// Mean irradiance of all planes through the up direction.
        Cylindrical,
        /// The same for the planes that face a half space.
        SemiCylindrical(SemiCylindrical),
    }
}

record! {
    /// Half cylinder around the up direction.
    pub struct SemiCylindrical {
        /// Direction that the half cylinder faces. Only its horizontal part counts.
        pub direction: Option<DVec3> = Direction([1.0, 0.0, 0.0]).optional("that of each sensor");
    }
}

impl Measure {
    /// Returns the adjective before *irradiance*, if there is one.
    #[must_use]
    pub fn adjective(&self) -> Option<&'static str> {
        match self {
            Self::Planar => None,
            Self::Cylindrical => Some("cylindrical"),
            Self::SemiCylindrical(_) => Some("semi-cylindrical"),
        }
    }
}
