//! The first shot: local lines carry the light of the sources to the first surfaces.
//!
//! Martínez, Forés and Martín (2009), section 2; Castro, Martínez and Sbert (1998).

use std::ops::Range;

use sir_accel::Ray;
use sir_geom::Rgb;
use sir_lines::{Allocation, LocalLines, Stage, Streams};
use sir_mesh::SideId;

use crate::balance::{Balance, Books, Counts};
use crate::error::SolveError;
use crate::global::AHEAD;
use crate::ledger::{Counters, HEADROOM, Ledger, SquareUnit};
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::solution::Solution;
use crate::sources::{Aimed, Source};
use crate::state::Visitor;
use crate::state::visit_counts;

/// Rays that are made at a time.
const RAYS: usize = 1024;

/// Copies of the ledger that there is room for, however large it is: later stages need more per side than this one.
const COPIES: usize = 2;

/// The lines of a first shot: what each one carries, and from where.
#[derive(Clone, Debug)]
pub struct FirstShot<'m> {
    model: &'m Model,
    sources: Vec<Source>,
    /// Power of one line of each source.
    per_line: Vec<Quanta>,
    /// How many times as dense lines are in a focus.
    density: f64,
    allocation: Allocation,
    streams: Streams,
    unit: PowerUnit,
    lines: u64,
}

/// What the lines of a first shot have brought so far. Any number of workers may trace into one.
#[derive(Debug)]
pub struct FirstShotTally {
    ledger: Ledger,
}

/// The outcome of a first shot.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Direct power received by each side.
    pub received: Received,
    /// The size of a quantum, for this and all later stages.
    pub unit: PowerUnit,
    /// Where the power went. Its `unshot` is the reflected direct power that has to be sent on.
    pub balance: Balance,
    /// What the lines met.
    pub counts: Counts,
    /// What some sides have sent of the light that they reflect, in a second shot.
    pub sent: Vec<(SideId, Quanta)>,
}

impl Shot {
    /// Power that each side reflects and has not sent; by chance a little less than nothing where it has sent all.
    #[must_use]
    pub fn unshot(&self, model: &Model) -> Vec<Quanta> {
        let mut unshot = Vec::with_capacity(model.mesh.side_count());
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = model.reflectance(triangle, side);
            unshot.push(self.received.power[side.index()].scaled(reflectance));
        });
        for &(side, sent) in &self.sent {
            unshot[side.index()] = unshot[side.index()] - sent;
        }
        unshot
    }

    /// Shows a first shot to a visitor.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.received.visit(visitor);
        self.unit.visit(visitor);
        let Balance { emitted, absorbed, blocked, escaped, unshot } = &mut self.balance;
        for quanta in [emitted, absorbed, blocked, escaped, unshot] {
            visitor.same(&mut quanta.0);
        }
        let Counts { lines, empty, odd, crossings } = &mut self.counts;
        visit_counts([lines, empty, odd, crossings], visitor);
    }

    /// The direct light alone: the irradiance by the sources, before any reflection.
    #[must_use]
    pub fn solution(&self, model: &Model) -> Solution {
        Solution::new(model, &self.received, self.unit)
    }

    /// The outcome of no shot at all, to be filled by a later stage that is restored.
    #[must_use]
    pub fn nothing(model: &Model) -> Self {
        Self {
            received: Received::nothing(model.mesh.side_count()),
            unit: PowerUnit::for_total(1.0, 0.0),
            balance: Balance::default(),
            counts: Counts::default(),
            sent: Vec::new(),
        }
    }
}

impl<'m> FirstShot<'m> {
    /// Shares lines among the sources in proportion to their power, so that all lines carry the same; with a focus, all lines in it, and all
    /// others.
    ///
    /// # Errors
    ///
    /// If nothing emits.
    pub fn new(model: &'m Model, lines: impl Into<LocalLines>, seed: u64) -> Result<Self, SolveError> {
        let LocalLines { count: lines, focus } = lines.into();
        let sources = Aimed::new(model, focus.as_ref());
        let total = sources.sources.iter().fold(Rgb::ZERO, |sum, s| sum + s.power);
        if total.max_element() <= 0.0 {
            return Err(SolveError::NoLight);
        }
        let reflectance = model.mesh.largest_reflectance(&model.scene);
        let unit = PowerUnit::for_total(total.max_element(), reflectance);
        Ok(Self::of(model, sources, unit, lines, seed, Stage::FIRST_SHOT))
    }

    /// As [`new`](Self::new), with these sources, all of which emit.
    pub(crate) fn of(
        model: &'m Model,
        aimed: Aimed,
        unit: PowerUnit,
        lines: u64,
        seed: u64,
        stage: Stage,
    ) -> Self {
        let weights = aimed.weights();
        let Aimed { sources, density, .. } = aimed;
        // A line carries ΣΦ/N in all, in the colour of its source; less where lines are denser, for which there are more.
        let line = weights.iter().sum::<f64>() / lines.max(1) as f64;
        let per_line = sources.iter().zip(&weights).map(|(s, w)| unit.quanta(s.power * (line / w))).collect();
        let offset = Streams::new(seed, Stage::ALLOCATION).line(stage.0 - Stage::FIRST_SHOT.0).unit();
        let allocation = Allocation::new(&weights, lines, offset);
        let streams = Streams::new(seed, stage);
        Self { model, sources, per_line, density, allocation, streams, unit, lines }
    }

    /// Number of lines.
    #[must_use]
    pub fn lines(&self) -> u64 {
        self.lines
    }

    /// Power that all lines of each source carry.
    pub(crate) fn sent(&self) -> impl Iterator<Item = Quanta> {
        self.per_line.iter().enumerate().map(|(k, power)| power.times(self.allocation.count(k) as i64))
    }

    /// An empty tally, for this number of workers: how many there are has no effect on the result, but on the time.
    #[must_use]
    pub fn tally(&self, workers: usize) -> FirstShotTally {
        // No line brings more than this: where those in a focus bring much less, squares need no headroom but all digits.
        let exact = if self.density > 1.0 { 1.0 / HEADROOM.sqrt() } else { 1.0 };
        let largest =
            |band: usize| exact * self.per_line.iter().map(|q| q.0[band] as f64).fold(0.0, f64::max);
        let squares = SquareUnit::new([0, 1, 2].map(largest), self.lines as f64);
        let sides = self.model.mesh.side_count();
        FirstShotTally { ledger: Ledger::new(sides, workers, COPIES, squares) }
    }

    /// The ray of a line.
    #[must_use]
    pub fn ray(&self, index: u64) -> Ray {
        self.ray_of(self.allocation.owner(index), index)
    }

    /// The ray of a line of a source.
    fn ray_of(&self, source: usize, index: u64) -> Ray {
        self.sources[source].emitter.ray(&self.model.scene, &mut self.streams.line(index))
    }

    /// Traces some of the lines. Each line should be traced once, by whomever; `worker` is the number of who does.
    pub fn trace(&self, worker: usize, lines: Range<u64>, tally: &FirstShotTally, books: &mut Books) {
        let Model { mesh, accel, .. } = self.model;
        let page = tally.ledger.page(worker);
        let mut tracer = accel.tracer();
        let (mut rays, mut powers) = (Vec::with_capacity(RAYS), Vec::with_capacity(RAYS));
        let (mut met, mut gifts) = (Vec::with_capacity(RAYS), Vec::with_capacity(RAYS));
        let mut first = lines.start;
        while first < lines.end {
            let end = lines.end.min(first + RAYS as u64);
            rays.clear();
            powers.clear();
            for (index, source) in (first..end).zip(self.allocation.owners(first)) {
                rays.push(self.ray_of(source, index));
                powers.push(self.per_line[source]);
            }
            first = end;
            met.clear();
            gifts.clear();
            tracer.closest_each(&rays, |i, hit| {
                books.balance.emitted += powers[i];
                books.counts.lines += 1;
                match hit {
                    Some(hit) => met.push((hit, powers[i])),
                    None => {
                        books.balance.escaped += powers[i];
                        books.counts.empty += 1;
                    }
                }
            });
            books.counts.crossings += met.len() as u64;
            for (i, &(hit, power)) in met.iter().enumerate() {
                if let Some((ahead, _)) = met.get(i + AHEAD) {
                    sir_accel::prefetch(mesh.place_of(ahead.triangle));
                }
                match mesh.side_at(hit.triangle, hit.point, hit.side) {
                    Some(side) => gifts.push((side, power)),
                    None => books.balance.blocked += power,
                }
            }
            // Records are far apart in memory, which is asked for some time before.
            for (i, &(side, power)) in gifts.iter().enumerate() {
                if let Some(&(ahead, _)) = gifts.get(i + AHEAD) {
                    page.prefetch(ahead);
                }
                page.give(side, power);
            }
        }
    }

    /// Closes the books once all lines are traced.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    pub fn finish(&self, tally: FirstShotTally, books: Books) -> Result<Shot, SolveError> {
        self.add(Received::nothing(self.model.mesh.side_count()), tally, books)
    }

    /// Adds what the lines have brought to what was received before.
    pub(crate) fn add(
        &self,
        mut received: Received,
        tally: FirstShotTally,
        books: Books,
    ) -> Result<Shot, SolveError> {
        let Books { mut balance, counts } = books;
        let lines = counts.lines.max(1) as f64;
        self.model.mesh.for_each_side(|triangle, _, _, side| {
            let power = tally.ledger.power(side);
            let reflected = power.scaled(self.model.reflectance(triangle, side));
            balance.unshot += reflected;
            balance.absorbed += power - reflected;
            received.power[side.index()] += power;
            // The number of lines is given, so the variance of a sum is binomial: Σw² − (Σw)²/N.
            let (squares, variance) = (tally.ledger.squares(side), &mut received.variance[side.index()]);
            for (k, variance) in variance.iter_mut().enumerate() {
                let power = power.0[k] as f64;
                *variance += (squares[k] - power * power / lines).max(0.0) as f32;
            }
        });
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "first shot" });
        }
        Ok(Shot { received, unit: self.unit, balance, counts, sent: Vec::new() })
    }
}

impl FirstShotTally {
    /// A tally to be filled with one that was saved, before it is known what a line carries.
    #[must_use]
    pub fn to_restore(model: &Model, workers: usize) -> Self {
        let any = SquareUnit::new([1.0; 3], 1.0);
        Self { ledger: Ledger::new(model.mesh.side_count(), workers, COPIES, any) }
    }

    /// Shows the state of the stage to a visitor.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.ledger.visit_unit(visitor);
        self.ledger.visit(Counters::All, visitor);
    }
}
