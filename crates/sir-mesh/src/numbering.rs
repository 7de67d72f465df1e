//! Numbering of the patches and sides of a scene.

use std::collections::HashMap;
use std::ops::Range;

use sir_geom::{Barycentric, BoundingBox, FaceId, Scene, Sides, TriangleId};

use crate::barycentric;
use crate::divisions::Subdivision;
use crate::error::MeshError;
use crate::index::PatchId;

/// Data to find a side of a triangle, and nothing else, so that it stays in the cache.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    pub(crate) first_side: u32,
    /// Parts of an edge, `n`, below 2¹⁶; the triangle has `n²` patches.
    divisions: u16,
    /// Sides per patch, 1 or 2.
    pub(crate) sides: u16,
}

impl Cut {
    pub(crate) fn divisions(self) -> u32 {
        u32::from(self.divisions)
    }

    pub(crate) fn sides(self) -> u32 {
        u32::from(self.sides)
    }
}

/// The patches of one triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patches {
    pub(crate) first: u32,
    /// Area of each patch.
    pub(crate) area: f64,
}

/// Cuts and first numbers of all triangles. Uses 28 bytes per triangle.
#[derive(Clone, Debug)]
pub(crate) struct Numbering {
    pub(crate) cuts: Vec<Cut>,
    pub(crate) patches_of: Vec<Patches>,
    /// Triangles in the order of the numbers of their patches; only the first of a merged face.
    pub(crate) owners: Vec<TriangleId>,
    pub(crate) patches: u32,
    pub(crate) sides: u32,
}

impl Numbering {
    /// Cuts the triangles of a scene; if a box is given, only those whose centroid is in it.
    pub(crate) fn new(
        scene: &Scene,
        subdivision: Subdivision,
        bounds: Option<BoundingBox>,
    ) -> Result<Self, MeshError> {
        let divisions = subdivision.divisions(scene, bounds)?;
        let mut numbering = Self {
            cuts: Vec::with_capacity(divisions.len()),
            patches_of: Vec::with_capacity(divisions.len()),
            owners: scene.triangle_ids().collect(),
            patches: 0,
            sides: 0,
        };
        for (t, &n) in scene.triangle_ids().zip(&divisions) {
            let per_triangle = n.checked_mul(n).ok_or(MeshError::TooMany)?;
            let divisions = u16::try_from(n).map_err(|_| MeshError::TooMany)?;
            let sides = match scene.material(t).sides {
                Sides::Front => 1,
                Sides::Both => 2,
            };
            numbering.cuts.push(Cut { first_side: numbering.sides, divisions, sides });
            numbering
                .patches_of
                .push(Patches { first: numbering.patches, area: scene.area(t) / f64::from(per_triangle) });
            let more = |count: u32, by: u32| count.checked_add(by).ok_or(MeshError::TooMany);
            numbering.patches = more(numbering.patches, per_triangle)?;
            numbering.sides =
                more(numbering.sides, per_triangle.checked_mul(u32::from(sides)).ok_or(MeshError::TooMany)?)?;
        }
        if subdivision == Subdivision::PerFace {
            numbering.merge_faces(scene);
        }
        Ok(numbering)
    }

    /// Merges the (undivided) triangles of each flat polygon into one patch.
    fn merge_faces(&mut self, scene: &Scene) {
        let mut faces: HashMap<FaceId, Vec<TriangleId>> = HashMap::new();
        for t in scene.triangle_ids() {
            faces.entry(scene.triangle(t).face).or_default().push(t);
        }
        faces.retain(|_, members| is_flat(scene, members));
        (self.patches, self.sides) = (0, 0);
        self.owners.clear();
        for t in scene.triangle_ids() {
            if let Some(members) = faces.get(&scene.triangle(t).face) {
                if t != members[0] {
                    self.cuts[t.index()] = self.cuts[members[0].index()];
                    self.patches_of[t.index()] = self.patches_of[members[0].index()];
                    continue;
                }
                self.patches_of[t.index()].area = members.iter().map(|&m| scene.area(m)).sum();
            }
            self.owners.push(t);
            self.patches_of[t.index()].first = self.patches;
            self.cuts[t.index()].first_side = self.sides;
            self.patches += 1;
            self.sides += self.cuts[t.index()].sides();
        }
    }

    /// Returns the number of parts into which each edge of a triangle is cut.
    pub(crate) fn divisions(&self, triangle: TriangleId) -> u32 {
        self.cuts[triangle.index()].divisions()
    }

    /// Returns the numbers of the patches of a triangle.
    pub(crate) fn patches_of(&self, triangle: TriangleId) -> Range<u32> {
        let (first, n) = (self.patches_of[triangle.index()].first, self.divisions(triangle));
        first..first + n * n
    }

    /// Returns the corners of a patch as points of its triangle.
    pub(crate) fn patch_corners(&self, triangle: TriangleId, patch: PatchId) -> [Barycentric; 3] {
        let first = self.patches_of[triangle.index()].first;
        barycentric::corners(self.divisions(triangle), patch.0 - first)
    }
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
