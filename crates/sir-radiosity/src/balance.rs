//! Where the power went, and what the lines met.

use crate::Quanta;

/// Energy balance of a stage. It closes exactly: `emitted = absorbed + blocked + escaped + unshot`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Balance {
    /// Sent out.
    pub emitted: Quanta,
    /// Absorbed by the active sides that received it.
    pub absorbed: Quanta,
    /// Absorbed by the backs of one-sided surfaces.
    pub blocked: Quanta,
    /// Left the scene.
    pub escaped: Quanta,
    /// Reflected, but not sent out again.
    pub unshot: Quanta,
}

impl Balance {
    /// Whether no power was lost or made.
    #[must_use]
    pub fn closes(&self) -> bool {
        (0..3).all(|band| {
            let of = |q: Quanta| i128::from(q.0[band]);
            of(self.emitted) == of(self.absorbed) + of(self.blocked) + of(self.escaped) + of(self.unshot)
        })
    }
}

/// What the lines of a stage met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Lines traced.
    pub lines: u64,
    /// Lines that met nothing.
    pub empty: u64,
    /// Global lines that met an odd number of triangles: none in scenes of closed surfaces.
    pub odd: u64,
    /// Triangles met.
    pub crossings: u64,
}
