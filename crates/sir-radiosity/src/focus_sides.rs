//! Which sides of patches are in the focus.

use sir_geom::Side;
use sir_lines::Focus;
use sir_mesh::{PatchId, SideId};

use crate::model::Model;

/// The sides that matter: those whose patch lies in the focus with all of its corners. Without a focus, all of them.
///
/// Whatever line crosses such a patch meets the focus, so all that cross it count alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FocusSides(Option<Vec<bool>>);

impl FocusSides {
    /// The sides of a model in a focus.
    #[must_use]
    pub fn of(model: &Model, focus: Option<&Focus>) -> Self {
        let Some(focus) = focus else { return Self(None) };
        let bounds = focus.bounds();
        let mut in_focus = vec![true; model.mesh.side_count()];
        // A face that is one patch has several triangles.
        for triangle in model.scene.triangle_ids() {
            let corners = model.scene.corners(triangle);
            let whole = corners.iter().all(|&corner| bounds.contains(corner));
            for patch in model.mesh.patches_of(triangle).map(PatchId) {
                let patch_in_focus = whole || {
                    let patch = model.mesh.patch_corners(triangle, patch);
                    patch.iter().all(|corner| bounds.contains(corner.point(corners)))
                };
                for side in [Side::Front, Side::Back] {
                    if let Some(id) = model.mesh.side_of(triangle, patch, side) {
                        in_focus[id.index()] &= patch_in_focus;
                    }
                }
            }
        }
        Self(Some(in_focus))
    }

    /// True if a side is one of them.
    #[inline]
    #[must_use]
    pub fn contains(&self, side: SideId) -> bool {
        self.0.as_ref().is_none_or(|in_focus| in_focus[side.index()])
    }

    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.as_ref().is_some_and(|in_focus| !in_focus.contains(&true))
    }

    /// True if no focus is set.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self.0.is_none()
    }
}
