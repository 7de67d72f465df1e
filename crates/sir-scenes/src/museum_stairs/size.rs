//! Dimensions that several parts of the hall share \[m\].
//!
//! The middle of the floor is `x = 0`. The stair leads to the wall at `z = 0`, and the entrance is at the opposite
//! wall.

/// Width of the cells of large surfaces.
pub(super) const CELL: f64 = 0.5;
/// Half the width of the hall.
pub(super) const HALF_WIDTH: f64 = 8.0;
/// Length of the hall.
pub(super) const LENGTH: f64 = 21.0;
/// Depth of the gallery, and of the stair's landing.
pub(super) const SIDE: f64 = 2.5;
/// Distance of the gallery's edge from the middle.
pub(super) const EDGE: f64 = HALF_WIDTH - SIDE;
/// Position `z` of the edge of the gallery over the entrance.
pub(super) const SOUTH_EDGE: f64 = LENGTH - SIDE;

/// Height of the gallery's floor: 32 risers.
pub(super) const GALLERY: f64 = 5.12;
/// Underside of the gallery.
pub(super) const UNDER_GALLERY: f64 = 4.7;
/// Height of the ceiling over the gallery.
pub(super) const AISLE: f64 = 10.5;
/// Height of the coffered ceiling.
pub(super) const HEIGHT: f64 = 13.0;

/// Height of a step.
pub(super) const RISER: f64 = 0.16;
/// Depth of a step.
pub(super) const TREAD: f64 = 0.30;
/// Height of the landing: 19 risers.
pub(super) const LANDING: f64 = 19.0 * RISER;
/// Half the width of the central flight. The side flights lead from here to the edge of the gallery in 12 treads.
pub(super) const FLIGHT: f64 = EDGE - 12.0 * TREAD;
/// Position `z` of the foot of the central flight.
pub(super) const FOOT: f64 = SIDE + 18.0 * TREAD;
/// Width of the parapets on which the balustrades of the stair stand.
pub(super) const PARAPET: f64 = 0.35;

/// Distance of the columns' axes behind the edge of the gallery.
pub(super) const COLUMN: f64 = 0.25;
/// Distance between columns along the sides.
pub(super) const BAY: f64 = 3.0;
/// Number of columns on each side, including the one at the corner.
pub(super) const COLUMNS: usize = 6;
/// Distance of the columns over the entrance from the middle.
pub(super) const DOOR_COLUMN: f64 = 1.9;
/// Height of the balustrades.
pub(super) const RAIL: f64 = 1.0;
/// Underside of the beams on the lower columns.
pub(super) const LOWER_BEAM: f64 = 4.2;
/// Underside of the beams on the upper columns.
pub(super) const UPPER_BEAM: f64 = 9.95;

/// Returns the positions `z` of the side columns, from the entrance to the stair.
pub(super) fn column_places() -> impl Iterator<Item = f64> {
    (0..COLUMNS).map(|i| SOUTH_EDGE + COLUMN - BAY * i as f64)
}

/// Returns the positions `z` of the middles of the bays between the side columns.
pub(super) fn bay_middles() -> impl Iterator<Item = f64> {
    column_places().take(COLUMNS - 1).map(|z| z - 0.5 * BAY)
}
