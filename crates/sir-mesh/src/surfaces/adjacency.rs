//! Which triangles continue each other across an edge.

use glam::DVec3;
use sir_geom::{PointTree, Scene, TriangleId, Weld, median_extent};

/// Distance below which points are one, in typical distances of vertices from the middle of the scene.
const TOLERANCE: f64 = 4e-6;

/// Number of triangles on one side of an edge that can have neighbors there. More are copies of each other.
const MAX_SHARING: usize = 8;

/// Cosine of the angle between normals above which triangles that share an edge with two others do not stand on them: 30°.
const FLAT: f64 = 0.866;

/// Neighbors of all triangles: those of the same material and group that share a part of an edge, and run along it in the
/// other direction, so that both show the same side. Where something stands on the edge, such as a wall on a floor, there
/// are none.
pub(crate) struct Adjacency {
    /// Offset of the neighbors of each triangle, and their number at the end.
    starts: Vec<u32>,
    /// Number of the edge, and the triangle beyond it.
    neighbors: Vec<(u8, TriangleId)>,
}

/// An edge of a triangle, or a part of it. The derived order puts parts of the same segment side by side.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    low: u32,
    high: u32,
    triangle: u32,
    number: u8,
    forward: bool,
    /// Ends of the whole edge.
    whole: (u32, u32),
}

impl Adjacency {
    pub(crate) fn new(scene: &Scene) -> Self {
        let (middle, distance) = median_extent(scene.vertices());
        let tolerance = TOLERANCE * distance;
        let mut weld = Weld::new(middle, tolerance);
        let points: Vec<u32> = scene.vertices().iter().map(|&p| weld.add(p)).collect();
        let positions = weld.into_points();
        let mut edges = divided(edges(scene, &points), &positions, tolerance);
        edges.sort_unstable();
        let mut pairs = Vec::new();
        for same in edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
            pair(scene, same, &mut pairs);
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; scene.triangles().len() + 1];
        pairs.iter().for_each(|pair| starts[pair.0 as usize + 1] += 1);
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        Self { starts, neighbors: pairs.iter().map(|pair| (pair.1, TriangleId(pair.2))).collect() }
    }

    /// Returns the neighbors of a triangle, with the number of the edge between them.
    pub(crate) fn of(&self, triangle: TriangleId) -> &[(u8, TriangleId)] {
        let [start, end] = [0, 1].map(|i| self.starts[triangle.index() + i] as usize);
        &self.neighbors[start..end]
    }
}

fn edges(scene: &Scene, points: &[u32]) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(3 * scene.triangles().len());
    for t in scene.triangle_ids() {
        let triangle = scene.triangle(t);
        let corners = triangle.vertices.map(|v| points[v.index()]);
        for number in 0..3u8 {
            let (from, to) = (corners[usize::from(number)], corners[(usize::from(number) + 1) % 3]);
            if from != to {
                edges.push(Edge {
                    low: from.min(to),
                    high: from.max(to),
                    triangle: t.0,
                    number,
                    forward: from < to,
                    whole: (from.min(to), from.max(to)),
                });
            }
        }
    }
    edges
}

/// Adds pairs of triangles that continue each other across an edge, in both orders.
fn pair(scene: &Scene, same: &[Edge], pairs: &mut Vec<(u32, u8, u32)>) {
    let continues = |a: &Edge, b: &Edge| {
        let [t, u] = [a, b].map(|edge| scene.triangle(TriangleId(edge.triangle)));
        (t.material, t.group) == (u.material, u.group)
    };
    let normals = |all: &[Edge]| all.iter().map(|edge| scene.normal(TriangleId(edge.triangle))).collect();
    let normals: Vec<DVec3> = if same.len() > 2 { normals(same) } else { Vec::new() };
    // Where surfaces cover each other, only whole edges tell which triangles belong together.
    let is_clear = |a: &Edge, b: &Edge| {
        let rivals = same.iter().filter(|edge| continues(edge, a)).count();
        rivals <= 2 || a.whole == b.whole
    };
    // Copies of one of the two, or of their backs, do not stand on them.
    let is_crossed =
        |i: usize, j: usize| normals.iter().any(|n| [i, j].iter().all(|&k| n.dot(normals[k]).abs() < FLAT));
    for (i, a) in same.iter().enumerate().filter(|(_, edge)| !edge.forward).take(MAX_SHARING) {
        for (j, b) in same.iter().enumerate().filter(|(_, edge)| edge.forward).take(MAX_SHARING) {
            if continues(a, b) && is_clear(a, b) && !is_crossed(i, j) {
                pairs.push((a.triangle, a.number, b.triangle));
                pairs.push((b.triangle, b.number, a.triangle));
            }
        }
    }
}

/// Returns edges cut at all points that lie on them.
fn divided(mut edges: Vec<Edge>, positions: &[DVec3], tolerance: f64) -> Vec<Edge> {
    edges.sort_unstable();
    let tree = PointTree::new(positions);
    let (mut parts, mut found) = (Vec::with_capacity(edges.len()), Vec::new());
    for same in edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        let ends = [same[0].low, same[0].high];
        let [a, b] = ends.map(|i| positions[i as usize]);
        tree.between(a, b, 2.5 * tolerance, &mut found);
        let between = found.iter().map(|&(_, i)| i).filter(|i| !ends.contains(i));
        let on: Vec<u32> = std::iter::once(ends[0]).chain(between).chain([ends[1]]).collect();
        for edge in same {
            parts.extend(on.windows(2).map(|ends| Edge {
                low: ends[0].min(ends[1]),
                high: ends[0].max(ends[1]),
                forward: edge.forward != (ends[0] > ends[1]),
                ..*edge
            }));
        }
    }
    parts
}
