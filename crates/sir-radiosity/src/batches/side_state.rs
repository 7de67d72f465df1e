//! The state of a side in the transport.

use crate::power::Quanta;
use crate::visitor::{Visitor, from_word, to_word, visit_slice};

/// State of a side between two batches.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SideState {
    /// Power that the side holds.
    pub(super) unshot: Quanta,
    /// Power that lines have brought.
    pub(super) brought: Quanta,
    /// Reflected direct power of the side.
    pub(super) source: [f32; 3],
    /// Number of lines that have crossed the side, counted by their weights.
    pub(super) crossings: u64,
}

impl SideState {
    /// Visits the states of all sides.
    pub(super) fn visit(sides: &mut [Self], visitor: &mut dyn Visitor) {
        visit_slice(
            sides,
            visitor,
            |side| {
                let Self { unshot: Quanta([a, b, c]), brought: Quanta([d, e, f]), source, crossings } = *side;
                let [g, h, i] = source.map(to_word);
                [a, b, c, d, e, f, g, h, i, crossings as i64]
            },
            |[a, b, c, d, e, f, g, h, i, crossings]| Self {
                unshot: Quanta([a, b, c]),
                brought: Quanta([d, e, f]),
                source: [g, h, i].map(from_word),
                crossings: crossings as u64,
            },
        );
    }
}
