//! Floor, walls with their arched openings, and vault: one closed surface whose fronts face inward.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;
use crate::model::sheet::lines;
use crate::model::wall::{Wall, half_rings};
use crate::reading_room::palette::Palette;
use crate::reading_room::size::{ARC, BAY, BAYS, HALF_WIDTH, LENGTH, OPENING, SPRING, TILE};

/// Depth of the window recesses \[m\].
pub(super) const WINDOW_DEPTH: f64 = 0.4;
/// Depth of the niche behind the dais \[m\].
pub(super) const NICHE_DEPTH: f64 = 0.8;
/// Depth of the half-round window above the niche \[m\].
pub(super) const LUNETTE_DEPTH: f64 = 0.5;
/// Radius of the half-round window \[m\].
pub(super) const LUNETTE_RADIUS: f64 = 2.5;

/// Heights of the grid lines on the walls \[m\]. They include the sill and the springing of the openings.
const WALL_LINES: [f64; 9] = [0.0, 0.6, OPENING.sill, 1.75, 2.3, OPENING.spring, 3.4, 3.9, SPRING];

/// Returns the shell of the room.
pub(super) fn shell(palette: &Palette) -> Model {
    let mut m = Model::default();
    let corner = |x: f64, z: f64| DVec3::new(x * HALF_WIDTH, 0.0, z);
    let west = Wall { left: corner(-1.0, LENGTH), right: -DVec3::Z };
    let north = Wall { left: corner(-1.0, 0.0), right: DVec3::X };
    let east = Wall { left: corner(1.0, 0.0), right: DVec3::Z };
    let south = Wall { left: corner(1.0, LENGTH), right: -DVec3::X };

    floor(&mut m, palette);
    for bay in 0..BAYS {
        wall_with_opening(&mut m, west, BAY * bay as f64, WINDOW_DEPTH, [palette.plaster, palette.sky]);
    }
    let niche = HALF_WIDTH - 0.5 * BAY;
    plain_wall(&mut m, north, [0.0, niche], palette.plaster);
    wall_with_opening(&mut m, north, niche, NICHE_DEPTH, [palette.plaster; 2]);
    plain_wall(&mut m, north, [niche + BAY, 2.0 * HALF_WIDTH], palette.plaster);
    plain_wall(&mut m, east, [0.0, LENGTH], palette.plaster);
    plain_wall(&mut m, south, [0.0, 2.0 * HALF_WIDTH], palette.plaster);

    vault(&mut m, palette);
    let (center, mut rings) = (HALF_WIDTH, half_rings(HALF_WIDTH, ARC, TILE));
    m.half_disc(south, [center, SPRING, 0.0], &rings, palette.plaster);
    let window = rings.split_off(rings.iter().position(|r| r.0 <= LUNETTE_RADIUS).unwrap_or(0));
    rings.extend(window.first());
    m.half_disc(north, [center, SPRING, 0.0], &rings, palette.plaster);
    m.half_disc(north, [center, SPRING, LUNETTE_DEPTH], &window, palette.sky);
    let mut edge = north.arc([center, SPRING, 0.0], window[0].0, window[0].1);
    let sill = lines(center - window[0].0, center + window[0].0, TILE);
    edge.extend(sill.iter().skip(1).map(|&u| north.at(u, SPRING, 0.0)));
    m.recess(&edge, north.at(0.0, 0.0, LUNETTE_DEPTH) - north.at(0.0, 0.0, 0.0), palette.plaster);
    m
}

fn floor(m: &mut Model, palette: &Palette) {
    let z = lines(0.0, LENGTH, TILE);
    let x = lines(-HALF_WIDTH, HALF_WIDTH, TILE);
    m.sheet(
        [z.len() - 1, x.len() - 1],
        |i, j| DVec3::new(x[j], 0.0, z[i]),
        |i, j| {
            if (i + j) % 2 == 0 { palette.pale_tile } else { palette.dark_tile }
        },
    );
}

fn vault(m: &mut Model, palette: &Palette) {
    let z = lines(0.0, LENGTH, TILE);
    m.sheet(
        [z.len() - 1, ARC],
        |i, j| {
            let (sin, cos) = (PI * j as f64 / ARC as f64).sin_cos();
            DVec3::new(HALF_WIDTH * cos, SPRING + HALF_WIDTH * sin, z[i])
        },
        |_, _| palette.vault,
    );
}

fn plain_wall(m: &mut Model, wall: Wall, [from, to]: [f64; 2], material: MaterialId) {
    let u = lines(from, to, TILE);
    m.sheet([u.len() - 1, WALL_LINES.len() - 1], |i, j| wall.at(u[i], WALL_LINES[j], 0.0), |_, _| material);
}

/// Adds one bay of a wall, starting at `u`, with an arched recess in its middle that ends in a pane.
fn wall_with_opening(m: &mut Model, wall: Wall, u: f64, depth: f64, [material, pane]: [MaterialId; 2]) {
    let center = u + 0.5 * BAY;
    let (left, right) = (center - OPENING.radius, center + OPENING.radius);
    plain_wall(m, wall, [u, left], material);
    plain_wall(m, wall, [right, u + BAY], material);
    let across = lines(left, right, TILE);
    let below = WALL_LINES.iter().take_while(|v| **v <= OPENING.sill).copied().collect::<Vec<_>>();
    m.sheet([across.len() - 1, below.len() - 1], |i, j| wall.at(across[i], below[j], 0.0), |_, _| material);

    // Around the arch: from its right foot up, across and down to the left foot, like the arch itself.
    let beside = WALL_LINES.iter().filter(|v| **v >= OPENING.spring && **v < SPRING);
    let mut around: Vec<DVec3> = beside.clone().map(|&v| wall.at(right, v, 0.0)).collect();
    around.extend(across.iter().rev().map(|&u| wall.at(u, SPRING, 0.0)));
    around.extend(beside.rev().map(|&v| wall.at(left, v, 0.0)));
    let segments = 12;
    let arch = wall.arc([center, OPENING.spring, 0.0], OPENING.radius, segments);
    m.stitch(&around, &arch, material);

    let jamb: Vec<f64> =
        WALL_LINES.iter().copied().filter(|v| (OPENING.sill..=OPENING.spring).contains(v)).collect();
    m.sheet([across.len() - 1, jamb.len() - 1], |i, j| wall.at(across[i], jamb[j], depth), |_, _| pane);
    m.half_disc(wall, [center, OPENING.spring, depth], &half_rings(OPENING.radius, segments, TILE), pane);
    let mut edge = arch;
    edge.extend(jamb.iter().rev().skip(1).map(|&v| wall.at(left, v, 0.0)));
    edge.extend(across.iter().skip(1).map(|&u| wall.at(u, OPENING.sill, 0.0)));
    edge.extend(jamb.iter().skip(1).map(|&v| wall.at(right, v, 0.0)));
    m.recess(&edge, wall.at(0.0, 0.0, depth) - wall.at(0.0, 0.0, 0.0), material);
}
