//! Seams: the edges of triangles, each divided at every point that lies on it.
//!
//! Neighboring triangles are cut into different numbers of parts, and files have T-junctions of their own. A seam has
//! *all* points on an edge, from any triangle, so that the pieces on its sides can share them.

use sir_geom::{Scene, TriangleId};
use sir_mesh::PatchMesh;

use glam::DVec3;

use crate::display::points::{PointTree, Weld};

/// Distance below which points are welded, in typical distances of vertices from the middle of the scene.
const TOLERANCE: f64 = 4e-6;

/// Edges of all triangles of a scene.
pub(super) struct Seams {
    /// Positions of the corners of triangles and of the divisions of their edges.
    pub(super) points: Vec<DVec3>,
    /// Point of each scene vertex.
    corners: Vec<u32>,
    /// Points on each edge in order, edge by edge.
    on_edge: Vec<u32>,
    /// Indices in `on_edge` of the ends of the parts of an edge: `n + 1` for each edge and each number `n` of parts.
    marks: Vec<u32>,
    /// Division of each edge `3t + e` of a triangle, from its corner `e` to the next one.
    edge_divisions: Vec<Division>,
}

/// Division of an edge of a triangle into equal parts.
#[derive(Clone, Copy, Default)]
struct Division {
    first_mark: u32,
    reversed: bool,
}

/// One edge of one triangle. The derived order groups edges that are the same line segment.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct TriangleEdge {
    low: u32,
    high: u32,
    divisions: u32,
    /// `2 (3t + e)`, plus one if the triangle runs from `high` to `low`.
    place: u64,
}

/// Returns the middle of points, and their typical distance from it: medians, which a few points far away do not change.
pub(crate) fn extent(points: &[DVec3]) -> (DVec3, f64) {
    let median = |mut numbers: Vec<f64>| {
        let middle = numbers.len() / 2;
        *numbers.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let along = |axis: usize| median(points.iter().map(|point| point[axis]).collect());
    let middle = DVec3::new(along(0), along(1), along(2));
    (middle, median(points.iter().map(|point| point.distance(middle)).collect()))
}

impl Seams {
    pub(super) fn new(scene: &Scene, mesh: &PatchMesh) -> Self {
        let (middle, distance) = extent(scene.vertices());
        let tolerance = TOLERANCE * distance;
        let mut weld = Weld::new(middle, tolerance);
        let corners: Vec<u32> = scene.vertices().iter().map(|&p| weld.add(p)).collect();
        let positions: Vec<DVec3> = scene.vertices().to_vec();

        let edges = sorted_edges(scene, mesh);
        let mut lattice: Vec<u32> = Vec::new();
        for group in edges.chunk_by(has_same_division) {
            let TriangleEdge { low, high, divisions: n, .. } = group[0];
            let (a, b) = (positions[low as usize], positions[high as usize]);
            lattice.push(corners[low as usize]);
            lattice.extend((1..n).map(|k| weld.add(a + (b - a) * (f64::from(k) / f64::from(n)))));
            lattice.push(corners[high as usize]);
        }

        let mut seams = Self {
            points: weld.into_points(),
            corners,
            on_edge: Vec::new(),
            marks: Vec::with_capacity(lattice.len()),
            edge_divisions: vec![Division::default(); 3 * scene.triangles().len()],
        };
        seams.cut(&edges, &lattice, tolerance);
        seams
    }

    fn cut(&mut self, edges: &[TriangleEdge], lattice: &[u32], tolerance: f64) {
        let tree = PointTree::new(&self.points);
        let mut found = Vec::new();
        for edge in edges.chunk_by(|x, y| (x.low, x.high) == (y.low, y.high)) {
            let (a, b) = (self.corners[edge[0].low as usize], self.corners[edge[0].high as usize]);
            found.clear();
            if a != b {
                // The divisions lie on the line between the corners before welding, which moves both by one tolerance.
                let [from, to] = [a, b].map(|i| self.points[i as usize]);
                tree.near_segment(from, to, 2.5 * tolerance, &mut found);
            }
            found.retain(|&(t, i)| 0.0 < t && t < 1.0 && i != a && i != b);
            found.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let first = self.on_edge.len();
            self.on_edge.push(a);
            self.on_edge.extend(found.iter().map(|f| f.1));
            if a != b {
                self.on_edge.push(b);
            }
            for group in edge.chunk_by(has_same_division) {
                let first_mark = self.marks.len();
                for TriangleEdge { place, .. } in group {
                    self.edge_divisions[(place / 2) as usize] =
                        Division { first_mark: first_mark as u32, reversed: place % 2 == 1 };
                }
                let mut at = first;
                for point in &lattice[first_mark..=first_mark + group[0].divisions as usize] {
                    // A part that is shorter than the tolerance has no point of its own and takes the last one.
                    at += self.on_edge[at..].iter().position(|p| p == point).unwrap_or(0);
                    self.marks.push(at as u32);
                }
            }
        }
    }

    /// Returns the points of part `k` of edge `e` of a triangle, in the direction of the triangle, from its beginning
    /// to its end (exclusive).
    pub(super) fn part(
        &self,
        triangle: TriangleId,
        edge: usize,
        k: u32,
        divisions: u32,
    ) -> impl Iterator<Item = u32> {
        let division = self.edge_divisions[3 * triangle.index() + edge];
        let mark = |k: u32| self.marks[(division.first_mark + k) as usize] as usize;
        let (start, end, step) = if division.reversed {
            (mark(divisions - k), mark(divisions - k - 1), usize::MAX)
        } else {
            (mark(k), mark(k + 1), 1)
        };
        let count = start.abs_diff(end).max(1);
        // A wrapping step by `usize::MAX` is a step back by one.
        (0..count).scan(start, move |at, _| {
            let here = *at;
            *at = at.wrapping_add(step);
            Some(self.on_edge[here])
        })
    }

    /// Returns the welded positions of the corners of a triangle.
    pub(super) fn corners(&self, scene: &Scene, triangle: TriangleId) -> [DVec3; 3] {
        scene.triangle(triangle).vertices.map(|v| self.points[self.corners[v.index()] as usize])
    }
}

fn has_same_division(x: &TriangleEdge, y: &TriangleEdge) -> bool {
    (x.low, x.high, x.divisions) == (y.low, y.high, y.divisions)
}

fn sorted_edges(scene: &Scene, mesh: &PatchMesh) -> Vec<TriangleEdge> {
    let mut edges = Vec::with_capacity(3 * scene.triangles().len());
    for t in scene.triangle_ids() {
        let v = scene.triangle(t).vertices;
        for e in 0..3 {
            let (from, to) = (v[e].0, v[(e + 1) % 3].0);
            edges.push(TriangleEdge {
                low: from.min(to),
                high: from.max(to),
                divisions: mesh.divisions(t),
                place: 2 * (3 * u64::from(t.0) + e as u64) + u64::from(from > to),
            });
        }
    }
    edges.sort_unstable();
    edges
}
