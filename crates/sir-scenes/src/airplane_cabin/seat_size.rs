//! Dimensions that the parts of a seat share \[m\].

use glam::DVec3;

/// Distance of seats side by side \[m\].
pub(super) const PLACE: f64 = 0.475;
/// Width of an arm rest \[m\].
pub(super) const ARM: f64 = 0.042;
/// Half the width of a backrest \[m\].
pub(super) const HALF_BACK: f64 = 0.5 * (PLACE - ARM) - 0.006;
/// Half the width of a group, with the arm rests at its ends \[m\].
pub(super) const HALF_GROUP: f64 = 1.5 * PLACE + 0.5 * ARM;
/// Axis about which backs recline, in the coordinates of a seat.
pub(super) const PIVOT: DVec3 = DVec3::new(0.48, 0.42, 0.0);
