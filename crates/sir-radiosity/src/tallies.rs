//! The tallies of a stage: what every side receives and sends, written by all workers concurrently.

use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};
use std::sync::atomic::{AtomicI64, AtomicU32};

use sir_mesh::SideId;

use crate::focus_sides::FocusSides;
use crate::power::Quanta;
use crate::received::Received;
use crate::visitor::Visitor;

/// What one side receives and sends, in one cache line, so that a line of light accesses one memory location per side.
///
/// Lines change only integers, and only by adding to them. The sums are therefore the same in any order and for any
/// number of workers.
///
/// A worker that changes a record locks it. That is one atomic operation instead of seven, each of which would take as
/// long as all other work on a record. Nothing is locked where only one worker writes.
#[derive(Debug, Default)]
#[repr(align(64))]
struct Record {
    power: [AtomicI64; 3],
    squares: [AtomicI64; 3],
    share: [AtomicU32; 3],
    /// Number of lines that left the side, counted by their weights; combined with [`LOCKED`] while a worker writes.
    crossings: AtomicU32,
}

/// Lock bit: the highest bit of the number of crossings.
const LOCKED: u32 = 1 << 31;

/// Power that sides receive in a stage, and the share that each of them sends with a line.
///
/// Writing requires only `&self`. There are several copies of all records if memory allows, because two cores that
/// write to the same cache line wait for each other. Only sums over the copies are meaningful.
#[derive(Debug)]
pub(crate) struct PatchTallies {
    /// All sides of the first copy, then all of the second, and so on.
    records: Vec<Record>,
    sides: usize,
    units: SquareUnits,
    /// True if several workers write to the same copy.
    shared: bool,
}

/// Largest total size of the copies \[bytes\] for which every worker gets its own copy: about the size of caches.
const MAX_COPIES_SIZE: usize = 16 << 20;

/// The counters of a [`PatchTallies`] that a visitor visits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Counters {
    /// All counters.
    All,
    /// Power and crossings, on which the next batch of lines depends.
    Batch,
    /// Sums of squares.
    Squares,
}

/// Number of sides whose counters are visited at a time: 16,384 sides take at most 0.9 MB.
const CHUNK: usize = 1 << 14;

impl PatchTallies {
    /// Returns empty tallies for some workers. There are at least `min_copies` copies, whatever their size, if there
    /// are as many workers.
    pub(crate) fn new(
        sides: usize,
        workers: usize,
        min_copies: usize,
        units: impl Into<SquareUnits>,
    ) -> Self {
        let fits = workers * sides * size_of::<Record>() <= MAX_COPIES_SIZE;
        let copies = if fits { workers.max(1) } else { workers.clamp(1, min_copies) };
        let records = sir_accel::collect_in_huge_pages((0..sides * copies).map(|_| Record::default()));
        Self { records, sides, units: units.into(), shared: copies < workers }
    }

    /// Returns the records of a side, one in each copy.
    fn of(&self, side: usize) -> impl Iterator<Item = &Record> {
        self.records[side..].iter().step_by(self.sides)
    }

    /// Returns the copy that a worker writes to.
    pub(crate) fn of_worker(&self, worker: usize) -> WorkerTallies<'_> {
        let copy = worker % (self.records.len() / self.sides);
        WorkerTallies {
            records: &self.records[copy * self.sides..][..self.sides],
            units: &self.units,
            shared: self.shared,
        }
    }

    /// Returns the power that a side sends with a line.
    pub(crate) fn share(&self, side: SideId) -> Quanta {
        self.records[side.index()].share()
    }

    /// Sets the power that a side sends with a line, rounded to 24 significant bits.
    pub(crate) fn set_share(&self, side: SideId, share: [f64; 3]) {
        for record in self.of(side.index()) {
            for (place, share) in record.share.iter().zip(share) {
                place.store((share as f32).to_bits(), Relaxed);
            }
        }
    }

    /// Returns the power received by a side.
    pub(crate) fn power(&self, side: SideId) -> Quanta {
        let copies = self.of(side.index()).map(Record::power);
        copies.fold(Quanta::ZERO, |sum, power| sum + power)
    }

    /// Returns and resets the power received by a side and the weight of all lines that left it.
    pub(crate) fn take(&self, side: SideId) -> (Quanta, u32) {
        let (mut power, mut crossings) = (Quanta::ZERO, 0);
        for record in self.of(side.index()) {
            power += record.power();
            crossings += record.crossings.load(Relaxed);
            record.power.iter().for_each(|power| power.store(0, Relaxed));
            record.crossings.store(0, Relaxed);
        }
        (power, crossings)
    }

    /// Returns the sum of the squares of the power that each line brought to a side \[quanta²\]. It is the variance of
    /// the sum if the number of lines is Poisson-distributed.
    pub(crate) fn squares(&self, side: SideId) -> [f64; 3] {
        std::array::from_fn(|band| {
            let squares: i64 = self.of(side.index()).map(|record| record.squares[band].load(Relaxed)).sum();
            squares as f64 * self.units.of(side).size[band]
        })
    }

    /// Adds the power and its variance to those received before.
    pub(crate) fn add_to(&self, received: &mut Received) {
        for (i, (power, variance)) in received.power.iter_mut().zip(&mut received.variance).enumerate() {
            let side = SideId::new(i);
            let more = self.squares(side);
            *power += self.power(side);
            *variance = std::array::from_fn(|band| (f64::from(variance[band]) + more[band]) as f32);
        }
    }

    /// Visits the units of the squares.
    pub(crate) fn visit_units(&mut self, visitor: &mut dyn Visitor) {
        self.units.visit(visitor);
    }

    /// Visits counters of all sides.
    pub(crate) fn visit(&self, counters: Counters, visitor: &mut dyn Visitor) {
        let (batch, squares) = (counters != Counters::Squares, counters != Counters::Batch);
        let width = if batch { 4 } else { 0 } + if squares { 3 } else { 0 };
        let mut words = Vec::new();
        for start in (0..self.sides).step_by(CHUNK) {
            let sides = start..self.sides.min(start + CHUNK);
            words.clear();
            words.resize(width * sides.len(), 0);
            for copy in self.records.chunks(self.sides) {
                for (record, words) in copy[sides.clone()].iter().zip(words.chunks_exact_mut(width)) {
                    let counters = record.counters(batch, squares);
                    words.iter_mut().zip(counters).for_each(|(word, counter)| *word += counter.load(Relaxed));
                    if batch {
                        words[width - 1] += i64::from(record.crossings.load(Relaxed));
                    }
                }
            }
            visitor.sum(&mut words);
            // The first copy takes the whole sum.
            for (i, copy) in self.records.chunks(self.sides).enumerate() {
                if i > 0 {
                    words.fill(0);
                }
                for (record, words) in copy[sides.clone()].iter().zip(words.chunks_exact(width)) {
                    let counters = record.counters(batch, squares);
                    words.iter().zip(counters).for_each(|(word, counter)| counter.store(*word, Relaxed));
                    if batch {
                        record.crossings.store(words[width - 1] as u32, Relaxed);
                    }
                }
            }
        }
    }

    /// Visits the shares of all sides.
    pub(crate) fn visit_shares(&self, visitor: &mut dyn Visitor) {
        let mut words = Vec::new();
        for start in (0..self.sides).step_by(CHUNK) {
            let sides = start..self.sides.min(start + CHUNK);
            words.clear();
            let shares = self.records[sides.clone()].iter().flat_map(|record| &record.share);
            words.extend(shares.map(|share| i64::from(share.load(Relaxed))));
            visitor.same(&mut words);
            for copy in self.records.chunks(self.sides) {
                let places = copy[sides.clone()].iter().flat_map(|record| &record.share);
                places.zip(&words).for_each(|(share, word)| share.store(*word as u32, Relaxed));
            }
        }
    }
}

/// One copy of the tallies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WorkerTallies<'a> {
    records: &'a [Record],
    units: &'a SquareUnits,
    shared: bool,
}

impl WorkerTallies<'_> {
    /// Prefetches the record of a side.
    #[inline]
    pub(crate) fn prefetch(self, side: SideId) {
        sir_accel::prefetch(&self.records[side.index()]);
    }

    /// Returns the power that a side sends with a line.
    #[inline]
    pub(crate) fn share(self, side: SideId) -> Quanta {
        self.records[side.index()].share()
    }

    /// Adds the power that a line brings to a side.
    #[inline]
    pub(crate) fn deposit(self, side: SideId, power: Quanta) {
        self.change(side, 0, power);
    }

    /// Adds the power that a line brings to a side, and leaves the sum of the squares as it is.
    #[inline]
    pub(crate) fn receive(self, side: SideId, power: Quanta) {
        let record = &self.records[side.index()];
        let crossings = if self.shared { record.lock() } else { record.crossings.load(Relaxed) };
        for (sum, power) in record.power.iter().zip(power.0) {
            sum.store(sum.load(Relaxed).wrapping_add(power), Relaxed);
        }
        record.crossings.store(crossings, Release);
    }

    /// Counts a line that leaves a side, and returns the power that it takes along: the share of the side times the
    /// weight of the line.
    #[inline]
    pub(crate) fn leave(self, side: SideId, weight: u32) -> Quanta {
        self.change(side, weight, Quanta::ZERO);
        self.share(side).times(i64::from(weight))
    }

    /// Exchanges the shares of two sides along a line that leaves each of them towards the other.
    #[inline]
    pub(crate) fn exchange(self, i: SideId, j: SideId, weight: u32) {
        let [from_i, from_j] = [i, j].map(|side| self.share(side).times(i64::from(weight)));
        self.change(i, weight, from_j);
        self.change(j, weight, from_i);
    }

    /// Adds to the weight of the lines that left a side, and to the power that it received.
    #[inline]
    fn change(self, side: SideId, lines: u32, power: Quanta) {
        let record = &self.records[side.index()];
        let squares = self.units.of(side).counts(power);
        let crossings = if self.shared { record.lock() } else { record.crossings.load(Relaxed) };
        let add = |sum: &AtomicI64, more: i64| sum.store(sum.load(Relaxed).wrapping_add(more), Relaxed);
        record.power.iter().zip(power.0).for_each(|(sum, power)| add(sum, power));
        record.squares.iter().zip(squares).for_each(|(sum, square)| add(sum, square));
        record.crossings.store(crossings + lines, Release);
    }
}

impl Record {
    /// Locks the record and returns the number of crossings. It waits until no other worker writes, which takes
    /// nanoseconds. Storing that number, or a larger one, unlocks the record.
    #[inline]
    fn lock(&self) -> u32 {
        let mut tries = 0u32;
        loop {
            let crossings = self.crossings.load(Relaxed) & !LOCKED;
            let locked = crossings | LOCKED;
            if self.crossings.compare_exchange_weak(crossings, locked, Acquire, Relaxed).is_ok() {
                return crossings;
            }
            tries += 1;
            // The other worker may have been suspended.
            if tries.is_multiple_of(64) { std::thread::yield_now() } else { std::hint::spin_loop() }
        }
    }

    #[inline]
    fn share(&self) -> Quanta {
        Quanta(std::array::from_fn(|band| f32::from_bits(self.share[band].load(Relaxed)) as i64))
    }

    fn power(&self) -> Quanta {
        Quanta(std::array::from_fn(|band| self.power[band].load(Relaxed)))
    }

    /// Returns the 64-bit counters that are requested: power, squares, or both.
    fn counters(&self, batch: bool, squares: bool) -> impl Iterator<Item = &AtomicI64> {
        let power = self.power.iter().take(if batch { 3 } else { 0 });
        power.chain(self.squares.iter().take(if squares { 3 } else { 0 }))
    }
}

/// Unit in which squares of power are counted, per band, such that their sums fit 62 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SquareUnit {
    /// Square quanta per count.
    size: [f64; 3],
    /// Counts per square quantum.
    density: [f64; 3],
    /// Largest count of a single contribution.
    max_count: f64,
}

/// Units of the squares: those of sides in the focus, where lines bring little power each, and those of all others.
#[derive(Clone, Debug)]
pub(crate) struct SquareUnits {
    pub(crate) inside: SquareUnit,
    pub(crate) outside: SquareUnit,
    pub(crate) in_focus: FocusSides,
}

impl From<SquareUnit> for SquareUnits {
    fn from(unit: SquareUnit) -> Self {
        Self { inside: unit, outside: unit, in_focus: FocusSides::all() }
    }
}

impl SquareUnits {
    #[inline]
    fn of(&self, side: SideId) -> &SquareUnit {
        if self.in_focus.contains(side) { &self.inside } else { &self.outside }
    }

    /// Restores the units that were passed to the visitor that saved them.
    pub(crate) fn restore(in_focus: FocusSides, visitor: &mut dyn Visitor) -> Self {
        let none = SquareUnit::of([1.0; 3], 0.0);
        let mut units = Self { inside: none, outside: none, in_focus };
        units.visit(visitor);
        units
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.inside.visit(visitor);
        if self.in_focus.is_all() {
            self.outside = self.inside;
        } else {
            self.outside.visit(visitor);
        }
    }
}

/// Safety factor on the largest squared contribution.
pub(crate) const HEADROOM: f64 = 64.0;

impl SquareUnit {
    /// Returns a unit for contributions of at most about `largest` quanta, of which a side gets at most about
    /// `count`.
    pub(crate) fn new(largest: [f64; 3], count: f64) -> Self {
        let max_count = (1u64 << 60) as f64 / (count.max(1.0) + 16.0);
        Self::of(largest.map(|l| (l * l * HEADROOM / max_count).max(1.0)), max_count)
    }

    fn of(size: [f64; 3], max_count: f64) -> Self {
        Self { size, density: size.map(|s| 1.0 / s), max_count }
    }

    /// Returns the square of a contribution, to the nearest count.
    #[inline]
    fn counts(&self, power: Quanta) -> [i64; 3] {
        std::array::from_fn(|band| {
            let power = power.0[band] as f64;
            (power * power * self.density[band] + 0.5).min(self.max_count) as i64
        })
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        let [r, g, b] = self.size;
        let mut words = [r, g, b, self.max_count].map(|x| x.to_bits() as i64);
        visitor.same(&mut words);
        let [r, g, b, max_count] = words.map(|w| f64::from_bits(w as u64));
        *self = Self::of([r, g, b], max_count);
    }
}
