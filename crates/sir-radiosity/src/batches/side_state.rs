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
    /// Before the tail, the reflected direct power of the side. In the tail, `brought` at the start of the tail.
    pub(super) snapshot: [f32; 3],
    /// Number of lines that have crossed the side, counted by their weights.
    pub(super) crossings: u64,
}

impl SideState {
    /// Returns the ratio-estimator factor `λ/((1 − e^−λ) C)` for `λ` expected and `C` actual crossings; 1 if no line
    /// crossed.
    pub(super) fn factor(&self, expected: f64) -> f64 {
        // `f64::exp_m1` differs between platforms.
        if self.crossings == 0 { 1.0 } else { expected / -libm::expm1(-expected) / self.crossings as f64 }
    }

    /// Returns the power that lines have brought, the part of it in the tail, and all of it with the tail extrapolated.
    pub(super) fn extrapolated(&self, band: usize, extrapolation: f64) -> [f64; 3] {
        let brought = self.brought.0[band] as f64;
        let tail = brought - f64::from(self.snapshot[band]);
        [brought, tail, brought + tail * extrapolation]
    }

    /// Returns the variance of the power that lines have brought, given the number of lines. `sum` is the total power,
    /// and `squares` the sum of the squares.
    pub(super) fn variance(&self, sum: f64, squares: f64) -> f64 {
        let lines = self.crossings as f64;
        if lines < 2.0 { squares } else { (squares - sum * sum / lines).max(0.0) * lines / (lines - 1.0) }
    }

    /// Visits the states of all sides.
    pub(super) fn visit(sides: &mut [Self], visitor: &mut dyn Visitor) {
        visit_slice(
            sides,
            visitor,
            |side| {
                let Self { unshot: Quanta([a, b, c]), brought: Quanta([d, e, f]), snapshot, crossings } =
                    *side;
                let [g, h, i] = snapshot.map(to_word);
                [a, b, c, d, e, f, g, h, i, crossings as i64]
            },
            |[a, b, c, d, e, f, g, h, i, crossings]| Self {
                unshot: Quanta([a, b, c]),
                brought: Quanta([d, e, f]),
                snapshot: [g, h, i].map(from_word),
                crossings: crossings as u64,
            },
        );
    }
}
