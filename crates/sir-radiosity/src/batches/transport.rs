//! The transport: successive batches of global lines.

use std::ops::Range;

use sir_lines::{GlobalLines, Purpose, Streams};
use sir_mesh::SideId;

use crate::batches::patch_sizes::PatchSizes;
use crate::batches::schedule::Schedule;
use crate::batches::side_range::SideRange;
use crate::batches::side_state::SideState;
use crate::batches::sums::{BatchSums, FocusSums};
use crate::batches::walks::Walks;
use crate::counted::{Counted, CountedPower};
use crate::error::SolveError;
use crate::focus_sides::FocusSides;
use crate::global;
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::segments::{End, Segment};
use crate::shot::Shot;
use crate::stage::{AnyOrder, Stage};
use crate::tallies::{Counters, PatchTallies, SquareUnit, SquareUnits, WorkerTallies};
use crate::totals::{Balance, StageTotals};
use crate::transported::{Transported, Walked};
use crate::visitor::Visitor;
use crate::workers::{BLOCK, Sides, Workers, map_sides};

/// Settings of a transport in batches.
#[derive(Clone, Debug)]
pub struct BatchSettings<'m> {
    /// The scene and its patches.
    pub model: &'m Model,
    /// Domain through which lines are drawn, with an optional focus.
    pub domain: GlobalLines,
    /// Number of lines.
    pub lines: u64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl<'m> BatchSettings<'m> {
    /// Returns the settings for this number of lines through a domain.
    pub fn new(model: &'m Model, domain: impl Into<GlobalLines>, lines: u64, seed: u64) -> Self {
        Self { model, domain: domain.into(), lines, seed }
    }
}

/// A transport of power along global lines in batches.
#[derive(Debug)]
pub struct Batches<'m> {
    model: &'m Model,
    domain: GlobalLines,
    /// Random start of the systematic sample of lines through the focus.
    offset: u64,
    focus_sides: FocusSides,
    streams: Streams,
    /// Power that the lines of this batch bring, and the power that each side sends with a line.
    tallies: PatchTallies,
    /// The direct light.
    direct: Received,
    states: Vec<SideState>,
    unit: PowerUnit,
    schedule: Schedule,
    seed: u64,
    /// Random walks after the last batch.
    walks: Option<Walks>,
    walked: Walked,
    /// Power of walks that surfaces have reflected and absorbed.
    reflected_walks: Quanta,
    absorbed_walks: Quanta,
}

impl<'m> Batches<'m> {
    /// Returns the transport before its first batch. `source` is the reflected direct power, and `reflected_share` its
    /// ratio to the power sent in the first shot.
    fn new(
        settings: BatchSettings<'m>,
        focus_sides: FocusSides,
        direct: Received,
        unit: PowerUnit,
        tallies: PatchTallies,
        (source, reflected_share): (FocusSums, f64),
        workers: &dyn Workers,
    ) -> Self {
        let BatchSettings { model, domain, lines, seed } = settings;
        let lines_per_crossing =
            PatchSizes::of(model, &focus_sides, workers).lines_per_crossing(&domain, lines);
        let schedule = Schedule::new(lines, lines_per_crossing, &domain, source, reflected_share);
        let purpose = Purpose::GLOBAL;
        let offset = Streams::new(seed, Purpose::ALLOCATION).line(purpose.0 - Purpose::FIRST_SHOT.0).unit();
        let offset = (offset * (1u128 << 64) as f64) as u64;
        let streams = Streams::new(seed, purpose);
        let states = vec![SideState::default(); model.mesh.side_count()];
        Self {
            model,
            domain,
            offset,
            focus_sides,
            streams,
            tallies,
            direct,
            states,
            unit,
            schedule,
            seed,
            walks: None,
            walked: Walked::default(),
            reflected_walks: Quanta::ZERO,
            absorbed_walks: Quanta::ZERO,
        }
    }

    /// Applies a function to blocks of sides and their states, and returns the results in order.
    fn map_states<T: Send>(
        &mut self,
        workers: &dyn Workers,
        function: impl Fn(SideRange<'_>, &mut [SideState]) -> T + Sync,
    ) -> Vec<T> {
        let Self { model, domain, focus_sides, tallies, states, schedule, .. } = self;
        map_sides(workers, &model.mesh, states.chunks_mut(BLOCK), |sides, states| {
            function(SideRange { model, domain, focus_sides, tallies, schedule, sides }, states)
        })
    }

    /// Sets the power that all sides send with each line of the batch that begins.
    fn open(&mut self, workers: &dyn Workers) {
        self.map_states(workers, |sides, states| sides.open(states));
    }

    /// Prepares random walks with the power that is unshot when all lines are traced. Returns false if there is none.
    fn begin_walks(&mut self, workers: &dyn Workers) -> bool {
        let Self { model, ref domain, ref focus_sides, ref states, ref schedule, seed, .. } = *self;
        let forecast = domain.forecast(schedule.lines());
        let sums = map_sides(workers, &model.mesh, states.chunks(BLOCK), |sides, states| {
            let amount: f64 = states.iter().map(|state| state.unshot.amount()).sum();
            let in_focus = sides.iter().filter(|(_, side)| focus_sides.contains(*side));
            let crossings = |(triangle, side)| forecast.crossings(model.area(triangle, side));
            [amount, in_focus.map(crossings).sum()]
        });
        let [amount, crossings] = [0, 1].map(|k| sums.iter().map(|sums| sums[k]).sum());
        let count = schedule.walks(amount, crossings);
        if count > 0 {
            let unshot = |side: SideId| states[side.index()].unshot;
            self.walks = Some(Walks::new(model, unshot, count, seed, workers));
        }
        self.walks.is_some()
    }

    /// Adds the power that walks have brought to that of the shots.
    fn end_walks(&mut self, walks: &Walks, workers: &dyn Workers) {
        self.walked = Walked { walks: walks.count(), power: self.schedule.sums().unshot.all };
        let Self { model, ref tallies, ref mut direct, .. } = *self;
        let blocks = direct.power.chunks_mut(BLOCK).zip(direct.variance.chunks_mut(BLOCK));
        let sums = map_sides(workers, &model.mesh, blocks, |sides, (powers, variances)| {
            let (mut reflected, mut absorbed) = (Quanta::ZERO, Quanta::ZERO);
            for (((triangle, side), sum), variance) in sides.iter().zip(powers).zip(variances) {
                let (power, _) = tallies.take(side);
                let of_side = power.scaled(model.reflectance(triangle, side));
                reflected += of_side;
                absorbed += power - of_side;
                *sum += power;
                for (variance, more) in variance.iter_mut().zip(walks.variance(power)) {
                    *variance += more as f32;
                }
            }
            (reflected, absorbed)
        });
        for (reflected, absorbed) in sums {
            self.reflected_walks += reflected;
            self.absorbed_walks += absorbed;
        }
    }
}

impl<'m> Stage for Batches<'m> {
    type Settings = BatchSettings<'m>;
    type Input = Shot;
    type Outcome = Transported;
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        let BatchSettings { model, domain, lines, seed } = settings;
        let mut words = vec![2, model.mesh.side_count() as u64, *lines, *seed, domain.domain().identity()];
        words.extend(domain.focus().iter().flat_map(|focus| focus.identity()));
        words
    }

    fn begin(settings: Self::Settings, shot: Shot, workers: &dyn Workers) -> Result<Self, SolveError> {
        let BatchSettings { model, ref domain, lines, .. } = settings;
        let focus_sides = FocusSides::of(model, domain.focus());
        let unshot = shot.unshot(model, workers);
        let Shot { received: direct, unit, balance, sent, .. } = shot;
        drop(sent);
        let (forecast, heavy) = (domain.forecast(lines), f64::from(domain.weight()));
        // Outside the focus and in it: the number of lines that cross a side, and the power that they bring.
        let of_block = |sides: Sides<'_>, unshot: &[Quanta]| {
            let mut source = FocusSums::default();
            let (mut most, mut brightest) = ([0.0; 2], [[0.0; 3]; 2]);
            for ((triangle, side), &unshot) in sides.iter().zip(unshot) {
                let reflectance = model.reflectance(triangle, side);
                let in_focus = focus_sides.contains(side);
                source.add(unshot, in_focus);
                let crossings = forecast.crossings(model.area(triangle, side));
                let weight = if in_focus { 1.0 } else { heavy };
                // There are fewer lines than their total weight, and each crosses the side at most once.
                let crossed = if in_focus { crossings } else { crossings.min(lines as f64) };
                let (most, brightest) =
                    (&mut most[usize::from(in_focus)], &mut brightest[usize::from(in_focus)]);
                *most = f64::max(*most, crossed);
                for band in 0..3 {
                    // All light that the side reflects, if the surfaces it sees are as bright, over all its crossings.
                    let share = weight * (unshot.0[band] as f64 / (1.0 - reflectance[band]) / crossings);
                    // NaN for a patch without covered area; `max` ignores it.
                    brightest[band] = f64::max(brightest[band], share);
                }
            }
            (source, most, brightest)
        };
        let mut source = FocusSums::default();
        let (mut most, mut brightest) = ([0.0; 2], [[0.0; 3]; 2]);
        for (of_block, crossed, bright) in map_sides(workers, &model.mesh, unshot.chunks(BLOCK), of_block) {
            source += of_block;
            for part in 0..2 {
                most[part] = f64::max(most[part], crossed[part]);
                brightest[part] = [0, 1, 2].map(|band| f64::max(brightest[part][band], bright[part][band]));
            }
        }
        // Sides in the focus and outside send power to each other, each with the weight of the line.
        let [outer, inner] = brightest;
        let brightest = [
            [0, 1, 2].map(|band| outer[band].max(inner[band])),
            [0, 1, 2].map(|band| inner[band].max(outer[band] / heavy)),
        ];
        let of_part = |part: usize| SquareUnit::new(brightest[part], most[part]);
        let units_of_squares =
            SquareUnits { inside: of_part(1), outside: of_part(0), in_focus: focus_sides.clone() };
        let tallies = PatchTallies::new(model.mesh.side_count(), workers.count(), 1, units_of_squares);
        let reflected_share = balance.unshot.total() / balance.emitted.total().max(1.0);
        let mut stage =
            Self::new(settings, focus_sides, direct, unit, tallies, (source, reflected_share), workers);
        for (state, unshot) in stage.states.iter_mut().zip(unshot) {
            (state.unshot, state.source) = (unshot, unshot.0.map(|q| q as f32));
        }
        stage.open(workers);
        Ok(stage)
    }

    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let model = settings.model;
        let focus_sides = FocusSides::of(model, settings.domain.focus());
        let sides = model.mesh.side_count();
        let unit = PowerUnit::restore(visitor);
        let units_of_squares = SquareUnits::restore(focus_sides.clone(), visitor);
        let tallies = PatchTallies::new(sides, workers.count(), 1, units_of_squares);
        let direct = Received::nothing(sides);
        let source = (FocusSums::default(), 0.0);
        let mut stage = Self::new(settings, focus_sides, direct, unit, tallies, source, workers);
        stage.visit_after_units(visitor);
        if stage.schedule.is_over() {
            stage.begin_walks(workers);
        }
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        match &self.walks {
            Some(_) => self.schedule.lines()..self.expected(),
            None => self.schedule.batch(),
        }
    }

    fn expected(&self) -> u64 {
        self.schedule.lines() + self.walks.as_ref().map_or(0, Walks::count)
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, worker: usize, _chain: &mut AnyOrder, lines: Range<u64>, totals: &mut StageTotals) {
        let tallies = self.tallies.of_worker(worker);
        if let Some(walks) = &self.walks {
            let first = self.schedule.lines();
            return walks.trace(self.model, lines.start - first..lines.end - first, tallies, totals);
        }
        let StageTotals { balance, counts } = totals;
        let prefetch = |side| tallies.prefetch(side);
        let draw = |index| self.domain.line(index, self.offset, self.streams.line(index).point());
        if self.domain.focus().is_none() {
            // The weight is a constant here, which costs nothing.
            global::trace(self.model, draw, lines, counts, prefetch, |_, _, segment| {
                exchange(tallies, balance, segment, 1);
            });
        } else {
            global::trace(self.model, draw, lines, counts, prefetch, |_, weight, segment| {
                exchange(tallies, balance, segment, weight);
            });
        }
    }

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::Batch, visitor);
    }

    fn advance(&mut self, workers: &dyn Workers) -> bool {
        if let Some(walks) = self.walks.take() {
            self.end_walks(&walks, workers);
            return false;
        }
        let mut sums = BatchSums::default();
        self.map_states(workers, |sides, states| sides.close(states))
            .into_iter()
            .for_each(|part| sums += part);
        if self.schedule.advance(sums) {
            self.open(workers);
            return true;
        }
        self.begin_walks(workers)
    }

    fn visit_end(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::Squares, visitor);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.unit.visit(visitor);
        self.tallies.visit_units(visitor);
        self.visit_after_units(visitor);
    }

    fn batches(&self) -> u64 {
        self.schedule.number() + 1
    }

    fn finish(self, totals: StageTotals, workers: &dyn Workers) -> Result<Transported, SolveError> {
        let StageTotals { balance: Balance { emitted: sent_by_walks, blocked, escaped, .. }, counts } =
            totals;
        let BatchSums { unshot, absorbed, .. } = self.schedule.sums();
        let balance = Balance {
            emitted: self.schedule.source(),
            absorbed: absorbed + self.absorbed_walks,
            blocked,
            escaped,
            unshot: unshot.all + self.reflected_walks - sent_by_walks,
        };
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "multipath" });
        }
        let mut sides = vec![CountedPower::default(); self.states.len()];
        let Self { model, domain, focus_sides, tallies, states, schedule, .. } = &self;
        let blocks = states.chunks(BLOCK).zip(sides.chunks_mut(BLOCK));
        map_sides(workers, &model.mesh, blocks, |sides, (states, counted)| {
            SideRange { model, domain, focus_sides, tallies, schedule, sides }.count(states, counted);
        });
        let Self { domain, focus_sides, direct, unit, schedule, walked, .. } = self;
        let counted = Some(Counted { domain, lines: schedule.lines(), focus_sides, sides });
        Ok(Transported { uncounted: direct, counted, unit, balance, counts, walked })
    }
}

impl Batches<'_> {
    /// Visits the state except the units, which are needed before the tallies can be created.
    fn visit_after_units(&mut self, visitor: &mut dyn Visitor) {
        self.schedule.visit(!self.focus_sides.is_all(), visitor);
        self.tallies.visit(Counters::All, visitor);
        self.tallies.visit_shares(visitor);
        self.direct.visit(visitor);
        SideState::visit(&mut self.states, visitor);
    }
}

/// Sends power both ways along a segment of a line.
#[inline]
fn exchange(tallies: WorkerTallies<'_>, balance: &mut Balance, segment: Segment, weight: u32) {
    match (segment.from, segment.to) {
        (End::Side(i, _), End::Side(j, _)) => tallies.exchange(i, j, weight),
        (End::Side(i, _), End::Outside) | (End::Outside, End::Side(i, _)) => {
            balance.escaped += tallies.leave(i, weight);
        }
        (End::Side(i, _), End::Inactive) | (End::Inactive, End::Side(i, _)) => {
            balance.blocked += tallies.leave(i, weight);
        }
        _ => {}
    }
}
