//! Division of the surfaces of a scene: which triangles share patches, and which parts each patch has.

use sir_geom::{Scene, TriangleId};

use crate::cells::Cells;
use crate::error::MeshError;
use crate::lattice::{Frame, Size};
use crate::parts::{Part, WHOLE};
use crate::subdivision::{MAX_DIVISIONS, PatchSize, longest_edge, parts};
use crate::surfaces::{FlatSurface, Surfaces, join};

/// Triangles that share a run of patches.
pub(crate) enum Region {
    /// One triangle, cut into congruent triangles: the number of parts of an edge.
    Triangle(TriangleId, u32),
    /// One patch of several triangles.
    Joined(Vec<TriangleId>),
    /// Cells of a lattice.
    Cells(Size, Cells),
}

/// Largest ratio of the longest edge of a single triangle to its height at which it is cut into congruent triangles; a
/// longer one is cut into cells.
const MAX_ELONGATION: f64 = 4.0;

/// Longest cell of a strip that is narrower than a cell, in widths of a cell.
const MAX_LENGTH: f64 = 4.0;

/// Largest number of cells of a lattice for each that the surface covers; a sparser surface is cut in two.
const MAX_SPARSITY: f64 = 16.0;

/// Number of cells up to which a lattice may be sparse.
const SMALL_LATTICE: f64 = 1024.0;

/// Width of patches outside of the box of those that are cut, relative to that of cells, up to which small surfaces are
/// joined.
const OUTER_WIDTH: f64 = 4.0;

/// Largest number of attempts at a number of patches, and its relative error at which they end.
const MAX_TRIES: usize = 8;
const CLOSE_ENOUGH: f64 = 2e-3;

/// Returns the regions of a scene, in the order of their first triangles.
pub(crate) fn layout(scene: &Scene, surfaces: &Surfaces, size: PatchSize) -> Result<Vec<Region>, MeshError> {
    size.check()?;
    let inside = surfaces.flat.iter().filter(|surface| surface.is_inside);
    let area: f64 = inside.map(|surface| surface.area).sum();
    let whole = |width: f64| {
        if area / (width * width) > f64::from(u32::MAX) {
            return Err(MeshError::TooMany);
        }
        Layout { scene, surfaces, size, width }.regions()
    };
    match size {
        PatchSize::MaxArea(area) => whole(area.sqrt()),
        PatchSize::MaxEdge(edge) => whole(edge),
        PatchSize::Count(target) => {
            if target > u64::from(u32::MAX) {
                return Err(MeshError::TooMany);
            }
            search((area / target.max(1) as f64).sqrt(), target as f64, whole)
        }
    }
}

/// Returns the regions with the number of patches nearest to `target`, found by changing the width of cells.
fn search(
    start: f64,
    target: f64,
    of_width: impl Fn(f64) -> Result<Vec<Region>, MeshError>,
) -> Result<Vec<Region>, MeshError> {
    let count = |regions: &[Region]| regions.iter().map(|region| region.patches() as f64).sum::<f64>();
    // Without surfaces to cut, all widths are the same.
    let first = if start > 0.0 { start } else { 1.0 };
    let mut best = of_width(first)?;
    let mut nearest = count(&best);
    // The number is about linear in the number of cells per area: the secant method finds where it is the target.
    let mut tried = vec![(1.0 / (first * first), nearest)];
    while (nearest / target - 1.0).abs() > CLOSE_ENOUGH && tried.len() < MAX_TRIES {
        let &(density, now) = &tried[tried.len() - 1];
        let slope = match tried.len().checked_sub(2).map(|before| tried[before]) {
            Some((other, then)) if (now - then) * (density - other) > 0.0 => (now - then) / (density - other),
            _ => now / density,
        };
        let next = (density + (target - now) / slope).clamp(density / 16.0, 4.0 * density);
        if next == density {
            break;
        }
        let regions = of_width((1.0 / next).sqrt())?;
        let now = count(&regions);
        tried.push((next, now));
        if (now - target).abs() < (nearest - target).abs() {
            (best, nearest) = (regions, now);
        }
    }
    Ok(best)
}

impl Region {
    pub(crate) fn first(&self) -> TriangleId {
        match self {
            Self::Triangle(triangle, _) => *triangle,
            Self::Joined(triangles) => triangles[0],
            Self::Cells(_, cells) => cells.placements[0].0,
        }
    }

    pub(crate) fn patches(&self) -> u64 {
        match self {
            Self::Triangle(_, n) => u64::from(*n) * u64::from(*n),
            Self::Joined(_) => 1,
            Self::Cells(_, cells) => u64::from(cells.patches),
        }
    }

    /// Returns the parts of the patches of several triangles or cells, with the number of the patch in the region.
    pub(crate) fn parts(&self, scene: &Scene) -> Vec<(u32, Part)> {
        let whole = |&triangle: &TriangleId| (0, Part { triangle, cell: WHOLE, end: scene.area(triangle) });
        match self {
            Self::Triangle(..) => Vec::new(),
            Self::Joined(triangles) => triangles.iter().map(whole).collect(),
            Self::Cells(_, cells) => cells.parts.clone(),
        }
    }
}

/// A division with cells of one width.
struct Layout<'a> {
    scene: &'a Scene,
    surfaces: &'a Surfaces,
    size: PatchSize,
    width: f64,
}

impl Layout<'_> {
    fn regions(&self) -> Result<Vec<Region>, MeshError> {
        let mut regions = Vec::new();
        let groups = join(self.surfaces, |surface| {
            if surface.is_single {
                None
            } else if surface.is_inside {
                self.is_small(surface).then_some(self.width)
            } else {
                Some(OUTER_WIDTH * self.width)
            }
        });
        let mut is_joined = vec![false; self.surfaces.flat.len()];
        for group in groups {
            let members = group.iter().flat_map(|&number| &self.surfaces.flat[number as usize].triangles);
            let mut triangles: Vec<TriangleId> = members.copied().collect();
            triangles.sort_unstable();
            regions.push(match triangles[..] {
                [triangle] => Region::Triangle(triangle, 1),
                _ => Region::Joined(triangles),
            });
            group.iter().for_each(|&number| is_joined[number as usize] = true);
        }
        for (surface, _) in self.surfaces.flat.iter().zip(is_joined).filter(|(_, is_joined)| !is_joined) {
            self.cut(surface, &surface.triangles, &mut regions)?;
        }
        regions.sort_by_key(Region::first);
        Ok(regions)
    }

    /// True if a surface is not cut.
    fn is_small(&self, surface: &FlatSurface) -> bool {
        match surface.triangles[..] {
            [triangle] if !self.is_long(triangle) => self.parts_of(triangle) == Ok(1),
            _ => self.cells_across(surface.extent).is_ok_and(|size| size.cells() == 1),
        }
    }

    fn is_long(&self, triangle: TriangleId) -> bool {
        let edge = longest_edge(self.scene, triangle);
        edge * edge > 2.0 * MAX_ELONGATION * self.scene.area(triangle)
    }

    /// Returns the number of parts of an edge of a triangle.
    fn parts_of(&self, triangle: TriangleId) -> Result<u32, MeshError> {
        let ratio = self.scene.area(triangle).sqrt() / self.width;
        match self.size {
            PatchSize::MaxArea(_) => parts(ratio),
            PatchSize::MaxEdge(max) => parts(longest_edge(self.scene, triangle) / max),
            PatchSize::Count(_) => Ok(ratio.round().clamp(1.0, f64::from(MAX_DIVISIONS)) as u32),
        }
    }

    /// Returns the columns and rows of a rectangle.
    fn cells_across(&self, extent: [f64; 2]) -> Result<Size, MeshError> {
        let narrow = extent[0].min(extent[1]);
        // Strips have longer cells, so that their area falls more slowly.
        let stretch = if narrow < self.width && !matches!(self.size, PatchSize::MaxEdge(_)) {
            (self.width / narrow).sqrt().min(MAX_LENGTH)
        } else {
            1.0
        };
        let across = |length: f64| {
            let ratio = length / (stretch * self.width);
            let count = match self.size {
                PatchSize::Count(_) => ratio.round().max(1.0),
                _ => f64::from(parts(ratio)?),
            };
            if count <= f64::from(u16::MAX) { Ok(count as u16) } else { Err(MeshError::TooMany) }
        };
        Ok(Size { columns: across(extent[0])?, rows: across(extent[1])? })
    }

    /// Adds the regions of some triangles of a flat surface.
    fn cut(
        &self,
        surface: &FlatSurface,
        triangles: &[TriangleId],
        regions: &mut Vec<Region>,
    ) -> Result<(), MeshError> {
        if let [triangle] = *triangles
            && (surface.is_single || !self.is_long(triangle))
        {
            let n = if surface.is_inside { self.parts_of(triangle)? } else { 1 };
            regions.push(Region::Triangle(triangle, n));
            return Ok(());
        }
        let scene = self.scene;
        let along = |axis: usize| {
            let corners = triangles.iter().flat_map(|&t| scene.corners(t));
            let all = corners.map(|p| (p - surface.origin).dot(surface.axes[axis]));
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let ranges = [along(0), along(1)];
        let extent = ranges.map(|(low, high)| high - low);
        let size = self.cells_across(extent)?;
        let cells = f64::from(size.cells());
        let area: f64 = triangles.iter().map(|&t| scene.area(t)).sum();
        let covered = cells * area / (extent[0] * extent[1]);
        if cells > MAX_SPARSITY * covered.max(1.0) && cells > SMALL_LATTICE && triangles.len() > 1 {
            let axis = usize::from(extent[1] > extent[0]);
            let middle = 0.5 * (ranges[axis].0 + ranges[axis].1);
            let is_low = |t: &TriangleId| {
                let center = crate::subdivision::centroid(scene, *t);
                (center - surface.origin).dot(surface.axes[axis]) < middle
            };
            let (low, high): (Vec<_>, Vec<_>) = triangles.iter().partition(|t| is_low(t));
            if !low.is_empty() && !high.is_empty() {
                self.cut(surface, &low, regions)?;
                return self.cut(surface, &high, regions);
            }
        }
        if size.cells() == 1 {
            regions.push(Region::Joined(triangles.to_vec()));
            return Ok(());
        }
        let [x, y] = surface.axes;
        let frame = Frame {
            origin: surface.origin + ranges[0].0 * x + ranges[1].0 * y,
            axes: [x * (f64::from(size.columns) / extent[0]), y * (f64::from(size.rows) / extent[1])],
        };
        regions
            .push(Region::Cells(size, Cells::new(scene, &self.surfaces.adjacency, triangles, &frame, size)));
        Ok(())
    }
}
