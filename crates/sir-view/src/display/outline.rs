//! The patches of one triangle as polygons that share all points with their neighbors.

use glam::DVec3;
use sir_geom::{Scene, TriangleId};
use sir_mesh::{PatchId, PatchMesh};

use crate::display::seams::Seams;

/// One triangle, its patches and the points on its rim. The buffers are reused for all triangles.
///
/// *Nodes* are numbered within the triangle: first those of the rim, counterclockwise from the first corner, then the
/// inner corners of patches.
#[derive(Default)]
pub(super) struct Outline {
    /// Point numbers of the nodes on the rim.
    rim: Vec<u32>,
    /// Positions of all nodes.
    pub(super) positions: Vec<DVec3>,
    /// Node at which each part of each edge begins.
    parts: Vec<u32>,
    /// Node of each corner of the regular subdivision, row by row.
    lattice: Vec<u32>,
    divisions: u32,
}

/// A node of the polygon of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub(super) node: u32,
    /// Index of the corner of the patch; `None` for a node on an edge of it.
    pub(super) corner: Option<u8>,
}

impl Outline {
    /// Loads a triangle.
    pub(super) fn set(&mut self, scene: &Scene, mesh: &PatchMesh, seams: &Seams, triangle: TriangleId) {
        let n = mesh.divisions(triangle);
        self.divisions = n;
        self.rim.clear();
        self.parts.clear();
        for edge in 0..3 {
            for k in 0..n {
                for (i, point) in seams.part(triangle, edge, k, n).enumerate() {
                    if self.rim.last() != Some(&point) {
                        self.rim.push(point);
                    }
                    if i == 0 {
                        self.parts.push(self.rim.len() as u32 - 1);
                    }
                }
            }
        }
        if self.rim.len() > 1 && self.rim.first() == self.rim.last() {
            self.rim.pop();
            let last = self.rim.len() as u32;
            self.parts.iter_mut().filter(|p| **p == last).for_each(|p| *p = 0);
        }
        self.positions.clear();
        self.positions.extend(self.rim.iter().map(|&p| seams.points[p as usize]));
        self.place_lattice(seams.corners(scene, triangle));
    }

    fn place_lattice(&mut self, [a, b, c]: [DVec3; 3]) {
        let n = self.divisions;
        let share = |k: u32| f64::from(k) / f64::from(n);
        self.lattice.clear();
        for j in 0..=n {
            for i in 0..=n - j {
                let rim = if j == 0 {
                    Some(i)
                } else if i + j == n {
                    Some(n + j)
                } else if i == 0 {
                    Some(3 * n - j)
                } else {
                    None
                };
                let node = match rim {
                    Some(part) => self.parts[(part % (3 * n)) as usize],
                    None => {
                        self.positions.push(a + (b - a) * share(i) + (c - a) * share(j));
                        self.positions.len() as u32 - 1
                    }
                };
                self.lattice.push(node);
            }
        }
    }

    /// Returns the point numbers of the nodes on the rim, which are the first ones.
    pub(super) fn rim(&self) -> &[u32] {
        &self.rim
    }

    /// Returns the corners of patches on the rim before and after a node of the rim, both of the same patch.
    pub(super) fn ends_around(&self, node: u32) -> [u32; 2] {
        let next = self.parts.partition_point(|&part| part <= node);
        [self.parts[next.saturating_sub(1)], self.parts.get(next).copied().unwrap_or(0)]
    }

    /// Writes the polygon of a patch to `out`, counterclockwise seen from the front. It has fewer than three nodes if
    /// the patch is smaller than the tolerance of the mesh.
    pub(super) fn polygon(
        &self,
        mesh: &PatchMesh,
        triangle: TriangleId,
        patch: PatchId,
        out: &mut Vec<Corner>,
    ) {
        let n = self.divisions;
        let cells = mesh.patch_corners(triangle, patch).map(|p| {
            let whole = |x: f64| (x * f64::from(n)).round() as u32;
            (whole(p.v), whole(p.w))
        });
        out.clear();
        for (corner, &(i, j)) in (0u8..).zip(&cells) {
            let (next_i, next_j) = cells[(usize::from(corner) + 1) % 3];
            out.push(Corner { node: self.node(i, j), corner: Some(corner) });
            // Only edges on the rim have nodes between their ends.
            let part = if j == 0 && next_j == 0 {
                i
            } else if i + j == n && next_i + next_j == n {
                n + j
            } else if i == 0 && next_i == 0 {
                3 * n - j
            } else {
                continue;
            };
            let rim = self.rim.len() as u32;
            let end = self.parts[((part + 1) % (3 * n)) as usize];
            let mut node = self.parts[part as usize];
            while node != end {
                node = (node + 1) % rim;
                if node != end {
                    out.push(Corner { node, corner: None });
                }
            }
        }
        out.dedup_by_key(|c| c.node);
        if out.len() > 1 && out[0].node == out[out.len() - 1].node {
            out.pop();
        }
    }

    fn node(&self, i: u32, j: u32) -> u32 {
        let row = j * (2 * self.divisions + 3 - j) / 2;
        self.lattice[(row + i) as usize]
    }
}
