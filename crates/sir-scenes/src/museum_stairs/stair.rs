//! Stair: a wide flight to a landing, from which two flights lead to the gallery.

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::model::{GAP, Model};
use crate::museum_stairs::balustrade;
use crate::museum_stairs::columns;
use crate::museum_stairs::columns::PEDESTAL;
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{EDGE, FLIGHT, FOOT, GALLERY, LANDING, PARAPET, RISER, SIDE, TREAD};

/// Half the width of the carpet.
pub(super) const CARPET: f64 = 1.15;
/// Width of the carpet's border.
pub(super) const BORDER: f64 = 0.09;
/// Height of the parapets above the edges of the steps.
const CURB: f64 = 0.10;
/// Half the width of the piers at the corners of the landing.
const PIER: f64 = 0.5 * PARAPET + 0.02;

/// Returns the stair with its balustrades.
pub(super) fn stair(palette: &Palette) -> Model {
    let mut m = Model::default();
    let inner = FLIGHT - GAP;
    // Grid lines at the edges and borders of the carpet.
    let mut across = vec![-inner];
    for side in [-1.0, 1.0] {
        let edges = [CARPET, CARPET - BORDER, 0.4].map(|x| side * x);
        if side < 0.0 { across.extend(edges) } else { across.extend(edges.iter().rev()) }
    }
    across.push(inner);
    let carpet = |x: f64| match x.abs() {
        ..1.06 => palette.carpet,
        1.06..CARPET => palette.carpet_border,
        _ => palette.stone,
    };

    // A flight runs along x in its own frame; this one runs from the foot toward −z.
    let central = flight(&across, 18, RISER, carpet);
    m.add(&central, DAffine3::from_cols(-DVec3::Z, DVec3::Y, DVec3::X, DVec3::new(0.0, GAP, FOOT)));
    let mut x = across.clone();
    x.splice(1..1, [-1.5]);
    x.insert(x.len() - 1, 1.5);

    let (near, far) = (SIDE - PARAPET - 2.0 * GAP, GAP);
    let side_carpet = |z: f64| match (z - 1.07).abs() {
        ..0.65 => palette.carpet,
        0.65..0.73 => palette.carpet_border,
        _ => palette.stone,
    };
    let lanes = [far, 0.34, 0.42, 0.84, 1.3, 1.72, 1.80, near];
    let mut z = lanes.to_vec();
    z.push(SIDE - GAP);
    let landing = |d: DVec3, p: DVec3| {
        let way = (1.07 - p.z).abs() - 0.65;
        match (p.x.abs() - 1.06).min(way) {
            _ if d.y <= 0.0 || p.z < 0.34 => palette.stone,
            _ if p.z < 0.42 => palette.carpet_border,
            ..0.0 => palette.carpet,
            0.0..0.09 => palette.carpet_border,
            _ => palette.stone,
        }
    };
    m.grid_block([&x, &[GAP, 1.0, 2.0, LANDING], &z], landing);
    let east = flight(&lanes, 12, LANDING + RISER, side_carpet);
    m.add_at(&east, FLIGHT, GAP, 0.0);
    // Mirror image: the same flight, rotated and moved to the other side.
    let turned: Vec<f64> = lanes.iter().rev().map(|z| -z).collect();
    let west = flight(&turned, 12, LANDING + RISER, |z| side_carpet(-z));
    m.add(&west, DAffine3::from_cols(-DVec3::X, DVec3::Y, -DVec3::Z, DVec3::new(-FLIGHT, GAP, 0.0)));
    for side in [-1.0, 1.0] {
        parapets(&mut m, palette, side);
    }
    m
}

/// Returns steps along `x` from the origin. The first has the height `first`; `across` are the grid lines along `z`.
fn flight(across: &[f64], steps: usize, first: f64, material: impl Fn(f64) -> MaterialId) -> Model {
    let mut m = Model::default();
    let height = |step: usize| first + RISER * step as f64 - GAP;
    let at = |step: usize, y: f64, lane: usize| DVec3::new(TREAD * step as f64, y, across[lane]);
    let lanes = across.len() - 1;
    for step in 0..steps {
        let (low, high) = (if step == 0 { 0.0 } else { height(step - 1) }, height(step));
        for lane in 0..lanes {
            let paint = material(0.5 * (across[lane] + across[lane + 1]));
            let quad = |a: (usize, f64), b: (usize, f64)| {
                [at(a.0, a.1, lane), at(a.0, a.1, lane + 1), at(b.0, b.1, lane + 1), at(b.0, b.1, lane)]
            };
            m.polygon(&quad((step, low), (step, high)), paint);
            m.polygon(&quad((step, high), (step + 1, high)), paint);
            m.polygon(&quad((step + 1, 0.0), (step, 0.0)), paint);
        }
        let paint = material(across[0]);
        let cheek = |lane: usize| {
            let mut p = vec![at(step + 1, 0.0, lane), at(step + 1, high, lane), at(step, high, lane)];
            if step > 0 {
                p.push(at(step, low, lane));
            }
            p.push(at(step, 0.0, lane));
            p
        };
        m.polygon(&cheek(lanes), paint);
        let mut back = cheek(0);
        back[1..].reverse();
        m.polygon(&back, paint);
    }
    for lane in 0..lanes {
        let (low, high) = (0.0, height(steps - 1));
        let corners = [(high, lane), (high, lane + 1), (low, lane + 1), (low, lane)];
        m.polygon(&corners.map(|(y, lane)| at(steps, y, lane)), material(across[0]));
    }
    m
}

/// Adds the parapets of one half of the stair, with their piers and balustrades.
fn parapets(m: &mut Model, palette: &Palette, side: f64) {
    let slope = RISER / TREAD;
    let x = FLIGHT + 0.5 * PARAPET;
    for [at, height, z] in piers() {
        pier(m, palette, [side * at, z], height);
    }
    let [[_, _, corner], [_, _, newel]] = piers();

    // Along the central flight; the section is (z, y).
    let (from, to) = (corner + PIER + GAP, newel - PIER - GAP);
    let edge = |z: f64| LANDING + CURB - slope * (z - SIDE);
    let section = [[from, GAP], [from, edge(from)], [to, edge(to)], [to, GAP]];
    let mut wall = Model::default();
    wall.prism(&section.map(|[z, y]| [-z, y]), [-0.5 * PARAPET, 0.5 * PARAPET], 1.0, palette.stone);
    m.add(&wall, DAffine3::from_cols(-DVec3::Z, DVec3::Y, DVec3::X, DVec3::new(side * x, 0.0, 0.0)));
    let top = |z: f64| DVec3::new(side * x, edge(z), z);
    m.add(&balustrade::between(palette, top(to), top(from)), DAffine3::IDENTITY);

    // In front of the side flight.
    let (from, to) = (FLIGHT + 2.0 * PIER + GAP, EDGE - GAP);
    let edge = |x: f64| LANDING + RISER + CURB + slope * (x - FLIGHT);
    let mut section =
        [[from, GAP], [to, GAP], [to, edge(to)], [from, edge(from)]].map(|[x, y]| [side * x, y]);
    if side < 0.0 {
        section.reverse();
    }
    m.prism(&section, [SIDE - PARAPET, SIDE - GAP], 1.0, palette.stone);
    tondo(m, palette, DVec3::new(side * 0.5 * (from + to), 2.1, SIDE - GAP));
    let top = |x: f64| DVec3::new(side * x, edge(x), SIDE - 0.5 * PARAPET);
    m.add(&balustrade::between(palette, top(from), top(to)), DAffine3::IDENTITY);

    // At the end of the balustrade on the gallery.
    let end = columns::pedestal(palette, 1.2);
    m.add_at(&end, side * (EDGE + PEDESTAL + 0.035), GALLERY + GAP, SIDE - PEDESTAL - 0.035);
}

/// Adds a marble panel with a round bronze shield in front of a wall that faces `+z`.
fn tondo(m: &mut Model, palette: &Palette, place: DVec3) {
    let mut panel = Model::default();
    panel.block([-1.05, -1.25, 2.0 * GAP], [1.05, 1.25, 0.05], 0.7, palette.verde);
    for side in [-1.0, 1.0] {
        let (a, b) = (side * (1.05 + GAP), side * 1.2);
        panel.block([a.min(b), -1.4, 2.0 * GAP], [a.max(b), 1.4, 0.09], 0.7, palette.pale);
        let (a, b) = (side * (1.25 + GAP), side * 1.4);
        panel.block([-1.05, a.min(b), 2.0 * GAP], [1.05, a.max(b), 0.09], 0.7, palette.pale);
    }
    let mut shield = Model::default();
    let profile = [
        [0.74, 0.0],
        [0.78, 0.06],
        [0.70, 0.09],
        [0.64, 0.05],
        [0.46, 0.07],
        [0.28, 0.15],
        [0.10, 0.19],
        [0.04, 0.27],
    ];
    shield.lathe(&profile, 28, palette.bronze);
    // The axis of the lathe becomes z.
    panel.add(&shield, DAffine3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y, DVec3::new(0.0, 0.0, 0.05 + GAP)));
    m.add(&panel, DAffine3::from_translation(place));
}

/// Adds a square pier with a cap from the floor to a height.
fn pier(m: &mut Model, palette: &Palette, [x, z]: [f64; 2], height: f64) {
    let mut slab = |half: f64, low: f64, high: f64| {
        m.block([x - half, low, z - half], [x + half, high, z + half], 0.6, palette.pale);
    };
    slab(PIER, GAP, height - 0.10 - GAP);
    slab(PIER + 0.035, height - 0.10, height);
}

/// Returns the distance from the middle, the height and the position `z` of two piers: at the corner of the landing and
/// at the foot.
fn piers() -> [[f64; 3]; 2] {
    let x = FLIGHT + PIER;
    [[x, LANDING + RISER + 1.42, SIDE - PARAPET + PIER], [x, RISER + 1.30, FOOT + PIER + GAP]]
}

/// Returns the positions of lamps on the tops of the piers.
pub(super) fn pier_tops() -> impl Iterator<Item = DVec3> {
    piers().into_iter().flat_map(|[x, y, z]| [-1.0, 1.0].map(|side| DVec3::new(side * x, y + GAP, z)))
}
