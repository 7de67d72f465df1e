//! Dimensions that several parts of the cabin share \[m\].
//!
//! The aisle runs along `z` in the middle of the floor. Passengers look toward `−z`, where the galley is.

/// Radius of the round section of the side walls.
pub(super) const RADIUS: f64 = 1.84;
/// Height of the section's center above the floor.
pub(super) const CENTER: f64 = 1.0;
/// Distance between seat rows.
pub(super) const PITCH: f64 = 0.79;
/// Distance between windows: three windows per two seat rows.
pub(super) const WINDOW_PITCH: f64 = PITCH * 2.0 / 3.0;
/// Length of an overhead unit (a bin and the panels above and below it): three windows.
pub(super) const UNIT: f64 = 3.0 * WINDOW_PITCH;
/// Number of units per side.
pub(super) const UNITS: usize = 15;
/// Number of window pitches from the front wall to the front bulkhead.
pub(super) const BEFORE: usize = 4;
/// Number of window pitches from the rear bulkhead to the rear wall.
pub(super) const BEHIND: usize = 3;
/// Total number of window pitches.
pub(super) const CELLS: usize = BEFORE + 3 * UNITS + BEHIND;
/// Length of the cabin.
pub(super) const LENGTH: f64 = WINDOW_PITCH * CELLS as f64;
/// Position `z` at which the units begin.
pub(super) const FRONT: f64 = WINDOW_PITCH * BEFORE as f64;
/// Position `z` at which the units end.
pub(super) const REAR: f64 = FRONT + UNIT * UNITS as f64;
/// Number of seat rows.
pub(super) const ROWS: usize = 29;
/// Position `z` of the front edge of the first row's cushions.
pub(super) const FIRST_ROW: f64 = FRONT + 0.56;
/// Half the width of the aisle between arm rests.
pub(super) const AISLE: f64 = 0.25;

/// Heights of the grid lines on the side walls, up to the edge of the ceiling.
pub(super) const WALL_LINES: [f64; 9] = [0.0, 0.27, 0.53, 0.8, 1.12, 1.44, 1.64, 1.92, 2.19];
/// Indices in [`WALL_LINES`] of the lower edge, the middle and the upper edge of a window's cell.
pub(super) const WINDOW_LINES: [usize; 3] = [3, 4, 5];
/// Points (x, y) of the ceiling's section from its middle toward its right edge.
pub(super) const CEILING: [[f64; 2]; 6] =
    [[0.0, 2.3], [0.2, 2.297], [0.45, 2.288], [0.7, 2.272], [0.95, 2.25], [1.18, 2.222]];

/// Returns half the width of the cabin at a height.
///
/// The walls are flat between grid lines. They are also flat over the whole height of the window cells, because grazing
/// light would reveal every facet.
pub(super) fn half_width(y: f64) -> f64 {
    let [low, _, high] = WINDOW_LINES;
    let on_circle = |y: f64| (RADIUS * RADIUS - (y - CENTER) * (y - CENTER)).sqrt();
    let next = WALL_LINES.iter().position(|&line| y < line).unwrap_or(WALL_LINES.len() - 1);
    let (a, b) = if (low + 1..=high).contains(&next) { (low, high) } else { (next.max(1) - 1, next.max(1)) };
    let (a, b) = (WALL_LINES[a], WALL_LINES[b]);
    on_circle(a) + (y - a) / (b - a) * (on_circle(b) - on_circle(a))
}

/// Returns the height of the ceiling at a distance from its middle.
pub(super) fn ceiling(x: f64) -> f64 {
    let edge = WALL_LINES[WALL_LINES.len() - 1];
    let mut points = CEILING.to_vec();
    points.push([half_width(edge), edge]);
    points
        .windows(2)
        .find(|p| x.abs() <= p[1][0])
        .map_or(edge, |p| p[0][1] + (x.abs() - p[0][0]) / (p[1][0] - p[0][0]) * (p[1][1] - p[0][1]))
}

/// Returns true if a camera is close to the part of the cabin around `z` on one side (−1 is left). Parts there are
/// rounder.
pub(super) fn near(side: f64, z: f64) -> bool {
    let both = [FRONT..FRONT + 2.1, 15.2..18.2];
    let one = if side > 0.0 { 10.0..13.4 } else { 11.2..11.6 };
    both.iter().chain([&one]).any(|stretch| stretch.contains(&z))
}
