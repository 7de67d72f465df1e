//! Lattices: the square cells of flat surfaces.
//!
//! Each triangle of a surface has an affine map from its points to coordinates of the lattice, in which cell `(i, j)` is
//! the square from `(i, j)` to `(i + 1, j + 1)`. The cell of a hit follows from one such map. Cells on the rim of the
//! lattice reach to infinity, so that rounding cannot put a point outside.

use glam::DVec3;
use sir_geom::{Barycentric, TriangleId};

use crate::piece::Piece;

/// Columns and rows of a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) columns: u16,
    pub(crate) rows: u16,
}

impl Size {
    pub(crate) fn cells(self) -> u32 {
        u32::from(self.columns) * u32::from(self.rows)
    }
}

/// Position and axes of a lattice in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) origin: DVec3,
    /// Gradients of the two coordinates.
    pub(crate) axes: [DVec3; 2],
}

/// A triangle in the coordinates of a lattice, rounded to single precision, so that more of them stay in the cache. All
/// computations use the same rounded numbers, so that they agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// First corner.
    start: [f32; 2],
    /// Edges from the first corner to the second and to the third.
    edges: [[f32; 2]; 2],
}

/// A point of a triangle, with its coordinates in the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    at: [f64; 2],
    on: Barycentric,
}

/// The part of a triangle in one cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    pub(crate) cell: u32,
    /// The part of the triangle.
    pub(crate) piece: Piece,
    /// Lengths of the borders with the next column and with the next row, in widths of a cell.
    pub(crate) borders: [f64; 2],
}

/// A polygon with at most seven corners.
#[derive(Clone, Copy)]
struct Corners {
    points: [Point; 8],
    count: usize,
}

impl Corners {
    const NONE: Self =
        Self { points: [Point { at: [0.0; 2], on: Barycentric { v: 0.0, w: 0.0 } }; 8], count: 0 };

    fn push(&mut self, point: Point) {
        // A convex polygon gains at most one corner with each cut, but rounding may bend it a little.
        if self.count < self.points.len() {
            self.points[self.count] = point;
            self.count += 1;
        }
    }

    fn all(&self) -> &[Point] {
        &self.points[..self.count]
    }

    /// Returns the range of a coordinate.
    fn range(&self, axis: usize) -> (f64, f64) {
        let all = self.all().iter().map(|p| p.at[axis]);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    }

    /// Returns the part in which a coordinate is at most (`sign` = 1) or at least (−1) `limit`.
    fn cut(&self, axis: usize, limit: f64, sign: f64) -> Self {
        let mut kept = Self::NONE;
        for (i, &point) in self.all().iter().enumerate() {
            let next = self.points[(i + 1) % self.count];
            let [here, there] = [point, next].map(|p| sign * (p.at[axis] - limit));
            if here <= 0.0 {
                kept.push(point);
            }
            if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
                // The point of an edge is the same from both sides, whatever the rounding.
                let (a, b) = if here < 0.0 { (point, next) } else { (next, point) };
                kept.push(a.towards(b, axis, limit));
            }
        }
        kept
    }
}

impl Point {
    /// Returns the point on the way to another one at which a coordinate is `limit`.
    fn towards(self, other: Self, axis: usize, limit: f64) -> Self {
        let share = (limit - self.at[axis]) / (other.at[axis] - self.at[axis]);
        let mix = |a: f64, b: f64| a + share * (b - a);
        let mut at = [mix(self.at[0], other.at[0]), mix(self.at[1], other.at[1])];
        at[axis] = limit;
        Self { at, on: Barycentric { v: mix(self.on.v, other.on.v), w: mix(self.on.w, other.on.w) } }
    }
}

impl Placement {
    /// Placement in which all points are the origin.
    pub(crate) const NOWHERE: Self = Self { start: [0.0; 2], edges: [[0.0; 2]; 2] };

    /// Returns the placement of a triangle with these corners.
    pub(crate) fn new(frame: &Frame, corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners.map(|p| frame.axes.map(|axis| (p - frame.origin).dot(axis)));
        let to = |p: [f64; 2]| [(p[0] - a[0]) as f32, (p[1] - a[1]) as f32];
        Self { start: a.map(|x| x as f32), edges: [to(b), to(c)] }
    }

    /// Returns the coordinates of a point.
    #[inline]
    pub(crate) fn at(&self, p: Barycentric) -> [f64; 2] {
        let along = |axis: usize| {
            let [start, first, second] =
                [self.start[axis], self.edges[0][axis], self.edges[1][axis]].map(f64::from);
            start + p.v * first + p.w * second
        };
        [along(0), along(1)]
    }

    /// Returns the number of the cell in which a point lies.
    #[inline]
    pub(crate) fn cell_at(&self, size: Size, p: Barycentric) -> u32 {
        // A cast of a float to an integer saturates, so anything out of range is caught by `min`.
        let [x, y] = self.at(p).map(|x| x as u32);
        y.min(u32::from(size.rows) - 1) * u32::from(size.columns) + x.min(u32::from(size.columns) - 1)
    }

    /// Calls `visit` with the parts of the triangle in all cells that it meets.
    pub(crate) fn for_each_cell(&self, size: Size, triangle: TriangleId, mut visit: impl FnMut(Cut)) {
        let all = self.corners();
        let (low, high) = all.range(1);
        for row in range(low, high, size.rows) {
            let strip = between(&all, 1, row, size.rows);
            let (low, high) = strip.range(0);
            for column in range(low, high, size.columns) {
                let cell = between(&strip, 0, column, size.columns);
                visit_cell(&cell, size, [column, row], triangle, &mut visit);
            }
        }
    }

    /// Returns the part of the triangle in a cell; `None` if it has no area.
    pub(crate) fn piece_in(&self, size: Size, cell: u32, triangle: TriangleId) -> Option<Piece> {
        let (columns, mut found) = (u32::from(size.columns), None);
        let [column, row] = [cell % columns, cell / columns].map(|x| x as u16);
        if let Some(corners) = self.whole_cell(size, [column, row]) {
            return Some(Piece::new(triangle, &corners));
        }
        let strip = between(&self.corners(), 1, row, size.rows);
        let cell = between(&strip, 0, column, size.columns);
        visit_cell(&cell, size, [column, row], triangle, &mut |cut| found = Some(cut.piece));
        found
    }

    /// Returns the corners of a cell if the triangle covers all of it. This is faster than clipping.
    fn whole_cell(&self, size: Size, [column, row]: [u16; 2]) -> Option<[Barycentric; 4]> {
        // Cells on the rim of the lattice reach to infinity.
        let is_inner = |place: u16, count: u16| place > 0 && place + 1 < count;
        if !is_inner(column, size.columns) || !is_inner(row, size.rows) {
            return None;
        }
        let [[a, b], [c, d]] = self.edges.map(|edge| edge.map(f64::from));
        let inverse = 1.0 / (a * d - b * c);
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[right, up]| {
            let x = f64::from(column) + right - f64::from(self.start[0]);
            let y = f64::from(row) + up - f64::from(self.start[1]);
            Barycentric { v: (x * d - y * c) * inverse, w: (a * y - b * x) * inverse }
        });
        corners.iter().all(|p| p.v >= 0.0 && p.w >= 0.0 && p.v + p.w <= 1.0).then_some(corners)
    }

    fn corners(&self) -> Corners {
        let mut all = Corners::NONE;
        for on in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(v, w)| Barycentric { v, w }) {
            all.push(Point { at: self.at(on), on });
        }
        all
    }
}

/// Returns the cells that a range of coordinates meets.
fn range(low: f64, high: f64, count: u16) -> std::ops::RangeInclusive<u16> {
    let last = count - 1;
    (low.floor() as u16).min(last)..=(high.floor() as u16).min(last)
}

/// Returns the part of a polygon in a row or column.
fn between(polygon: &Corners, axis: usize, place: u16, count: u16) -> Corners {
    let mut part = *polygon;
    if place > 0 {
        part = part.cut(axis, f64::from(place), -1.0);
    }
    if place + 1 < count {
        part = part.cut(axis, f64::from(place) + 1.0, 1.0);
    }
    part
}

fn visit_cell(
    polygon: &Corners,
    size: Size,
    [column, row]: [u16; 2],
    triangle: TriangleId,
    visit: &mut impl FnMut(Cut),
) {
    if polygon.count < 3 {
        return;
    }
    let on: [Barycentric; 8] = polygon.points.map(|p| p.on);
    let piece = Piece::new(triangle, &on[..polygon.count.min(7)]);
    if piece.share() <= 0.0 {
        return;
    }
    let border = |axis: usize, place: u16, count: u16| {
        let limit = f64::from(place) + 1.0;
        let ends = polygon.all().iter().filter(|p| place + 1 < count && p.at[axis] == limit);
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p.at[1 - axis]), high.max(p.at[1 - axis]))
        });
        (high - low).max(0.0)
    };
    visit(Cut {
        cell: u32::from(row) * u32::from(size.columns) + u32::from(column),
        piece,
        borders: [border(0, column, size.columns), border(1, row, size.rows)],
    });
}
