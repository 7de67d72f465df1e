//! The patches as polygons that share all points with their neighbors.
//!
//! A patch that is a part of one triangle, or joins several, is shown as its pieces. A patch that is a cell is one polygon,
//! whatever its triangles: the outline of its pieces together.
//!
//! Neighboring triangles are cut into different numbers of parts, and files have T-junctions of their own. So the edges of
//! polygons that lie on an edge of a triangle are divided at *all* points that lie on them.

use glam::DVec3;
use sir_geom::{Barycentric, PointTree, Scene, TriangleId, Weld, median_extent};
use sir_mesh::{PatchId, PatchMesh};

use crate::display::node::Node;
use crate::display::outlines::{Outlines, is_straight};

/// Distance below which points are welded, in typical distances of vertices from the middle of the scene.
const TOLERANCE: f64 = 4e-6;

/// A polygon of a patch: its nodes run counterclockwise seen from the front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    /// A triangle in whose plane it lies.
    pub(super) triangle: TriangleId,
    pub(super) patch: PatchId,
    start: u32,
}

/// Polygons of all patches: for each triangle, those of the patches that are shown with it.
#[derive(Default)]
pub(super) struct Polygons {
    pub(super) points: Vec<DVec3>,
    list: Vec<Polygon>,
    nodes: Vec<Node>,
}

/// Returns the patches that are shown with a triangle. The cells of a surface are shown with its first triangle.
pub(super) fn shown_with(mesh: &PatchMesh, triangle: TriangleId) -> std::ops::Range<u32> {
    let (first, patches) = mesh.surface_of(triangle);
    if mesh.divisions(triangle).is_none() && first != triangle { 0..0 } else { patches }
}

impl Polygons {
    pub(super) fn new(scene: &Scene, mesh: &PatchMesh) -> Self {
        let (middle, distance) = median_extent(scene.vertices());
        let tolerance = TOLERANCE * distance;
        let (mut pieces, on_rim) = pieces(scene, mesh, Weld::new(middle, tolerance));
        let seams = Seams::new(&pieces, &on_rim, 2.5 * tolerance);
        let points = std::mem::take(&mut pieces.points);
        let divided = Self { points, ..seams.divide(&pieces, &on_rim) };
        drop((pieces, on_rim, seams));
        divided.joined(mesh, 2.5 * tolerance)
    }

    /// Returns the polygons with the numbers of their first nodes.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Polygon, u32, &[Node])> {
        (0..self.list.len()).map(|i| (self.list[i], self.list[i].start, self.nodes_of(i)))
    }

    pub(super) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    fn nodes_of(&self, polygon: usize) -> &[Node] {
        let end = self.list.get(polygon + 1).map_or(self.nodes.len(), |next| next.start as usize);
        &self.nodes[self.list[polygon].start as usize..end]
    }

    /// Adds a polygon without nodes, to which nodes are added.
    fn begin(&mut self, triangle: TriangleId, patch: PatchId) {
        self.list.push(Polygon { triangle, patch, start: self.nodes.len() as u32 });
    }

    /// Removes repeated points from the last polygon.
    fn end(&mut self) {
        let Some(start) = self.list.last().map(|polygon| polygon.start as usize) else { return };
        let mut kept = start;
        for i in start..self.nodes.len() {
            if kept == start || self.nodes[i].point != self.nodes[kept - 1].point {
                self.nodes[kept] = self.nodes[i];
                kept += 1;
            }
        }
        while kept > start + 1 && self.nodes[kept - 1].point == self.nodes[start].point {
            kept -= 1;
        }
        self.nodes.truncate(kept);
    }

    /// Returns the polygons with one for each patch that is a cell.
    fn joined(self, mesh: &PatchMesh, tolerance: f64) -> Self {
        let mut outlines = Outlines::default();
        let mut needed = vec![false; self.points.len()];
        let mut joined = Self { list: Vec::with_capacity(self.list.len()), ..Self::default() };
        let is_cell = |polygon: &Polygon| mesh.divisions(polygon.triangle).is_none();
        let mut next = 0;
        for run in self.list.chunk_by(|a, b| a.patch == b.patch && is_cell(a)) {
            let range = next..next + run.len();
            next = range.end;
            let pieces = || range.clone().map(|i| self.nodes_of(i));
            let outline = if is_cell(&run[0]) { outlines.of(pieces()) } else { None };
            if let Some(outline) = outline {
                joined.begin(run[0].triangle, run[0].patch);
                let nodes: Vec<Node> =
                    outline.into_iter().map(|point| Node { point, is_corner: false }).collect();
                for i in 0..nodes.len() {
                    needed[nodes[i].point as usize] |= !self.is_straight(around(&nodes, i), tolerance);
                }
                joined.nodes.extend(nodes);
            } else {
                for (polygon, nodes) in run.iter().zip(pieces()) {
                    joined.begin(polygon.triangle, polygon.patch);
                    joined.nodes.extend_from_slice(nodes);
                    nodes.iter().for_each(|node| needed[node.point as usize] |= node.is_corner);
                }
            }
        }
        joined.reduce(&needed, |around| self.is_straight(around, tolerance));
        Self { points: self.points, ..joined }
    }

    /// True if the middle one of three points lies between the others.
    fn is_straight(&self, around: [u32; 3], tolerance: f64) -> bool {
        is_straight(around.map(|point| self.points[point as usize]), tolerance)
    }

    /// Removes nodes that no polygon needs, and finds the corners of outlines, which have none yet.
    fn reduce(&mut self, needed: &[bool], is_straight: impl Fn([u32; 3]) -> bool) {
        let (mut kept, mut nodes) = (0, Vec::new());
        for polygon in 0..self.list.len() {
            nodes.clear();
            nodes.extend(self.nodes_of(polygon).iter().filter(|node| needed[node.point as usize]));
            let is_outline = nodes.iter().all(|node: &Node| !node.is_corner);
            self.list[polygon].start = kept as u32;
            for i in 0..nodes.len() {
                let is_corner = nodes[i].is_corner || is_outline && !is_straight(around(&nodes, i));
                self.nodes[kept] = Node { is_corner, ..nodes[i] };
                kept += 1;
            }
        }
        self.nodes.truncate(kept);
    }
}

/// Returns the points of a node and of those before and after it.
fn around(nodes: &[Node], i: usize) -> [u32; 3] {
    let len = nodes.len();
    [(i + len - 1) % len, i, (i + 1) % len].map(|k| nodes[k].point)
}

/// Returns the pieces of all patches as polygons and, for the edge that begins at each node, true if it lies on an edge of a
/// triangle.
fn pieces(scene: &Scene, mesh: &PatchMesh, mut weld: Weld) -> (Polygons, Vec<bool>) {
    let mut polygons = Polygons::default();
    let mut on_rim = Vec::new();
    let mut add = |patch, piece: &sir_mesh::Piece| {
        let corners = scene.corners(piece.triangle);
        polygons.begin(piece.triangle, patch);
        let all = piece.corners();
        for (i, corner) in all.iter().enumerate() {
            polygons.nodes.push(Node { point: weld.add(corner.point(corners)), is_corner: true });
            on_rim.push(is_on_rim([*corner, all[(i + 1) % all.len()]]));
        }
    };
    for t in scene.triangle_ids() {
        if mesh.divisions(t).is_some() {
            mesh.for_each_piece_of(t, |patch, piece| add(patch, &piece));
        } else {
            for patch in shown_with(mesh, t).map(PatchId) {
                mesh.pieces(t, patch).for_each(|piece| add(patch, &piece));
            }
        }
    }
    polygons.points = weld.into_points();
    (polygons, on_rim)
}

/// True if both ends of an edge lie on one edge of their triangle.
fn is_on_rim(ends: [Barycentric; 2]) -> bool {
    const ROUNDING: f64 = 1e-9;
    let on = |distance: fn(&Barycentric) -> f64| ends.iter().all(|end| distance(end).abs() < ROUNDING);
    on(|p| p.v) || on(|p| p.w) || on(|p| 1.0 - p.v - p.w)
}

/// Edges of polygons that lie on edges of triangles, each divided at every point that lies on it.
struct Seams {
    /// Ends of the edges, the smaller number first, sorted.
    edges: Vec<(u32, u32)>,
    /// Points between the ends of each edge, from the first to the second, and the offset of each list.
    between: Vec<u32>,
    starts: Vec<u32>,
}

impl Seams {
    fn new(polygons: &Polygons, on_rim: &[bool], tolerance: f64) -> Self {
        let mut edges = Vec::new();
        for (_, start, nodes) in polygons.iter() {
            for (i, node) in nodes.iter().enumerate() {
                let next = nodes[(i + 1) % nodes.len()];
                if on_rim[start as usize + i] && node.point != next.point {
                    edges.push((node.point.min(next.point), node.point.max(next.point)));
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let mut ends: Vec<u32> = edges.iter().flat_map(|&(a, b)| [a, b]).collect();
        ends.sort_unstable();
        ends.dedup();
        let places: Vec<DVec3> = ends.iter().map(|&p| polygons.points[p as usize]).collect();
        let tree = PointTree::new(&places);
        let (mut between, mut starts) = (Vec::new(), Vec::with_capacity(edges.len() + 1));
        let mut found = Vec::new();
        for &(a, b) in &edges {
            starts.push(between.len() as u32);
            let [from, to] = [a, b].map(|p| polygons.points[p as usize]);
            tree.between(from, to, tolerance, &mut found);
            let on = found.iter().map(|&(_, i)| ends[i as usize]);
            between.extend(on.filter(|&point| point != a && point != b));
        }
        starts.push(between.len() as u32);
        Self { edges, between, starts }
    }

    /// Returns polygons with their edges divided, without the points.
    fn divide(&self, polygons: &Polygons, on_rim: &[bool]) -> Polygons {
        let mut divided = Polygons { list: Vec::with_capacity(polygons.list.len()), ..Polygons::default() };
        for (Polygon { triangle, patch, .. }, start, nodes) in polygons.iter() {
            divided.begin(triangle, patch);
            for (i, node) in nodes.iter().enumerate() {
                divided.nodes.push(*node);
                let next = nodes[(i + 1) % nodes.len()];
                let edge = (node.point.min(next.point), node.point.max(next.point));
                let place = on_rim[start as usize + i].then(|| self.edges.binary_search(&edge));
                let Some(Ok(place)) = place else { continue };
                let [from, to] = [0, 1].map(|k| self.starts[place + k] as usize);
                let inner = self.between[from..to].iter().map(|&point| Node { point, is_corner: false });
                if node.point < next.point {
                    divided.nodes.extend(inner);
                } else {
                    divided.nodes.extend(inner.rev());
                }
            }
            divided.end();
        }
        divided
    }
}
