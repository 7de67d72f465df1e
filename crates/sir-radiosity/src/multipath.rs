//! Multipath: global lines pass power on between all surfaces that face each other.
//!
//! Sbert, Pueyo, Neumann and Purgathofer (1996), *Global multipath Monte Carlo algorithms for radiosity*; Martínez,
//! Forés and Martín (2009), section 2.
//!
//! As published, every line takes along its share of the reflected direct power, and what has been reflected but not
//! sent on when the lines end is missing from the result: a share of about `ρ/(1−ρ)/n` for patches that `n` lines
//! cross. Here the last lines, the *tail*, take no such share and only send on: what is left then falls off like
//! `exp(−(1−ρ) m)` with the number `m` of them that cross a patch.

use std::ops::Range;

use sir_geom::TriangleId;
use sir_lines::{Domain, Stage, Streams};
use sir_mesh::SideId;

use crate::segments::{End, Segment, segments};
use crate::{Balance, Counts, Model, PowerUnit, Quanta, Received, Shot, Solution, SolveError};

/// What a side holds while power travels.
#[derive(Clone, Copy, Debug)]
struct SideState {
    /// Power received and reflected, but not sent on.
    unshot: Quanta,
    /// Reflected direct power that leaves with every line before the tail \[quanta\]: its forecast share.
    emission: [f32; 3],
}

/// A transport of power along global lines. Sequential: the result depends on the order of the lines.
#[derive(Clone, Debug)]
pub struct Multipath<'m> {
    model: &'m Model,
    sides: Vec<SideState>,
    books: Books,
    streams: Streams,
    unit: PowerUnit,
    settings: MultipathSettings,
}

/// The lines of a transport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MultipathSettings {
    /// Number of lines, the tail included.
    pub lines: u64,
    /// How many of them, at the end, only send on what was reflected. With none, the method is as published.
    pub tail: u64,
    /// Where the lines are drawn from.
    pub domain: Domain,
}

impl MultipathSettings {
    /// This number of lines, of which the last tenth is the tail.
    #[must_use]
    pub fn new(lines: u64, domain: Domain) -> Self {
        Self { lines, tail: lines / 10, domain }
    }

    /// Lines that take a share of the reflected direct power along.
    fn emitting(&self) -> u64 {
        self.lines.saturating_sub(self.tail)
    }
}

/// What is written down while power travels.
#[derive(Clone, Debug)]
struct Books {
    received: Received,
    balance: Balance,
    counts: Counts,
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
    /// Where the power of this stage went. Its `emitted` is what the lines took from the sources by forecast, which
    /// differs from the reflected direct power by chance.
    pub balance: Balance,
    /// What the lines met.
    pub counts: Counts,
}

impl<'m> Multipath<'m> {
    /// Prepares the transport of the reflected direct power of a first shot.
    ///
    /// A side of a patch of area `A` is left by `n = N · 2A/S` of the `N` lines before the tail on average, so each
    /// takes `1/n` of its reflected direct power along.
    #[must_use]
    pub fn new(model: &'m Model, shot: Shot, settings: MultipathSettings, seed: u64) -> Self {
        let forecast = settings.domain.forecast(settings.emitting());
        let mut sides = Vec::with_capacity(model.mesh.side_count());
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflected =
                shot.received.power[side.index()].scaled(model.scene.material(triangle).reflectance);
            let crossings = forecast.crossings(model.mesh.patch_area(triangle));
            sides.push(SideState {
                unshot: Quanta::ZERO,
                emission: reflected.0.map(|q| (q as f64 / crossings) as f32),
            });
        });
        let books = Books { received: shot.received, balance: Balance::default(), counts: Counts::default() };
        let streams = Streams::new(seed, Stage::GLOBAL);
        Self { model, sides, books, streams, unit: shot.unit, settings }
    }

    /// Traces the next lines. The ranges of successive calls should follow each other.
    pub fn trace(&mut self, lines: Range<u64>) {
        let Self { model, sides, books, streams, settings, .. } = self;
        let mut tracer = model.accel.tracer();
        for index in lines {
            let line = settings.domain.sample(&mut streams.line(index));
            let hits = tracer.all_hits(&line);
            books.counts.lines += 1;
            books.counts.empty += u64::from(hits.is_empty());
            books.counts.odd += hits.len() as u64 % 2;
            books.counts.crossings += hits.len() as u64;
            let emits = index < settings.emitting();
            segments(&model.mesh, hits, |segment| exchange(model, sides, books, segment, emits));
        }
    }

    /// Closes the books once all lines are traced.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    pub fn finish(self) -> Result<Transported, SolveError> {
        let Self { model, sides, books, unit, .. } = self;
        let Books { received, mut balance, counts } = books;
        for side in &sides {
            balance.unshot += side.unshot;
        }
        // The solution needs room.
        drop(sides);
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "multipath" });
        }
        let solution = Solution::new(model, &received, unit);
        Ok(Transported { solution, received, unit, balance, counts })
    }
}

/// Both ends of a segment send what they hold to the other one.
#[inline]
fn exchange(model: &Model, sides: &mut [SideState], books: &mut Books, segment: Segment, emits: bool) {
    let mut take = |books: &mut Books, side| take(sides, books, side, emits);
    match (segment.from, segment.to) {
        (End::Side(i, triangle_i), End::Side(j, triangle_j)) => {
            let (from_i, from_j) = (take(books, i), take(books, j));
            give(model, sides, books, (j, triangle_j), from_i);
            give(model, sides, books, (i, triangle_i), from_j);
        }
        (End::Side(i, _), End::Outside) | (End::Outside, End::Side(i, _)) => {
            let power = take(books, i);
            books.balance.escaped += power;
        }
        (End::Side(i, _), End::Inactive) | (End::Inactive, End::Side(i, _)) => {
            let power = take(books, i);
            books.balance.blocked += power;
        }
        _ => {}
    }
}

/// Takes all unshot power of a side and, if the line emits, its share of the reflected direct power.
#[inline]
fn take(sides: &mut [SideState], books: &mut Books, side: SideId, emits: bool) -> Quanta {
    let state = &mut sides[side.index()];
    let emission = if emits { Quanta(state.emission.map(|e| e as i64)) } else { Quanta::ZERO };
    books.balance.emitted += emission;
    std::mem::take(&mut state.unshot) + emission
}

/// A side receives power, absorbs some and keeps the rest to send it on.
#[inline]
fn give(
    model: &Model,
    sides: &mut [SideState],
    books: &mut Books,
    (side, triangle): (SideId, TriangleId),
    power: Quanta,
) {
    books.received.add(side, power);
    let reflected = power.scaled(model.scene.material(triangle).reflectance);
    sides[side.index()].unshot += reflected;
    books.balance.absorbed += power - reflected;
}
