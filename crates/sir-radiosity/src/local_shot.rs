//! A shot: local lines from sources, each carrying the same power to the first surface that it hits.

use std::ops::Range;

use sir_accel::Ray;
use sir_geom::Rgb;
use sir_lines::{Allocation, Numbers, Purpose, Streams};
use sir_mesh::SideId;

use crate::emitter::Emitter;
use crate::error::SolveError;
use crate::global::PREFETCH_DISTANCE;
use crate::line_numbers::LineNumbers;
use crate::model::Model;
use crate::patch_side::PatchSide;
use crate::power::{PowerUnit, Quanta};
use crate::shot::{Shot, ShotSettings};
use crate::stage::{AnyOrder, Stage};
use crate::tallies::{Counters, HEADROOM, PatchTallies, SquareUnit};
use crate::totals::StageTotals;
use crate::visitor::Visitor;
use crate::workers::{BLOCK, Workers, map_sides};

/// Number of rays that are generated at a time.
const RAYS: usize = 1024;

/// Smallest number of copies of the tallies, whatever their size. Later stages need more memory per side than this one.
const COPIES: usize = 2;

/// A first shot, which starts from nothing, or a second shot, which starts from the outcome of the first.
#[derive(Debug)]
pub struct LocalShot<'m, I, S> {
    input: I,
    model: &'m Model,
    sources: Vec<S>,
    /// Side to which each source belongs; empty in a first shot.
    sides: Vec<SideId>,
    /// Power of one line of each source.
    per_line: Vec<Quanta>,
    allocation: Allocation,
    numbers: LineNumbers,
    unit: PowerUnit,
    lines: u64,
    tallies: PatchTallies,
}

/// A source of lines.
pub trait LineSource: Sync {
    /// Returns the ray that belongs to the numbers of a line.
    fn ray(&self, model: &Model, numbers: &mut impl Numbers) -> Ray;
}

impl LineSource for Emitter {
    #[inline]
    fn ray(&self, model: &Model, numbers: &mut impl Numbers) -> Ray {
        self.ray(&model.scene, numbers)
    }
}

impl LineSource for PatchSide {
    #[inline]
    fn ray(&self, model: &Model, numbers: &mut impl Numbers) -> Ray {
        (*self).ray(model, numbers)
    }
}

/// Starting point of a shot, from which the sources of its lines follow.
pub(crate) trait ShotInput<S>: Sync + Sized {
    /// Name of the shot.
    const NAME: &'static str;
    /// Number that identifies the shot among the stages.
    const KIND: u64;
    /// Purpose of its random numbers.
    const PURPOSE: Purpose;

    /// Returns the sources.
    ///
    /// # Errors
    ///
    /// If there is no light.
    fn sources(
        &self,
        settings: &ShotSettings<'_>,
        workers: &dyn Workers,
    ) -> Result<ShotSources<S>, SolveError>;

    /// Visits the input.
    fn visit(&mut self, visitor: &mut dyn Visitor);

    /// Restores the input that [`visit`](Self::visit) passed to the visitor that saved it.
    fn restore(model: &Model, visitor: &mut dyn Visitor) -> Self;

    /// Returns the shot to which the lines add.
    fn into_shot(self, model: &Model) -> Shot;
}

/// Sources of the lines of a shot.
pub(crate) struct ShotSources<S> {
    /// The sources, all of which emit.
    pub(crate) sources: Vec<S>,
    /// Power of each source \[W\].
    pub(crate) powers: Vec<Rgb>,
    /// Weights \[W\] in proportion to the number of lines of each source.
    pub(crate) weights: Vec<f64>,
    /// Ratio of lines per power in the focus to lines per power elsewhere.
    pub(crate) density: f64,
    /// Side to which each source belongs; empty in a first shot.
    pub(crate) sides: Vec<SideId>,
    /// Size of a quantum.
    pub(crate) unit: PowerUnit,
}

impl<I, S: LineSource> LocalShot<'_, I, S> {
    /// Returns the input of the shot, without the results of its lines.
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
        self.sources[source].ray(self.model, &mut self.numbers.line(index))
    }
}

impl<'m, I: ShotInput<S>, S: LineSource> Stage for LocalShot<'m, I, S> {
    type Settings = ShotSettings<'m>;
    type Input = I;
    type Outcome = Shot;
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        settings.identity(<I as ShotInput<S>>::KIND)
    }

    /// Distributes lines among sources in proportion to their power, so that all lines carry the same power; with a
    /// focus, all lines of sources in it, and all others. There are no lines if there are no sources.
    fn begin(settings: Self::Settings, input: I, workers: &dyn Workers) -> Result<Self, SolveError> {
        let ShotSources { sources, powers, weights, density, sides, unit } =
            input.sources(&settings, workers)?;
        let ShotSettings { model, lines, seed, points, .. } = settings;
        let lines = if sources.is_empty() { 0 } else { lines.count };
        // A line carries ΣΦ/N in the color of its source, and less in the focus, where there are more lines.
        let line = weights.iter().sum::<f64>() / lines.max(1) as f64;
        let quanta = |(power, weight): (Rgb, &f64)| unit.quanta(power * (line / weight));
        let per_line: Vec<Quanta> = powers.into_iter().zip(&weights).map(quanta).collect();
        let offset = Streams::new(seed, Purpose::ALLOCATION)
            .line(<I as ShotInput<S>>::PURPOSE.0 - Purpose::FIRST_SHOT.0)
            .unit();
        let allocation = Allocation::new(&weights, lines, offset);
        let numbers = LineNumbers::new(points, seed, <I as ShotInput<S>>::PURPOSE);
        // No line brings more than this. Lines in a focus may bring much less, so squares then need precision, not
        // headroom.
        let exact = if density > 1.0 { 1.0 / HEADROOM.sqrt() } else { 1.0 };
        let largest = |band: usize| exact * per_line.iter().map(|q| q.0[band] as f64).fold(0.0, f64::max);
        let squares = SquareUnit::new([0, 1, 2].map(largest), lines as f64);
        let tallies = PatchTallies::new(model.mesh.side_count(), workers.count(), COPIES, squares);
        Ok(Self { input, model, sources, sides, per_line, allocation, numbers, unit, lines, tallies })
    }

    /// Restores the input and the tallies. The sources follow from the input.
    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let input = <I as ShotInput<S>>::restore(settings.model, visitor);
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
        let (mut hits, mut deposits) = (Vec::with_capacity(RAYS), Vec::with_capacity(RAYS));
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
            hits.clear();
            deposits.clear();
            tracer.closest_each(&rays, |i, hit| {
                totals.balance.emitted += powers[i];
                totals.counts.lines += 1;
                match hit {
                    Some(hit) => hits.push((hit, powers[i])),
                    None => {
                        totals.balance.escaped += powers[i];
                        totals.counts.empty += 1;
                    }
                }
            });
            totals.counts.crossings += hits.len() as u64;
            for (i, &(hit, power)) in hits.iter().enumerate() {
                if let Some((ahead, _)) = hits.get(i + PREFETCH_DISTANCE) {
                    sir_accel::prefetch(mesh.first_entry(ahead.triangle));
                }
                if let Some((ahead, _)) = hits.get(i + PREFETCH_DISTANCE / 2) {
                    sir_accel::prefetch(mesh.second_entry(ahead.triangle));
                }
                match mesh.side_at(hit.triangle, hit.point, hit.side) {
                    Some(side) => deposits.push((side, power)),
                    None => totals.balance.blocked += power,
                }
            }
            // Records are far apart in memory, so they are prefetched.
            for (i, &(side, power)) in deposits.iter().enumerate() {
                if let Some(&(ahead, _)) = deposits.get(i + PREFETCH_DISTANCE) {
                    tallies.prefetch(ahead);
                }
                tallies.deposit(side, power);
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

    /// Adds what the lines have brought and what their sources have sent to the input.
    fn finish(self, totals: StageTotals, workers: &dyn Workers) -> Result<Shot, SolveError> {
        let Self { input, model, sources, sides, per_line, allocation, unit, tallies, .. } = self;
        // The memory of sources and tallies is needed for what follows.
        drop(sources);
        let Shot { mut received, mut sent, correction, .. } = input.into_shot(model);
        let StageTotals { mut balance, counts } = totals;
        let lines = counts.lines.max(1) as f64;
        let blocks = received.power.chunks_mut(BLOCK).zip(received.variance.chunks_mut(BLOCK));
        let sums = map_sides(workers, &model.mesh, blocks, |sides, (powers, variances)| {
            let (mut unshot, mut absorbed) = (Quanta::ZERO, Quanta::ZERO);
            for (((triangle, side), sum), variance) in sides.iter().zip(powers).zip(variances) {
                let power = tallies.power(side);
                let reflected = power.scaled(model.reflectance(triangle, side));
                unshot += reflected;
                absorbed += power - reflected;
                *sum += power;
                // The number of lines is fixed, so the variance of a sum is binomial: Σw² − (Σw)²/N.
                let squares = tallies.squares(side);
                for (k, variance) in variance.iter_mut().enumerate() {
                    let power = power.0[k] as f64;
                    *variance += (squares[k] - power * power / lines).max(0.0) as f32;
                }
            }
            (unshot, absorbed)
        });
        for (unshot, absorbed) in sums {
            balance.unshot += unshot;
            balance.absorbed += absorbed;
        }
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: <I as ShotInput<S>>::NAME });
        }
        drop(tallies);
        sent.reserve_exact(sides.len());
        for (source, side) in sides.into_iter().enumerate() {
            let power = per_line[source].times(allocation.count(source) as i64);
            match sent.last_mut() {
                Some((last, sum)) if *last == side => *sum += power,
                _ => sent.push((side, power)),
            }
        }
        Ok(Shot { received, unit, balance, counts, sent, correction })
    }
}
