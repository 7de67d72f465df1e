//! Options of the acceleration structure.

use std::sync::Arc;

use crate::opacity::{Opacity, OpacityTest};

/// Properties of triangles beside their geometry. By default all are opaque, and later ones lie on top of earlier ones that they
/// touch.
#[derive(Clone, Debug, Default)]
pub struct Options {
    pub(crate) contact_priorities: Option<Vec<u32>>,
    pub(crate) opacity: Option<OpacityTest>,
}

impl Options {
    /// Sets the priority of each triangle among those in contact with it: the side that faces a viewer shows the highest one (see
    /// [`Hit`](crate::Hit)). Of equal priorities, later triangles count as higher.
    #[must_use]
    pub fn contact_priorities(self, priorities: Vec<u32>) -> Self {
        Self { contact_priorities: Some(priorities), ..self }
    }

    /// Makes some triangles transparent, at least in places. `is_transparent` has an element per triangle; the opacity is asked for only
    /// where it is true.
    #[must_use]
    pub fn opacity(self, is_transparent: Vec<bool>, opacity: impl Opacity + 'static) -> Self {
        Self { opacity: Some(OpacityTest::new(is_transparent, Arc::new(opacity))), ..self }
    }
}
