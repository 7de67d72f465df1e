//! Bulkheads at both ends of the seat rows, each with a doorway and curtains; the front one has screens.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::size::{FRONT, REAR, WALL_LINES, ceiling, half_width};
use crate::model::pillow::Ends;
use crate::model::sheet::lines;
use crate::model::{GAP, Model};

/// Half the width of a doorway \[m\].
pub(super) const DOORWAY: f64 = 0.33;
/// Height of a doorway \[m\].
const HEIGHT: f64 = 2.0;
/// Distance of the bulkheads from the shell \[m\]. The facets of the shell lie slightly inside its round section.
const CLEAR: f64 = 0.006;
const THICK: f64 = 0.04;

/// Returns both bulkheads with their screens and curtains.
pub(super) fn bulkheads(palette: &Palette) -> Model {
    let mut m = Model::default();
    let z = FRONT - 0.03;
    bulkhead(&mut m, palette, [z - THICK, z]);
    for side in [-1.0, 1.0] {
        screen(&mut m, palette, [side * 0.94, 1.27, z + GAP]);
    }
    m.add_at(&curtain(palette, 0.20), -DOORWAY + 0.012, 0.012, z - THICK - 0.08);
    let z = REAR + 0.03;
    bulkhead(&mut m, palette, [z, z + THICK]);
    m.add_at(&curtain(palette, 0.26), -DOORWAY + 0.012, 0.012, z + THICK + 0.08);
    m.add_at(&curtain(palette, 0.26), DOORWAY - 0.272, 0.012, z + THICK + 0.08);
    m
}

fn bulkhead(m: &mut Model, palette: &Palette, z: [f64; 2]) {
    let columns = lines(DOORWAY, half_width(1.0), 0.28).len();
    let row = |from: f64, to: f64, y: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let x = (0..columns).map(|i| from + (to - from) * i as f64 / (columns - 1) as f64);
        x.map(|x| [x, y(x)]).collect()
    };
    let mut rows: Vec<Vec<[f64; 2]>> = WALL_LINES[..WALL_LINES.len() - 1]
        .iter()
        .map(|&y| row(DOORWAY, half_width(y) - CLEAR, &|_| y.max(GAP)))
        .collect();
    let edge = half_width(WALL_LINES[WALL_LINES.len() - 1]) - 0.05;
    rows.push(row(DOORWAY, edge, &|x| ceiling(x) - CLEAR));
    plate(m, &rows, z, palette.bulkhead);
    let mirrored: Vec<Vec<[f64; 2]>> =
        rows.iter().map(|r| r.iter().rev().map(|[x, y]| [-x, *y]).collect()).collect();
    plate(m, &mirrored, z, palette.bulkhead);

    let lintel = DOORWAY - GAP;
    let x = lines(-lintel, lintel, 0.17);
    let rows = [HEIGHT, 2.14].map(|y| x.iter().map(|&x| [x, y]).collect::<Vec<_>>());
    let top = x.iter().map(|&x| [x, ceiling(x) - CLEAR]).collect();
    let [low, middle] = rows;
    plate(m, &[low, middle, top], z, palette.bulkhead);
}

/// Adds a plate between two positions `z`. `rows` are ordered from bottom to top; each has the same number of points
/// from left to right.
fn plate(m: &mut Model, rows: &[Vec<[f64; 2]>], [near, far]: [f64; 2], material: MaterialId) {
    let (height, width) = (rows.len() - 1, rows[0].len() - 1);
    let at = |i: usize, j: usize, z: f64| DVec3::new(rows[j][i][0], rows[j][i][1], z);
    m.sheet([width, height], |i, j| at(i, j, far), |_, _| material);
    m.sheet([width, height], |i, j| at(width - i, j, near), |_, _| material);
    let mut around: Vec<(usize, usize)> = (0..width).map(|i| (i, 0)).collect();
    around.extend((0..height).map(|j| (width, j)));
    around.extend((1..=width).rev().map(|i| (i, height)));
    around.extend((0..=height).rev().map(|j| (0, j)));
    let edge = |i: usize, j: usize| at(around[i].0, around[i].1, [near, far][j]);
    m.sheet([around.len() - 1, 1], edge, |_, _| material);
}

/// Adds a screen that shows a map with the route. The point is the middle of its lower edge.
fn screen(m: &mut Model, palette: &Palette, [x, y, z]: [f64; 3]) {
    let (half, frame) = (0.27, 0.025);
    let mut columns = vec![-half - frame];
    columns.extend(lines(-half, half, 0.09));
    columns.push(half + frame);
    let mut rows = vec![-frame];
    rows.extend(lines(0.0, 0.36, 0.09));
    rows.push(0.36 + frame);
    let columns: Vec<f64> = columns.iter().map(|c| x + c).collect();
    let rows: Vec<f64> = rows.iter().map(|r| y + r).collect();
    let [sea, land, route] = palette.screens;
    m.grid_block([&columns, &rows, &[z, z + 0.03]], |d, p| {
        let (u, v) = ((p.x - x + half) / 0.09, (p.y - y) / 0.09);
        let inside = (0.0..6.0).contains(&u) && (0.0..4.0).contains(&v);
        if d.z <= 0.0 || !inside {
            return palette.dark;
        }
        let (u, v) = (u as usize, v as usize);
        // Range of land columns in each row of the map, from the bottom up.
        let coast = [[0, 2], [0, 1], [3, 5], [4, 6]][v];
        if u == [1, 2, 3, 4][v] {
            route
        } else if (coast[0]..coast[1]).contains(&u) {
            land
        } else {
            sea
        }
    });
}

/// Returns a curtain of the given width that hangs in folds, with its lower left end on the origin.
fn curtain(palette: &Palette, width: f64) -> Model {
    let mut m = Model::default();
    let (folds, points) = (width / 0.075, 6.0);
    let count = (folds * points) as usize;
    let wave = |offset: f64| {
        (0..=count).map(move |i| {
            let s = i as f64 / count as f64;
            [width * s, offset + 0.026 * (TAU * folds * s).sin()]
        })
    };
    // Seen from above; `y` of the section points toward −z.
    let section: Vec<[f64; 2]> =
        wave(-0.005).chain(wave(0.005).collect::<Vec<_>>().into_iter().rev()).collect();
    let mut lying = Model::default();
    let ends = Ends { radius: 0.0, pieces: 0, cell: 0.4, cut: 0.0 };
    lying.pillow(&section, [0.0, HEIGHT - 0.05], ends, |_| palette.curtain);
    m.add(&lying, DAffine3::from_rotation_x(-0.5 * PI));
    m
}
