//! The number of batches, and the number of lines of each.

use std::ops::Range;

use sir_lines::GlobalLines;

use crate::batches::sums::{BatchSums, FocusSums};
use crate::power::Quanta;
use crate::visitor::{Visitor, visit_counts, visit_float};

/// Largest number of parts in which the power of the sources is sent out.
///
/// More parts spread the light of a source over more lines. Most of this gain is reached with 16 parts. Each part costs
/// an exchange between ranks.
const MAX_PARTS: u64 = 16;

/// Smallest number of crossings of a typical patch by a batch that sends a part of the sources, so that the power it
/// holds is not dominated by chance.
const CROSSINGS_PER_PART: f64 = 8.0;

/// Crossings of a typical patch by the smallest batch. Smaller batches delay less of what the tail sends.
const MIN_CROSSINGS: f64 = 0.25;

/// Crossings of a typical patch that are reserved for the tail, times the absorbed share of the power sent. The unshot
/// power falls below `exp(−RESERVE/2)`.
const RESERVE: f64 = 7.0;

/// Largest share of all lines that is reserved for the tail.
const MAX_RESERVE_SHARE: f64 = 0.75;

/// Largest number of batches into which the reserve is divided.
const MAX_RESERVE_BATCHES: f64 = 32.0;

/// Unshot share of the power of the sources below which no further batch is made.
const NEGLIGIBLE: f64 = 1e-5;

/// Largest ratio of the unshot power at the end to that at the start of the tail for which the tail is extrapolated.
const MAX_EXTRAPOLATION: f64 = 0.9;

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
    /// Unshot power at the start of the tail.
    unshot_at_tail: FocusSums,
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
            unshot_at_tail: FocusSums::default(),
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

    /// True in the first batch of the tail, which sends nothing of the sources.
    pub(super) fn tail_begins(&self) -> bool {
        self.number == self.parts
    }

    /// Adds the sums of the batch that ends and proceeds to the next one. Returns false if there is none.
    pub(super) fn advance(&mut self, closed: BatchSums) -> bool {
        self.sums += closed;
        self.sums.unshot = closed.unshot;
        let [_, end] = self.batch;
        if end >= self.lines {
            return false;
        }
        self.number += 1;
        if self.tail_begins() {
            self.unshot_at_tail = self.sums.unshot;
        }
        self.batch = [end, end];
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

    /// Returns the extrapolation factor per band: the power to be added for each unit of power received in the tail.
    ///
    /// Unshot power in the focus is assumed to spread in the focus, and unshot power elsewhere likewise.
    pub(super) fn extrapolation(&self, inside: bool) -> [f64; 3] {
        let [unshot_at_tail, unshot] = [self.unshot_at_tail, self.sums.unshot].map(|sums| sums.part(inside));
        std::array::from_fn(|band| {
            let (before, after) = (unshot_at_tail.0[band] as f64, unshot.0[band] as f64);
            if after > 0.0 && after <= MAX_EXTRAPOLATION * before { after / (before - after) } else { 0.0 }
        })
    }

    pub(super) fn visit(&mut self, focused: bool, visitor: &mut dyn Visitor) {
        // The other fields follow from the scene and the number of lines.
        let Self { batch: [start, end], number, reflected_share, source, unshot_at_tail, sums, .. } = self;
        visit_counts([start, end, number], visitor);
        visit_float(reflected_share, visitor);
        let BatchSums { unshot, sent, reflected, absorbed } = sums;
        for power in [source, unshot_at_tail, unshot, sent, reflected] {
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
