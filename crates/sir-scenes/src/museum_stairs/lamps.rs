//! Lamps: sconces on the walls, globes on the piers of the stair, strips in the great niche.

use glam::{DAffine3, DVec3};

use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::shell::APSE;
use crate::museum_stairs::size::{DOOR_COLUMN, GALLERY, HALF_WIDTH, LENGTH, column_places};
use crate::museum_stairs::stair;

/// Returns all lamps except those on the cornice and in the vitrines.
pub(super) fn lamps(palette: &Palette) -> Model {
    let mut m = Model::default();
    let sconce = sconce(palette);
    // On the pilasters of both floors.
    for z in column_places() {
        for y in [2.55, GALLERY + 2.35] {
            for side in [-1.0, 1.0] {
                m.add_at(&sconce, side * (HALF_WIDTH - 0.36), y, z);
            }
        }
    }
    for x in [-DOOR_COLUMN, DOOR_COLUMN] {
        for y in [2.55, GALLERY + 2.35] {
            m.add_at(&sconce, x, y, LENGTH - 0.26);
        }
    }
    let globe = standing_globe(palette);
    for top in stair::pier_tops() {
        m.add(&globe, DAffine3::from_translation(top));
    }
    niche_frame(&mut m, palette);
    m
}

/// Returns an opaque bowl about the origin with a lamp inside that shines upward.
fn sconce(palette: &Palette) -> Model {
    let mut m = Model::default();
    let bowl = [
        [0.020, -0.15],
        [0.110, -0.07],
        [0.150, 0.01],
        [0.160, 0.03],
        [0.145, 0.03],
        [0.095, -0.055],
        [0.020, -0.09],
    ];
    m.turned_ring(&bowl, 10, |_| palette.gold);
    let lit = |d: DVec3, _| if d.y > 0.0 { palette.bulb } else { palette.iron };
    m.grid_block([&[-0.045, 0.045], &[-0.045, -0.025], &[-0.045, 0.045]], lit);
    m
}

/// Returns a globe on a bronze stand, on the origin.
fn standing_globe(palette: &Palette) -> Model {
    let mut m = Model::default();
    let stand = [
        [0.13, 0.0],
        [0.13, 0.03],
        [0.07, 0.06],
        [0.035, 0.12],
        [0.055, 0.20],
        [0.022, 0.52],
        [0.045, 0.56],
        [0.075, 0.60],
        [0.080, 0.62],
    ];
    m.lathe(&stand, 12, palette.bronze);
    let (radius, middle, bands) = (0.16, 0.62 + 0.16 + GAP, 4);
    let profile: Vec<[f64; 2]> = (0..=bands)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / f64::from(bands)).sin_cos();
            [if i % bands == 0 { 0.0 } else { radius * sin }, middle - radius * cos]
        })
        .collect();
    m.lathe(&profile, 10, palette.globe);
    m
}

/// Adds pillars and an arch around the great niche, and the light strips behind them.
fn niche_frame(m: &mut Model, palette: &Palette) {
    let (inner, outer) = (APSE.radius - 0.11, APSE.radius + 0.26);
    // The ledge rises above the floor of the niche and hides the gap behind it.
    let (foot, lip) = (APSE.sill - 0.25, APSE.sill + 0.03);
    m.block([-outer - 0.1, foot, GAP], [outer + 0.1, lip, 0.24], 0.5, palette.pale);
    for side in [-1.0, 1.0] {
        let mut post = |near: f64, far: f64, y: [f64; 2], z: [f64; 2], cell: f64, material| {
            let (a, b) = (side * near, side * far);
            m.block([a.min(b), y[0], z[0]], [a.max(b), y[1], z[1]], cell, material);
        };
        post(inner, outer, [lip + GAP, APSE.spring - 0.16 - GAP], [GAP, 0.14], 0.6, palette.pale);
        post(
            inner - 0.03,
            outer + 0.04,
            [APSE.spring - 0.16, APSE.spring - GAP],
            [GAP, 0.18],
            0.6,
            palette.pale,
        );
        let strip = [APSE.radius - 0.05, APSE.radius - 0.01];
        post(
            strip[0],
            strip[1],
            [APSE.sill + 0.15, APSE.spring - 0.2],
            [-0.065, -0.025],
            3.0,
            palette.niche_lamp,
        );
    }
    let segments = 20;
    let arc = |r: f64| {
        (0..=segments).map(move |i| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / f64::from(segments)).sin_cos();
            [r * cos, APSE.spring + r * sin]
        })
    };
    let section: Vec<[f64; 2]> = arc(outer).chain(arc(inner).rev()).collect();
    m.prism(&section, [GAP, 0.14], 1.0, palette.pale);
    let section: Vec<[f64; 2]> = arc(outer + 0.08).chain(arc(outer + GAP).rev()).collect();
    m.prism(&section, [GAP, 0.18], 1.0, palette.gold);
}
