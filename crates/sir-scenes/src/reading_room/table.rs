//! Tables, chairs and reading lamps.

use glam::DVec3;

use crate::model::{GAP, Model};
use crate::reading_room::palette::Palette;

/// Height of the table tops \[m\].
pub(super) const TABLE_HEIGHT: f64 = 0.77;

/// Returns a long table about the origin: 1.0 m along `x`, 2.4 m along `z`, on turned legs, with a leather top.
pub(super) fn table(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (x, z) = (0.5, 1.2);
    let under = TABLE_HEIGHT - 0.045;
    let top = |d: DVec3, p: DVec3| {
        let inside = p.x.abs() < x - 0.08 && p.z.abs() < z - 0.08;
        if d.y > 0.0 && inside { palette.leather } else { palette.oak }
    };
    m.grid_block(
        [
            &[-x, -x + 0.08, 0.0, x - 0.08, x],
            &[under, TABLE_HEIGHT],
            &[-z, -z + 0.08, -0.56, 0.0, 0.56, z - 0.08, z],
        ],
        top,
    );
    let (ax, az, low) = (x - 0.08, z - 0.1, under - 0.11);
    for side in [-1.0, 1.0] {
        let cx = side * ax;
        m.block([cx - 0.012, low, -az + 0.05], [cx + 0.012, under - GAP, az - 0.05], 0.6, palette.oak);
        let cz = side * az;
        m.block([-ax + 0.05, low, cz - 0.012], [ax - 0.05, under - GAP, cz + 0.012], 0.6, palette.oak);
        for end in [-1.0, 1.0] {
            let mut leg = Model::default();
            leg.block([-0.04, 0.5, -0.04], [0.04, under - GAP, 0.04], 1.0, palette.oak);
            let profile = [
                [0.022, 0.0],
                [0.030, 0.03],
                [0.020, 0.07],
                [0.024, 0.20],
                [0.036, 0.36],
                [0.030, 0.42],
                [0.040, 0.45],
                [0.034, 0.5 - GAP],
            ];
            leg.lathe(&profile, 8, palette.oak);
            m.add_at(&leg, cx, 0.0, end * az);
        }
    }
    m
}

/// Returns a chair on the origin that faces `−z`.
pub(super) fn chair(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (wood, w) = (palette.walnut, 0.215);
    m.block([-w, 0.425, -0.21], [w, 0.455, 0.21], 1.0, wood);
    m.block([-w + 0.015, 0.455 + GAP, -0.195], [w - 0.015, 0.475, 0.18], 1.0, palette.seat);
    for side in [-1.0, 1.0] {
        let x = side * (w - 0.018);
        m.block([x - 0.018, 0.0, -0.205], [x + 0.018, 0.425 - GAP, -0.169], 1.0, wood);
        m.block([x - 0.016, 0.0, 0.212], [x + 0.016, 0.93, 0.244], 1.0, wood);
        m.block([x - 0.01, 0.16, -0.169 + GAP], [x + 0.01, 0.185, 0.212 - GAP], 1.0, wood);
    }
    let inner = w - 0.034 - GAP;
    for (low, high) in [(0.56, 0.60), (0.67, 0.71)] {
        m.block([-inner, low, 0.218], [inner, high, 0.236], 1.0, wood);
    }
    m.block([-inner, 0.78, 0.216], [inner, 0.91, 0.238], 1.0, palette.seat);
    m
}

/// Returns a reading lamp on the origin, with a brass foot, a green shade with a pale lining, and a bulb under the
/// shade.
pub(super) fn reading_lamp(palette: &Palette) -> Model {
    let mut m = Model::default();
    let foot = [
        [0.085, 0.0],
        [0.085, 0.012],
        [0.060, 0.025],
        [0.018, 0.04],
        [0.012, 0.06],
        [0.018, 0.10],
        [0.011, 0.14],
        [0.011, 0.29],
    ];
    m.lathe(&foot, 10, palette.brass);
    let bulb = [[0.016, 0.292], [0.032, 0.315], [0.032, 0.335], [0.016, 0.36]];
    m.lathe(&bulb, 8, palette.bulb);
    let outside = [[0.172, 0.285], [0.165, 0.325], [0.120, 0.38], [0.03, 0.415]];
    let inside = [[0.028, 0.409], [0.116, 0.374], [0.159, 0.322], [0.166, 0.285]];
    let profile: Vec<_> = outside.into_iter().chain(inside).collect();
    m.turned_ring(&profile, 14, |i| match i {
        0..=2 => palette.lamp_shade,
        3 | 7 => palette.brass,
        _ => palette.shade_lining,
    });
    m
}
