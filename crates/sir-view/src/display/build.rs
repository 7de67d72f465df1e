//! Construction of the display mesh from polygons.

use std::f64::consts::PI;
use std::sync::OnceLock;

use glam::DVec3;
use sir_geom::{Rgb, Scene, Side, triangulate};
use sir_mesh::PatchMesh;

use crate::display::mesh::{DisplayMesh, DisplayVertex, rgb};
use crate::display::node::Node;
use crate::display::polygons::{Polygons, shown_with};
use crate::display::smooth::{EdgePiece, Groups};

impl<'a> DisplayMesh<'a> {
    /// Creates the mesh for a solution: the irradiance `E` \[W/m²\] of every [`SideId`](sir_mesh::SideId).
    ///
    /// # Panics
    ///
    /// If `irradiance` does not have one value for every side of `mesh`.
    #[must_use]
    pub fn new(scene: &'a Scene, mesh: &'a PatchMesh, irradiance: &'a [Rgb]) -> Self {
        assert_eq!(irradiance.len(), mesh.side_count(), "one irradiance for every side of the mesh");
        let polygons = Polygons::new(scene, mesh);
        let mut groups = groups(scene, mesh, &polygons, irradiance);
        let mut display = Self {
            scene,
            mesh,
            irradiance,
            emits: true,
            positions: Vec::new(),
            vertices: Vec::new(),
            triangles: Vec::with_capacity(mesh.side_count()),
            piece_starts: Vec::with_capacity(mesh.side_count() + 1),
            first_pieces: Vec::with_capacity(scene.triangles().len()),
            levels: OnceLock::new(),
        };
        display.emit(&polygons, &mut groups);
        display
    }

    fn emit(&mut self, polygons: &Polygons, groups: &mut Groups) {
        let Self { scene, mesh, .. } = *self;
        self.positions.clone_from(&polygons.points);
        // Vertex of each group, if it exists already.
        let mut known = vec![None; groups.len()];
        let mut waiting = polygons.iter().peekable();
        let (mut of_patch, mut vertices, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        for t in scene.triangle_ids() {
            let (first, _) = mesh.surface_of(t);
            let is_shown_elsewhere = mesh.divisions(t).is_none() && first != t;
            self.first_pieces.push(if is_shown_elsewhere {
                self.first_pieces[first.index()]
            } else {
                self.piece_starts.len() as u32
            });
            let is_own = |triangle| mesh.divisions(t).is_none() || triangle == t;
            for patch in shown_with(mesh, t) {
                of_patch.clear();
                while let Some(next) =
                    waiting.next_if(|(polygon, ..)| polygon.patch.0 == patch && is_own(polygon.triangle))
                {
                    of_patch.push(next);
                }
                // Both sides share the centers of polygons.
                let centers: Vec<Option<u32>> =
                    of_patch.iter().map(|(.., nodes)| self.add_center(nodes)).collect();
                for &side in mesh.sides_of(t) {
                    self.piece_starts.push(self.triangles.len() as u32);
                    for (&(_, start, nodes), center) in of_patch.iter().zip(&centers) {
                        vertices.clear();
                        self.add_vertices(groups, &mut known, (start, nodes), side, &mut vertices);
                        triangles.clear();
                        self.triangulate(nodes, &vertices, *center, &mut triangles);
                        let turned =
                            |[a, b, c]: [u32; 3]| if side == Side::Back { [b, a, c] } else { [a, b, c] };
                        self.triangles.extend(triangles.iter().copied().map(turned));
                    }
                }
            }
        }
        self.piece_starts.push(self.triangles.len() as u32);
    }

    /// Appends the vertices of the nodes of a polygon.
    fn add_vertices(
        &mut self,
        groups: &mut Groups,
        known: &mut [Option<u32>],
        (start, nodes): (u32, &[Node]),
        side: Side,
        vertices: &mut Vec<u32>,
    ) {
        let mut cuts = Vec::new();
        for (number, node) in (start..).zip(nodes) {
            let (group, irradiance) = groups.find(number, side);
            let vertex = known[group].or_else(|| irradiance.map(|e| self.push(node.point, e)));
            known[group] = vertex;
            if vertex.is_none() {
                cuts.push(((number - start) as usize, group));
            }
            vertices.push(vertex.unwrap_or_default());
        }
        // Where only surfaces beyond a crease divide an edge of a patch, irradiance is interpolated along the edge.
        for (i, group) in cuts {
            let len = nodes.len();
            let corner = |step: usize| {
                let around = (1..len).map(|k| (i + k * step) % len);
                around.into_iter().find(|&k| nodes[k].is_corner).unwrap_or(i)
            };
            let ends = [corner(len - 1), corner(1)];
            let [from, to, at] = [ends[0], ends[1], i].map(|k| self.positions[nodes[k].point as usize]);
            let share = from.distance(at) / (from.distance(at) + at.distance(to));
            let [e, f] = ends.map(|k| rgb(self.vertices[vertices[k] as usize].irradiance));
            let vertex = self.push(nodes[i].point, e.lerp(f, share));
            known[group] = Some(vertex);
            vertices[i] = vertex;
        }
    }

    /// Adds the center of a polygon of more than three nodes to the positions, and returns its number; `None` for a polygon
    /// that needs none.
    fn add_center(&mut self, nodes: &[Node]) -> Option<u32> {
        if nodes.len() < 4 {
            return None;
        }
        let corners = nodes.iter().filter(|node| node.is_corner);
        let corners: Vec<DVec3> = corners.map(|node| self.positions[node.point as usize]).collect();
        let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
        // The center sees all corners of a convex polygon.
        let turns: Vec<DVec3> = (0..corners.len())
            .map(|i| (corners[i] - center).cross(corners[(i + 1) % corners.len()] - center))
            .collect();
        let normal: DVec3 = turns.iter().sum();
        if turns.iter().any(|turn| turn.dot(normal) <= 0.0) {
            return None;
        }
        self.positions.push(center);
        Some(self.positions.len() as u32 - 1)
    }

    /// Cuts a polygon into triangles: a fan around its center, if it has one.
    fn triangulate(
        &mut self,
        nodes: &[Node],
        vertices: &[u32],
        center: Option<u32>,
        triangles: &mut Vec<[u32; 3]>,
    ) {
        match (center, vertices) {
            (None, &[a, b, c]) => triangles.push([a, b, c]),
            (None, [_, _, _, ..]) => {
                let positions: Vec<DVec3> =
                    nodes.iter().map(|node| self.positions[node.point as usize]).collect();
                triangles.extend(triangulate(&positions).iter().map(|t| t.map(|i| vertices[i])));
            }
            (None, _) => {}
            (Some(position), _) => {
                // The center has the value that the corners alone would give it. The fan therefore differs from the patches
                // next to it only along the edge that has more points.
                let corners = || nodes.iter().zip(vertices).filter(|(node, _)| node.is_corner);
                let values = corners().map(|(_, &v)| rgb(self.vertices[v as usize].irradiance));
                let mean = values.sum::<Rgb>() / corners().count() as f64;
                let center = self.push(position, mean);
                for (i, &vertex) in vertices.iter().enumerate() {
                    triangles.push([vertex, vertices[(i + 1) % vertices.len()], center]);
                }
            }
        }
    }

    fn push(&mut self, position: u32, irradiance: Rgb) -> u32 {
        self.vertices.push(DisplayVertex { position, irradiance: irradiance.as_vec3().to_array() });
        self.vertices.len() as u32 - 1
    }
}

/// Returns the groups of nodes that share one irradiance.
fn groups(scene: &Scene, mesh: &PatchMesh, polygons: &Polygons, irradiance: &[Rgb]) -> Groups {
    let has_backs = scene.triangle_ids().any(|t| scene.is_active(t, Side::Back));
    let mut groups = Groups::new(polygons.node_count(), 1 + usize::from(has_backs));
    let mut pieces = Vec::with_capacity(polygons.node_count());
    for (polygon, start, nodes) in polygons.iter().filter(|(.., nodes)| nodes.len() > 2) {
        let len = nodes.len();
        let node = |i: usize| (nodes[i].point, start + i as u32);
        pieces.extend((0..len).map(|i| EdgePiece::new(polygon.triangle, node(i), node((i + 1) % len))));
        let corners = || nodes.iter().filter(|node| node.is_corner);
        let center = corners().map(|node| polygons.points[node.point as usize]).sum::<DVec3>()
            / corners().count() as f64;
        for i in 0..len {
            let weight = weight(&polygons.points, nodes, i, center);
            for &side in mesh.sides_of(polygon.triangle) {
                if let Some(id) = mesh.side_of(polygon.triangle, polygon.patch, side) {
                    groups.add(start + i as u32, side, irradiance[id.index()], weight, nodes[i].is_corner);
                }
            }
        }
    }
    groups.join(scene, &polygons.points, &mut pieces);
    groups
}

/// Returns the weight of a polygon at a node: the angle there over the distance to the center of the polygon.
fn weight(points: &[DVec3], nodes: &[Node], i: usize, center: DVec3) -> f64 {
    let len = nodes.len();
    let at = points[nodes[i].point as usize];
    let angle = if nodes[i].is_corner {
        let [u, v] = [(i + 1) % len, (i + len - 1) % len].map(|k| points[nodes[k].point as usize] - at);
        u.cross(v).length().atan2(u.dot(v))
    } else {
        PI
    };
    // The center of an outline that is not convex may be anywhere.
    angle.max(f64::EPSILON) / center.distance(at).max(f64::EPSILON)
}
