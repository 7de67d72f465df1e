//! Floor, side walls with their windows, ceiling and ends: one closed surface whose fronts face inward.

use glam::DVec3;

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::size::{
    AISLE, BEFORE, BEHIND, CEILING, CELLS, LENGTH, WALL_LINES, WINDOW_LINES, WINDOW_PITCH, half_width,
};
use crate::airplane_cabin::window::{Wall, window};
use crate::model::Model;
use crate::model::sheet::lines;
use crate::random::Random;

/// Number of cells of the runner along each window pitch, and across the runner.
const RUNNER_CELLS: usize = 4;
/// Distance from the middle of the aisle at which the coarse cells of the floor begin \[m\].
const BESIDE: f64 = AISLE + 0.2;

/// Returns the shell of the cabin.
pub(super) fn shell(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    floor(&mut m, palette);
    for side in [-1.0, 1.0] {
        wall(&mut m, palette, random, Wall { side });
    }
    let (z, x) = (z_lines(2), ceiling_line());
    let last = x.len() - 1;
    let at = |i: usize, j: usize| DVec3::new(x[last - j][0], x[last - j][1], z[i]);
    m.sheet([z.len() - 1, last], at, |_, _| palette.panel);
    end(&mut m, palette, 0.0);
    end(&mut m, palette, LENGTH);
    m
}

/// Returns positions `z` along the cabin, spaced by the window pitch divided by `parts`.
fn z_lines(parts: usize) -> Vec<f64> {
    (0..=CELLS * parts).map(|i| WINDOW_PITCH * i as f64 / parts as f64).collect()
}

/// Returns the points of the ceiling's section from left to right.
fn ceiling_line() -> Vec<[f64; 2]> {
    let edge = WALL_LINES[WALL_LINES.len() - 1];
    let mut half = CEILING.to_vec();
    half.push([half_width(edge), edge]);
    half.iter().skip(1).rev().map(|[x, y]| [-x, *y]).chain(half.iter().copied()).collect()
}

/// Returns the grid lines of the floor from beside the runner to the right wall.
fn outer_floor() -> Vec<f64> {
    lines(BESIDE, half_width(0.0), 0.3)
}

fn runner_lines() -> Vec<f64> {
    lines(-AISLE, AISLE, 2.0 * AISLE / RUNNER_CELLS as f64)
}

fn floor(m: &mut Model, palette: &Palette) {
    let (fine, coarse) = (z_lines(RUNNER_CELLS), z_lines(2));
    runner(m, palette, &fine);
    let along = |x: f64, z: &[f64]| z.iter().map(|&z| DVec3::new(x, 0.0, z)).collect::<Vec<_>>();
    m.stitch(&along(AISLE, &fine), &along(BESIDE, &coarse), palette.runner_edge);
    let (mut near, mut far) = (along(-AISLE, &fine), along(-BESIDE, &coarse));
    near.reverse();
    far.reverse();
    m.stitch(&near, &far, palette.runner_edge);
    let x = outer_floor();
    let last = x.len() - 1;
    let size = [coarse.len() - 1, last];
    m.sheet(size, |i, j| DVec3::new(x[j], 0.0, coarse[i]), |_, _| palette.carpet);
    m.sheet(size, |i, j| DVec3::new(-x[last - j], 0.0, coarse[i]), |_, _| palette.carpet);
}

/// Adds the runner along the aisle. Each window pitch has a diamond with a dot in its middle; cells are split along the
/// diamond's sides.
fn runner(m: &mut Model, palette: &Palette, z: &[f64]) {
    let x = runner_lines();
    let middle = 0.5 * RUNNER_CELLS as f64;
    for i in 0..z.len() - 1 {
        for j in 0..x.len() - 1 {
            let at = |di: usize, dj: usize| DVec3::new(x[j + dj], 0.0, z[i + di]);
            let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            let (across, along) = (j as f64 + 0.5 - middle, (i % RUNNER_CELLS) as f64 + 0.5 - middle);
            let farther = across.abs() + along.abs() + 0.3;
            let color = |distance: f64| match distance {
                d if d < 1.0 => palette.runner_dot,
                d if d < 2.0 => palette.runner_figure,
                _ => palette.runner,
            };
            let (inner, outer) = (color(farther - 0.6), color(farther));
            // The half nearer to the middle of the diamond comes first.
            let halves = match (across > 0.0, along > 0.0) {
                (true, true) => [[a, b, d], [b, c, d]],
                (false, false) => [[b, c, d], [a, b, d]],
                (true, false) => [[a, b, c], [a, c, d]],
                (false, true) => [[a, c, d], [a, b, c]],
            };
            m.polygon(&halves[0], inner);
            m.polygon(&halves[1], outer);
        }
    }
}

fn wall(m: &mut Model, palette: &Palette, random: &mut Random, wall: Wall) {
    let z = z_lines(2);
    let last = z.len() - 1;
    // Seen from the aisle, from left to right, the right wall runs backward and the left wall forward.
    let z_at = |i: usize| if wall.side > 0.0 { z[i] } else { z[last - i] };
    let [low, _, high] = WINDOW_LINES;
    for (first, to) in [(0, low), (high, WALL_LINES.len() - 1)] {
        let at = |i: usize, j: usize| wall.at(z_at(i), WALL_LINES[first + j]);
        let color = |_, j: usize| if first + j == 0 { palette.dado } else { palette.panel };
        m.sheet([last, to - first], at, color);
    }
    for cell in 0..CELLS {
        let z = [0, 1, 2].map(|i| z_at(2 * cell + i));
        let place = if wall.side > 0.0 { cell } else { CELLS - 1 - cell };
        if (BEFORE..CELLS - BEHIND).contains(&place) {
            window(m, palette, random, wall, z);
        } else {
            m.sheet([2, high - low], |i, j| wall.at(z[i], WALL_LINES[low + j]), |_, _| palette.panel);
        }
    }
}

/// Adds the wall at one end: rows of cells between the floor and the ceiling.
fn end(m: &mut Model, palette: &Palette, z: f64) {
    let mut x: Vec<f64> = outer_floor().iter().rev().map(|x| -x).collect();
    x.extend(runner_lines());
    x.extend(outer_floor());
    let mut rows: Vec<Vec<DVec3>> = vec![x.iter().map(|&x| DVec3::new(x, 0.0, z)).collect()];
    for &y in &WALL_LINES[1..WALL_LINES.len() - 1] {
        let w = half_width(y);
        rows.push(lines(-w, w, 0.26).iter().map(|&x| DVec3::new(x, y, z)).collect());
    }
    rows.push(ceiling_line().iter().map(|[x, y]| DVec3::new(*x, *y, z)).collect());
    for pair in rows.windows(2) {
        let (mut low, mut high) = (pair[0].clone(), pair[1].clone());
        if z > 0.0 {
            low.reverse();
            high.reverse();
        }
        m.stitch(&low, &high, palette.bulkhead);
    }
}
