//! Paintings and tapestries in their frames, and the doors.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{GALLERY, HALF_WIDTH, LENGTH, bay_middles};

/// Returns all pictures and doors.
pub(super) fn pictures(palette: &Palette) -> Model {
    let mut m = Model::default();
    let sizes = [[1.7, 1.25], [1.25, 1.6], [1.9, 1.3], [1.25, 1.6], [1.7, 1.25]];
    for (i, (z, size)) in bay_middles().zip(sizes).enumerate() {
        for side in [-1.0, 1.0] {
            let number = 2 * i + usize::from(side > 0.0);
            let place = DAffine3::from_translation(DVec3::new(side * (HALF_WIDTH - GAP), GALLERY + 2.35, z));
            m.add(&painting(palette, number, size), place * DAffine3::from_rotation_y(-side * FRAC_PI_2));
        }
    }
    for side in [-1.0, 1.0] {
        let hung = DAffine3::from_translation(DVec3::new(side * 3.75, 7.6, GAP));
        m.add(&tapestry(palette), hung);
        let place = DAffine3::from_translation(DVec3::new(side * 4.3, GALLERY + 2.35, LENGTH - GAP));
        m.add(&painting(palette, 11, [1.9, 1.3]), place * DAffine3::from_rotation_y(PI));
        // Doors at the ends of the gallery.
        m.add_at(&door(palette, 0.65), side * 6.75, GALLERY + GAP, GAP);
    }
    let entrance =
        DAffine3::from_translation(DVec3::new(0.0, GAP, LENGTH - GAP)) * DAffine3::from_rotation_y(PI);
    m.add(&door(palette, 1.05), entrance);
    m
}

/// Returns a painting about the origin in front of the plane `z = 0`: a landscape of colored bands.
fn painting(palette: &Palette, number: usize, [width, height]: [f64; 2]) -> Model {
    let mut m = Model::default();
    let (x, y) = (0.5 * width, 0.5 * height);
    let frame = 0.11;
    for side in [-1.0, 1.0] {
        let (a, b) = (side * (x + GAP), side * (x + frame));
        m.block([a.min(b), -y - frame, 0.0], [a.max(b), y + frame, 0.075], 0.8, palette.gold);
        let (a, b) = (side * (y + GAP), side * (y + frame));
        m.block([-x, a.min(b), 0.0], [x, a.max(b), 0.07], 0.8, palette.gold);
    }
    let columns = 12;
    let point = |i: usize, j: usize| {
        let u = 2.0 * i as f64 / f64::from(columns) - 1.0;
        [x * u, y * horizon(number, j, u)]
    };
    let paint = |_, j: usize| palette.paints[LANDSCAPES[number % LANDSCAPES.len()][j]];
    panel(&mut m, [columns as usize, BANDS], point, [0.004, 0.035], palette.dark_wood, paint);
    m
}

/// Number of color bands in a landscape.
const BANDS: usize = 7;

/// Paint indices of the bands of each landscape, from the bottom up.
const LANDSCAPES: [[usize; BANDS]; 5] = [
    [6, 5, 4, 5, 1, 0, 0],
    [7, 6, 8, 2, 2, 9, 1],
    [5, 4, 3, 3, 9, 1, 0],
    [7, 3, 3, 0, 9, 1, 2],
    [6, 4, 4, 3, 0, 9, 9],
];

/// Returns the height of the lower edge of a landscape's band at `x`. Both coordinates run from −1 to 1.
fn horizon(number: usize, band: usize, x: f64) -> f64 {
    if band == 0 || band == BANDS {
        return if band == 0 { -1.0 } else { 1.0 };
    }
    let (n, k) = (number as f64, band as f64);
    let even = 2.0 * k / BANDS as f64 - 1.0;
    // The edges are wavier in the middle than near the bottom and the top.
    let swing = 0.11 - 0.02 * (k - 3.0).abs();
    even + swing * ((2.1 + 0.5 * (n * 0.7).sin()) * x + 2.3 * k + n).sin() + 0.03 * (7.0 * x + k * n).sin()
}

/// Adds a flat box whose front, which faces `+z`, is a grid with cells of different materials.
///
/// `point(i, j)` moves right with `i` and up with `j`. The back is not divided into cells.
fn panel(
    m: &mut Model,
    [columns, rows]: [usize; 2],
    point: impl Fn(usize, usize) -> [f64; 2],
    [back, front]: [f64; 2],
    side: MaterialId,
    paint: impl Fn(usize, usize) -> MaterialId,
) {
    let at = |[x, y]: [f64; 2], z: f64| DVec3::new(x, y, z);
    m.sheet([columns, rows], |i, j| at(point(i, j), front), paint);
    // Around the edge, counterclockwise seen from the front.
    let mut edge: Vec<[f64; 2]> = (0..columns).map(|i| point(i, 0)).collect();
    edge.extend((0..rows).map(|j| point(columns, j)));
    edge.extend((1..=columns).rev().map(|i| point(i, rows)));
    edge.extend((1..=rows).rev().map(|j| point(0, j)));
    let middle = at([0.0; 2], back);
    for (i, &p) in edge.iter().enumerate() {
        let q = edge[(i + 1) % edge.len()];
        m.polygon(&[at(p, back), at(q, back), at(q, front), at(p, front)], side);
        m.polygon(&[at(q, back), at(p, back), middle], side);
    }
}

/// Returns a tapestry about the origin in front of the plane `z = 0`, with a border, a lattice and lozenges.
fn tapestry(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (x, y) = (0.9, 1.75);
    let (across, up) = (lines(-x, x, 0.15), lines(-y, y, 0.15));
    let paint = |i: usize, j: usize| {
        let (u, v) = (0.5 * (across[i] + across[i + 1]), 0.5 * (up[j] + up[j + 1]));
        let edge = (x - u.abs()).min(y - v.abs());
        let lozenge = (u / 0.6).abs() + ((v / 0.9 + 20.5).rem_euclid(1.0) - 0.5).abs() * 1.6;
        match edge {
            ..0.15 => palette.carpet_border,
            0.15..0.3 => palette.coffer,
            _ if lozenge < 0.3 => palette.paints[9],
            _ if lozenge < 0.8 => palette.carpet,
            _ => palette.niche,
        }
    };
    let cells = [across.len() - 1, up.len() - 1];
    panel(&mut m, cells, |i, j| [across[i], up[j]], [0.01, 0.03], palette.niche, paint);
    m.block([-x - 0.1, y + 0.01, 0.005], [x + 0.1, y + 0.06, 0.06], 0.6, palette.gold);
    m
}

/// Returns a framed double door about the origin in front of the plane `z = 0`.
fn door(palette: &Palette, half: f64) -> Model {
    let mut m = Model::default();
    let (height, frame) = (2.75, 0.2);
    for side in [-1.0, 1.0] {
        let mut slab = |near: f64, far: f64, low: f64, high: f64, z: [f64; 2], material| {
            let (a, b) = (side * near, side * far);
            m.block([a.min(b), low, z[0]], [a.max(b), high, z[1]], 0.5, material);
        };
        slab(half + GAP, half + frame, 0.0, height, [0.0, 0.13], palette.pale);
        slab(0.004, half, 0.0, height - GAP, [0.0, 0.05], palette.wood);
        for (low, high) in [(0.2, 0.95), (1.1, 1.75), (1.9, 2.55)] {
            slab(0.12, half - 0.12, low, high, [0.05 + GAP, 0.08], palette.dark_wood);
        }
    }
    let over = half + frame + 0.08;
    m.block([-over, height + GAP, 0.0], [over, height + 0.26, 0.18], 0.5, palette.pale);
    m
}
