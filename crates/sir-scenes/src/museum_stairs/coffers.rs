//! The coffered ceiling with its skylight.

use glam::DVec3;

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{CELL, EDGE, HEIGHT, SOUTH_EDGE};

/// Distance between coffers: a coffer is two cells wide and a rib one.
const MODULE: f64 = 3.0 * CELL;
/// Width of a coffer.
const COFFER: f64 = 2.0 * CELL;
/// Width of the step in a coffer.
const STEP: f64 = 0.12;
/// Depth of a coffer up to its step.
const LOWER: f64 = 0.22;
/// Depths of a closed coffer and of a coffer with a pane.
const DEPTHS: [f64; 2] = [0.40, 0.62];

/// Returns, for each coffer, true if it has a pane, and the corner of its mouth with the smallest coordinates.
fn coffers() -> impl Iterator<Item = (bool, DVec3)> {
    let count = |length: f64| ((length - CELL) / MODULE).round() as usize;
    let (across, along) = (count(2.0 * EDGE), count(SOUTH_EDGE));
    (0..across * along).map(move |n| {
        let (i, j) = (n % across, n / across);
        let lit = (1..across - 1).contains(&i) && (2..along - 2).contains(&j);
        let corner = DVec3::new(-EDGE + CELL + MODULE * i as f64, HEIGHT, CELL + MODULE * j as f64);
        (lit, corner)
    })
}

/// Adds the ceiling of the middle to the shell, with fronts down.
pub(super) fn ceiling(m: &mut Model, palette: &Palette) {
    let (x, z) = (lines(-EDGE, EDGE, CELL), lines(0.0, SOUTH_EDGE, CELL));
    for i in 0..x.len() - 1 {
        for j in 0..z.len() - 1 {
            if i % 3 == 0 || j % 3 == 0 {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                m.polygon(&corners.map(|(i, j)| DVec3::new(x[i], HEIGHT, z[j])), palette.plaster);
            }
        }
    }
    for (lit, corner) in coffers() {
        coffer(m, palette, corner, lit);
    }
}

/// Adds a coffer: sides, a step, sides and a bottom.
fn coffer(m: &mut Model, palette: &Palette, corner: DVec3, lit: bool) {
    let depth = DEPTHS[usize::from(lit)];
    let ring = |inset: f64, up: f64| {
        let (a, b) = (inset, COFFER - inset);
        [[a, a], [b, a], [b, b], [a, b]].map(|[x, z]| corner + DVec3::new(x, up, z))
    };
    let [mouth, ledge, inner, bottom] =
        [ring(0.0, 0.0), ring(0.0, LOWER), ring(STEP, LOWER), ring(STEP, depth)];
    for k in 0..4 {
        let l = (k + 1) % 4;
        // Each side of the mouth has a vertex of the ribs in its middle.
        let middle = 0.5 * (mouth[k] + mouth[l]);
        m.polygon(&[ledge[k], mouth[k], middle, mouth[l], ledge[l]], palette.plaster);
        m.polygon(&[inner[k], ledge[k], ledge[l], inner[l]], palette.gold);
        m.polygon(&[bottom[k], inner[k], inner[l], bottom[l]], palette.plaster);
    }
    m.polygon(&bottom, if lit { palette.sky } else { palette.coffer });
}

/// Returns bars under the panes, and rosettes in the other coffers.
pub(super) fn fittings(palette: &Palette) -> Model {
    let mut m = Model::default();
    let mut rosette = Model::default();
    let petals = 4;
    // (radius, distance below the bottom), from the lowest point up.
    let profile = [[0.05, 0.105], [0.20, 0.065], [0.22, 0.04], [0.16, 0.012]];
    rosette.loft(
        profile.len(),
        2 * petals,
        |i, j| {
            let [radius, below] = profile[i];
            let r = if i >= 1 && j % 2 == 1 { 0.72 * radius } else { radius };
            let (sin, cos) = (std::f64::consts::PI * j as f64 / petals as f64).sin_cos();
            DVec3::new(r * cos, -below, -r * sin)
        },
        |_, _| palette.gold,
    );
    let (half, reach) = (0.5 * COFFER, 0.5 * COFFER - STEP - GAP);
    for (lit, corner) in coffers() {
        let [x, z] = [corner.x + half, corner.z + half];
        if lit {
            let (thin, low) = (0.016, HEIGHT + LOWER + 0.12);
            let middle = low + 2.0 * thin;
            m.block([x - reach, low, z - thin], [x + reach, middle - GAP, z + thin], 1.0, palette.iron);
            m.block(
                [x - thin, middle, z - reach],
                [x + thin, middle + 2.0 * thin, z + reach],
                1.0,
                palette.iron,
            );
        } else {
            m.add_at(&rosette, x, HEIGHT + DEPTHS[0], z);
        }
    }
    m
}
