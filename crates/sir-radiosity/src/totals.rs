//! Energy balance and counts of a stage.

use std::ops::AddAssign;

use crate::power::Quanta;
use crate::visitor::Visitor;

/// Energy balance of a stage. It closes exactly: `emitted = absorbed + blocked + escaped + unshot`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Balance {
    /// Power sent out.
    pub emitted: Quanta,
    /// Power absorbed by the active sides that received it.
    pub absorbed: Quanta,
    /// Power absorbed by the backs of one-sided surfaces.
    pub blocked: Quanta,
    /// Power that left the scene or never met it. Light from outside enters through the box around the scene.
    pub escaped: Quanta,
    /// Power reflected, but not sent out again.
    pub unshot: Quanta,
}

impl Balance {
    /// True if no power was lost or created.
    #[must_use]
    pub fn closes(&self) -> bool {
        (0..3).all(|band| {
            let of = |q: Quanta| i128::from(q.0[band]);
            of(self.emitted) == of(self.absorbed) + of(self.blocked) + of(self.escaped) + of(self.unshot)
        })
    }
}

/// Counts of the lines of a stage and of their hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Number of lines traced.
    pub lines: u64,
    /// Number of lines that hit nothing.
    pub empty: u64,
    /// Number of global lines that hit an odd number of triangles: zero in scenes of closed surfaces.
    pub odd: u64,
    /// Number of triangles hit.
    pub crossings: u64,
}

/// The part of the balance and of the counts that one worker records. The totals of all workers add up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTotals {
    /// Energy balance.
    pub balance: Balance,
    /// Counts of lines and hits.
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
    /// Visits the totals.
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
