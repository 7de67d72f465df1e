//! The building around the office, its windows, and what is seen through them.

use glam::DVec3;

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::office::palette::Palette;
use crate::office::size::{
    COLUMNS, DEPTH, GROUND, HEIGHT, LENGTH, LINTEL, ROWS, SILL, TILE, WALL, WINDOWS, window,
};

/// Half the width of the bars that carry the tiles of the ceiling \[m\].
const BAR: f64 = 0.012;
/// Depth of the boxes of the recessed luminaires \[m\].
const RECESS: f64 = 0.01;
/// Ends of the building along the street \[m\].
const ENDS: [f64; 2] = [-8.0, 20.0];
/// Height of the roof \[m\].
const ROOF: f64 = 3.5;
/// Distance of the facade on the other side of the street \[m\].
const STREET: f64 = 18.0;
/// Depth of the windows of that facade \[m\].
const REVEAL: f64 = 0.3;
/// Distance of the window frames from the inner surface of the wall \[m\].
const FRAME: f64 = 0.24;

/// Returns the building: one closed solid with the room as a cavity.
pub(super) fn building(palette: &Palette) -> Model {
    let mut m = Model::default();
    let mut x = vec![ENDS[0], ENDS[1]];
    x.extend((0..WINDOWS).flat_map(window));
    x.extend(tiles(LENGTH));
    let mut z = vec![-WALL, DEPTH + WALL];
    z.extend(tiles(DEPTH));
    for lines in [&mut x, &mut z] {
        lines.sort_by(f64::total_cmp);
    }
    let y = [GROUND + GAP, 0.0, SILL, LINTEL, HEIGHT, HEIGHT + RECESS, ROOF];

    let filled = |p: DVec3| {
        let in_room = p.x > 0.0 && p.x < LENGTH && p.y > 0.0 && p.y < HEIGHT && p.z > 0.0 && p.z < DEPTH;
        let in_window = p.z < 0.0 && p.y > SILL && p.y < LINTEL && is_in_window(p.x);
        let in_recess = p.y > HEIGHT && p.y < HEIGHT + RECESS && is_luminaire(p);
        !(in_room || in_window || in_recess)
    };
    let surface = |normal: DVec3, p: DVec3| {
        let inside = p.x >= 0.0 && p.x <= LENGTH && (0.0..ROOF).contains(&p.y) && p.z >= 0.0 && p.z <= DEPTH;
        if !inside {
            return if p.z > -WALL && p.z < 0.0 && p.y > 0.0 && p.y < HEIGHT && is_in_reveal(p.x) {
                palette.white
            } else {
                palette.facade
            };
        }
        match normal.y {
            up if up > 0.5 => palette.floor,
            down if down < -0.5 && p.y > HEIGHT + 0.5 * RECESS => palette.luminaire,
            down if down < -0.5 && is_bar(p) => palette.ceiling_bar,
            down if down < -0.5 => palette.ceiling,
            _ if p.y > HEIGHT => palette.luminaire,
            _ => palette.wall,
        }
    };
    m.cells([&x, &y, &z], filled, surface);
    m
}

/// Returns the lines of the tiles of the ceiling along a side of the room, with both edges of each bar between them.
fn tiles(length: f64) -> Vec<f64> {
    let count = (length / TILE).round() as usize;
    let bars = (1..count).flat_map(|i| [TILE * i as f64 - BAR, TILE * i as f64 + BAR]);
    [0.0].into_iter().chain(bars).chain([length]).collect()
}

fn is_bar(p: DVec3) -> bool {
    [p.x, p.z].iter().any(|along| (along / TILE - (along / TILE).round()).abs() * TILE < BAR)
}

fn is_luminaire(p: DVec3) -> bool {
    let in_tile = |center: &f64, at: f64| (at - center).abs() < 0.5 * TILE - BAR;
    COLUMNS.iter().any(|x| in_tile(x, p.x)) && ROWS.iter().any(|z| in_tile(z, p.z))
}

fn is_in_window(x: f64) -> bool {
    (0..WINDOWS).map(window).any(|[left, right]| x > left && x < right)
}

fn is_in_reveal(x: f64) -> bool {
    (0..WINDOWS).map(window).any(|[left, right]| x >= left && x <= right)
}

/// Returns the frames, panes and sills of the windows, and a radiator below each.
pub(super) fn windows(palette: &Palette) -> Model {
    let mut m = Model::default();
    for [left, right] in (0..WINDOWS).map(window) {
        let (left, right, low, high) = (left + GAP, right - GAP, SILL + GAP, LINTEL - GAP);
        let (out, bar) = (-FRAME - 0.06, 0.05);
        let middle = 0.5 * (left + right);
        let mut part = |[x, y]: [f64; 2], [to_x, to_y]: [f64; 2], material| {
            m.block([x, y, out], [to_x, to_y, -FRAME], 9.0, material);
        };
        part([left, low], [right, low + bar], palette.frame);
        part([left, high - bar], [right, high], palette.frame);
        let (low, high) = (low + bar + GAP, high - bar - GAP);
        for x in [left, middle - 0.5 * bar, right - bar] {
            part([x, low], [x + bar, high], palette.frame);
        }
        for [from, to] in [[left + bar, middle - 0.5 * bar], [middle + 0.5 * bar, right - bar]] {
            let z = out + 0.025;
            m.block([from + GAP, low, z], [to - GAP, high, z + 0.012], 9.0, palette.glass);
        }
        m.block([left, SILL + GAP, -FRAME + GAP], [right, SILL + 0.02, 0.04], 9.0, palette.white);
        for x in lines(left + 0.2, right - 0.2, 0.125).windows(2) {
            m.block([x[0], 0.14, 0.02], [x[1] - 0.012, 0.7, 0.09], 9.0, palette.white);
        }
    }
    m
}

/// Returns the ground and the building on the other side of the street.
pub(super) fn street(palette: &Palette) -> Model {
    let mut m = Model::default();
    m.block([-34.0, GROUND - 0.5, -44.0], [46.0, GROUND, 30.0], 40.0, palette.ground);

    let mut x = lines(-30.0, 42.0, 2.4);
    x.extend(lines(-30.0 + 1.2, 42.0 - 1.2, 2.4));
    x.sort_by(f64::total_cmp);
    let floors = lines(GROUND + GAP, GROUND + 8.4, 2.8);
    let mut y: Vec<f64> = floors.iter().flat_map(|floor| [*floor, floor + 0.9, floor + 2.4]).collect();
    y.truncate(3 * (floors.len() - 1) + 1);
    let z = [-STREET - 12.0, -STREET - REVEAL, -STREET];
    let is_window = |p: DVec3| {
        let above_floor = (p.y - GROUND).rem_euclid(2.8);
        above_floor > 0.9 && above_floor < 2.4 && (p.x + 30.0).rem_euclid(2.4) > 1.2
    };
    let filled = |p: DVec3| !(is_window(p) && p.z > -STREET - REVEAL);
    m.cells([&x, &y, &z], filled, |normal, p| {
        // Blinds are down in some of the windows.
        let number = ((p.x + 30.0) / 2.4).floor() + 7.0 * ((p.y - GROUND) / 2.8).floor();
        match normal.z > 0.5 && is_window(p) {
            true if (3.0 * number).rem_euclid(7.0) < 2.0 => palette.facade_blind,
            true => palette.facade_glass,
            false => palette.facade,
        }
    });
    m
}
