//! A shot: local lines from sources, each carrying the same power to the first surface that it meets.

use std::ops::Range;

use sir_accel::Ray;
use sir_lines::{Allocation, Purpose, Streams};
use sir_mesh::SideId;

use crate::error::SolveError;
use crate::global::AHEAD;
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::shot::{Shot, ShotSettings};
use crate::sources::{FocusedSources, Source};
use crate::stage::{AnyOrder, Stage, Workers};
use crate::tallies::{Counters, HEADROOM, PatchTallies, SquareUnit};
use crate::totals::StageTotals;
use crate::visitor::Visitor;

/// Rays that are made at a time.
const RAYS: usize = 1024;

/// Copies of the tallies that are made however large they are: later stages need more memory per side than this one.
const COPIES: usize = 2;

/// A first shot, which starts from nothing, or a second one, which starts from the outcome of the first.
#[derive(Debug)]
pub struct LocalShot<'m, I> {
    input: I,
    model: &'m Model,
    sources: Vec<Source>,
    /// The side that each source is, or is a part of; none in a first shot.
    sides: Vec<SideId>,
    /// Power of one line of each source.
    per_line: Vec<Quanta>,
    allocation: Allocation,
    streams: Streams,
    unit: PowerUnit,
    lines: u64,
    tallies: PatchTallies,
}

/// What a shot starts from. The sources of its lines follow from it.
pub(crate) trait ShotInput: Sync + Sized {
    /// The name of the shot.
    const NAME: &'static str;
    /// Tells the shot from other stages.
    const KIND: u64;
    /// Tells its random numbers from others.
    const PURPOSE: Purpose;

    /// Returns the sources.
    ///
    /// # Errors
    ///
    /// If there is no light.
    fn sources(&self, settings: &ShotSettings<'_>) -> Result<ShotSources, SolveError>;

    /// Shows the input to a visitor.
    fn visit(&mut self, visitor: &mut dyn Visitor);

    /// Returns the input that [`visit`](Self::visit) has shown to the visitor who saved it.
    fn restore(model: &Model, visitor: &mut dyn Visitor) -> Self;

    /// Returns the power that sides have received, and that which they have sent.
    fn into_power(self, model: &Model) -> (Received, Vec<(SideId, Quanta)>);
}

/// Sources of the lines of a shot.
pub(crate) struct ShotSources {
    /// The sources, all of which emit.
    pub(crate) sources: FocusedSources,
    /// The side that each of them is, or is a part of; none in a first shot.
    pub(crate) sides: Vec<SideId>,
    /// The size of a quantum.
    pub(crate) unit: PowerUnit,
}

impl<I> LocalShot<'_, I> {
    /// Returns what the shot started from, without what its lines have brought.
    #[must_use]
    pub fn into_input(self) -> I {
        self.input
    }

    /// Returns the ray of a line.
    #[must_use]
    pub fn ray(&self, index: u64) -> Ray {
        self.ray_of(self.allocation.owner(index), index)
    }

    /// Returns the ray of a line of a source.
    fn ray_of(&self, source: usize, index: u64) -> Ray {
        self.sources[source].emitter.ray(&self.model.scene, &mut self.streams.line(index))
    }
}

impl<'m, I: ShotInput> Stage for LocalShot<'m, I> {
    type Settings = ShotSettings<'m>;
    type Input = I;
    type Outcome = Shot;
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        settings.identity(I::KIND)
    }

    /// Shares lines among sources in proportion to their power, so that all lines carry the same; with a focus, all lines in it, and
    /// all others. There are no lines if there are no sources.
    fn begin(settings: Self::Settings, input: I, workers: &dyn Workers) -> Result<Self, SolveError> {
        let ShotSources { sources, sides, unit } = input.sources(&settings)?;
        let ShotSettings { model, lines, seed } = settings;
        let weights = sources.weights();
        let FocusedSources { sources, density, .. } = sources;
        let lines = if sources.is_empty() { 0 } else { lines.count };
        // A line carries ΣΦ/N in all, in the color of its source; less where lines are denser, for which there are more.
        let line = weights.iter().sum::<f64>() / lines.max(1) as f64;
        let quanta = |(source, weight): (&Source, _)| unit.quanta(source.power * (line / weight));
        let per_line: Vec<Quanta> = sources.iter().zip(&weights).map(quanta).collect();
        let offset =
            Streams::new(seed, Purpose::ALLOCATION).line(I::PURPOSE.0 - Purpose::FIRST_SHOT.0).unit();
        let allocation = Allocation::new(&weights, lines, offset);
        let streams = Streams::new(seed, I::PURPOSE);
        // No line brings more than this: where those in a focus bring much less, squares need no headroom but all digits.
        let exact = if density > 1.0 { 1.0 / HEADROOM.sqrt() } else { 1.0 };
        let largest = |band: usize| exact * per_line.iter().map(|q| q.0[band] as f64).fold(0.0, f64::max);
        let squares = SquareUnit::new([0, 1, 2].map(largest), lines as f64);
        let tallies = PatchTallies::new(model.mesh.side_count(), workers.count(), COPIES, squares);
        Ok(Self { input, model, sources, sides, per_line, allocation, streams, unit, lines, tallies })
    }

    /// Restores the input and the tallies: the sources follow from the input.
    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let input = I::restore(settings.model, visitor);
        let mut stage = Self::begin(settings, input, workers)?;
        stage.visit_round(visitor);
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        0..self.lines
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, worker: usize, _chain: &mut AnyOrder, lines: Range<u64>, totals: &mut StageTotals) {
        let Model { mesh, accel, .. } = self.model;
        let tallies = self.tallies.of_worker(worker);
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

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::All, visitor);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.input.visit(visitor);
        self.visit_round(visitor);
    }

    /// Adds to the input what the lines have brought, and what their sources have sent.
    fn finish(self, totals: StageTotals) -> Result<Shot, SolveError> {
        let Self { input, model, sides, per_line, allocation, unit, tallies, .. } = self;
        let (mut received, mut sent) = input.into_power(model);
        let StageTotals { mut balance, counts } = totals;
        let lines = counts.lines.max(1) as f64;
        model.mesh.for_each_side(|triangle, _, _, side| {
            let power = tallies.power(side);
            let reflected = power.scaled(model.reflectance(triangle, side));
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
            return Err(SolveError::Unbalanced { stage: I::NAME });
        }
        for (source, side) in sides.into_iter().enumerate() {
            let power = per_line[source].times(allocation.count(source) as i64);
            match sent.last_mut() {
                Some((last, sum)) if *last == side => *sum += power,
                _ => sent.push((side, power)),
            }
        }
        Ok(Shot { received, unit, balance, counts, sent })
    }
}
