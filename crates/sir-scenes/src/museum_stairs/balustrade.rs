//! Stone balustrades with turned balusters, level or sloping along a flight of steps.

use glam::{DAffine3, DVec3};

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::RAIL;

/// Maximum distance between balusters.
const PITCH: f64 = 0.315;
/// Length of the cells.
const CELL: f64 = 0.7;
/// Height of the plinth.
const PLINTH: f64 = 0.10;
/// Height of the handrail.
const HANDRAIL: f64 = 0.13;

/// Returns a balustrade from `from` to `to`.
///
/// If these differ in height, the balustrade is sheared: its balusters stay vertical, and plinth and handrail follow
/// the slope.
pub(super) fn between(palette: &Palette, from: DVec3, to: DVec3) -> Model {
    let span = to - from;
    let length = span.x.hypot(span.z);
    let along = span / length;
    let across = DVec3::new(along.x, 0.0, along.z).cross(DVec3::Y);
    let mut m = Model::default();
    m.add(&level(palette, length), DAffine3::from_cols(along, DVec3::Y, across, from));
    m
}

/// Returns a level balustrade along `x` from the origin.
fn level(palette: &Palette, length: f64) -> Model {
    let mut m = Model::default();
    m.block([GAP, GAP, -0.10], [length - GAP, PLINTH, 0.10], CELL, palette.pale);
    let mut rail = Model::default();
    let (low, high) = (RAIL - HANDRAIL, RAIL);
    let section = [
        [-0.08, low],
        [0.08, low],
        [0.11, low + 0.045],
        [0.115, low + 0.09],
        [0.06, high],
        [-0.06, high],
        [-0.115, low + 0.09],
        [-0.11, low + 0.045],
    ];
    rail.prism(&section, [GAP, length - GAP], CELL, palette.rosso);
    // The prism's z becomes x, and its x becomes −z.
    m.add(&rail, DAffine3::from_cols(-DVec3::Z, DVec3::Y, DVec3::X, DVec3::ZERO));

    let (foot, head) = (PLINTH + GAP, RAIL - HANDRAIL - GAP);
    let profile = [
        [0.072, 0.0],
        [0.072, 0.05],
        [0.042, 0.09],
        [0.082, 0.22],
        [0.074, 0.33],
        [0.036, 0.60],
        [0.050, 0.66],
        [0.070, 0.72],
        [0.070, head - foot],
    ]
    .map(|[r, y]| [r, foot + y]);
    let mut baluster = Model::default();
    baluster.lathe(&profile, 7, palette.pale);
    let margin = 0.12;
    for x in lines(margin, length - margin, PITCH) {
        m.add_at(&baluster, x, 0.0, 0.0);
    }
    m
}
