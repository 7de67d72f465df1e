//! Probes: a grid of points in a box at which irradiance is measured in all directions.

use glam::DVec3;

use crate::text::field::Format as _;
use crate::text::formats::{Vector, number, positive};
use crate::text::reader::{Fields, Reader};
use crate::text::record::record;

/// Share of backs above which a probe is invalid: a probe between a wall and a ground sees about a half.
const MAX_BACKS: f64 = 0.25;

record! {
    /// Points in a box, for objects that move through a scene.
    pub struct Probes, check Probes::check {
        /// Approximate distance of neighboring probes along each axis: the box is divided into whole cells, each with a
        /// probe in its center.
        pub spacing: f64 = positive(1.0).required().unit("m");
        /// Corner of the box with the smallest coordinates.
        pub min: Option<DVec3> = Vector([0.0; 3]).optional("that of the `Focus`, or of the scene").unit("m");
        /// Opposite corner.
        pub max: Option<DVec3> = Vector([5.0, 3.0, 4.0]).optional("that of the `Focus`, or of the scene").unit("m");
        /// Share of the surfaces in view that may show the backs of one-sided surfaces. A probe that sees more of them is
        /// invalid.
        pub backs: f64 = number(MAX_BACKS).with_range(|x| (0.0..=1.0).contains(&x), "from 0 to 1").or(MAX_BACKS);
    }
}

impl Probes {
    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        if let (Some(min), Some(max)) = (self.min, self.max)
            && !min.cmple(max).all()
        {
            let message = "`min` must not exceed `max` in any coordinate";
            let help = "give the corner with the smallest coordinates as `min`";
            reader.problem(fields.place, message, help);
        }
    }
}
