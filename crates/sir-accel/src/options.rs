//! Options of the acceleration structure.

use std::sync::Arc;

use crate::opacity::{Opacity, OpacityTest};

/// Properties of triangles besides their geometry. By default all triangles are opaque, and later ones lie on top of
/// earlier ones in contact with them.
#[derive(Clone, Debug, Default)]
pub struct Options {
    pub(crate) contact_priorities: Option<Vec<u32>>,
    pub(crate) opacity: Option<OpacityTest>,
}

impl Options {
    /// Sets the contact priority of each triangle. Of triangles in contact whose fronts face a viewer, the one with the
    /// highest priority is visible (see [`Hit`](crate::Hit)). Among equal priorities, later triangles count as higher.
    #[must_use]
    pub fn contact_priorities(self, priorities: Vec<u32>) -> Self {
        Self { contact_priorities: Some(priorities), ..self }
    }

    /// Makes some triangles transparent, at least in places. `is_transparent` has one element per triangle; the opacity
    /// is evaluated only for triangles where it is true.
    #[must_use]
    pub fn opacity(self, is_transparent: Vec<bool>, opacity: impl Opacity + 'static) -> Self {
        Self { opacity: Some(OpacityTest::new(is_transparent, Arc::new(opacity))), ..self }
    }
}
