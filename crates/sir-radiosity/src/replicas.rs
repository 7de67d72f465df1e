//! Multipath: global lines, traced one after the other, pass power on between all surfaces that face each other.
//!
//! Sbert, Pueyo, Neumann and Purgathofer (1996), *Global multipath Monte Carlo algorithms for radiosity*; Martínez,
//! Forés and Martín (2009), sections 2 and 4.
//!
//! What a line carries depends on the lines before it, so workers can share this transport only by running it several
//! times. The *replicas* of Martínez, Forés and Martín share the lines and the light, and their results add up, which
//! is the same as averaging full results. Power that has been reflected but not sent on when the lines of a replica end
//! is missing from the result: a share of about `ρ/(1−ρ) · P/n` for patches that `n` lines cross in `P` replicas
//! together.
//!
//! Here the last lines of a replica, the *tail*, take no power from the sources and only send on reflected power. What
//! is left then falls off like `exp(−(1−ρ) m)`, where `m` is the number of tail lines that cross a patch. Without a
//! tail, the method is as published.

use std::ops::Range;

use sir_geom::TriangleId;
use sir_lines::{Domain, Purpose, Streams};
use sir_mesh::SideId;

use crate::error::SolveError;
use crate::focus_sides::FocusSides;
use crate::global;
use crate::model::Model;
use crate::power::{PowerUnit, Quanta, visit_quanta};
use crate::received::Received;
use crate::segments::{End, Segment};
use crate::shot::Shot;
use crate::stage::{Chain, Stage, chain_units, share};
use crate::tallies::{Counters, PatchTallies, SquareUnit, SquareUnits, WorkerTallies};
use crate::totals::{Balance, StageTotals};
use crate::transported::{Transported, Walked};
use crate::visitor::Visitor;
use crate::workers::Workers;

/// Settings of a multipath transport.
#[derive(Clone, Debug)]
pub struct ReplicaSettings<'m> {
    /// The scene and its patches.
    pub model: &'m Model,
    /// The domain through which lines are drawn.
    pub domain: Domain,
    /// Number of lines of all replicas together.
    pub lines: u64,
    /// Number of lines of all tails together: the last lines of each replica, which only send on reflected power. With
    /// zero, the method is as published.
    pub tail: u64,
    /// Number of independent replicas that share the lines: at least 1.
    pub replicas: u64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl<'m> ReplicaSettings<'m> {
    /// Returns the settings for this number of lines in one replica, whose last tenth is the tail.
    #[must_use]
    pub fn new(model: &'m Model, domain: Domain, lines: u64, seed: u64) -> Self {
        Self { model, domain, lines, tail: lines / 10, replicas: 1, seed }
    }
}

/// A sequential transport of power along global lines, in independent replicas.
#[derive(Debug)]
pub struct Replicas<'m> {
    settings: ReplicaSettings<'m>,
    /// The direct light.
    received: Received,
    /// Power that the lines bring, and the share of the reflected direct power that leaves with each line.
    tallies: PatchTallies,
    streams: Streams,
    unit: PowerUnit,
}

/// State of one replica: multipath with its share of the lines.
#[derive(Clone, Debug)]
pub struct Replica {
    /// The end of its range of lines, exclusive.
    end: u64,
    /// The first line of the tail.
    tail: u64,
    /// Power received and reflected, but not sent on.
    unshot: Vec<Quanta>,
}

impl Chain for Replica {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_quanta(&mut self.unshot, visitor);
    }
}

impl<'m> Replicas<'m> {
    fn new(
        settings: ReplicaSettings<'m>,
        received: Received,
        unit: PowerUnit,
        tallies: PatchTallies,
    ) -> Self {
        let streams = Streams::new(settings.seed, Purpose::GLOBAL);
        Self { settings, received, tallies, streams, unit }
    }
}

impl<'m> Stage for Replicas<'m> {
    type Settings = ReplicaSettings<'m>;
    type Input = Shot;
    type Outcome = Transported;
    type Chain = Replica;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        let ReplicaSettings { model, domain, lines, tail, replicas, seed } = settings;
        vec![3, model.mesh.side_count() as u64, *lines, *seed, *tail, *replicas, domain.identity()]
    }

    /// Prepares the transport of the reflected direct power of a shot.
    ///
    /// Of the `N` lines that are not in a tail, `n = N · 2A/S` leave a side of a patch of area `A` on average, so each
    /// takes `1/n` of the reflected direct power of the side along.
    fn begin(settings: Self::Settings, shot: Shot, workers: &dyn Workers) -> Result<Self, SolveError> {
        let model = settings.model;
        let forecast = settings.domain.forecast(settings.lines.saturating_sub(settings.tail));
        let unshot = shot.unshot(model, workers);
        let mut shares = Vec::with_capacity(model.mesh.side_count());
        let (mut largest, mut most) = ([0.0; 3], 0.0);
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = model.reflectance(triangle, side);
            let crossings = forecast.crossings(model.area(triangle, side));
            // A patch without covered area holds no power.
            let share = unshot[side.index()].0.map(|q| if q == 0 { 0.0 } else { q as f64 / crossings });
            for band in 0..3 {
                largest[band] = f64::max(largest[band], share[band] / (1.0 - reflectance[band]));
            }
            most = f64::max(most, crossings);
            shares.push(share);
        });
        let tallies = PatchTallies::new(shares.len(), workers.count(), 1, SquareUnit::new(largest, most));
        for (i, share) in shares.into_iter().enumerate() {
            tallies.set_share(SideId::new(i), share);
        }
        Ok(Self::new(settings, shot.received, shot.unit, tallies))
    }

    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let sides = settings.model.mesh.side_count();
        let unit = PowerUnit::restore(visitor);
        let units_of_squares = SquareUnits::restore(FocusSides::all(), visitor);
        let tallies = PatchTallies::new(sides, workers.count(), 1, units_of_squares);
        let mut stage = Self::new(settings, Received::nothing(sides), unit, tallies);
        stage.visit_after_units(visitor);
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        0..self.settings.lines
    }

    fn chains(&self) -> u64 {
        self.settings.replicas
    }

    fn chain(&self, number: u64) -> Replica {
        let ReplicaSettings { model, tail, replicas, .. } = self.settings;
        let lines = chain_units(&self.round(), number, replicas);
        let tail = share(tail, number, replicas);
        let tail = lines.end - (tail.end - tail.start).min(lines.end - lines.start);
        Replica { end: lines.end, tail, unshot: vec![Quanta::ZERO; model.mesh.side_count()] }
    }

    /// Traces the next lines of a replica. After its last line, its unshot power is added to the balance.
    fn trace(&self, worker: usize, replica: &mut Replica, lines: Range<u64>, totals: &mut StageTotals) {
        let Replica { end, tail, unshot } = replica;
        let at_the_end = lines.end == *end;
        let StageTotals { balance, counts } = totals;
        let ReplicaSettings { model, domain, .. } = &self.settings;
        let tallies = self.tallies.of_worker(worker);
        let prefetch = |side| tallies.prefetch(side);
        let draw = |index| (domain.line(self.streams.line(index).point()), 1);
        global::trace(model, draw, lines, counts, prefetch, |index, _, segment| {
            exchange(model, tallies, unshot, balance, segment, index < *tail);
        });
        if at_the_end {
            for unshot in std::mem::take(unshot) {
                balance.unshot += unshot;
            }
        }
    }

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::All, visitor);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.unit.visit(visitor);
        self.tallies.visit_units(visitor);
        self.visit_after_units(visitor);
    }

    fn batches(&self) -> u64 {
        self.settings.replicas
    }

    fn finish(self, totals: StageTotals, _workers: &dyn Workers) -> Result<Transported, SolveError> {
        let Self { mut received, tallies, unit, .. } = self;
        let StageTotals { balance, counts } = totals;
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "multipath" });
        }
        tallies.add_to(&mut received);
        let walked = Walked::default();
        Ok(Transported { uncounted: received, counted: None, unit, balance, counts, walked })
    }
}

impl Replicas<'_> {
    /// Visits the state except the units, which are needed before the tallies can be created.
    fn visit_after_units(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::All, visitor);
        self.tallies.visit_shares(visitor);
        self.received.visit(visitor);
    }
}

/// Exchanges the power that the two ends of a segment hold.
#[inline]
fn exchange(
    model: &Model,
    tallies: WorkerTallies<'_>,
    unshot: &mut [Quanta],
    balance: &mut Balance,
    segment: Segment,
    emits: bool,
) {
    // Takes all unshot power of a side and, if the line emits, its share of the reflected direct power.
    let mut take = |side: SideId| {
        let emission = if emits { tallies.share(side) } else { Quanta::ZERO };
        balance.emitted += emission;
        std::mem::take(&mut unshot[side.index()]) + emission
    };
    match (segment.from, segment.to) {
        (End::Side(i, triangle_i), End::Side(j, triangle_j)) => {
            let (from_i, from_j) = (take(i), take(j));
            deposit(model, tallies, unshot, balance, (j, triangle_j), from_i);
            deposit(model, tallies, unshot, balance, (i, triangle_i), from_j);
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

/// Adds received power to a side, which absorbs a part and keeps the rest to send it on.
#[inline]
fn deposit(
    model: &Model,
    tallies: WorkerTallies<'_>,
    unshot: &mut [Quanta],
    balance: &mut Balance,
    (side, triangle): (SideId, TriangleId),
    power: Quanta,
) {
    tallies.deposit(side, power);
    let reflected = power.scaled(model.reflectance(triangle, side));
    unshot[side.index()] += reflected;
    balance.absorbed += power - reflected;
}
