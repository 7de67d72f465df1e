//! Which sides of patches are in the focus.

use sir_geom::Side;
use sir_lines::Focus;
use sir_mesh::{PatchId, SideId};

use crate::model::Model;

/// The sides that matter: those whose patch lies in the focus with all of its corners. Without a focus, all of them.
///
/// Whatever line crosses such a patch meets the focus, so all that cross it count alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inside(Option<Vec<bool>>);

impl Inside {
    /// The sides of a model in a focus.
    #[must_use]
    pub fn of(model: &Model, focus: Option<&Focus>) -> Self {
        let Some(focus) = focus else { return Self(None) };
        let bounds = focus.bounds();
        let mut inside = vec![true; model.mesh.side_count()];
        // A face that is one patch has several triangles.
        for triangle in model.scene.triangle_ids() {
            let corners = model.scene.corners(triangle);
            let whole = corners.iter().all(|&corner| bounds.contains(corner));
            for patch in model.mesh.patches_of(triangle).map(PatchId) {
                let patch_inside = whole || {
                    let patch = model.mesh.patch_corners(triangle, patch);
                    patch.iter().all(|corner| bounds.contains(corner.point(corners)))
                };
                for side in [Side::Front, Side::Back] {
                    if let Some(id) = model.mesh.side_of(triangle, patch, side) {
                        inside[id.index()] &= patch_inside;
                    }
                }
            }
        }
        Self(Some(inside))
    }

    /// Whether a side is one of them.
    #[inline]
    #[must_use]
    pub fn has(&self, side: SideId) -> bool {
        self.0.as_ref().is_none_or(|inside| inside[side.index()])
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.as_ref().is_some_and(|inside| !inside.contains(&true))
    }

    /// Whether it is all, because there is no focus.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self.0.is_none()
    }
}
