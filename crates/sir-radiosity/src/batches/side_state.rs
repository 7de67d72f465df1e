//! What the transport knows of a side.

use crate::power::Quanta;
use crate::visitor::{Visitor, from_word, to_word, visit_slice};

/// What the transport knows of a side between two batches.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SideState {
    /// Power that it holds.
    pub(super) unshot: Quanta,
    /// Power that lines have brought.
    pub(super) brought: Quanta,
    /// While the sources are sent out, what is to be sent of them; afterwards, as `brought` when they had ceased.
    pub(super) noted: [f32; 3],
    /// Lines that have crossed it, by their weights.
    pub(super) crossings: u64,
}

impl SideState {
    /// Returns the ratio-estimator factor `λ/((1 − e^−λ) C)` for `λ` expected and `C` actual crossings; 1 if no line crossed.
    pub(super) fn factor(&self, expected: f64) -> f64 {
        if self.crossings == 0 { 1.0 } else { expected / -(-expected).exp_m1() / self.crossings as f64 }
    }

    /// Returns the power that lines have brought, the part of it in the tail, and all of it with the tail stretched.
    pub(super) fn stretched(&self, band: usize, stretch: f64) -> [f64; 3] {
        let brought = self.brought.0[band] as f64;
        let tail = brought - f64::from(self.noted[band]);
        [brought, tail, brought + tail * stretch]
    }

    /// Returns the variance of the power that lines have brought, given their number: `sum` in all, with the sum of `squares`.
    pub(super) fn variance(&self, sum: f64, squares: f64) -> f64 {
        let lines = self.crossings as f64;
        if lines < 2.0 { squares } else { (squares - sum * sum / lines).max(0.0) * lines / (lines - 1.0) }
    }

    /// Shows the states of all sides to a visitor.
    pub(super) fn visit(sides: &mut [Self], visitor: &mut dyn Visitor) {
        visit_slice(
            sides,
            visitor,
            |side| {
                let Self { unshot: Quanta([a, b, c]), brought: Quanta([d, e, f]), noted, crossings } = *side;
                let [g, h, i] = noted.map(to_word);
                [a, b, c, d, e, f, g, h, i, crossings as i64]
            },
            |[a, b, c, d, e, f, g, h, i, crossings]| Self {
                unshot: Quanta([a, b, c]),
                brought: Quanta([d, e, f]),
                noted: [g, h, i].map(from_word),
                crossings: crossings as u64,
            },
        );
    }
}
