//! A side of a patch, from which local lines start.

use std::collections::HashMap;

use glam::DVec3;
use sir_geom::{Side, TriangleId};
use sir_lines::Numbers;
use sir_mesh::{PatchId, SideId};

use crate::emitter::Emitter;
use crate::model::Model;

/// A side of the part of a patch that lies in one of its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchSide {
    /// The triangle.
    pub triangle: TriangleId,
    /// The patch.
    pub patch: PatchId,
    /// The side.
    pub side: Side,
}

impl PatchSide {
    /// Returns the place of a side of a patch of `triangle`.
    pub(crate) fn of(model: &Model, triangle: TriangleId, id: SideId) -> Self {
        let patch = model.mesh.patch_of_side(triangle, id);
        let is_front = model.mesh.side_of(triangle, patch, Side::Front) == Some(id);
        Self { triangle, patch, side: if is_front { Side::Front } else { Side::Back } }
    }

    /// Returns the corners of the part of the patch.
    #[inline]
    pub(crate) fn corners(self, model: &Model) -> [DVec3; 3] {
        let corners = model.scene.corners(self.triangle);
        model.mesh.patch_corners(self.triangle, self.patch).map(|corner| corner.point(corners))
    }

    /// Returns the unit normal on this side.
    #[inline]
    pub(crate) fn normal(self, model: &Model) -> DVec3 {
        match self.side {
            Side::Front => model.scene.normal(self.triangle),
            Side::Back => -model.scene.normal(self.triangle),
        }
    }

    /// Returns the emitter of lines from this side.
    #[inline]
    #[must_use]
    pub fn emitter(self, model: &Model) -> Emitter {
        let Self { triangle, patch, side } = self;
        let (corners, normal) = (self.corners(model), self.normal(model));
        Emitter::Surface { triangle, patch: Some(patch), side, corners, normal }
    }
}

/// Triangles of the patches that have several, by number of patch.
#[derive(Clone, Debug)]
pub(crate) struct MergedPatches(HashMap<u32, Vec<TriangleId>>);

impl MergedPatches {
    pub(crate) fn of(model: &Model) -> Self {
        let Model { scene, mesh, .. } = model;
        let mut merged: HashMap<u32, Vec<TriangleId>> = HashMap::new();
        if mesh.patch_count() < scene.triangles().len() {
            for triangle in scene.triangle_ids() {
                let patches = mesh.patches_of(triangle);
                if patches.len() == 1 {
                    merged.entry(patches.start).or_default().push(triangle);
                }
            }
            merged.retain(|_, triangles| triangles.len() > 1);
        }
        Self(merged)
    }

    /// Returns all parts of a patch.
    pub(crate) fn parts(&self, place: PatchSide) -> impl Iterator<Item = PatchSide> {
        let merged = self.0.get(&place.patch.0).map_or(&[][..], Vec::as_slice);
        let single = merged.is_empty().then_some(place);
        single.into_iter().chain(merged.iter().map(move |&triangle| PatchSide { triangle, ..place }))
    }

    /// Returns a random part of a patch, with a probability in proportion to its area. Only a patch of several triangles
    /// takes a number.
    #[inline]
    pub(crate) fn part_of(&self, place: PatchSide, model: &Model, numbers: &mut impl Numbers) -> PatchSide {
        match self.0.get(&place.patch.0) {
            Some(triangles) => {
                let area = |t| model.scene.area(t);
                PatchSide { triangle: one_of(triangles, area, numbers.unit()), ..place }
            }
            None => place,
        }
    }
}

/// Returns a random triangle with a probability in proportion to its area. `random` is uniform in `[0, 1)`.
fn one_of(triangles: &[TriangleId], area: impl Fn(TriangleId) -> f64, random: f64) -> TriangleId {
    let all: f64 = triangles.iter().map(|&t| area(t)).sum();
    let mut left = random * all;
    let mut chosen = triangles[0];
    for &triangle in triangles {
        chosen = triangle;
        left -= area(triangle);
        if left < 0.0 {
            break;
        }
    }
    chosen
}
