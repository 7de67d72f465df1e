//! Dais with steps and balustrade, the globe on it, and the niche behind it.

use glam::DVec3;

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::reading_room::palette::Palette;
use crate::reading_room::size::{DAIS, DAIS_DEPTH, HALF_WIDTH, OPENING, TILE};

/// Half the width of the steps \[m\].
const STEPS: f64 = 1.5;

/// Returns the dais with its steps and balustrade.
pub(super) fn dais(palette: &Palette) -> Model {
    let mut m = Model::default();
    let x = lines(-HALF_WIDTH + GAP, HALF_WIDTH - GAP, TILE);
    let z = lines(GAP, DAIS_DEPTH, TILE);
    let face = |d: DVec3, _| if d.y > 0.0 { palette.oak } else { palette.stone };
    m.grid_block([&x, &[GAP, DAIS], &z], face);

    let rise = 0.25 * DAIS;
    for step in 1..4 {
        let front = DAIS_DEPTH + 0.3 * f64::from(4 - step);
        let height = rise * f64::from(step);
        m.block([-STEPS, GAP, front - 0.3 + GAP], [STEPS, height, front], TILE, palette.stone);
    }
    for side in [-1.0, 1.0] {
        let inner = side * (STEPS + 0.12);
        let outer = side * (HALF_WIDTH - 0.13);
        balustrade(&mut m, palette, [inner.min(outer), inner.max(outer)]);
    }
    m
}

/// Adds a balustrade along the front of the dais, with posts at `from` and `to`.
fn balustrade(m: &mut Model, palette: &Palette, [from, to]: [f64; 2]) {
    let z = DAIS_DEPTH - 0.15;
    let floor = DAIS + GAP;
    for x in [from, to] {
        m.block([x - 0.1, floor, z - 0.1], [x + 0.1, floor + 0.95, z + 0.1], TILE, palette.stone);
        m.block(
            [x - 0.12, floor + 0.95 + GAP, z - 0.12],
            [x + 0.12, floor + 1.0, z + 0.12],
            TILE,
            palette.stone,
        );
    }
    let (left, right) = (from + 0.1 + GAP, to - 0.1 - GAP);
    m.block([left, floor, z - 0.07], [right, floor + 0.08, z + 0.07], TILE, palette.stone);
    m.block([left, floor + 0.80, z - 0.08], [right, floor + 0.90, z + 0.08], TILE, palette.stone);
    let mut baluster = Model::default();
    let profile = [
        [0.055, 0.0],
        [0.055, 0.05],
        [0.030, 0.08],
        [0.060, 0.20],
        [0.028, 0.45],
        [0.038, 0.62],
        [0.055, 0.66],
        [0.055, 0.72 - 2.0 * GAP],
    ];
    baluster.lathe(&profile, 8, palette.stone);
    for x in lines(left + 0.13, right - 0.13, 0.21) {
        m.add_at(&baluster, x, floor + 0.08 + GAP, z);
    }
}

/// Returns a frame around the niche that hides two lamps behind its edges, and an urn in the niche.
pub(super) fn niche(palette: &Palette) -> Model {
    let mut m = Model::default();
    let edge = OPENING.radius;
    for side in [-1.0, 1.0] {
        let mut post = |near: f64, far: f64, low: f64, high: f64, front: f64, back: f64, material| {
            let (a, b) = (side * near, side * far);
            m.block([a.min(b), low, back], [a.max(b), high, front], TILE, material);
        };
        post(edge - 0.10, edge + 0.16, DAIS + GAP, OPENING.spring, 0.10, GAP, palette.stone);
        post(edge - 0.14, edge + 0.20, OPENING.spring + GAP, OPENING.spring + 0.1, 0.14, GAP, palette.stone);
        post(
            edge - 0.06,
            edge - 0.02,
            OPENING.sill + 0.1,
            OPENING.spring - 0.1,
            -0.04,
            -0.08,
            palette.niche_lamp,
        );
    }
    let mut urn = Model::default();
    urn.block([-0.22, 0.0, -0.22], [0.22, 0.45, 0.22], TILE, palette.stone);
    let profile = [
        [0.11, 0.0],
        [0.12, 0.03],
        [0.06, 0.08],
        [0.05, 0.12],
        [0.13, 0.22],
        [0.21, 0.38],
        [0.23, 0.50],
        [0.20, 0.62],
        [0.11, 0.72],
        [0.09, 0.80],
        [0.14, 0.88],
        [0.15, 0.90],
    ];
    let mut vase = Model::default();
    vase.lathe(&profile, 24, palette.urn);
    urn.add_at(&vase, 0.0, 0.45 + GAP, 0.0);
    m.add_at(&urn, 0.0, OPENING.sill + GAP, -0.45);
    m
}

/// Returns a terrestrial globe on a turned stand, on the origin.
pub(super) fn globe(palette: &Palette) -> Model {
    let mut m = Model::default();
    let stand = [
        [0.24, 0.0],
        [0.24, 0.03],
        [0.10, 0.07],
        [0.04, 0.14],
        [0.06, 0.24],
        [0.035, 0.34],
        [0.05, 0.44],
        [0.05, 0.50],
    ];
    m.lathe(&stand, 14, palette.walnut);
    let (radius, center) = (0.32, 0.83);
    let arc: Vec<[f64; 2]> = (0..=12)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / 12.0).sin_cos();
            [if i % 12 == 0 { 0.0 } else { radius * sin }, center - radius * cos]
        })
        .collect();
    m.lathe(&arc, 20, palette.sea);
    let ring =
        [[0.40, center - 0.015], [0.40, center + 0.015], [0.34, center + 0.015], [0.34, center - 0.015]];
    m.turned_ring(&ring, 20, |_| palette.brass);
    m
}
