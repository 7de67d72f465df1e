//! The sides of patches that are in the focus.

use sir_geom::Side;
use sir_lines::Focus;
use sir_mesh::SideId;

use crate::model::Model;

/// The sides in the focus: those whose patch has all of its corners in the focus. Without a focus, all sides.
///
/// Any line that crosses such a patch meets the focus, so all lines that cross it have the same weight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FocusSides(Option<Vec<bool>>);

impl FocusSides {
    /// Returns all sides, as without a focus.
    #[must_use]
    pub fn all() -> Self {
        Self(None)
    }

    /// Returns the sides of a model that are in a focus.
    #[must_use]
    pub fn of(model: &Model, focus: Option<&Focus>) -> Self {
        let Some(focus) = focus else { return Self::all() };
        let bounds = focus.bounds();
        let mut in_focus = vec![true; model.mesh.side_count()];
        for triangle in model.scene.triangle_ids() {
            let corners = model.scene.corners(triangle);
            let whole = corners.iter().all(|&corner| bounds.contains(corner));
            model.mesh.for_each_piece_of(triangle, |patch, piece| {
                let piece_in_focus =
                    whole || piece.corners().iter().all(|corner| bounds.contains(corner.point(corners)));
                for side in [Side::Front, Side::Back] {
                    if let Some(id) = model.mesh.side_of(triangle, patch, side) {
                        in_focus[id.index()] &= piece_in_focus;
                    }
                }
            });
        }
        Self(Some(in_focus))
    }

    /// True if a side is in the focus.
    #[inline]
    #[must_use]
    pub fn contains(&self, side: SideId) -> bool {
        self.0.as_ref().is_none_or(|in_focus| in_focus[side.index()])
    }

    /// Returns the number of sides of a model that are in the focus.
    #[must_use]
    pub fn count(&self, model: &Model) -> usize {
        self.0.as_ref().map_or(model.mesh.side_count(), |in_focus| in_focus.iter().filter(|is| **is).count())
    }

    /// True if no side is in the focus.
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
