//! Statues on plinths, vases and benches.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::sculptor::{Figure, bust, figure};
use crate::museum_stairs::shell::{APSE, SMALL};
use crate::museum_stairs::size::{EDGE, FOOT, GALLERY, HALF_WIDTH, LENGTH, bay_middles};

/// Returns all statues.
pub(super) fn statues(palette: &Palette) -> Model {
    let mut m = Model::default();
    // Victory in the great niche.
    let plinth = 0.55;
    let z = -0.36;
    plinth_at(&mut m, palette.verde, [0.0, APSE.sill + GAP, z], [0.5, plinth]);
    let victory = carved(palette.marble, Figure::Victory, 0.0457);
    let place = DVec3::new(0.0, APSE.sill + plinth + 2.0 * GAP, z);
    m.add(
        &victory,
        DAffine3::from_scale_rotation_translation(DVec3::splat(1.32), glam::DQuat::IDENTITY, place),
    );

    // Two water bearers beside the foot of the stair.
    let bearer = carved(palette.marble, Figure::WaterBearer, 0.0553);
    for side in [-1.0, 1.0] {
        let place = [side * 3.9, GAP, FOOT - 1.7];
        plinth_at(&mut m, palette.verde, place, [0.45, 0.9]);
        let foot = DVec3::new(place[0], 0.9 + 2.0 * GAP, place[2]);
        let turn = DAffine3::from_translation(foot) * DAffine3::from_rotation_y(-0.35 * side);
        m.add(&bearer, turn * DAffine3::from_scale(DVec3::splat(1.12)));
    }
    busts(&mut m, palette);

    // Abstract works on the floor of the hall and on the gallery.
    let knot = knot(palette.bronze);
    plinth_at(&mut m, palette.rosso, [-2.75, GAP, 11.4], [0.55, 0.8]);
    m.add_at(&knot, -2.75, 0.8 + 2.0 * GAP, 11.4);
    plinth_at(&mut m, palette.rosso, [2.75, GAP, 11.4], [0.45, 0.7]);
    m.add_at(&twisted(palette.verdigris), 2.75, 0.7 + 2.0 * GAP, 11.4);
    for side in [-1.0, 1.0] {
        let place = [side * (HALF_WIDTH - 0.95), GALLERY + GAP, LENGTH - 0.95];
        plinth_at(&mut m, palette.verde, place, [0.3, 0.9]);
        m.add_at(&krater(palette), place[0], place[1] + 0.9 + GAP, place[2]);
    }
    m
}

/// Adds busts and amphorae in the niches of the side walls.
fn busts(m: &mut Model, palette: &Palette) {
    let mut carved = Model::default();
    let bounds = [DVec3::new(-0.2555, -0.0431, -0.2407), DVec3::new(0.27, 0.74, 0.26)];
    carved.carve(bounds, 0.0291, bust, |_| palette.marble);
    let mut on_foot = Model::default();
    let foot = [[0.13, 0.0], [0.13, 0.03], [0.08, 0.06], [0.065, 0.12], [0.10, 0.16], [0.10, 0.18]];
    on_foot.lathe(&foot, 16, palette.rosso);
    on_foot.add_at(&carved, 0.0, 0.18, 0.0);
    for (i, z) in bay_middles().enumerate() {
        for side in [-1.0, 1.0] {
            let x = side * (HALF_WIDTH + 0.5 * SMALL.depth - 0.02);
            let y = SMALL.sill + GAP;
            if (i + usize::from(side > 0.0)) % 3 == 0 {
                plinth_at(m, palette.pale, [x, y, z], [0.19, 0.42]);
                let place = DAffine3::from_translation(DVec3::new(x, y + 0.42 + GAP, z));
                m.add(&on_foot, place * DAffine3::from_rotation_y(-side * 0.5 * PI));
            } else {
                m.add_at(&amphora(palette.clay, palette.glaze, 1.45), x, y, z);
            }
        }
    }
}

/// Adds a plinth of the given half width and height, with a base and a cap.
fn plinth_at(m: &mut Model, material: MaterialId, [x, y, z]: [f64; 3], [half, height]: [f64; 2]) {
    let mut slab = |half: f64, low: f64, high: f64| {
        m.block([x - half, y + low, z - half], [x + half, y + high, z + half], 0.6, material);
    };
    let band = 0.12 * height;
    slab(half, 0.0, band);
    slab(0.88 * half, band + GAP, height - band - GAP);
    slab(half, height - band, height);
}

fn carved(material: MaterialId, kind: Figure, cell: f64) -> Model {
    let mut m = Model::default();
    let (low, high) = match kind {
        Figure::Victory => (DVec3::new(-1.1113, -0.0531, -0.6117), DVec3::new(1.15, 2.45, 0.56)),
        Figure::WaterBearer => (DVec3::new(-0.5113, -0.0531, -0.5117), DVec3::new(0.56, 2.25, 0.56)),
    };
    m.carve([low, high], cell, |p| figure(p, kind), |_| material);
    m
}

/// Returns a trefoil knot above the origin that stands on the lowest point of its tube.
fn knot(material: MaterialId) -> Model {
    let mut m = Model::default();
    let (rings, columns, tube) = (96, 10, 0.115);
    let curve = |t: f64| {
        let r = 0.46 + 0.21 * (3.0 * t).cos();
        DVec3::new(r * (2.0 * t).sin(), r * (2.0 * t).cos(), 0.27 * (3.0 * t).sin())
    };
    let point = |i: usize, j: usize| {
        let t = TAU * i as f64 / rings as f64;
        let along = (curve(t + 1e-4) - curve(t - 1e-4)).normalize();
        let side = along.cross(DVec3::Z).normalize();
        let up = side.cross(along);
        let (sin, cos) = (TAU * j as f64 / columns as f64).sin_cos();
        curve(t) + tube * (cos * side - sin * up)
    };
    let lowest = (0..rings * columns).map(|n| point(n / columns, n % columns).y).fold(0.0, f64::min);
    m.endless_loft(rings, columns, |i, j| point(i, j) - lowest * DVec3::Y, material);
    m
}

/// Returns a slender twisted solid that tapers to a blade, on the origin.
fn twisted(material: MaterialId) -> Model {
    let mut m = Model::default();
    let (rows, columns, height) = (32, 24, 2.2);
    m.loft(
        rows,
        columns,
        |i, j| {
            let t = i as f64 / (rows - 1) as f64;
            let angle = TAU * j as f64 / columns as f64;
            let (lobes, swell) = (0.34 * (3.0 * angle).cos(), 0.24 + 0.10 * (PI * t).sin() - 0.13 * t);
            let r = swell * (1.0 + lobes);
            let (sin, cos) = (angle + 3.6 * t).sin_cos();
            let lean = 0.12 * (TAU * t).sin();
            DVec3::new(r * cos + lean, height * t, -r * sin)
        },
        |_, _| material,
    );
    m
}

/// Returns a krater (a bowl for mixing wine), on the origin.
fn krater(palette: &Palette) -> Model {
    let mut m = Model::default();
    let outside = [
        [0.20, 0.0],
        [0.20, 0.04],
        [0.09, 0.09],
        [0.08, 0.18],
        [0.16, 0.24],
        [0.26, 0.34],
        [0.29, 0.44],
        [0.26, 0.62],
        [0.27, 0.76],
        [0.36, 0.86],
    ];
    let inside = [[0.33, 0.86], [0.24, 0.75], [0.23, 0.62], [0.25, 0.44], [0.0, 0.34]];
    let profile: Vec<[f64; 2]> = outside.into_iter().chain(inside).collect();
    m.lathe(&profile, 28, palette.celadon);
    m
}

/// Returns an amphora with painted bands, `size` times 0.62 m high, on the origin.
pub(super) fn amphora(body: MaterialId, band: MaterialId, size: f64) -> Model {
    let mut m = Model::default();
    let outline = [
        [0.075, 0.0, 0.0],
        [0.085, 0.015, 0.0],
        [0.045, 0.045, 0.0],
        [0.075, 0.12, 0.0],
        [0.130, 0.22, 0.0],
        [0.165, 0.32, 1.0],
        [0.160, 0.41, 0.0],
        [0.110, 0.47, 0.0],
        [0.060, 0.50, 1.0],
        [0.052, 0.56, 0.0],
        [0.082, 0.60, 1.0],
        [0.085, 0.62, 1.0],
        [0.060, 0.62, 1.0],
        [0.040, 0.55, 1.0],
    ];
    let columns = 16;
    m.loft(
        outline.len(),
        columns,
        |i, j| {
            let [r, y, _] = outline[i];
            let (sin, cos) = (TAU * j as f64 / columns as f64).sin_cos();
            size * DVec3::new(r * cos, y, -r * sin)
        },
        |i, _| if outline[i][2] > 0.5 { band } else { body },
    );
    m
}

/// Returns the benches on the floor along the gallery's edge.
pub(super) fn benches(palette: &Palette) -> Model {
    let mut m = Model::default();
    for (side, places) in [(-1.0, [11.0, 15.0]), (1.0, [12.9, 15.4])] {
        for z in places {
            let x = side * (EDGE - 0.95);
            m.block([x - 0.22, 0.40, z - 0.9], [x + 0.22, 0.47, z + 0.9], 0.6, palette.dark_wood);
            m.block([x - 0.2, 0.47 + GAP, z - 0.88], [x + 0.2, 0.53, z + 0.88], 0.6, palette.leather);
            for end in lines(z - 0.7, z + 0.7, 1.4) {
                m.block([x - 0.19, GAP, end - 0.07], [x + 0.19, 0.40 - GAP, end + 0.07], 0.6, palette.pale);
            }
        }
    }
    m
}
