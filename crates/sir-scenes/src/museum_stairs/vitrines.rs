//! Open vitrines with vases under hidden lamps.

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{FOOT, SOUTH_EDGE};
use crate::museum_stairs::statues::amphora;

/// Returns all vitrines.
pub(super) fn vitrines(palette: &Palette) -> Model {
    let mut m = Model::default();
    let colors = [
        [palette.clay, palette.glaze],
        [palette.celadon, palette.gold],
        [palette.glaze, palette.clay],
        [palette.paints[0], palette.marble],
    ];
    let far = SOUTH_EDGE - 1.6;
    let places = [[-3.1, FOOT + 1.3], [4.05, FOOT + 1.3], [-4.05, far], [4.05, far]];
    for (colors, [x, z]) in colors.into_iter().zip(places) {
        m.add_at(&vitrine(palette, colors), x, GAP, z);
    }
    m
}

/// Returns a plinth with a cap on four posts, on the origin.
fn vitrine(palette: &Palette, [body, band]: [MaterialId; 2]) -> Model {
    let mut m = Model::default();
    let (half, plinth, clear) = (0.34, 0.92, 1.05);
    m.block([-half, 0.0, -half], [half, 0.10, half], 0.6, palette.dark_wood);
    m.block(
        [0.04 - half, 0.10 + GAP, 0.04 - half],
        [half - 0.04, plinth - 0.05, half - 0.04],
        0.6,
        palette.wood,
    );
    m.block([-half, plinth - 0.05 + GAP, -half], [half, plinth, half], 0.6, palette.dark_wood);
    let (low, high) = (plinth + GAP, plinth + clear);
    for x in [-1.0, 1.0] {
        for z in [-1.0, 1.0] {
            let (x, z) = (x * (half - 0.025), z * (half - 0.025));
            m.block([x - 0.014, low, z - 0.014], [x + 0.014, high - GAP, z + 0.014], 1.2, palette.gold);
        }
    }
    m.block([-half, high, -half], [half, high + 0.09, half], 0.6, palette.dark_wood);
    // Hipped roof: a solid of revolution with four sides.
    let roof = [[half * std::f64::consts::SQRT_2 - 0.02, 0.0], [0.12, 0.16], [0.09, 0.19]];
    let mut hipped = Model::default();
    hipped.lathe(&roof, 4, palette.bronze);
    let turn = DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_4);
    m.add(&hipped, DAffine3::from_translation(DVec3::new(0.0, high + 0.09 + GAP, 0.0)) * turn);
    // A rim hides the lamp.
    let rim = half - 0.06;
    let mut bar = |x: [f64; 2], z: [f64; 2]| {
        m.block([x[0], high - 0.05, z[0]], [x[1], high - GAP, z[1]], 0.8, palette.dark_wood);
    };
    for side in [-1.0, 1.0f64] {
        let (a, b) = (side * (rim - 0.02), side * rim);
        bar([a.min(b), a.max(b)], [-rim, rim]);
        bar([-rim + 0.02 + GAP, rim - 0.02 - GAP], [a.min(b), a.max(b)]);
    }
    let lamp = |d: DVec3, _| if d.y < 0.0 { palette.spot } else { palette.iron };
    m.grid_block([&[-0.11, 0.11], &[high - 0.03, high - GAP], &[-0.11, 0.11]], lamp);
    m.add_at(&amphora(body, band, 1.15), 0.0, plinth + GAP, 0.0);
    m
}
