//! Multipath: global lines pass power on between all surfaces that face each other, one after the other.
//!
//! Sbert, Pueyo, Neumann and Purgathofer (1996), *Global multipath Monte Carlo algorithms for radiosity*; Martínez,
//! Forés and Martín (2009), sections 2 and 4.
//!
//! What a line carries depends on the lines before it, so this transport can only be shared among workers by running it
//! several times: the *replicas* of Martínez, Forés and Martín share the lines and the light, and their results add up
//! (which is to say that full results are averaged). Power that has been reflected but not sent on when the lines of a
//! replica end is missing from the result: a share of about `ρ/(1−ρ) · P/n` for patches that `n` lines cross in `P`
//! replicas together.
//!
//! Here the last lines of a replica, the *tail*, take no power from the sources and only send on: what is left then
//! falls off like `exp(−(1−ρ) m)` with the number `m` of them that cross a patch. Without a tail, the method is as
//! published.

use std::ops::Range;

use sir_geom::TriangleId;
use sir_lines::{Domain, Stage, Streams};
use sir_mesh::SideId;

use crate::balance::{Balance, Books, Counts};
use crate::error::SolveError;
use crate::first_shot::Shot;
use crate::global;
use crate::ledger::{Counters, Ledger, Page, SquareUnit};
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::segments::{End, Segment};
use crate::solution::Solution;
use crate::state::Visitor;
use crate::state::visit_quanta;

/// A sequential transport of power along global lines, in independent replicas.
#[derive(Debug)]
pub struct Multipath<'m> {
    model: &'m Model,
    /// The direct light.
    received: Received,
    /// What the lines bring, and the share of the reflected direct power that leaves with each line.
    ledger: Ledger,
    streams: Streams,
    unit: PowerUnit,
    settings: MultipathSettings,
}

/// The lines of a transport.
#[derive(Clone, Debug, PartialEq)]
pub struct MultipathSettings {
    /// Number of lines, of all replicas together.
    pub lines: u64,
    /// How many of them, at the ends of the replicas, only send on what was reflected. With none, the method is as
    /// published.
    pub tail: u64,
    /// Among how many independent replicas the lines are shared: at least 1.
    pub replicas: u64,
    /// Where the lines are drawn from.
    pub domain: Domain,
}

impl MultipathSettings {
    /// This number of lines in one replica, of which the last tenth is the tail.
    #[must_use]
    pub fn new(lines: u64, domain: Domain) -> Self {
        Self { lines, tail: lines / 10, replicas: 1, domain }
    }

    /// The lines of a replica.
    #[must_use]
    pub fn lines_of(&self, replica: u64) -> Range<u64> {
        share(self.lines, replica, self.replicas)
    }
}

/// The part of `0..count` that belongs to one of several workers or replicas. The parts follow each other and differ in
/// length by one at most.
#[must_use]
pub fn share(count: u64, part: u64, parts: u64) -> Range<u64> {
    let start = |p: u64| (u128::from(count) * u128::from(p) / u128::from(parts)) as u64;
    start(part)..start(part + 1)
}

/// One run of multipath on its share of the lines. Its lines must be traced in order.
#[derive(Clone, Debug)]
pub struct Replica {
    /// The lines that are still to be traced.
    lines: Range<u64>,
    /// From which line on nothing is taken from the sources.
    tail: u64,
    /// Power received and reflected, but not sent on.
    unshot: Vec<Quanta>,
}

/// The outcome of a transport.
#[derive(Clone, Debug)]
pub struct Transported {
    /// Irradiance of all sides.
    pub solution: Solution,
    /// Power received by each side, direct and indirect: the exact tallies.
    pub received: Received,
    /// The size of a quantum.
    pub unit: PowerUnit,
    /// Where the power of this stage went.
    ///
    /// In multipath, `emitted` is what the lines took from the sources by forecast, which differs from the reflected
    /// direct power by chance; in batches it is that power.
    pub balance: Balance,
    /// What the lines met.
    pub counts: Counts,
    /// Power added to what was received to make up for the unshot; none in multipath, where the unshot is missing.
    pub made_up: Quanta,
}

impl<'m> Multipath<'m> {
    /// Prepares the transport of the reflected direct power of a first shot, for this number of workers: how many there
    /// are has no effect on the result, but on the time.
    ///
    /// A side of a patch of area `A` is left by `n = N · 2A/S` of the `N` lines that are not in a tail on average, so
    /// each takes `1/n` of its reflected direct power along.
    #[must_use]
    pub fn new(model: &'m Model, shot: Shot, settings: MultipathSettings, seed: u64, workers: usize) -> Self {
        let forecast = settings.domain.forecast(settings.lines.saturating_sub(settings.tail));
        let unshot = shot.unshot(model);
        let mut shares = Vec::with_capacity(model.mesh.side_count());
        let (mut largest, mut most) = ([0.0; 3], 0.0);
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = model.reflectance(triangle, side);
            let crossings = forecast.crossings(model.area(triangle, side));
            // A patch that is all gap holds nothing.
            let share = unshot[side.index()].0.map(|q| if q == 0 { 0.0 } else { q as f64 / crossings });
            for band in 0..3 {
                largest[band] = f64::max(largest[band], share[band] / (1.0 - reflectance[band]));
            }
            most = f64::max(most, crossings);
            shares.push(share);
        });
        let ledger = Ledger::new(shares.len(), workers, 1, SquareUnit::new(largest, most));
        for (i, share) in shares.into_iter().enumerate() {
            ledger.set_share(SideId::new(i), share);
        }
        let streams = Streams::new(seed, Stage::GLOBAL);
        Self { model, received: shot.received, ledger, streams, unit: shot.unit, settings }
    }

    /// A replica, with none of its lines traced.
    #[must_use]
    pub fn replica(&self, number: u64) -> Replica {
        let lines = self.settings.lines_of(number);
        let tail = share(self.settings.tail, number, self.settings.replicas);
        let tail = lines.end - (tail.end - tail.start).min(lines.end - lines.start);
        Replica { lines, tail, unshot: vec![Quanta::ZERO; self.model.mesh.side_count()] }
    }

    /// Traces at most `count` of the next lines of a replica; `worker` is the number of who does. At its end, what is
    /// unshot is booked.
    pub fn trace(&self, worker: usize, replica: &mut Replica, count: u64, books: &mut Books) {
        let Replica { lines, tail, unshot } = replica;
        let now = lines.start..lines.end.min(lines.start.saturating_add(count));
        lines.start = now.end;
        let Books { balance, counts } = books;
        let (model, page) = (self.model, self.ledger.page(worker));
        let soon = |side| page.prefetch(side);
        let draw = |index| (self.settings.domain.line(self.streams.line(index).point()), 1);
        global::trace(model, draw, now, counts, soon, |index, _, segment| {
            exchange(model, page, unshot, balance, segment, index < *tail);
        });
        if lines.is_empty() {
            for unshot in std::mem::take(unshot) {
                balance.unshot += unshot;
            }
        }
    }

    /// Shows the state of the stage to a visitor, but for that of the replicas which are under way.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.unit.visit(visitor);
        self.ledger.visit_unit(visitor);
        self.ledger.visit(Counters::All, visitor);
        self.ledger.visit_shares(visitor);
        self.received.visit(visitor);
    }

    /// Shows what the lines brought to a visitor.
    pub fn visit_counters(&mut self, visitor: &mut dyn Visitor) {
        self.ledger.visit(Counters::All, visitor);
    }

    /// Closes the books once all replicas have come to their end.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    pub fn finish(self, books: Books) -> Result<Transported, SolveError> {
        let Self { model, mut received, ledger, unit, .. } = self;
        let Books { balance, counts } = books;
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "multipath" });
        }
        ledger.add_to(&mut received);
        drop(ledger);
        let solution = Solution::new(model, &received, unit);
        Ok(Transported { solution, received, unit, balance, counts, made_up: Quanta::ZERO })
    }
}

impl Replica {
    /// How many lines are still to be traced.
    #[must_use]
    pub fn lines_left(&self) -> u64 {
        self.lines.end - self.lines.start
    }

    /// Shows the state of a replica that is under way to a visitor; the visitor is told that all workers have it alike,
    /// and has to see to it that they do.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        let mut start = [self.lines.start as i64];
        visitor.same(&mut start);
        self.lines.start = start[0] as u64;
        visit_quanta(&mut self.unshot, visitor);
    }
}

/// Both ends of a segment send what they hold to the other one.
#[inline]
fn exchange(
    model: &Model,
    page: Page<'_>,
    unshot: &mut [Quanta],
    balance: &mut Balance,
    segment: Segment,
    emits: bool,
) {
    // Takes all unshot power of a side and, if the line emits, its share of the reflected direct power.
    let mut take = |side: SideId| {
        let emission = if emits { page.share(side) } else { Quanta::ZERO };
        balance.emitted += emission;
        std::mem::take(&mut unshot[side.index()]) + emission
    };
    match (segment.from, segment.to) {
        (End::Side(i, triangle_i), End::Side(j, triangle_j)) => {
            let (from_i, from_j) = (take(i), take(j));
            give(model, page, unshot, balance, (j, triangle_j), from_i);
            give(model, page, unshot, balance, (i, triangle_i), from_j);
        }
        (End::Side(i, _), End::Outside) | (End::Outside, End::Side(i, _)) => {
            let power = take(i);
            balance.escaped += power;
        }
        (End::Side(i, _), End::Inactive) | (End::Inactive, End::Side(i, _)) => {
            let power = take(i);
            balance.blocked += power;
        }
        _ => {}
    }
}

/// A side receives power, absorbs some and keeps the rest to send it on.
#[inline]
fn give(
    model: &Model,
    page: Page<'_>,
    unshot: &mut [Quanta],
    balance: &mut Balance,
    (side, triangle): (SideId, TriangleId),
    power: Quanta,
) {
    page.give(side, power);
    let reflected = power.scaled(model.reflectance(triangle, side));
    unshot[side.index()] += reflected;
    balance.absorbed += power - reflected;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_cover_the_range_evenly() {
        for lines in [0, 1, 7, 1000, u64::MAX] {
            for workers in [1, 2, 3, 64] {
                let mut next = 0;
                for w in 0..workers {
                    let part = share(lines, w, workers);
                    assert_eq!(part.start, next);
                    assert!((part.end - part.start).abs_diff(lines / workers) <= 1);
                    next = part.end;
                }
                assert_eq!(next, lines);
            }
        }
    }
}
