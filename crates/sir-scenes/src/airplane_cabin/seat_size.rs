//! Dimensions that the parts of a seat share \[m\].

use glam::DVec3;

/// Distance between the centers of adjacent seats \[m\].
pub(super) const PLACE: f64 = 0.475;
/// Width of an arm rest \[m\].
pub(super) const ARM: f64 = 0.042;
/// Half the width of a backrest \[m\].
pub(super) const HALF_BACK: f64 = 0.5 * (PLACE - ARM) - 0.006;
/// Half the width of a group, including the arm rests at its ends \[m\].
pub(super) const HALF_GROUP: f64 = 1.5 * PLACE + 0.5 * ARM;
/// Point on the axis about which backrests recline, in the coordinates of a seat \[m\].
pub(super) const PIVOT: DVec3 = DVec3::new(0.48, 0.42, 0.0);
