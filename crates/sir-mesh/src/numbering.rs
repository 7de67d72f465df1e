//! Numbering of the patches and sides of a scene.

use std::collections::HashMap;
use std::hint::select_unpredictable;
use std::ops::Range;

use sir_geom::{Barycentric, BoundingBox, FaceId, Scene, Sides, TriangleId};

use crate::barycentric;
use crate::cells::{SPLIT, Split};
use crate::error::MeshError;
use crate::index::PatchId;
use crate::lattice::{Placement, Size};
use crate::layout::{Region, layout};
use crate::parts::{Part, Parts, WHOLE};
use crate::piece::Piece;
use crate::subdivision::Subdivision;
use crate::surfaces::Surfaces;

/// Data to find a side of a triangle, and nothing else, so that it stays in the cache.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// First side of the triangle; if it is cut into cells, the number of its [`Place`].
    first: u32,
    /// Parts of an edge, `n`, below 2¹⁶; the triangle has `n²` patches. Zero if it is cut into cells.
    divisions: u16,
    /// Sides per patch, 1 or 2.
    sides: u16,
}

impl Cut {
    #[inline]
    pub(crate) fn sides(self) -> u32 {
        u32::from(self.sides)
    }
}

/// A triangle in the lattice of its surface: half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Place {
    placement: Placement,
    /// Number of the lattice.
    lattice: u32,
}

/// The lattice of a surface.
#[derive(Clone, Copy, Debug)]
struct Lattice {
    size: Size,
    /// Offset of the patches of its cells in [`Numbering::tables`], or [`NONE`] if each cell is a patch.
    table: u32,
    first_side: u32,
}

impl Place {
    const NOWHERE: Self = Self { placement: Placement::NOWHERE, lattice: 0 };
}

impl Lattice {
    const NOWHERE: Self = Self { size: Size { columns: 1, rows: 1 }, table: NONE, first_side: 0 };
}

/// The patches of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patches {
    pub(crate) first: u32,
    /// Number of the first patch among those with parts; [`NONE`] if the triangle is cut into congruent triangles.
    listed: u32,
    /// Area of each patch that has no parts.
    area: f64,
}

/// Mark of what does not exist.
const NONE: u32 = u32::MAX;

/// Cuts and first numbers of all triangles. Uses 28 bytes per triangle, 32 more per triangle that is cut into cells, up to
/// 4 per cell, and for patches that are cells or have several triangles 4 per patch and 16 per triangle of each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbering {
    cuts: Vec<Cut>,
    patches_of: Vec<Patches>,
    /// The first one is that of triangles that are not cut into cells.
    places: Vec<Place>,
    /// The first one is that of triangles that are not cut into cells.
    lattices: Vec<Lattice>,
    /// Patches of cells, numbered within their surface, or splits. The first one is that of lattices without a table.
    tables: Vec<u32>,
    splits: Vec<Split>,
    parts: Parts,
    /// First triangle of each surface, in the order of the numbers of their patches, and the number of patches.
    pub(crate) surfaces: Vec<(TriangleId, u32)>,
    pub(crate) patches: u32,
    pub(crate) sides: u32,
    /// True if a patch is not flat.
    pub(crate) is_bent: bool,
}

impl Numbering {
    /// Cuts a scene; if a box is given, only triangles whose centroid is in it.
    pub(crate) fn new(
        scene: &Scene,
        subdivision: Subdivision,
        bounds: Option<BoundingBox>,
    ) -> Result<Self, MeshError> {
        let regions = match subdivision {
            Subdivision::PerFace => faces(scene),
            Subdivision::Surfaces(size) => layout(scene, &Surfaces::new(scene, bounds), size)?,
            Subdivision::PerTriangle | Subdivision::Triangles(_) => {
                let divisions = subdivision.divisions(scene, bounds)?;
                scene.triangle_ids().zip(divisions).map(|(t, n)| Region::Triangle(t, n)).collect()
            }
        };
        let count = scene.triangles().len();
        let mut numbering = Self {
            cuts: vec![Cut { first: 0, divisions: 1, sides: 1 }; count],
            patches_of: vec![Patches { first: 0, listed: NONE, area: 0.0 }; count],
            places: vec![Place::NOWHERE],
            lattices: vec![Lattice::NOWHERE],
            tables: vec![0],
            surfaces: Vec::with_capacity(regions.len()),
            ..Self::default()
        };
        for region in &regions {
            numbering.add(scene, region)?;
        }
        Ok(numbering)
    }

    fn add(&mut self, scene: &Scene, region: &Region) -> Result<(), MeshError> {
        let sides = match scene.material(region.first()).sides {
            Sides::Front => 1,
            Sides::Both => 2,
        };
        let count = u32::try_from(region.patches()).map_err(|_| MeshError::TooMany)?;
        let (first, first_side) = (self.patches, self.sides);
        let more = |count: u32, by: Option<u32>| {
            by.and_then(|by| count.checked_add(by)).filter(|&all| all < NONE).ok_or(MeshError::TooMany)
        };
        self.patches = more(first, Some(count))?;
        self.sides = more(first_side, count.checked_mul(u32::from(sides)))?;
        self.surfaces.push((region.first(), count));
        let listed = self.parts.len();
        match region {
            Region::Triangle(triangle, n) => {
                let divisions = u16::try_from(*n).map_err(|_| MeshError::TooMany)?;
                self.cuts[triangle.index()] = Cut { first: first_side, divisions, sides };
                let area = scene.area(*triangle) / f64::from(count);
                self.patches_of[triangle.index()] = Patches { first, listed: NONE, area };
            }
            Region::Joined(triangles) => {
                self.is_bent |= !is_flat(scene, triangles);
                for triangle in triangles {
                    self.cuts[triangle.index()] = Cut { first: first_side, divisions: 1, sides };
                    self.patches_of[triangle.index()] = Patches { first, listed, area: 0.0 };
                }
            }
            Region::Cells(size, cells) => {
                let table = if cells.table.is_empty() { NONE } else { self.tables.len() as u32 };
                let first_split = self.splits.len() as u32;
                let moved = |&entry: &u32| if entry & SPLIT != 0 { entry + first_split } else { entry };
                self.tables.extend(cells.table.iter().map(moved));
                self.splits.extend_from_slice(&cells.splits);
                let lattice = self.lattices.len() as u32;
                self.lattices.push(Lattice { size: *size, table, first_side });
                for &(triangle, placement) in &cells.placements {
                    let place = self.places.len() as u32;
                    self.cuts[triangle.index()] = Cut { first: place, divisions: 0, sides };
                    self.patches_of[triangle.index()] = Patches { first, listed, area: 0.0 };
                    self.places.push(Place { placement, lattice });
                }
            }
        }
        region
            .parts(scene)
            .chunk_by(|a, b| a.0 == b.0)
            .for_each(|parts| self.parts.add(parts.iter().map(|(_, part)| *part)));
        Ok(())
    }

    /// Returns the record that finds the sides of a triangle.
    #[inline]
    pub(crate) fn cut(&self, triangle: TriangleId) -> &Cut {
        &self.cuts[triangle.index()]
    }

    /// Returns the number of parts into which each edge of a triangle is cut; `None` if it is cut into cells.
    pub(crate) fn divisions(&self, triangle: TriangleId) -> Option<u32> {
        let Cut { divisions, .. } = self.cuts[triangle.index()];
        (divisions > 0).then_some(divisions.into())
    }

    /// Returns the first patch of the surface of a triangle.
    #[inline]
    pub(crate) fn first_patch(&self, triangle: TriangleId) -> u32 {
        self.patches_of[triangle.index()].first
    }

    pub(crate) fn surface_of(&self, triangle: TriangleId) -> (TriangleId, Range<u32>) {
        let first = self.first_patch(triangle);
        let place = self.surfaces.partition_point(|surface| self.first_patch(surface.0) < first);
        let (owner, count) = self.surfaces[place];
        (owner, first..first + count)
    }

    /// Returns the first side of the surface of a triangle.
    #[inline]
    pub(crate) fn first_side(&self, triangle: TriangleId) -> u32 {
        let cut = self.cuts[triangle.index()];
        if cut.divisions > 0 { cut.first } else { self.lattice(self.place(cut)).first_side }
    }

    /// Returns the number of a patch among those with parts; `None` if it has none.
    #[inline]
    fn listed(&self, triangle: TriangleId, patch: PatchId) -> Option<u32> {
        let Patches { first, listed, .. } = self.patches_of[triangle.index()];
        (listed != NONE).then(|| listed + (patch.0 - first))
    }

    #[inline]
    pub(crate) fn area(&self, triangle: TriangleId, patch: PatchId) -> f64 {
        self.listed(triangle, patch)
            .map_or(self.patches_of[triangle.index()].area, |listed| self.parts.area(listed))
    }

    /// Returns the number of the patch in which a point lies within the surface of its triangle, and the first side of the
    /// surface.
    #[inline]
    pub(crate) fn locate(&self, triangle: TriangleId, point: Barycentric) -> (u32, u32) {
        let cut = self.cuts[triangle.index()];
        if self.places.len() == 1 {
            return (barycentric::locate(cut.divisions.into(), point), cut.first);
        }
        // Both ways are gone, as the processor cannot predict which is needed.
        let regular = barycentric::locate(u32::from(cut.divisions).max(1), point);
        let place = self.place(cut);
        let lattice = self.lattice(place);
        let entry = self.in_table(lattice, place.placement.cell_at(lattice.size, point), triangle);
        select_unpredictable(cut.divisions > 0, (regular, cut.first), (entry, lattice.first_side))
    }

    #[inline]
    fn lattice(&self, place: &Place) -> &Lattice {
        &self.lattices[place.lattice as usize]
    }

    /// Returns the place of a triangle, or a place that is none if it is not cut into cells.
    #[inline]
    pub(crate) fn place(&self, cut: Cut) -> &Place {
        &self.places[select_unpredictable(cut.divisions == 0, cut.first as usize, 0)]
    }

    #[inline]
    fn in_table(&self, lattice: &Lattice, cell: u32, triangle: TriangleId) -> u32 {
        let is_plain = lattice.table == NONE;
        let entry = self.tables[select_unpredictable(is_plain, 0, lattice.table as usize + cell as usize)];
        let entry = select_unpredictable(is_plain, cell, entry);
        // Few cells are split.
        if entry & SPLIT == 0 { entry } else { self.in_split(entry, triangle) }
    }

    #[cold]
    fn in_split(&self, entry: u32, triangle: TriangleId) -> u32 {
        let split = &self.splits[(entry - SPLIT) as usize];
        // Rounding may put a point into a cell beside that of its triangle.
        let place = split.partition_point(|(other, _)| *other < triangle).min(split.len() - 1);
        split[place].1
    }

    fn piece(&self, part: Part) -> Option<Piece> {
        if part.cell == WHOLE {
            return Some(Piece::whole(part.triangle));
        }
        let place = self.place(self.cuts[part.triangle.index()]);
        place.placement.piece_in(self.lattice(place).size, part.cell, part.triangle)
    }

    /// Returns the pieces of a patch.
    pub(crate) fn pieces(
        &self,
        triangle: TriangleId,
        patch: PatchId,
    ) -> impl Iterator<Item = Piece> + use<'_> {
        let listed = self.listed(triangle, patch);
        let regular = listed.is_none().then(|| self.regular_piece(triangle, patch));
        let parts = listed.map_or(&[][..], |listed| self.parts.of(listed));
        regular.into_iter().chain(parts.iter().filter_map(|&part| self.piece(part)))
    }

    fn regular_piece(&self, triangle: TriangleId, patch: PatchId) -> Piece {
        Piece::new(triangle, &self.regular_corners(triangle, patch))
    }

    fn regular_corners(&self, triangle: TriangleId, patch: PatchId) -> [Barycentric; 3] {
        let Patches { first, .. } = self.patches_of[triangle.index()];
        let n = u32::from(self.cuts[triangle.index()].divisions);
        barycentric::corners(n, patch.0 - first)
    }

    /// Calls `visit` with the pieces of a triangle and their patches.
    pub(crate) fn for_each_piece_of(&self, triangle: TriangleId, mut visit: impl FnMut(PatchId, Piece)) {
        let Patches { first, listed, .. } = self.patches_of[triangle.index()];
        let cut = self.cuts[triangle.index()];
        if cut.divisions == 0 {
            let place = self.place(cut);
            let lattice = self.lattice(place);
            place.placement.for_each_cell(lattice.size, triangle, |cut| {
                visit(PatchId(first + self.in_table(lattice, cut.cell, triangle)), cut.piece);
            });
        } else if listed != NONE {
            visit(PatchId(first), Piece::whole(triangle));
        } else {
            let n = u32::from(cut.divisions);
            for patch in (first..first + n * n).map(PatchId) {
                visit(patch, self.regular_piece(triangle, patch));
            }
        }
    }

    /// Returns the corners of a patch without parts.
    pub(crate) fn single_triangle(&self, triangle: TriangleId, patch: PatchId) -> Option<[Barycentric; 3]> {
        self.listed(triangle, patch).is_none().then(|| self.regular_corners(triangle, patch))
    }

    /// Returns a triangle, and a part of it, in which a random point of a patch lies, for a uniform number in `[0, 1)`, and
    /// the remainder of the number.
    #[inline]
    pub(crate) fn random_part(
        &self,
        triangle: TriangleId,
        patch: PatchId,
        random: f64,
    ) -> (TriangleId, [Barycentric; 3], f64) {
        let Some(listed) = self.listed(triangle, patch) else {
            return (triangle, self.regular_corners(triangle, patch), random);
        };
        let (part, rest) = self.parts.random(listed, random);
        let piece = self.piece(part).unwrap_or_else(|| Piece::whole(part.triangle));
        let (corners, rest) = piece.random_triangle(rest);
        (piece.triangle, corners, rest)
    }

    /// Returns the memory in use \[bytes\].
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.cuts[..])
            + size_of_val(&self.patches_of[..])
            + size_of_val(&self.places[..])
            + size_of_val(&self.lattices[..])
            + size_of_val(&self.tables[..])
            + self.splits.iter().map(|split| size_of_val(&split[..]) + size_of::<Split>()).sum::<usize>()
            + size_of_val(&self.surfaces[..])
            + self.parts.bytes()
    }
}

/// Returns the flat polygons of a scene, and the triangles of others.
fn faces(scene: &Scene) -> Vec<Region> {
    let mut faces: HashMap<FaceId, Vec<TriangleId>> = HashMap::new();
    for t in scene.triangle_ids() {
        faces.entry(scene.triangle(t).face).or_default().push(t);
    }
    let region = |t: TriangleId| match &faces[&scene.triangle(t).face] {
        members if members.len() == 1 || !is_flat(scene, members) => Some(Region::Triangle(t, 1)),
        members => (members[0] == t).then(|| Region::Joined(members.clone())),
    };
    scene.triangle_ids().filter_map(region).collect()
}

/// Returns true if triangles lie in one plane, up to rounding of their corners, and face the same way.
fn is_flat(scene: &Scene, triangles: &[TriangleId]) -> bool {
    let normal = scene.normal(triangles[0]);
    let [origin, ..] = scene.corners(triangles[0]);
    let corners = || triangles.iter().flat_map(|&t| scene.corners(t));
    let size = corners().map(|c| c.distance(origin)).fold(0.0, f64::max);
    triangles.iter().all(|&t| scene.normal(t).dot(normal) > 0.0)
        && corners().all(|c| (c - origin).dot(normal).abs() <= 1e-6 * size)
}
