//! Lines of a shot: local lines from sources, each carrying the same power to the first surface that it meets.

use std::ops::Range;

use sir_accel::Ray;
use sir_lines::{Allocation, Purpose, Streams};

use crate::error::SolveError;
use crate::global::AHEAD;
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::shot::Shot;
use crate::sources::{FocusedSources, Source};
use crate::tallies::{HEADROOM, PatchTallies, SquareUnit};
use crate::totals::StageTotals;

/// Rays that are made at a time.
const RAYS: usize = 1024;

/// Copies of the tallies that are made however large they are: later stages need more memory per side than this one.
const COPIES: usize = 2;

/// Local lines from sources: what each of them carries, and where it starts.
#[derive(Clone, Debug)]
pub(crate) struct ShotLines<'m> {
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

impl<'m> ShotLines<'m> {
    /// Shares lines among sources, all of which emit, in proportion to their power, so that all lines carry the same;
    /// with a focus, all lines in it, and all others.
    pub(crate) fn new(
        model: &'m Model,
        sources: FocusedSources,
        unit: PowerUnit,
        lines: u64,
        seed: u64,
        purpose: Purpose,
    ) -> Self {
        let weights = sources.weights();
        let FocusedSources { sources, density, .. } = sources;
        // A line carries ΣΦ/N in all, in the colour of its source; less where lines are denser, for which there are more.
        let line = weights.iter().sum::<f64>() / lines.max(1) as f64;
        let per_line = sources.iter().zip(&weights).map(|(s, w)| unit.quanta(s.power * (line / w))).collect();
        let offset = Streams::new(seed, Purpose::ALLOCATION).line(purpose.0 - Purpose::FIRST_SHOT.0).unit();
        let allocation = Allocation::new(&weights, lines, offset);
        let streams = Streams::new(seed, purpose);
        Self { model, sources, per_line, density, allocation, streams, unit, lines }
    }

    /// Returns the number of lines.
    pub(crate) fn lines(&self) -> u64 {
        self.lines
    }

    /// Returns the power that all lines of each source carry.
    pub(crate) fn sent(&self) -> impl Iterator<Item = Quanta> {
        self.per_line.iter().enumerate().map(|(k, power)| power.times(self.allocation.count(k) as i64))
    }

    /// Returns empty tallies for this number of workers, which has no effect on the result.
    pub(crate) fn tallies(&self, workers: usize) -> PatchTallies {
        // No line brings more than this: where those in a focus bring much less, squares need no headroom but all digits.
        let exact = if self.density > 1.0 { 1.0 / HEADROOM.sqrt() } else { 1.0 };
        let largest =
            |band: usize| exact * self.per_line.iter().map(|q| q.0[band] as f64).fold(0.0, f64::max);
        let squares = SquareUnit::new([0, 1, 2].map(largest), self.lines as f64);
        PatchTallies::new(self.model.mesh.side_count(), workers, COPIES, squares)
    }

    /// Returns the ray of a line.
    pub(crate) fn ray(&self, index: u64) -> Ray {
        self.ray_of(self.allocation.owner(index), index)
    }

    /// Returns the ray of a line of a source.
    fn ray_of(&self, source: usize, index: u64) -> Ray {
        self.sources[source].emitter.ray(&self.model.scene, &mut self.streams.line(index))
    }

    /// Traces some of the lines and adds what they bring to `tallies`; `worker` is the number of the thread that does.
    pub(crate) fn trace(
        &self,
        worker: usize,
        lines: Range<u64>,
        tallies: &PatchTallies,
        totals: &mut StageTotals,
    ) {
        let Model { mesh, accel, .. } = self.model;
        let tallies = tallies.of_worker(worker);
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
                totals.balance.emitted += powers[i];
                totals.counts.lines += 1;
                match hit {
                    Some(hit) => met.push((hit, powers[i])),
                    None => {
                        totals.balance.escaped += powers[i];
                        totals.counts.empty += 1;
                    }
                }
            });
            totals.counts.crossings += met.len() as u64;
            for (i, &(hit, power)) in met.iter().enumerate() {
                if let Some((ahead, _)) = met.get(i + AHEAD) {
                    sir_accel::prefetch(mesh.place_of(ahead.triangle));
                }
                match mesh.side_at(hit.triangle, hit.point, hit.side) {
                    Some(side) => gifts.push((side, power)),
                    None => totals.balance.blocked += power,
                }
            }
            // Records are far apart in memory, which is asked for some time before.
            for (i, &(side, power)) in gifts.iter().enumerate() {
                if let Some(&(ahead, _)) = gifts.get(i + AHEAD) {
                    tallies.prefetch(ahead);
                }
                tallies.give(side, power);
            }
        }
    }

    /// Adds what the lines have brought to what was received before.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    pub(crate) fn add_to(
        &self,
        mut received: Received,
        tallies: &PatchTallies,
        totals: StageTotals,
    ) -> Result<Shot, SolveError> {
        let StageTotals { mut balance, counts } = totals;
        let lines = counts.lines.max(1) as f64;
        self.model.mesh.for_each_side(|triangle, _, _, side| {
            let power = tallies.power(side);
            let reflected = power.scaled(self.model.reflectance(triangle, side));
            balance.unshot += reflected;
            balance.absorbed += power - reflected;
            received.power[side.index()] += power;
            // The number of lines is given, so the variance of a sum is binomial: Σw² − (Σw)²/N.
            let (squares, variance) = (tallies.squares(side), &mut received.variance[side.index()]);
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
