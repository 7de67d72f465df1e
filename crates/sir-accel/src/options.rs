//! Options of the acceleration structure.

use std::fmt;
use std::sync::Arc;

use sir_types::TriangleId;

use crate::opacity::{Opacity, OpacityTest};

/// Properties of triangles besides their geometry. By default all triangles are opaque, and later ones lie on top of
/// earlier ones in contact with them.
#[derive(Default)]
pub struct Options<'p> {
    pub(crate) contact_priorities: Option<ContactPriorities<'p>>,
    pub(crate) opacity: Option<OpacityTest>,
}

/// Function that returns the contact priorities of triangles.
pub(crate) type ContactPriorities<'p> = Box<dyn FnOnce(&[TriangleId]) -> Vec<u32> + 'p>;

impl<'p> Options<'p> {
    /// Sets the contact priorities of triangles. Of triangles in contact whose fronts face a viewer, the one with the
    /// highest priority is visible (see [`Hit`](crate::Hit)). Among equal priorities, later triangles count as higher.
    ///
    /// The function is called once, with the numbers of all triangles in contact with others in ascending order, and
    /// returns one priority for each.
    #[must_use]
    pub fn contact_priorities(self, priorities: impl FnOnce(&[TriangleId]) -> Vec<u32> + 'p) -> Self {
        Self { contact_priorities: Some(Box::new(priorities)), ..self }
    }

    /// Makes some triangles transparent, at least in places. `is_transparent` has one element per triangle; the opacity
    /// is evaluated only for triangles where it is true.
    #[must_use]
    pub fn opacity(self, is_transparent: Vec<bool>, opacity: impl Opacity + 'static) -> Self {
        Self { opacity: Some(OpacityTest::new(is_transparent, Arc::new(opacity))), ..self }
    }
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("contact_priorities", &self.contact_priorities.is_some())
            .field("opacity", &self.opacity)
            .finish()
    }
}
