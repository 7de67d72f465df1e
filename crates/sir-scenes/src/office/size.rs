//! Dimensions that several parts of the office share \[m\].
//!
//! The windows are in the wall `z = 0`. The floor is `y = 0`, and the left wall, with the door, is `x = 0`.

/// Length of the room along the windows.
pub(super) const LENGTH: f64 = 12.6;
/// Depth of the room.
pub(super) const DEPTH: f64 = 8.4;
/// Height of the suspended ceiling.
pub(super) const HEIGHT: f64 = 2.8;
/// Side of a tile of the ceiling and of the recessed luminaires.
pub(super) const TILE: f64 = 0.6;
/// Thickness of the outer walls.
pub(super) const WALL: f64 = 0.4;

/// Number of windows.
pub(super) const WINDOWS: usize = 4;
/// Distance of the windows from each other.
pub(super) const WINDOW_PITCH: f64 = LENGTH / WINDOWS as f64;
/// Width of a window.
pub(super) const WINDOW_WIDTH: f64 = 2.4;
/// Height of the sill of the windows.
pub(super) const SILL: f64 = 0.85;
/// Height of the lintel of the windows.
pub(super) const LINTEL: f64 = 2.45;

/// Height of the ground outside.
pub(super) const GROUND: f64 = -4.0;

/// Height of the desks.
pub(super) const DESK: f64 = 0.735;

/// Positions of the recessed luminaires along `x`, and of the downlights.
pub(super) const COLUMNS: [f64; 5] = [1.5, 3.9, 6.3, 8.7, 11.1];
/// Positions of the recessed luminaires along `z`.
pub(super) const ROWS: [f64; 3] = [1.5, 3.9, 6.3];
/// Position of the downlights along `z`.
pub(super) const DOWNLIGHTS: f64 = 7.5;

/// Returns the left and right end of a window.
pub(super) fn window(index: usize) -> [f64; 2] {
    let center = (index as f64 + 0.5) * WINDOW_PITCH;
    [center - 0.5 * WINDOW_WIDTH, center + 0.5 * WINDOW_WIDTH]
}
