//! The display mesh: patches cut so that they share all points, with irradiance at the points.

mod calm;
mod levels;
mod outline;
mod points;
mod seams;
mod smooth;

use std::sync::OnceLock;

use glam::DVec3;
use sir_geom::{Barycentric, Rgb, Scene, Side, TriangleId};
use sir_mesh::{PatchId, PatchMesh, SideId};

use levels::Levels;
use outline::{Corner, Outline};
use seams::Seams;
use smooth::{Groups, RimPiece};

/// A vertex of a [`DisplayMesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayVertex {
    /// Number of its position in [`DisplayMesh::positions`].
    pub position: u32,
    /// Irradiance `E` \[W/m²\] on the surface to which it belongs.
    pub irradiance: [f32; 3],
}

/// The triangles into which one side of one patch was cut.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// The triangle of the scene.
    pub triangle: TriangleId,
    /// The side of it.
    pub side: Side,
    /// The side of the patch.
    pub id: SideId,
    /// Numbers of vertices, counter-clockwise seen from the side. Empty for a patch smaller than the precision of
    /// the coordinates.
    pub triangles: &'a [[u32; 3]],
}

/// A conforming triangulation of all active sides of the patches of a scene, with irradiance at its vertices.
///
/// Triangles share their vertices wherever their edges touch, whatever the number of parts that the edges are cut
/// in, and whatever T-junctions the file has. So nothing cracks.
///
/// A vertex has the mean irradiance of the patches around it that belong to one smooth surface, which are those
/// that continue each other across an edge with nothing between them, bent by less than 30°. The mean is weighted by the angle at the vertex over
/// the distance to the patch's centre. On a regular subdivision it reproduces a linear field. It is the
/// irradiance that is averaged and not the radiosity, so that colours do not run into each other where materials
/// change: `B = M + ρE` is evaluated with the material, and the texture, of each triangle.
#[derive(Clone, Debug)]
pub struct DisplayMesh<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) mesh: &'a PatchMesh,
    irradiance: &'a [Rgb],
    /// Whether what surfaces and the sky emit is shown, too.
    pub(crate) emits: bool,
    positions: Vec<DVec3>,
    vertices: Vec<DisplayVertex>,
    triangles: Vec<[u32; 3]>,
    /// Where the triangles of each piece begin; one more than there are pieces. Pieces are numbered triangle by
    /// triangle, patch by patch, side by side.
    piece_starts: Vec<u32>,
    /// Where the pieces of each triangle begin; one more than there are triangles.
    first_pieces: Vec<u32>,
    /// Made when a picture first needs them.
    levels: OnceLock<Levels>,
}

impl<'a> DisplayMesh<'a> {
    /// Makes the mesh for a solution: the irradiance `E` \[W/m²\] of every [`SideId`].
    ///
    /// # Panics
    ///
    /// If `irradiance` has not one value for every side of `mesh`.
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

    /// The same mesh with the standard error of irradiance \[W/m²\] in its place: radiosity and radiance then are those standard
    /// errors, and what surfaces and the sky emit, which has none, is left out.
    ///
    /// Errors are interpolated as the irradiance is. That of an interpolated value is a little less, as far as the noise of the
    /// patches that it is made of is independent.
    ///
    /// # Panics
    ///
    /// If `errors` has not one value for every side of `mesh`.
    #[must_use]
    pub fn of_errors(scene: &'a Scene, mesh: &'a PatchMesh, errors: &'a [Rgb]) -> Self {
        Self { emits: false, ..Self::new(scene, mesh, errors) }
    }

    /// Positions; vertices with different irradiance may share one.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The vertices.
    #[must_use]
    pub fn vertices(&self) -> &[DisplayVertex] {
        &self.vertices
    }

    /// All triangles: numbers of vertices, counter-clockwise seen from the side that they show.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Every side of every patch with its triangles. With
    /// [`Subdivision::PerFace`](sir_mesh::Subdivision::PerFace) a side comes once for each triangle of its face.
    pub fn pieces(&self) -> impl Iterator<Item = Piece<'_>> {
        self.scene.triangle_ids().flat_map(|t| self.pieces_of(t))
    }

    /// The pieces of one triangle of the scene.
    pub fn pieces_of(&self, t: TriangleId) -> impl Iterator<Item = Piece<'_>> {
        let sides = active_sides(self.scene, t);
        self.mesh.patches_of(t).map(PatchId).flat_map(move |patch| {
            sides.iter().filter_map(move |&side| {
                let id = self.mesh.side_of(t, patch, side)?;
                Some(Piece { triangle: t, side, id, triangles: self.triangles_of(t, patch, side) })
            })
        })
    }

    /// Irradiance \[W/m²\] at a point of a side of a triangle of the scene, interpolated; `None` if the side does
    /// not reflect.
    #[must_use]
    pub fn irradiance_at(&self, triangle: TriangleId, point: Barycentric, side: Side) -> Option<Rgb> {
        let patch = self.mesh.patch_at(triangle, point);
        let id = self.mesh.side_of(triangle, patch, side)?;
        let corners = self.scene.corners(triangle);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let position = point.point(corners);
        let weights = |t: &[u32; 3]| {
            let c = t.map(|v| self.positions[self.vertices[v as usize].position as usize] - position);
            let part = |i: usize| c[(i + 1) % 3].cross(c[(i + 2) % 3]).dot(normal);
            let parts = [part(0), part(1), part(2)];
            let sum: f64 = parts.iter().sum();
            parts.map(|p| p / sum)
        };
        // Rounding may put the point outside all of them: it belongs to the one that it is least outside of.
        let inside = |w: &[f64; 3]| w[0].min(w[1]).min(w[2]);
        let found = self
            .triangles_of(triangle, patch, side)
            .iter()
            .map(|t| (t, weights(t)))
            .filter(|(_, w)| w[0].is_finite() && w[1].is_finite() && w[2].is_finite())
            .max_by(|(_, v), (_, w)| inside(v).total_cmp(&inside(w)));
        let Some((t, w)) = found else { return Some(self.irradiance[id.index()]) };
        let w = w.map(|x| x.clamp(0.0, 1.0));
        let weighted = |i: usize| w[i] * rgb(self.vertices[t[i] as usize].irradiance);
        Some((weighted(0) + weighted(1) + weighted(2)) / (w[0] + w[1] + w[2]))
    }

    /// Radiosity `B = M + ρE` \[W/m²\] of a side of a patch of a triangle on which `irradiance` falls, on the mean over the
    /// patch; of a mesh of errors `ρE`.
    #[must_use]
    pub fn radiosity(&self, triangle: TriangleId, patch: PatchId, side: Side, irradiance: Rgb) -> Rgb {
        let emitted =
            if self.emits { self.mesh.exitance(self.scene, triangle, patch, side) } else { Rgb::ZERO };
        emitted + self.mesh.reflectance(self.scene, triangle, patch) * irradiance
    }

    /// The same about a point of a triangle, whose textures are shown as the mean over `width` \[m\]; with 0 as they are at the
    /// point.
    #[must_use]
    pub fn radiosity_at(
        &self,
        triangle: TriangleId,
        point: Barycentric,
        side: Side,
        irradiance: Rgb,
        width: f64,
    ) -> Rgb {
        let Self { scene, mesh, .. } = self;
        if !mesh.is_varied(triangle) {
            return self.radiosity(triangle, mesh.patch_at(triangle, point), side, irradiance);
        }
        let levels = self.levels.get_or_init(|| Levels::of(scene));
        let emitted =
            if self.emits { levels.exitance(scene, triangle, side, point, width) } else { Rgb::ZERO };
        emitted + levels.reflectance(scene, triangle, point, width) * irradiance
    }

    /// Radiosity \[W/m²\] of a piece with this irradiance.
    pub(crate) fn radiosity_of(&self, piece: &Piece<'_>, irradiance: Rgb) -> Rgb {
        let patch = self.mesh.patch_of_side(piece.triangle, piece.id);
        self.radiosity(piece.triangle, patch, piece.side, irradiance)
    }

    /// Radiosity \[W/m²\] of a piece as it was solved, not interpolated.
    pub(crate) fn own_radiosity(&self, piece: &Piece<'_>) -> Rgb {
        self.radiosity_of(piece, self.irradiance[piece.id.index()])
    }

    fn triangles_of(&self, triangle: TriangleId, patch: PatchId, side: Side) -> &[[u32; 3]] {
        let sides = active_sides(self.scene, triangle).len() as u32;
        let patch = patch.0 - self.mesh.patches_of(triangle).start;
        let piece = self.first_pieces[triangle.index()] + patch * sides + u32::from(side == Side::Back);
        let [start, end] = [piece, piece + 1].map(|p| self.piece_starts[p as usize] as usize);
        &self.triangles[start..end]
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
                let centre = self.add_centre(&outline, &polygon);
                for (&side, vertices) in sides.iter().zip(&vertices_of_sides) {
                    self.piece_starts.push(self.triangles.len() as u32);
                    nodes.clear();
                    nodes.extend(polygon.iter().map(|c| (vertices[c.node as usize], c.corner.is_some())));
                    if side == Side::Back {
                        nodes.reverse();
                    }
                    self.add_polygon(&nodes, centre);
                }
            }
        }
        self.piece_starts.push(self.triangles.len() as u32);
        self.first_pieces.push(self.piece_starts.len() as u32 - 1);
    }

    /// Appends the vertices on the rim of a side of a triangle, in the order of its nodes, to `vertices`.
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
        // Where an edge of a patch is cut for the sake of what lies beyond a crease, its light goes on straight.
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

    /// The position of the centre of a polygon that needs one.
    fn add_centre(&mut self, outline: &Outline, polygon: &[Corner]) -> Option<u32> {
        if polygon.len() < 4 {
            return None;
        }
        let corners = || polygon.iter().filter(|c| c.corner.is_some());
        let sum: DVec3 = corners().map(|c| outline.positions[c.node as usize]).sum();
        self.positions.push(sum / corners().count() as f64);
        Some(self.positions.len() as u32 - 1)
    }

    /// A triangle, or a fan of triangles around the centre of a polygon. Nodes are vertices, and whether they are
    /// corners of the patch.
    fn add_polygon(&mut self, nodes: &[(u32, bool)], centre: Option<u32>) {
        if let Some(position) = centre {
            // The value that the triangle of the corners alone would have there: the fan differs from the
            // patches next to it only along the edge that has more points.
            let corners =
                || nodes.iter().filter(|n| n.1).map(|n| rgb(self.vertices[n.0 as usize].irradiance));
            let mean = corners().sum::<Rgb>() / corners().count() as f64;
            let centre = push(&mut self.vertices, position, mean);
            for (i, node) in nodes.iter().enumerate() {
                self.triangles.push([node.0, nodes[(i + 1) % nodes.len()].0, centre]);
            }
        } else if let &[a, b, c] = nodes {
            self.triangles.push([a.0, b.0, c.0]);
        }
    }
}

/// The rims of all triangles.
struct Rims {
    /// Number of the first rim node of each triangle.
    first_nodes: Vec<u32>,
    groups: Groups,
    pieces: Vec<RimPiece>,
    /// Vertices of the groups as far as they were made.
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

/// Calls `add` with every node of every patch of a triangle and the weight of the patch there: the angle at the
/// node over the distance to the centre of the patch.
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
    // All patches of a triangle are congruent, so these hold for each.
    let at_corner: [f64; 3] = std::array::from_fn(|i| {
        let [u, v] = [1, 2].map(|k| corners[(i + k) % 3] - corners[i]);
        u.cross(v).length().atan2(u.dot(v)) * n / middle.distance(corners[i])
    });
    for patch in mesh.patches_of(triangle).map(PatchId) {
        outline.polygon(mesh, triangle, patch, polygon);
        let on_edge = polygon.iter().any(|c| c.corner.is_none());
        let centre = || {
            let c = mesh.patch_corners(triangle, patch).map(|b| b.point(corners));
            (c[0] + c[1] + c[2]) / 3.0
        };
        let centre = if on_edge { centre() } else { DVec3::ZERO };
        for c in &*polygon {
            let weight = match c.corner {
                Some(i) => at_corner[usize::from(i)],
                None => std::f64::consts::PI / centre.distance(outline.positions[c.node as usize]),
            };
            add(*c, patch, weight);
        }
    }
}

/// The sides of a triangle that reflect.
fn active_sides(scene: &Scene, triangle: TriangleId) -> &'static [Side] {
    if scene.is_active(triangle, Side::Back) { &[Side::Front, Side::Back] } else { &[Side::Front] }
}

fn push(vertices: &mut Vec<DisplayVertex>, position: u32, irradiance: Rgb) -> u32 {
    vertices.push(DisplayVertex { position, irradiance: irradiance.as_vec3().to_array() });
    vertices.len() as u32 - 1
}

fn rgb(irradiance: [f32; 3]) -> Rgb {
    Rgb::from_array(irradiance.map(f64::from))
}
