//! Floor, walls with their arched openings, and vault: one closed surface with its fronts inward.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::MaterialId;

use super::palette::Palette;
use super::size::{ARC, BAY, BAYS, HALF_WIDTH, LENGTH, OPENING, SPRING, TILE};
use crate::model::{Model, lines};

/// Depth of the window recesses \[m\].
pub(super) const WINDOW_DEPTH: f64 = 0.4;
/// Depth of the niche behind the dais \[m\].
pub(super) const NICHE_DEPTH: f64 = 0.8;
/// Depth of the half-round window above the niche \[m\].
pub(super) const LUNETTE_DEPTH: f64 = 0.5;
/// Radius of the half-round window \[m\].
pub(super) const LUNETTE_RADIUS: f64 = 2.5;

/// Heights of the lines of cells on the walls \[m\]; sill and springing of the openings are two of them.
const WALL_LINES: [f64; 9] = [0.0, 0.6, OPENING.sill, 1.75, 2.3, OPENING.spring, 3.4, 3.9, SPRING];

/// A wall seen from inside: `u` metres from its left end, `v` above the floor, `w` behind its surface.
#[derive(Clone, Copy)]
struct Wall {
    left: DVec3,
    right: DVec3,
}

impl Wall {
    fn at(self, u: f64, v: f64, w: f64) -> DVec3 {
        self.left + u * self.right + v * DVec3::Y - w * self.right.cross(DVec3::Y)
    }
}

/// The shell of the room.
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
    let (centre, mut rings) = (HALF_WIDTH, half_rings(HALF_WIDTH, ARC));
    half_disc(&mut m, south, [centre, SPRING, 0.0], &rings, palette.plaster);
    let window = rings.split_off(rings.iter().position(|r| r.0 <= LUNETTE_RADIUS).unwrap_or(0));
    rings.extend(window.first());
    half_disc(&mut m, north, [centre, SPRING, 0.0], &rings, palette.plaster);
    half_disc(&mut m, north, [centre, SPRING, LUNETTE_DEPTH], &window, palette.sky);
    let mut edge = arc(north, [centre, SPRING, 0.0], window[0].0, window[0].1);
    let sill = lines(centre - window[0].0, centre + window[0].0, TILE);
    edge.extend(sill.iter().skip(1).map(|&u| north.at(u, SPRING, 0.0)));
    recess(&mut m, &edge, north.at(0.0, 0.0, LUNETTE_DEPTH) - north.at(0.0, 0.0, 0.0), palette.plaster);
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

/// One bay of a wall, from `u` on, with an arched recess in its middle that ends in a pane.
fn wall_with_opening(m: &mut Model, wall: Wall, u: f64, depth: f64, [material, pane]: [MaterialId; 2]) {
    let centre = u + 0.5 * BAY;
    let (left, right) = (centre - OPENING.radius, centre + OPENING.radius);
    plain_wall(m, wall, [u, left], material);
    plain_wall(m, wall, [right, u + BAY], material);
    let across = lines(left, right, TILE);
    let below = WALL_LINES.iter().take_while(|v| **v <= OPENING.sill).copied().collect::<Vec<_>>();
    m.sheet([across.len() - 1, below.len() - 1], |i, j| wall.at(across[i], below[j], 0.0), |_, _| material);

    // Around the arch: from its right foot up, over and down to the left foot, as on the arch itself.
    let beside = WALL_LINES.iter().filter(|v| **v >= OPENING.spring && **v < SPRING);
    let mut around: Vec<DVec3> = beside.clone().map(|&v| wall.at(right, v, 0.0)).collect();
    around.extend(across.iter().rev().map(|&u| wall.at(u, SPRING, 0.0)));
    around.extend(beside.rev().map(|&v| wall.at(left, v, 0.0)));
    let segments = 12;
    let arch = arc(wall, [centre, OPENING.spring, 0.0], OPENING.radius, segments);
    m.stitch(&around, &arch, material);

    let jamb: Vec<f64> =
        WALL_LINES.iter().copied().filter(|v| (OPENING.sill..=OPENING.spring).contains(v)).collect();
    m.sheet([across.len() - 1, jamb.len() - 1], |i, j| wall.at(across[i], jamb[j], depth), |_, _| pane);
    half_disc(m, wall, [centre, OPENING.spring, depth], &half_rings(OPENING.radius, segments), pane);
    let mut edge = arch;
    edge.extend(jamb.iter().rev().skip(1).map(|&v| wall.at(left, v, 0.0)));
    edge.extend(across.iter().skip(1).map(|&u| wall.at(u, OPENING.sill, 0.0)));
    edge.extend(jamb.iter().skip(1).map(|&v| wall.at(right, v, 0.0)));
    recess(m, &edge, wall.at(0.0, 0.0, depth) - wall.at(0.0, 0.0, 0.0), material);
}

/// The sides of a recess: `edge` is its closed outline, counter-clockwise seen from the room, and `inward` leads to
/// its bottom.
fn recess(m: &mut Model, edge: &[DVec3], inward: DVec3, material: MaterialId) {
    m.sheet([edge.len() - 1, 2], |i, j| edge[i] + 0.5 * j as f64 * inward, |_, _| material);
}

/// A half circle on a wall, counter-clockwise from its right end.
fn arc(wall: Wall, [u, v, w]: [f64; 3], radius: f64, segments: usize) -> Vec<DVec3> {
    (0..=segments)
        .map(|i| {
            let (sin, cos) = (PI * i as f64 / segments as f64).sin_cos();
            wall.at(u + radius * cos, v + radius * sin, w)
        })
        .collect()
}

/// Radii and numbers of segments of half circles from the given one down to the centre, a tile apart.
fn half_rings(radius: f64, segments: usize) -> Vec<(f64, usize)> {
    lines(radius, 0.0, -TILE)
        .iter()
        .map(|&r| (r, ((segments as f64 * r / radius).round() as usize).max(1)))
        .collect()
}

/// The area between half circles about one centre. A circle of radius zero is the centre itself.
fn half_disc(m: &mut Model, wall: Wall, centre: [f64; 3], rings: &[(f64, usize)], material: MaterialId) {
    for pair in rings.windows(2) {
        let [outer, inner] = [pair[0], pair[1]].map(|(r, segments)| arc(wall, centre, r, segments));
        m.stitch(&outer, &inner, material);
    }
}
