//! Where the power went, and what the lines met.

use std::ops::AddAssign;

use crate::power::Quanta;
use crate::visitor::Visitor;

/// Energy balance of a stage. It closes exactly: `emitted = absorbed + blocked + escaped + unshot`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Balance {
    /// Sent out.
    pub emitted: Quanta,
    /// Absorbed by the active sides that received it.
    pub absorbed: Quanta,
    /// Absorbed by the backs of one-sided surfaces.
    pub blocked: Quanta,
    /// Left the scene, or never met it: light from outside enters the box around it.
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

/// What one worker writes down: its part of the balance and of the counts. Those of all workers add up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTotals {
    /// Where the power went.
    pub balance: Balance,
    /// What the lines met.
    pub counts: Counts,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.lines += other.lines;
        self.empty += other.empty;
        self.odd += other.odd;
        self.crossings += other.crossings;
    }
}

impl AddAssign for StageTotals {
    fn add_assign(&mut self, other: Self) {
        let (mine, theirs) = (&mut self.balance, other.balance);
        mine.emitted += theirs.emitted;
        mine.absorbed += theirs.absorbed;
        mine.blocked += theirs.blocked;
        mine.escaped += theirs.escaped;
        mine.unshot += theirs.unshot;
        self.counts += other.counts;
    }
}

impl StageTotals {
    /// Shows the totals to a visitor.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        let Self { balance: b, counts: c } = self;
        for quanta in [&mut b.emitted, &mut b.absorbed, &mut b.blocked, &mut b.escaped, &mut b.unshot] {
            visitor.sum(&mut quanta.0);
        }
        let counts = [&mut c.lines, &mut c.empty, &mut c.odd, &mut c.crossings];
        let mut words = [0; 4];
        words.iter_mut().zip(&counts).for_each(|(word, count)| *word = **count as i64);
        visitor.sum(&mut words);
        counts.into_iter().zip(words).for_each(|(count, word)| *count = word as u64);
    }
}
