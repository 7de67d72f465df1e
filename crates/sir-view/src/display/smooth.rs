//! Continuity of surfaces, and the irradiance that continuous surfaces share.
//!
//! Around each piece of an edge, the triangles that meet there are sorted by angle. A side continues on the first side
//! that it faces, if there is an empty angle of nearly 180° between the two. The two halves of a ceiling are therefore
//! one surface, unless a wall between them meets them in this edge; front and back of a sheet never are; and light does
//! not bleed around a crease.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sir_geom::{Rgb, Scene, Side, TriangleId};

/// Largest deviation from 180° at which a surface continues smoothly \[rad\].
const CREASE: f64 = PI / 6.0;

/// Difference of angles about an edge below which triangles cover each other \[rad\]. It is the angle up to which the
/// tracer treats surfaces as parallel.
const SAME_SHEET: f64 = 1e-3;

/// A piece of an edge of one polygon.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgePiece {
    /// End with the smaller point number.
    low: u32,
    high: u32,
    /// Nodes at the low and the high end, numbered over all polygons.
    nodes: [u32; 2],
    triangle: u32,
    /// True if the polygon runs from the low to the high end.
    forward: bool,
}

impl EdgePiece {
    /// Creates the piece of a polygon in the plane of a triangle from one node to the next; each is a pair (point, node).
    pub(super) fn new(triangle: TriangleId, from: (u32, u32), to: (u32, u32)) -> Self {
        let forward = from.0 < to.0;
        let (low, high) = if forward { (from, to) } else { (to, from) };
        Self { low: low.0, high: high.0, nodes: [low.1, high.1], triangle: triangle.0, forward }
    }
}

/// Disjoint sets (union-find) of pairs (node, side) that share one irradiance, with the sums that determine it.
pub(super) struct Groups {
    parents: Vec<u32>,
    /// Weighted mean of the irradiance in three bands, and sum of weights. Means of equal values are exact.
    means: Vec<[f32; 4]>,
    has_corner: Vec<bool>,
    /// Sides per node: 1 if no surface has an active back.
    sides: usize,
}

impl Groups {
    pub(super) fn new(nodes: usize, sides: usize) -> Self {
        let count = nodes * sides;
        Self {
            parents: (0..count as u32).collect(),
            means: vec![[0.0; 4]; count],
            has_corner: vec![false; count],
            sides,
        }
    }

    fn slot(&self, node: u32, side: Side) -> usize {
        self.sides * node as usize + usize::from(side == Side::Back)
    }

    /// Adds the irradiance of a patch at a node of its polygon, which is a corner or lies on an edge.
    pub(super) fn add(&mut self, node: u32, side: Side, irradiance: Rgb, weight: f64, is_corner: bool) {
        let slot = self.slot(node, side);
        let [r, g, b] = irradiance.to_array();
        self.add_to(slot, [r, g, b, weight].map(|x| x as f32), is_corner);
    }

    fn add_to(&mut self, slot: usize, more: [f32; 4], has_corner: bool) {
        let [r, g, b, weight] = more;
        let mean = &mut self.means[slot];
        mean[3] += weight;
        // Without weight there is nothing to add.
        let share = if weight > 0.0 { weight / mean[3] } else { 0.0 };
        mean.iter_mut().zip([r, g, b]).for_each(|(mean, more)| *mean += share * (more - *mean));
        self.has_corner[slot] |= has_corner;
    }

    /// Unites the sides that continue each other, and adds up their sums.
    pub(super) fn join(&mut self, scene: &Scene, points: &[DVec3], pieces: &mut [EdgePiece]) {
        pieces.sort_unstable();
        let mut sheets = Vec::new();
        for around in pieces.chunk_by(|x, y| (x.low, x.high) == (y.low, y.high)) {
            if around.len() > 1 {
                let along = points[around[0].high as usize] - points[around[0].low as usize];
                sheets_around(scene, along, around, &mut sheets);
                self.join_sheets(scene, &sheets);
            }
        }
        for i in 0..self.parents.len() {
            let root = self.root(i);
            if root != i {
                self.add_to(root, self.means[i], self.has_corner[i]);
            }
        }
    }

    /// Unites sides that face each other across a gap of nearly 180° between neighboring sheets.
    fn join_sheets(&mut self, scene: &Scene, sheets: &[Sheet]) {
        for (i, sheet) in sheets.iter().enumerate() {
            let next = &sheets[(i + 1) % sheets.len()];
            let gap = (next.angle - sheet.angle).rem_euclid(TAU);
            if (gap - PI).abs() <= CREASE {
                self.unite(scene, sheet.rising, next.falling);
            }
        }
    }

    fn unite(&mut self, scene: &Scene, (a, side_a): (EdgePiece, Side), (b, side_b): (EdgePiece, Side)) {
        let is_active = |p: EdgePiece, side| scene.is_active(TriangleId(p.triangle), side);
        if is_active(a, side_a) && is_active(b, side_b) {
            for end in 0..2 {
                let (x, y) =
                    (self.root(self.slot(a.nodes[end], side_a)), self.root(self.slot(b.nodes[end], side_b)));
                // The smallest number is the root, regardless of the order of the calls.
                self.parents[x.max(y)] = x.min(y) as u32;
            }
        }
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.parents[i] as usize != i {
            self.parents[i] = self.parents[self.parents[i] as usize];
            i = self.parents[i] as usize;
        }
        i
    }

    /// Returns the number of set numbers, most of which are unused.
    pub(super) fn len(&self) -> usize {
        self.parents.len()
    }

    /// Returns the number of the set of a node and a side, and its irradiance. The irradiance is `None` if no patch of
    /// the set has a corner there, so that the node only divides an edge.
    pub(super) fn find(&mut self, node: u32, side: Side) -> (usize, Option<Rgb>) {
        let root = self.root(self.slot(node, side));
        let [r, g, b, _] = self.means[root].map(f64::from);
        (root, self.has_corner[root].then(|| Rgb::new(r, g, b)))
    }
}

/// Contents of one half-plane of an edge: a triangle, or several that cover each other.
#[derive(Clone, Copy)]
struct Sheet {
    /// Angle of the half-plane about the edge \[rad\].
    angle: f64,
    /// Uppermost triangle and its side, seen from larger angles.
    rising: (EdgePiece, Side),
    /// The same, seen from smaller angles.
    falling: (EdgePiece, Side),
}

impl Sheet {
    fn new(angle: f64, piece: EdgePiece) -> Self {
        // A triangle that runs forward shows its front in the direction of increasing angle.
        let side = if piece.forward { Side::Front } else { Side::Back };
        Self { angle, rising: (piece, side), falling: (piece, side.flip()) }
    }

    /// Adds a triangle in the same half-plane. Of triangles that cover each other, light meets only one: the last that
    /// shows its front, otherwise the first (the rule of [`sir_accel::Hit`]). The others stay dark and must not darken
    /// their neighbors.
    fn cover(&mut self, other: &Self) {
        let upper = |a: (EdgePiece, Side), b: (EdgePiece, Side)| match (a.1, b.1) {
            (Side::Front, Side::Back) => a,
            (Side::Back, Side::Front) => b,
            (Side::Front, Side::Front) => {
                if a.0.triangle > b.0.triangle {
                    a
                } else {
                    b
                }
            }
            (Side::Back, Side::Back) => {
                if a.0.triangle < b.0.triangle {
                    a
                } else {
                    b
                }
            }
        };
        self.rising = upper(self.rising, other.rising);
        self.falling = upper(self.falling, other.falling);
    }
}

/// Collects the sheets around an edge, sorted by angle from the first triangle.
fn sheets_around(scene: &Scene, along: DVec3, around: &[EdgePiece], sheets: &mut Vec<Sheet>) {
    let inward = |p: &EdgePiece| {
        let m = scene.normal(TriangleId(p.triangle)).cross(along);
        if p.forward { m } else { -m }
    };
    let x = inward(&around[0]);
    let y = along.normalize_or_zero().cross(x);
    sheets.clear();
    sheets.extend(around.iter().map(|p| {
        let m = inward(p);
        let angle = m.dot(y).atan2(m.dot(x));
        // A triangle that covers the first one must not be separated from it because its angle is rounded to below
        // zero.
        Sheet::new(if angle < -SAME_SHEET { angle + TAU } else { angle }, *p)
    }));
    sheets.sort_unstable_by(|a, b| a.angle.total_cmp(&b.angle).then(a.rising.0.cmp(&b.rising.0)));
    sheets.dedup_by(|next, sheet| {
        let same = next.angle - sheet.angle < SAME_SHEET;
        if same {
            sheet.cover(next);
        }
        same
    });
}
