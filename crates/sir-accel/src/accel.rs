//! The acceleration structure.

use glam::DVec3;
use sir_types::{BoundingSphere, TriangleId};

use crate::contact::{ContactOrder, Stacks};
use crate::error::{AccelError, MAX_TRIANGLES};
use crate::grid::Grid;
use crate::opacity::OpacityTest;
use crate::options::Options;
use crate::scratch::ScratchPool;
use crate::tree::Tree;
use crate::triangle::GridTriangle;

/// Acceleration structure: triangles arranged for tracing lines.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(crate) grid: Grid,
    pub(crate) tree: Tree,
    stacks: Stacks,
    /// `None` if all triangles are opaque.
    pub(crate) opacity: Option<OpacityTest>,
    pub(crate) scratch: ScratchPool,
}

impl Accel {
    /// Builds the acceleration structure of triangles, which are numbered in the order of `indices`. Their front is the
    /// side from which the corners run counterclockwise. Takes about a second per million triangles.
    ///
    /// Corners are rounded to a grid of 2³¹ steps across the bounding sphere of all triangles. A triangle that has no
    /// area, or none on this grid, keeps its number and is never hit. `indices` may be empty. Positions that no
    /// triangle uses are ignored.
    ///
    /// # Errors
    ///
    /// Returns an error if an index is out of range, a coordinate is not finite, the coordinates are too large or too
    /// small for their squares to be computed, there are 2³¹ triangles or more, or a list in the options does not have
    /// one element per triangle.
    pub fn build(
        positions: &[DVec3],
        indices: &[[u32; 3]],
        options: Options<'_>,
    ) -> Result<Self, AccelError> {
        let grid = Grid::new(bounding_sphere(positions, indices)?);
        let Options { contact_priorities, opacity } = options;
        let check = |list, found, triangles| {
            if found == triangles { Ok(()) } else { Err(AccelError::WrongLength { list, found, triangles }) }
        };
        let count = indices.len();
        opacity.as_ref().map_or(Ok(()), |test| check("transparent triangles", test.triangles(), count))?;
        let triangles: Vec<GridTriangle> = indices
            .iter()
            .zip(0..)
            .map(|(corners, number)| {
                // `bounding_sphere` has checked the indices.
                GridTriangle::new(corners.map(|i| grid.vertex(positions[i as usize])), TriangleId(number))
            })
            .collect();
        let mut tree = Tree::new(&triangles);
        let stacks = Stacks::find(&mut tree, grid.origin(), |ids| {
            let priorities = contact_priorities.map_or_else(|| vec![0; ids.len()], |of| of(ids));
            check("contact priorities", priorities.len(), ids.len()).map(|()| priorities)
        })?;
        let opacity = opacity.filter(OpacityTest::is_needed);
        Ok(Self { grid, tree, stacks, opacity, scratch: ScratchPool::default() })
    }

    /// Returns true if some triangles are transparent, at least in places.
    #[must_use]
    pub fn has_transparency(&self) -> bool {
        self.opacity.is_some()
    }

    /// Returns the memory in use \[bytes\].
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tree.bytes()
            + size_of_val(self.stacks.of_rank.as_slice())
            + self.opacity.as_ref().map_or(0, OpacityTest::bytes)
    }

    /// Returns true if two triangles are in contact, directly or through others between them (see [`Hit`](crate::Hit)).
    #[must_use]
    pub fn are_in_contact(&self, a: TriangleId, b: TriangleId) -> bool {
        self.contacts().are_together(a, b)
    }

    /// Returns the contact distance of a triangle \[unit of the coordinates\]: two surfaces are in contact within the
    /// smaller of their contact distances. `None` if there is no such triangle.
    #[must_use]
    pub fn contact_distance(&self, triangle: TriangleId) -> Option<f64> {
        Some(self.grid.length(self.stacks.distance(self.tree.triangle(triangle)?)))
    }

    /// Returns the length of a step of the grid to which corners are rounded \[unit of the coordinates\].
    #[must_use]
    pub fn grid_step(&self) -> f64 {
        self.grid.length(1.0)
    }

    /// Returns the order of triangles in contact.
    pub(crate) fn contacts(&self) -> ContactOrder<'_> {
        ContactOrder { tree: &self.tree, stacks: &self.stacks }
    }
}

/// Checks triangles, and returns a bounding sphere of the positions that they use.
fn bounding_sphere(positions: &[DVec3], indices: &[[u32; 3]]) -> Result<BoundingSphere, AccelError> {
    if indices.len() > MAX_TRIANGLES {
        return Err(AccelError::TooMany { count: indices.len() });
    }
    let mut is_used = vec![false; positions.len()];
    for (triangle, corners) in indices.iter().enumerate() {
        for &index in corners {
            let count = positions.len();
            let is_used = is_used.get_mut(index as usize);
            *is_used.ok_or(AccelError::OutOfRange { triangle, index, count })? = true;
        }
    }
    let used = || positions.iter().zip(&is_used).enumerate().filter(|(_, (_, is_used))| **is_used);
    if let Some((position, _)) = used().find(|(_, (p, _))| !p.is_finite()) {
        return Err(AccelError::NotFinite { position });
    }
    let sphere = if is_used.contains(&false) {
        BoundingSphere::of(&used().map(|(_, (&p, _))| p).collect::<Vec<_>>())
    } else {
        BoundingSphere::of(positions)
    };
    match sphere {
        // Without triangles, or with all their corners in one point, nothing has an area on any grid.
        None => Ok(BoundingSphere { center: DVec3::ZERO, radius: 1.0 }),
        Some(sphere) if sphere.radius == 0.0 => Ok(BoundingSphere { radius: 1.0, ..sphere }),
        Some(sphere) if (1e-140..=1e140).contains(&sphere.radius) => Ok(sphere),
        Some(sphere) => Err(AccelError::Extent { radius: sphere.radius }),
    }
}
