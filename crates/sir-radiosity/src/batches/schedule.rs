//! How many batches there are, and how many lines each has.

use std::ops::Range;

use sir_lines::GlobalLines;

use crate::batches::sums::{BatchSums, FocusSums};
use crate::power::Quanta;
use crate::visitor::{Visitor, visit_counts, visit_float};

/// Most parts in which the sources are sent out.
///
/// More parts spread the light of a source over more lines, to a limit that is nearly reached with 16, and cost an exchange
/// between ranks each.
const MOST_PARTS: u64 = 16;

/// Crossings of a typical patch that a batch with a part of the sources should have at least, for what it holds not to
/// be mere chance.
const CROSSINGS_PER_PART: f64 = 8.0;

/// How often the smallest batch crosses a typical patch. The smaller, the less of what the tail sends is held back.
const SMALLEST: f64 = 0.25;

/// Crossings of a typical patch that are kept for the tail, times the absorbed share of what is sent: what is unshot falls to
/// less than `exp(−RESERVE/2)`.
const RESERVE: f64 = 7.0;

/// Most of all lines that are kept for the tail.
const MOST_RESERVED: f64 = 0.75;

/// Into how many batches the reserve is cut at most.
const RESERVE_BATCHES: f64 = 32.0;

/// Share of the sources' power below which the unshot is not worth another batch.
const NEGLIGIBLE: f64 = 1e-5;

/// Largest share of the power unshot when the sources had ceased that may be left for the tail to be stretched.
const STRETCHABLE: f64 = 0.9;

/// Which batch the transport is in, what all batches so far have done, and how many lines the next one has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// Lines of all batches together.
    lines: u64,
    /// The lines of this batch: the first one, and the one after the last.
    batch: [u64; 2],
    /// Number of this batch, from 0.
    number: u64,
    /// Parts in which the sources are sent out.
    parts: u64,
    /// Lines of the smallest batch.
    least: u64,
    /// Reflected power per power sent in the first shot.
    guess: f64,
    /// Most lines of a batch.
    most: u64,
    /// How much a side outside of the focus counts for the number of lines.
    outside: f64,
    /// Reflected direct power, in all.
    source: FocusSums,
    /// Unshot power when the sources had ceased.
    ceased: FocusSums,
    /// Sums over all batches so far; `unshot` is that of now.
    sums: BatchSums,
}

impl Schedule {
    /// Returns the schedule of `lines` lines, and its first batch.
    ///
    /// `once` is the number of lines that cross a typical patch once, `source` the reflected direct power, and `guess` the
    /// reflected power per power sent in the first shot.
    pub(super) fn new(lines: u64, once: f64, domain: &GlobalLines, source: FocusSums, guess: f64) -> Self {
        let parts = (lines as f64 / once / CROSSINGS_PER_PART) as u64;
        let mut schedule = Self {
            lines,
            batch: [0; 2],
            number: 0,
            parts: parts.clamp(1, MOST_PARTS),
            least: (SMALLEST * once).ceil() as u64,
            guess,
            source,
            most: domain.max_lines(),
            outside: 1.0 / f64::from(domain.weight()),
            ceased: FocusSums::default(),
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

    /// Returns the number of lines of all batches.
    pub(super) fn lines(&self) -> u64 {
        self.lines
    }

    /// Returns the reflected direct power.
    pub(super) fn source(&self) -> Quanta {
        self.source.all
    }

    /// Returns what all batches so far have done; `unshot` is that of now.
    pub(super) fn sums(&self) -> BatchSums {
        self.sums
    }

    /// True in the first batch that sends nothing of the sources.
    pub(super) fn sources_just_ceased(&self) -> bool {
        self.number == self.parts
    }

    /// Goes on to the next batch after one that did this. Returns false if there is none.
    pub(super) fn advance(&mut self, closed: BatchSums) -> bool {
        self.sums += closed;
        self.sums.unshot = closed.unshot;
        let [_, end] = self.batch;
        if end >= self.lines {
            return false;
        }
        self.number += 1;
        if self.sources_just_ceased() {
            self.ceased = self.sums.unshot;
        }
        self.batch = [end, end];
        self.batch[1] += self.next_lines();
        true
    }

    /// Share of the sources' power that is kept for later batches.
    pub(super) fn withheld(&self) -> f64 {
        (1.0 - (self.number + 1) as f64 / self.parts as f64).max(0.0)
    }

    /// Returns how many lines the batch that begins now should have.
    ///
    /// Of each unit of power sent, `r` is reflected and has to be sent again. Some lines are kept in reserve, and the rest is
    /// shared in proportion to power, for the same relative error in all that is sent: `1/(1−r)` for each unit held. In
    /// the tail the number of lines falls off more slowly, with the square root of the power, for less to be left at the
    /// end. (With its fourth root still less is left, but where light is smooth the noise grows by 13 %.) The tail ends
    /// with the reserve, in small batches.
    fn next_lines(&self) -> u64 {
        let (left, least) = (self.lines - self.batch[0], self.least as f64);
        let weighted = |power: FocusSums| power.weighted(self.outside);
        let (source, held, sent) =
            (weighted(self.source), weighted(self.sums.unshot), weighted(self.sums.sent));
        let r = if sent > 0.0 { weighted(self.sums.reflected) / sent } else { self.guess };
        let sends = |r: f64| 1.0 / (1.0 - r);
        let r = r.clamp(0.0, 0.999);

        let emitting = self.number < self.parts;
        let in_tail = if emitting { source / self.parts as f64 * r * sends(r) } else { held };
        let still_to_send = held * sends(r) + in_tail * (sends(r.sqrt()) - sends(r));
        let reserve = (RESERVE / SMALLEST * least * sends(r)).min(MOST_RESERVED * self.lines as f64);
        let shared = (left as f64 - reserve).max(0.0);
        let wanted = shared * (held - self.withheld() * source) / still_to_send;

        let over = !emitting && held <= NEGLIGIBLE * source;
        let wanted = wanted.max(reserve / RESERVE_BATCHES).max(least);
        let lines = if over { left } else { left.min(wanted as u64) };
        let lines = if left - lines < self.least { left } else { lines };
        // Crossings of a side are counted in 32 bits.
        lines.min(self.most)
    }

    /// What is to be added to the power received in the tail for each unit of it, per band.
    /// The power left in the focus is taken to spread in it, and that left elsewhere likewise.
    pub(super) fn stretch(&self, inside: bool) -> [f64; 3] {
        let [ceased, unshot] = [self.ceased, self.sums.unshot].map(|sums| sums.part(inside));
        std::array::from_fn(|band| {
            let (before, after) = (ceased.0[band] as f64, unshot.0[band] as f64);
            if after > 0.0 && after <= STRETCHABLE * before { after / (before - after) } else { 0.0 }
        })
    }

    pub(super) fn visit(&mut self, focused: bool, visitor: &mut dyn Visitor) {
        // The other fields follow from the scene and the number of lines.
        let Self { batch: [start, end], number, guess, source, ceased, sums, .. } = self;
        visit_counts([start, end, number], visitor);
        visit_float(guess, visitor);
        let BatchSums { unshot, sent, reflected, absorbed } = sums;
        for power in [source, ceased, unshot, sent, reflected] {
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
