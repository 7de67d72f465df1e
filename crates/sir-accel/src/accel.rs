//! The acceleration structure.

use glam::DVec3;
use sir_types::{BoundingSphere, TriangleId};

use crate::contact::ContactOrder;
use crate::error::{AccelError, MAX_TRIANGLES};
use crate::grid::Grid;
use crate::opacity::OpacityTest;
use crate::options::Options;
use crate::tree::Tree;
use crate::triangle::GridTriangle;

/// Acceleration structure: triangles arranged for tracing lines.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(crate) grid: Grid,
    pub(crate) tree: Tree,
    /// Rank of each triangle in the order of contact priorities; `None` if the rank is its number.
    ranks: Option<Vec<u32>>,
    /// `None` if all triangles are opaque.
    pub(crate) opacity: Option<OpacityTest>,
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
    pub fn build(positions: &[DVec3], indices: &[[u32; 3]], options: Options) -> Result<Self, AccelError> {
        let grid = Grid::new(bounding_sphere(positions, indices)?);
        let Options { contact_priorities, opacity } = options;
        let check = |list, found| {
            if found == indices.len() {
                Ok(())
            } else {
                Err(AccelError::WrongLength { list, found, triangles: indices.len() })
            }
        };
        contact_priorities.as_ref().map_or(Ok(()), |list| check("contact priorities", list.len()))?;
        opacity.as_ref().map_or(Ok(()), |test| check("transparent triangles", test.triangles()))?;
        let triangles: Vec<GridTriangle> = indices
            .iter()
            .zip(0..)
            .map(|(corners, number)| {
                // `bounding_sphere` has checked the indices.
                GridTriangle::new(corners.map(|i| grid.vertex(positions[i as usize])), TriangleId(number))
            })
            .collect();
        let tree = Tree::new(&triangles);
        let opacity = opacity.filter(OpacityTest::is_needed);
        Ok(Self { grid, tree, ranks: contact_priorities.map(|list| ranks(&list)), opacity })
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
            + self.ranks.as_ref().map_or(0, |ranks| size_of_val(ranks.as_slice()))
            + self.opacity.as_ref().map_or(0, OpacityTest::bytes)
    }

    /// Returns the order of triangles in contact.
    pub(crate) fn contacts(&self) -> ContactOrder<'_> {
        ContactOrder { tree: &self.tree, ranks: self.ranks.as_deref() }
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

/// Returns the rank of each element in the order by priority, then by number.
fn ranks(priorities: &[u32]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..priorities.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (priorities[i as usize], i));
    let mut ranks = vec![0; order.len()];
    order.iter().zip(0..).for_each(|(&i, rank)| ranks[i as usize] = rank);
    ranks
}
