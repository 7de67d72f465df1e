//! Construction of the display mesh from patches.

use std::sync::OnceLock;

use glam::DVec3;
use sir_geom::{Rgb, Scene, Side, TriangleId};
use sir_mesh::{PatchId, PatchMesh};

use crate::display::mesh::{DisplayMesh, DisplayVertex, active_sides, rgb};
use crate::display::outline::{Corner, Outline};
use crate::display::seams::Seams;
use crate::display::smooth::{Groups, RimPiece};

impl<'a> DisplayMesh<'a> {
    /// Creates the mesh for a solution: the irradiance `E` \[W/m²\] of every [`SideId`](sir_mesh::SideId).
    ///
    /// # Panics
    ///
    /// If `irradiance` does not have one value for every side of `mesh`.
    #[must_use]
    pub fn new(scene: &'a Scene, mesh: &'a PatchMesh, irradiance: &'a [Rgb]) -> Self {
        assert_eq!(irradiance.len(), mesh.side_count(), "one irradiance for every side of the mesh");
        let seams = Seams::new(scene, mesh);
        let mut rims = Rims::new(scene, mesh, &seams);
        rims.gather(scene, mesh, &seams, irradiance);
        rims.groups.join(scene, &seams.points, &mut rims.pieces);
        rims.pieces = Vec::new();
        let mut display = Self {
            scene,
            mesh,
            irradiance,
            emits: true,
            positions: Vec::new(),
            vertices: Vec::new(),
            triangles: Vec::with_capacity(mesh.side_count()),
            piece_starts: Vec::with_capacity(mesh.side_count() + 1),
            first_pieces: Vec::with_capacity(scene.triangles().len() + 1),
            levels: OnceLock::new(),
        };
        display.emit(&seams, &mut rims);
        display
    }

    fn emit(&mut self, seams: &Seams, rims: &mut Rims) {
        self.positions.clone_from(&seams.points);
        let mut outline = Outline::default();
        let mut polygon = Vec::new();
        let (mut nodes, mut inner) = (Vec::new(), Vec::new());
        for t in self.scene.triangle_ids() {
            outline.set(self.scene, self.mesh, seams, t);
            self.first_pieces.push(self.piece_starts.len() as u32);
            let rim_len = outline.rim().len();
            let first_inner = self.positions.len() as u32;
            self.positions.extend(&outline.positions[rim_len..]);
            let sides = active_sides(self.scene, t);
            let mut vertices_of_sides = [Vec::new(), Vec::new()];
            for (&side, vertices) in sides.iter().zip(&mut vertices_of_sides) {
                inner.clear();
                inner.resize(outline.positions.len() - rim_len, (Rgb::ZERO, 0.0));
                weigh(self.scene, self.mesh, &outline, t, &mut polygon, |corner, patch, weight| {
                    if let (Some(i), Some(id)) =
                        ((corner.node as usize).checked_sub(rim_len), self.mesh.side_of(t, patch, side))
                    {
                        let (sum, weights) = &mut inner[i];
                        *sum += weight * self.irradiance[id.index()];
                        *weights += weight;
                    }
                });
                self.add_rim(rims, &outline, t, side, vertices);
                for (point, &(sum, weight)) in (first_inner..).zip(&inner) {
                    vertices.push(push(&mut self.vertices, point, sum / weight));
                }
            }
            for patch in self.mesh.patches_of(t).map(PatchId) {
                outline.polygon(self.mesh, t, patch, &mut polygon);
                let center = self.add_center(&outline, &polygon);
                for (&side, vertices) in sides.iter().zip(&vertices_of_sides) {
                    self.piece_starts.push(self.triangles.len() as u32);
                    nodes.clear();
                    nodes.extend(polygon.iter().map(|c| (vertices[c.node as usize], c.corner.is_some())));
                    if side == Side::Back {
                        nodes.reverse();
                    }
                    self.add_polygon(&nodes, center);
                }
            }
        }
        self.piece_starts.push(self.triangles.len() as u32);
        self.first_pieces.push(self.piece_starts.len() as u32 - 1);
    }

    /// Appends the vertices on the rim of a side of a triangle to `vertices`, in the order of its nodes.
    fn add_rim(
        &mut self,
        rims: &mut Rims,
        outline: &Outline,
        t: TriangleId,
        side: Side,
        vertices: &mut Vec<u32>,
    ) {
        let mut cuts = Vec::new();
        for (node, &point) in (0..).zip(outline.rim()) {
            let (group, irradiance) = rims.groups.find(rims.first_nodes[t.index()] + node, side);
            let known = rims.vertices[group];
            let number = known.or_else(|| irradiance.map(|e| push(&mut self.vertices, point, e)));
            rims.vertices[group] = number;
            if number.is_none() {
                cuts.push((node, group));
            }
            vertices.push(number.unwrap_or_default());
        }
        // Where only surfaces beyond a crease divide an edge of a patch, irradiance is interpolated along the edge.
        for (node, group) in cuts {
            let [a, b] = outline.ends_around(node);
            let [from, at, to] = [a, node, b].map(|i| outline.positions[i as usize]);
            let share = from.distance(at) / (from.distance(at) + at.distance(to));
            let [e, f] = [a, b].map(|i| rgb(self.vertices[vertices[i as usize] as usize].irradiance));
            let number = push(&mut self.vertices, outline.rim()[node as usize], e.lerp(f, share));
            rims.vertices[group] = Some(number);
            vertices[node as usize] = number;
        }
    }

    /// Adds the center of a polygon of more than three nodes to the positions, and returns its number.
    fn add_center(&mut self, outline: &Outline, polygon: &[Corner]) -> Option<u32> {
        if polygon.len() < 4 {
            return None;
        }
        let corners = || polygon.iter().filter(|c| c.corner.is_some());
        let sum: DVec3 = corners().map(|c| outline.positions[c.node as usize]).sum();
        self.positions.push(sum / corners().count() as f64);
        Some(self.positions.len() as u32 - 1)
    }

    /// Adds a triangle, or a fan of triangles around the center of a polygon. A node is a vertex, with true if it is a
    /// corner of the patch.
    fn add_polygon(&mut self, nodes: &[(u32, bool)], center: Option<u32>) {
        if let Some(position) = center {
            // The center has the value that the triangle of the corners alone would have there. The fan therefore
            // differs from the patches next to it only along the edge that has more points.
            let corners =
                || nodes.iter().filter(|n| n.1).map(|n| rgb(self.vertices[n.0 as usize].irradiance));
            let mean = corners().sum::<Rgb>() / corners().count() as f64;
            let center = push(&mut self.vertices, position, mean);
            for (i, node) in nodes.iter().enumerate() {
                self.triangles.push([node.0, nodes[(i + 1) % nodes.len()].0, center]);
            }
        } else if let &[a, b, c] = nodes {
            self.triangles.push([a.0, b.0, c.0]);
        }
    }
}

/// Rims of all triangles.
struct Rims {
    /// Number of the first rim node of each triangle.
    first_nodes: Vec<u32>,
    groups: Groups,
    pieces: Vec<RimPiece>,
    /// Vertex of each group, if it exists already.
    vertices: Vec<Option<u32>>,
}

impl Rims {
    fn new(scene: &Scene, mesh: &PatchMesh, seams: &Seams) -> Self {
        let mut outline = Outline::default();
        let mut first_nodes = Vec::with_capacity(scene.triangles().len());
        let mut pieces = Vec::new();
        let mut count = 0;
        for t in scene.triangle_ids() {
            outline.set(scene, mesh, seams, t);
            let rim = outline.rim();
            let len = rim.len() as u32;
            let node = |i: u32| (rim[i as usize], count + i);
            if len >= 3 {
                pieces.extend((0..len).map(|i| RimPiece::new(t, node(i), node((i + 1) % len))));
            }
            first_nodes.push(count);
            count += len;
        }
        let groups = Groups::new(count as usize);
        let vertices = vec![None; groups.len()];
        Self { first_nodes, groups, pieces, vertices }
    }

    fn gather(&mut self, scene: &Scene, mesh: &PatchMesh, seams: &Seams, irradiance: &[Rgb]) {
        let mut outline = Outline::default();
        let mut polygon = Vec::new();
        for (t, &first) in scene.triangle_ids().zip(&self.first_nodes) {
            outline.set(scene, mesh, seams, t);
            let rim = outline.rim().len() as u32;
            weigh(scene, mesh, &outline, t, &mut polygon, |corner, patch, weight| {
                if corner.node < rim {
                    for &side in active_sides(scene, t) {
                        if let Some(id) = mesh.side_of(t, patch, side) {
                            let e = irradiance[id.index()];
                            self.groups.add(first + corner.node, side, e, weight, corner.corner.is_some());
                        }
                    }
                }
            });
        }
    }
}

/// Calls `add` with every node of every patch of a triangle and the weight of the patch there: the angle at the node
/// over the distance to the center of the patch.
fn weigh(
    scene: &Scene,
    mesh: &PatchMesh,
    outline: &Outline,
    triangle: TriangleId,
    polygon: &mut Vec<Corner>,
    mut add: impl FnMut(Corner, PatchId, f64),
) {
    let corners = scene.corners(triangle);
    let n = f64::from(mesh.divisions(triangle));
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    // All patches of a triangle are congruent, so they share these weights.
    let at_corner: [f64; 3] = std::array::from_fn(|i| {
        let [u, v] = [1, 2].map(|k| corners[(i + k) % 3] - corners[i]);
        u.cross(v).length().atan2(u.dot(v)) * n / middle.distance(corners[i])
    });
    for patch in mesh.patches_of(triangle).map(PatchId) {
        outline.polygon(mesh, triangle, patch, polygon);
        let on_edge = polygon.iter().any(|c| c.corner.is_none());
        let center = || {
            let c = mesh.patch_corners(triangle, patch).map(|b| b.point(corners));
            (c[0] + c[1] + c[2]) / 3.0
        };
        let center = if on_edge { center() } else { DVec3::ZERO };
        for c in &*polygon {
            let weight = match c.corner {
                Some(i) => at_corner[usize::from(i)],
                None => std::f64::consts::PI / center.distance(outline.positions[c.node as usize]),
            };
            add(*c, patch, weight);
        }
    }
}

fn push(vertices: &mut Vec<DisplayVertex>, position: u32, irradiance: Rgb) -> u32 {
    vertices.push(DisplayVertex { position, irradiance: irradiance.as_vec3().to_array() });
    vertices.len() as u32 - 1
}
