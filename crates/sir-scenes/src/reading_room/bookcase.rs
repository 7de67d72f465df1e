//! Bookcases with books, books on tables, and a ladder.

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::random::Random;
use crate::reading_room::palette::Palette;

/// Thickness of boards \[m\].
const BOARD: f64 = 0.035;

/// Bookcase, open at the front.
///
/// Its left rear corner stands on the origin, its front faces `+z`, and its width is along `x`.
#[derive(Clone, Copy)]
pub(super) struct Bookcase {
    pub(super) width: f64,
    pub(super) depth: f64,
    /// Height without the cornice.
    pub(super) height: f64,
    /// Number of stacks side by side.
    pub(super) stacks: usize,
    /// Number of shelves per stack.
    pub(super) shelves: usize,
}

impl Bookcase {
    /// Returns the bookcase filled with books.
    pub(super) fn build(&self, palette: &Palette, random: &mut Random) -> Model {
        let mut m = Model::default();
        let wood = palette.walnut;
        let Self { width, depth, height, .. } = *self;
        let (base, back) = (0.1, 0.02);
        m.block([0.0, 0.0, 0.0], [width, base, depth], 0.8, wood);
        m.block([0.0, base + GAP, 0.0], [width, height - BOARD - GAP, back], 0.8, wood);
        m.block([0.0, height - BOARD, 0.0], [width, height, depth], 0.8, wood);
        self.cornice(&mut m, palette);

        let stack = (width - BOARD) / self.stacks as f64;
        for i in 0..=self.stacks {
            let x = stack * i as f64;
            let top = height - BOARD - GAP;
            m.block([x, base + GAP, back + GAP], [x + BOARD, top, depth], 0.8, wood);
        }
        let pitch = (height - BOARD - base) / self.shelves as f64;
        for i in 0..self.stacks {
            let left = stack * i as f64 + BOARD + GAP;
            let right = stack * (i + 1) as f64 - GAP;
            for j in 0..self.shelves {
                let mut floor = base + pitch * j as f64;
                if j > 0 {
                    m.block([left, floor - BOARD, back + GAP], [right, floor, depth - 0.01], 0.8, wood);
                }
                floor += GAP;
                let clear = pitch - BOARD - 2.0 * GAP;
                let books =
                    row_of_books(palette, random, right - left - 2.0 * GAP, clear, depth - back - 0.02);
                m.add_at(&books, left + GAP, floor, back + 0.01);
            }
        }
        m
    }

    /// Adds a molding on top.
    fn cornice(&self, m: &mut Model, palette: &Palette) {
        let (y, out) = (self.height + GAP, 0.04);
        let mut turned = Model::default();
        // Section seen along the case; x is the depth.
        let section = [
            [0.0, 0.0],
            [self.depth, 0.0],
            [self.depth + 0.01, 0.03],
            [self.depth + out, 0.07],
            [self.depth + out, 0.10],
            [0.0, 0.10],
        ];
        turned.prism(&section, [-out, self.width + out], 0.6, palette.walnut);
        // The section's x becomes z and the prism's z becomes −x, from the far end of the case.
        let turn = DAffine3::from_cols(DVec3::Z, DVec3::Y, -DVec3::X, DVec3::new(self.width, y, 0.0));
        m.add(&turned, turn);
    }
}

/// Returns books that fill a space of the given width, height and depth from the origin, with their spines at the
/// front.
fn row_of_books(palette: &Palette, random: &mut Random, width: f64, height: f64, depth: f64) -> Model {
    let mut m = Model::default();
    let mut x = 0.0;
    while x < width {
        let rest = width - x;
        let kind = random.unit();
        if kind < 0.05 && rest > 0.45 {
            x += pile(&mut m, palette, random, x, height, depth);
        } else if kind < 0.13 && rest > 0.3 {
            x += leaning_book(&mut m, palette, random, x, height, depth);
        } else if kind < 0.16 && rest < 0.5 * width {
            x += random.between(0.05, 0.2);
        } else {
            x += run(&mut m, palette, random, x, rest, height, depth);
        }
    }
    m
}

fn cover(palette: &Palette, random: &mut Random) -> MaterialId {
    palette.books[random.below(palette.books.len())]
}

/// Adds a few upright books of one kind. Returns the width used.
fn run(
    m: &mut Model,
    palette: &Palette,
    random: &mut Random,
    from: f64,
    width: f64,
    height: f64,
    depth: f64,
) -> f64 {
    let (mut material, tall) = (cover(palette, random), random.between(0.68, 0.93) * height);
    let thick = random.between(0.030, 0.066);
    let deep = random.between(0.60, 0.85) * depth;
    // Volumes of one edition have the same size and cover; other books differ.
    let (edition, count) = (random.unit() < 0.4, 2 + random.below(7));
    let mut used = 0.0;
    for _ in 0..count {
        let vary = if edition { 0.0 } else { 1.0 };
        let t = thick * (1.0 + 0.35 * vary * random.between(-1.0, 1.0));
        if used + t + GAP > width {
            return width;
        }
        let h = (tall * (1.0 + 0.09 * vary * random.between(-1.0, 1.0))).min(0.97 * height);
        let spine = depth - random.between(0.004, 0.012) - 0.02 * vary * random.unit();
        let x = from + used;
        m.block([x, 0.0, spine - deep], [x + t, h, spine], 1.0, material);
        used += t + 1.5 * GAP;
        if !edition {
            material = cover(palette, random);
        }
    }
    used
}

/// Adds a book that leans to the left. Returns the width used.
fn leaning_book(
    m: &mut Model,
    palette: &Palette,
    random: &mut Random,
    from: f64,
    height: f64,
    depth: f64,
) -> f64 {
    let (h, t, angle) = (0.8 * height, random.between(0.03, 0.05), random.between(0.12, 0.25));
    let mut book = Model::default();
    let front = depth - 0.02;
    book.block([0.0, 0.0, 0.25 * depth], [t, h, front], 1.0, cover(palette, random));
    let foot = DVec3::new(from + h * angle.sin() + 2.0 * GAP, 0.0, 0.0);
    m.add(&book, DAffine3::from_translation(foot) * DAffine3::from_rotation_z(angle));
    h * angle.sin() + t * angle.cos() + 4.0 * GAP
}

/// Adds a pile of lying books. Returns the width used.
fn pile(m: &mut Model, palette: &Palette, random: &mut Random, from: f64, height: f64, depth: f64) -> f64 {
    let width = random.between(0.26, 0.32);
    let mut y = 0.0;
    for _ in 0..2 + random.below(4) {
        let t = random.between(0.03, 0.055);
        if y + t > 0.9 * height {
            break;
        }
        let w = width - random.between(0.0, 0.05);
        let front = depth - random.between(0.01, 0.03);
        m.block([from, y, 0.2 * depth], [from + w, y + t, front], 1.0, cover(palette, random));
        y += t + GAP;
    }
    width + 5.0 * GAP
}

/// Returns a pile of books and an open book for a table, on the origin, about 0.5 m wide.
pub(super) fn books_on_table(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let mut y = 0.0;
    for _ in 0..1 + random.below(3) {
        let t = random.between(0.025, 0.05);
        let mut book = Model::default();
        book.block([-0.09, 0.0, -0.12], [0.09, t, 0.12], 1.0, cover(palette, random));
        let turn = DAffine3::from_rotation_y(random.between(-0.4, 0.4));
        m.add(&book, DAffine3::from_translation(DVec3::new(-0.2, y, 0.0)) * turn);
        y += t + GAP;
    }
    // Two stacks of pages that rise toward the fold, on an open cover.
    let page = [[0.0, 0.006], [0.15, 0.006], [0.15, 0.016], [0.10, 0.028], [0.04, 0.034], [0.0, 0.022]];
    let mut open = Model::default();
    open.block([-0.16, 0.0, -0.12], [0.16, 0.005, 0.12], 1.0, cover(palette, random));
    let left: Vec<[f64; 2]> = page.iter().rev().map(|[x, y]| [-x - 0.5 * GAP, *y]).collect();
    let right = page.map(|[x, y]| [x + 0.5 * GAP, y]);
    open.prism(&right, [-0.11, 0.11], 1.0, palette.paper);
    open.prism(&left, [-0.11, 0.11], 1.0, palette.paper);
    m.add_at(&open, 0.12, 0.0, 0.0);
    m
}

/// Returns a ladder of the given height with its feet at the origin. Its upper end leans toward `−z` by `reach`.
pub(super) fn ladder(palette: &Palette, height: f64, reach: f64) -> Model {
    let mut upright = Model::default();
    let (half, length) = (0.22, (height * height + reach * reach).sqrt());
    for side in [-1.0, 1.0] {
        let x = side * half;
        upright.block([x - 0.02, 0.0, -0.03], [x + 0.02, length, 0.03], 0.6, palette.oak);
    }
    for y in lines(0.3, length - 0.25, 0.3) {
        let x = half - 0.02 - GAP;
        upright.block([-x, y, -0.02], [x, y + 0.03, 0.02], 1.0, palette.oak);
    }
    let mut m = Model::default();
    m.add(&upright, DAffine3::from_rotation_x(-(reach / height).atan()));
    m
}
