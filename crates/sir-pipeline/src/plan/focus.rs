//! The stage `Focus`.

use glam::DVec3;
use sir_geom::BoundingBox;

use crate::text::field::Format as _;
use crate::text::formats::{Vector, number};
use crate::text::reader::{Fields, Reader};
use crate::text::record::record;

/// Largest share: the rest of the scene must get lines, too.
const MAX_SHARE: f64 = 0.95;

record! {
    /// Box of interest, which gets a larger share of the lines.
    pub struct Focus, check Focus::check {
        /// Corner of the box with the smallest coordinates.
        pub min: DVec3 = Vector([0.0; 3]).required().unit("m");
        /// Opposite corner.
        pub max: DVec3 = Vector([5.0, 3.0, 4.0]).required().unit("m");
        /// Approximate share of the lines of `FirstShot` and `Multipath` that goes through the box, if that is more
        /// than without a focus. Lines in the box are at most 262,144 times as dense as elsewhere.
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
            let message = "`min` must not exceed `max` in any coordinate";
            let help = "give the corner with the smallest coordinates as `min`";
            reader.problem(fields.place, message, help);
        }
    }
}
