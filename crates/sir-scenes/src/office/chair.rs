//! Office chairs, and the chairs of the meeting table.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3};

use crate::model::pillow::Ends;
use crate::model::{GAP, Model};
use crate::office::palette::Palette;

/// Returns a swivel chair on the origin that faces `−z`.
pub(super) fn swivel_chair(palette: &Palette) -> Model {
    let mut m = Model::default();
    for i in 0..5 {
        let mut foot = Model::default();
        let section = [[0.036, 0.075], [0.29, 0.055], [0.29, 0.075], [0.036, 0.105]];
        foot.prism(&section, [-0.018, 0.018], 9.0, palette.dark);
        foot.block([0.262, 0.002, -0.02], [0.312, 0.054 - GAP, 0.02], 9.0, palette.dark);
        m.add(&foot, DAffine3::from_rotation_y(TAU * (f64::from(i) + 0.25) / 5.0));
    }
    m.lathe(&[[0.034, 0.065], [0.034, 0.11], [0.022, 0.13], [0.022, 0.40]], 12, palette.dark);
    m.block([-0.11, 0.40 + GAP, -0.12], [0.11, 0.43, 0.30], 9.0, palette.dark);
    let seat = Ends { radius: 0.03, pieces: 2, cell: 9.0, cut: 0.018 };
    let section = [[-0.24, 0.43 + GAP], [0.24, 0.43 + GAP], [0.24, 0.50], [-0.24, 0.50]];
    m.pillow(&section, [-0.25, 0.22], seat, |_| palette.seat);
    // The back stands behind the seat and leans back a little.
    let mut back = Model::default();
    let rounded = Ends { radius: 0.02, pieces: 2, cell: 9.0, cut: 0.05 };
    back.pillow(&[[-0.22, 0.0], [0.22, 0.0], [0.21, 0.50], [-0.21, 0.50]], [0.0, 0.05], rounded, |_| {
        palette.seat
    });
    back.block([-0.03, -0.18, 0.05 + GAP], [0.03, 0.30, 0.068], 9.0, palette.dark);
    let lean = DAffine3::from_translation(DVec3::new(0.0, 0.62, 0.245)) * DAffine3::from_rotation_x(0.12);
    m.add(&back, lean);
    for side in [-1.0, 1.0] {
        let x = side * 0.275;
        m.block([x - 0.012, 0.42, -0.03], [x + 0.012, 0.64, 0.03], 9.0, palette.dark);
        let (inner, outer) = (side * (0.24 + GAP), side * (0.263 - GAP));
        m.block([inner.min(outer), 0.445, -0.025], [inner.max(outer), 0.465, 0.025], 9.0, palette.dark);
        m.block([x - 0.03, 0.64 + GAP, -0.14], [x + 0.03, 0.662, 0.10], 9.0, palette.dark);
    }
    m
}

/// Returns a chair with four legs on the origin that faces `−z`.
pub(super) fn plain_chair(palette: &Palette) -> Model {
    let mut m = Model::default();
    for x in [-0.19, 0.19] {
        m.block([x - 0.011, 0.0, -0.20], [x + 0.011, 0.44 - GAP, -0.178], 9.0, palette.dark);
        m.block([x - 0.011, 0.0, 0.19], [x + 0.011, 0.44 - GAP, 0.212], 9.0, palette.dark);
        m.block([x - 0.011, 0.44, 0.222], [x + 0.011, 0.70, 0.236], 9.0, palette.dark);
    }
    let rounded = Ends { radius: 0.012, pieces: 2, cell: 9.0, cut: 0.01 };
    let section = [[-0.215, 0.44], [0.215, 0.44], [0.215, 0.468], [-0.215, 0.468]];
    m.pillow(&section, [-0.22, 0.22 - GAP], rounded, |_| palette.meeting_seat);
    let section = [[-0.215, 0.52], [0.215, 0.52], [0.205, 0.82], [-0.205, 0.82]];
    m.pillow(&section, [0.195, 0.222 - GAP], Ends { cut: 0.03, ..rounded }, |_| palette.meeting_seat);
    m
}
