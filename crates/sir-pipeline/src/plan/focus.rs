//! The stage `Focus`.

use glam::DVec3;
use sir_geom::BoundingBox;

use crate::text::field::Format as _;
use crate::text::formats::{Vector, number};
use crate::text::reader::{Fields, Reader};
use crate::text::record::record;

/// The largest share: what is not in the focus must get lines, too.
const MAX_SHARE: f64 = 0.95;

record! {
    /// Says which part of the scene matters.
    pub struct Focus, check Focus::check {
        /// The corner of the box with the smallest coordinates.
        pub min: DVec3 = Vector([0.0; 3]).required().unit("m");
        /// The opposite corner.
        pub max: DVec3 = Vector([5.0, 3.0, 4.0]).required().unit("m");
        /// About this share of the lines of `FirstShot` and of `Multipath` goes through the box, if it is more than without. Lines
        /// in the box are at most 4,096 times as dense as elsewhere.
        pub share: f64 = number(0.75).with_range(|x| (0.0..=MAX_SHARE).contains(&x), "from 0 to 0.95").or(0.75);
    }
}

impl Focus {
    /// Returns the box.
    #[must_use]
    pub fn bounds(&self) -> BoundingBox {
        BoundingBox { min: self.min, max: self.max }
    }

    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        if !self.min.cmple(self.max).all() {
            let message = "`min` must not be larger than `max` in any coordinate";
            let help = "give the corner with the smallest coordinates as `min`";
            reader.problem(fields.place, message, help);
        }
    }
}
