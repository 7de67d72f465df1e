//! Floor, walls with their niches, and ceilings: one closed surface whose fronts face inward.
//!
//! All parts use the same grid lines, half a meter apart, so that neighbors share their edges.

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;
use crate::model::sheet::lines;
use crate::model::wall::{Wall, half_rings};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{AISLE, CELL, EDGE, HALF_WIDTH, HEIGHT, LENGTH, SOUTH_EDGE, bay_middles};
use crate::museum_stairs::{coffers, floor};

/// Niche with a round arch. Its edges lie on grid lines.
#[derive(Clone, Copy)]
pub(super) struct Niche {
    /// Distance of its middle from the left end of its wall.
    pub(super) middle: f64,
    /// Height of its lower edge.
    pub(super) sill: f64,
    /// Height at which its arch begins.
    pub(super) spring: f64,
    /// Half its width, equal to the radius of its arch.
    pub(super) radius: f64,
    /// Height of the grid line above it.
    pub(super) top: f64,
    pub(super) depth: f64,
}

/// Great niche over the landing.
pub(super) const APSE: Niche =
    Niche { middle: HALF_WIDTH, sill: 3.5, spring: 6.5, radius: 1.5, top: 8.5, depth: 1.1 };

/// Niche in a side wall for a bust.
pub(super) const SMALL: Niche =
    Niche { middle: 0.0, sill: 1.0, spring: 2.5, radius: 0.75, top: 3.5, depth: 0.5 };

/// Returns the shell of the hall.
pub(super) fn shell(palette: &Palette) -> Model {
    let mut m = Model::default();
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let north = Wall { left: corner(-HALF_WIDTH, 0.0), right: DVec3::X };
    let south = Wall { left: corner(HALF_WIDTH, LENGTH), right: -DVec3::X };
    let east = Wall { left: corner(HALF_WIDTH, 0.0), right: DVec3::Z };
    let west = Wall { left: corner(-HALF_WIDTH, LENGTH), right: -DVec3::Z };

    floor::floor(&mut m, palette);
    let paint = |v: f64| wall_paint(palette, v);
    let (width, inner) = (2.0 * HALF_WIDTH, HALF_WIDTH - EDGE);
    wall(&mut m, north, [0.0, inner], [0.0, AISLE], &[], paint);
    let hall_wall = |v: f64| if v > 1.0 && v < 9.5 { palette.terracotta } else { paint(v) };
    wall(&mut m, north, [inner, width - inner], [0.0, HEIGHT], &[APSE], hall_wall);
    wall(&mut m, north, [width - inner, width], [0.0, AISLE], &[], paint);
    let beside_door = [HALF_WIDTH - 3.75, HALF_WIDTH + 3.75].map(|middle| Niche { middle, ..SMALL });
    wall(&mut m, south, [0.0, width], [0.0, AISLE], &beside_door, paint);
    let niches: Vec<Niche> = bay_middles().map(|middle| Niche { middle, ..SMALL }).collect();
    wall(&mut m, east, [0.0, LENGTH], [0.0, AISLE], &niches, paint);
    let niches: Vec<Niche> = bay_middles().map(|z| Niche { middle: LENGTH - z, ..SMALL }).collect();
    wall(&mut m, west, [0.0, LENGTH], [0.0, AISLE], &niches, paint);
    recessed(&mut m, north, APSE, palette);
    for (on, n) in beside_door.map(|n| (south, n)) {
        recessed(&mut m, on, n, palette);
    }
    for z in bay_middles() {
        recessed(&mut m, east, Niche { middle: z, ..SMALL }, palette);
        recessed(&mut m, west, Niche { middle: LENGTH - z, ..SMALL }, palette);
    }

    // Walls of the raised middle, and the two heights of the ceiling.
    let attic = |corner: DVec3, right: DVec3| Wall { left: corner, right };
    wall(&mut m, attic(corner(EDGE, 0.0), DVec3::Z), [0.0, SOUTH_EDGE], [AISLE, HEIGHT], &[], paint);
    wall(&mut m, attic(corner(-EDGE, SOUTH_EDGE), -DVec3::Z), [0.0, SOUTH_EDGE], [AISLE, HEIGHT], &[], paint);
    wall(&mut m, attic(corner(EDGE, SOUTH_EDGE), -DVec3::X), [0.0, 2.0 * EDGE], [AISLE, HEIGHT], &[], paint);
    ceiling(&mut m, [-HALF_WIDTH, -EDGE], [0.0, LENGTH], palette.plaster);
    ceiling(&mut m, [EDGE, HALF_WIDTH], [0.0, LENGTH], palette.plaster);
    ceiling(&mut m, [-EDGE, EDGE], [SOUTH_EDGE, LENGTH], palette.plaster);
    coffers::ceiling(&mut m, palette);
    m
}

/// Returns the material of the walls at a height.
fn wall_paint(palette: &Palette, v: f64) -> MaterialId {
    match v {
        ..1.0 => palette.rosso,
        1.0..4.5 => palette.terracotta,
        4.5..6.0 => palette.pale,
        6.0..9.5 => palette.green_wall,
        9.5..AISLE => palette.frieze,
        _ => palette.plaster,
    }
}

/// Adds a part of a wall, with openings for the niches.
fn wall(
    m: &mut Model,
    wall: Wall,
    [left, right]: [f64; 2],
    [low, high]: [f64; 2],
    niches: &[Niche],
    paint: impl Fn(f64) -> MaterialId,
) {
    let (u, v) = (lines(left, right, CELL), heights(low, high));
    for i in 0..u.len() - 1 {
        for j in 0..v.len() - 1 {
            let (middle, height) = (0.5 * (u[i] + u[i + 1]), 0.5 * (v[j] + v[j + 1]));
            let inside =
                |n: &Niche| (middle - n.middle).abs() < n.radius && (n.sill..n.top).contains(&height);
            if !niches.iter().any(inside) {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                m.polygon(&corners.map(|(i, j)| wall.at(u[i], v[j], 0.0)), paint(height));
            }
        }
    }
    for n in niches {
        // From the right foot of the arch up, across and down to the left foot, like the arch itself.
        let (l, r) = (n.middle - n.radius, n.middle + n.radius);
        let (across, beside) = (lines(l, r, CELL), heights(n.spring, n.top));
        let mut around: Vec<DVec3> = beside.iter().map(|&v| wall.at(r, v, 0.0)).collect();
        around.extend(across.iter().rev().skip(1).map(|&u| wall.at(u, n.top, 0.0)));
        around.extend(beside.iter().rev().skip(1).map(|&v| wall.at(l, v, 0.0)));
        m.stitch(&around, &wall.arc([n.middle, n.spring, 0.0], n.radius, ARC), paint(n.spring));
    }
}

/// Heights of the grid lines on the walls. They include the edges of niches and of colors.
const HEIGHTS: [f64; 16] =
    [0.0, 1.0, 1.75, 2.5, 3.5, 4.5, 5.25, 6.0, 6.5, 7.5, 8.5, 9.5, AISLE, 11.3, 12.1, HEIGHT];

fn heights(low: f64, high: f64) -> Vec<f64> {
    HEIGHTS.into_iter().filter(|v| (low..=high).contains(v)).collect()
}

/// Number of segments of an arch.
const ARC: usize = 14;

/// Adds the sides and the back of a niche.
fn recessed(m: &mut Model, wall: Wall, n: Niche, palette: &Palette) {
    let (l, r) = (n.middle - n.radius, n.middle + n.radius);
    let (across, jamb) = (lines(l, r, CELL), heights(n.sill, n.spring));
    let rows = jamb.len() - 1;
    m.sheet([across.len() - 1, rows - 1], |i, j| wall.at(across[i], jamb[j], n.depth), |_, _| palette.niche);
    // The last row joins the grid to the half disc.
    let rings = half_rings(n.radius, ARC, CELL);
    let row = |u: &[f64], v: f64| u.iter().map(|&u| wall.at(u, v, n.depth)).collect::<Vec<_>>();
    let mut diameter: Vec<f64> = rings.iter().map(|ring| n.middle - ring.0).collect();
    diameter.extend(rings.iter().rev().skip(1).map(|ring| n.middle + ring.0));
    m.stitch(&row(&across, jamb[rows - 1]), &row(&diameter, n.spring), palette.niche);
    m.half_disc(wall, [n.middle, n.spring, n.depth], &rings, palette.niche);
    let mut edge = wall.arc([n.middle, n.spring, 0.0], n.radius, ARC);
    edge.extend(jamb.iter().rev().skip(1).map(|&v| wall.at(l, v, 0.0)));
    edge.extend(across.iter().skip(1).map(|&u| wall.at(u, n.sill, 0.0)));
    edge.extend(jamb.iter().skip(1).map(|&v| wall.at(r, v, 0.0)));
    m.recess(&edge, wall.at(0.0, 0.0, n.depth) - wall.at(0.0, 0.0, 0.0), palette.pale);
}

/// Adds a part of the ceiling over the gallery.
fn ceiling(m: &mut Model, [west, east]: [f64; 2], [north, south]: [f64; 2], material: MaterialId) {
    let (x, z) = (lines(west, east, CELL), lines(north, south, CELL));
    m.sheet([x.len() - 1, z.len() - 1], |i, j| DVec3::new(x[i], AISLE, z[j]), |_, _| material);
}
