//! The number of batches, and the number of lines of each.

use std::ops::Range;

use sir_lines::GlobalLines;

use crate::batches::sums::{BatchSums, FocusSums};
use crate::power::Quanta;
use crate::visitor::{Visitor, visit_counts, visit_float};

/// Largest number of parts in which the power of the sources is sent out.
///
/// More parts spread the light of a source over more lines. Most of this gain is reached with 8 parts. Each part costs
/// an exchange between ranks.
const MAX_PARTS: u64 = 8;

/// Smallest number of crossings of a typical patch by a batch that sends a part of the sources, so that the power it
/// holds is not dominated by chance.
const CROSSINGS_PER_PART: f64 = 4.0;

/// Crossings of a typical patch by the smallest batch. With fewer, batches cost more than random walks do.
const MIN_CROSSINGS: f64 = 2.0;

/// Crossings of a typical patch that are reserved for the tail, times the absorbed share of the power sent. Random walks
/// send on what is unshot then.
const RESERVE: f64 = 2.0;

/// Largest share of all lines that is reserved for the tail.
const MAX_RESERVE_SHARE: f64 = 0.75;

/// Largest number of batches into which the reserve is divided.
const MAX_RESERVE_BATCHES: f64 = 32.0;

/// Unshot share of the power of the sources below which no further batch is made.
const NEGLIGIBLE: f64 = 1e-5;

/// Smallest number of random walks, and the largest share of the number of lines that it may be.
const MIN_WALKS: (u64, u64) = (1000, 10);

/// Variance that random walks add, as a share of that of the lines if these bring very different amounts.
const WALK_VARIANCE: f64 = 0.5;

/// Schedule of the transport: the current batch, the sums over all batches so far, and the size of the next batch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// Number of lines of all batches together.
    lines: u64,
    /// Range of lines of this batch: the first line and the end, exclusive.
    batch: [u64; 2],
    /// Number of this batch, from 0.
    number: u64,
    /// Number of parts in which the power of the sources is sent out.
    parts: u64,
    /// Smallest number of lines of a batch.
    min_lines: u64,
    /// Reflected power over power sent in the first shot.
    reflected_share: f64,
    /// Largest number of lines of a batch.
    max_lines: u64,
    /// Weight of the power outside the focus in the choice of the number of lines.
    outside_weight: f64,
    /// Reflected direct power.
    source: FocusSums,
    /// Sums over all batches so far; `unshot` is the current one.
    sums: BatchSums,
}

impl Schedule {
    /// Returns the schedule of `lines` lines, with its first batch.
    ///
    /// `lines_per_crossing` is the number of lines that cross a typical patch once, `source` the reflected direct
    /// power, and `reflected_share` the reflected power over the power sent in the first shot.
    pub(super) fn new(
        lines: u64,
        lines_per_crossing: f64,
        domain: &GlobalLines,
        source: FocusSums,
        reflected_share: f64,
    ) -> Self {
        let parts = (lines as f64 / lines_per_crossing / CROSSINGS_PER_PART) as u64;
        // Batches are smaller with a dense focus. Their number must suffice for most lines to carry light of the sources.
        let max_lines = domain.max_lines();
        let mut schedule = Self {
            lines,
            batch: [0; 2],
            number: 0,
            parts: parts.clamp(1, MAX_PARTS).max(lines / max_lines),
            min_lines: (MIN_CROSSINGS * lines_per_crossing).ceil() as u64,
            reflected_share,
            source,
            max_lines,
            outside_weight: 1.0 / f64::from(domain.weight()),
            sums: BatchSums { unshot: source, ..BatchSums::default() },
        };
        schedule.batch = [0, schedule.next_lines()];
        schedule
    }

    /// Returns the lines of the current batch.
    pub(super) fn batch(&self) -> Range<u64> {
        self.batch[0]..self.batch[1]
    }

    /// Returns the number of the current batch, from 0.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Returns the number of lines of all batches together.
    pub(super) fn lines(&self) -> u64 {
        self.lines
    }

    /// Returns the reflected direct power.
    pub(super) fn source(&self) -> Quanta {
        self.source.all
    }

    /// Returns the sums over all batches so far; `unshot` is the current one.
    pub(super) fn sums(&self) -> BatchSums {
        self.sums
    }

    /// True if all lines are traced.
    pub(super) fn is_over(&self) -> bool {
        self.batch[0] == self.lines
    }

    /// Returns the number of random walks that send on the unshot power, whose amount over all sides is `amount`.
    /// `crossings` is the expected number of crossings of the sides in the focus by all lines.
    ///
    /// Of the power `P` received in the focus, lines know the part `P/n` of a typical one of `n` patches up to `P/n` times
    /// the root of `n/crossings`, if the light is uneven. A walk brings `amount/walks` to each of the patches on its way, of
    /// which there are at most `1/(1−ρ)` on average. All walks are taken to start in the focus.
    pub(super) fn walks(&self, amount: f64, crossings: f64) -> u64 {
        if amount == 0.0 {
            return 0;
        }
        let FocusSums { all, in_focus } = self.sums.reflected;
        let (reflected, in_focus) = (all.total(), in_focus.total());
        if in_focus <= 0.0 {
            return self.lines;
        }
        let received = reflected + self.sums.absorbed.total();
        let share = amount / (received * in_focus / reflected);
        let rays = 1.0 / (1.0 - (reflected / received).clamp(0.0, 0.999));
        let walks = share * share * rays * crossings / WALK_VARIANCE;
        let (fewest, share) = MIN_WALKS;
        (walks as u64).clamp(fewest.min(self.lines.div_ceil(share)), self.lines)
    }

    /// Adds the sums of the batch that ends and proceeds to the next one. Returns false if there is none.
    pub(super) fn advance(&mut self, closed: BatchSums) -> bool {
        self.sums += closed;
        self.sums.unshot = closed.unshot;
        let [_, end] = self.batch;
        self.batch = [end, end];
        if self.is_over() {
            return false;
        }
        self.number += 1;
        self.batch[1] += self.next_lines();
        true
    }

    /// Returns the share of the power of the sources that is withheld for later batches.
    pub(super) fn withheld(&self) -> f64 {
        (1.0 - (self.number + 1) as f64 / self.parts as f64).max(0.0)
    }

    /// Returns the number of lines of the batch that begins.
    ///
    /// Of each unit of power sent, `r` is reflected and has to be sent again. Some lines are kept in reserve. The
    /// others are distributed in proportion to power, so that the relative error is the same for all power sent:
    /// `1/(1−r)` for each unit held. In the tail the number of lines falls off more slowly, with the square root of the
    /// power, so that less is left at the end. (With its fourth root still less is left, but where light is smooth the
    /// noise grows by 13 %.) The tail ends with the reserve, in small batches.
    fn next_lines(&self) -> u64 {
        let (left, min_lines) = (self.lines - self.batch[0], self.min_lines as f64);
        let weighted = |power: FocusSums| power.weighted(self.outside_weight);
        let (source, held, sent) =
            (weighted(self.source), weighted(self.sums.unshot), weighted(self.sums.sent));
        let r = if sent > 0.0 { weighted(self.sums.reflected) / sent } else { self.reflected_share };
        let sends = |r: f64| 1.0 / (1.0 - r);
        let r = r.clamp(0.0, 0.999);

        let emitting = self.number < self.parts;
        let in_tail = if emitting { source / self.parts as f64 * r * sends(r) } else { held };
        let still_to_send = held * sends(r) + in_tail * (sends(r.sqrt()) - sends(r));
        let reserve =
            (RESERVE / MIN_CROSSINGS * min_lines * sends(r)).min(MAX_RESERVE_SHARE * self.lines as f64);
        let shared = (left as f64 - reserve).max(0.0);
        let wanted = shared * (held - self.withheld() * source) / still_to_send;

        let over = !emitting && held <= NEGLIGIBLE * source;
        let wanted = wanted.max(reserve / MAX_RESERVE_BATCHES).max(min_lines);
        let lines = if over { left } else { left.min(wanted as u64) };
        let lines = if left - lines < self.min_lines { left } else { lines };
        // Crossings of a side are counted in 32 bits.
        lines.min(self.max_lines)
    }

    pub(super) fn visit(&mut self, focused: bool, visitor: &mut dyn Visitor) {
        // The other fields follow from the scene and the number of lines.
        let Self { batch: [start, end], number, reflected_share, source, sums, .. } = self;
        visit_counts([start, end, number], visitor);
        visit_float(reflected_share, visitor);
        let BatchSums { unshot, sent, reflected, absorbed } = sums;
        for power in [source, unshot, sent, reflected] {
            visitor.same(&mut power.all.0);
            if focused {
                visitor.same(&mut power.in_focus.0);
            } else {
                power.in_focus = power.all;
            }
        }
        visitor.same(&mut absorbed.0);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use sir_lines::Domain;

    use super::*;

    /// Power that leaves an open scene brings nothing to its surfaces, so it must not count among what lines know.
    #[test]
    fn the_number_of_walks_follows_from_the_power_received_in_the_focus() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let domain = GlobalLines::from(Domain::hull(&corners));
        let walks = |sent: i64, in_focus: i64| {
            let mut schedule = Schedule::new(1_000_000, 100.0, &domain, FocusSums::default(), 0.5);
            let quanta = |power| Quanta([power; 3]);
            let sums = &mut schedule.sums;
            sums.sent = FocusSums { all: quanta(sent), in_focus: quanta(0) };
            sums.reflected = FocusSums { all: quanta(500_000), in_focus: quanta(in_focus) };
            sums.absorbed = quanta(500_000);
            schedule.walks(3.0 * 10_000.0, 1e7)
        };
        let closed = walks(1_000_000, 500_000);
        // A hundredth of the power is unshot, half of it is reflected: 10⁻⁴ · 2 · 10⁷/(1/2).
        assert_eq!(closed, 4000);
        assert_eq!(walks(1_000_000_000, 500_000), closed);
        assert_eq!(walks(1_000_000, 250_000), 4 * closed);
        assert_eq!(walks(1_000_000, 0), 1_000_000);
    }
}
