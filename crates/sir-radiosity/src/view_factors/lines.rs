//! The lines that estimate view factors.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use sir_accel::Ray;
use sir_geom::{Line, Side, TriangleId};
use sir_lines::{Allocation, Purpose, Streams, cosine_direction};

use crate::emitter::point_on_surface;
use crate::error::SolveError;
use crate::grouping::{Grouping, active_area};
use crate::model::Model;
use crate::stage::{AnyOrder, Stage};
use crate::totals::StageTotals;
use crate::view_factors::effort::{Next, ViewFactorSettings};
use crate::view_factors::table::ViewFactors;
use crate::visitor::Visitor;
use crate::workers::Workers;

/// Largest number of groups. The tables grow with its square.
pub const MAX_GROUPS: usize = 4096;

/// Number of rays that are generated at a time.
const RAYS: usize = 1024;

/// The triangles of a group, as a sender of lines.
#[derive(Clone, Debug, Default)]
struct Sender {
    triangles: Vec<TriangleId>,
    /// Running sums of their active areas.
    ends: Vec<f64>,
}

/// Input of a view factor computation.
#[derive(Clone, Copy, Debug)]
pub struct ViewFactorTask<'m> {
    /// The scene and its patches.
    pub model: &'m Model,
    /// The groups of surfaces.
    pub grouping: &'m Grouping,
    /// Accuracy, number of lines and seed.
    pub settings: ViewFactorSettings,
}

/// Local lines that estimate view factors, in rounds.
///
/// [`Stage::begin`] fails with more than [`MAX_GROUPS`] groups, and with too few lines for the groups.
#[derive(Debug)]
pub struct ViewFactorLines<'m> {
    model: &'m Model,
    grouping: &'m Grouping,
    settings: ViewFactorSettings,
    streams: Streams,
    senders: Vec<Sender>,
    /// Number of lines of each group in all rounds before this one, and how many of them arrived at each receiver.
    lines: Vec<u64>,
    counts: Vec<u64>,
    /// Counts of this round, by all threads.
    round: Vec<AtomicU64>,
    next: Next,
    allocation: Allocation,
}

impl<'m> ViewFactorLines<'m> {
    /// Returns the number of lines of all rounds before this one.
    fn done(&self) -> u64 {
        self.lines.iter().sum()
    }

    /// Determines the number of lines of the next round and allocates them to groups.
    fn plan_round(&mut self) {
        self.next = self.settings.next(&self.lines, &self.counts);
        self.allocation = Allocation::new(&self.next.weights, self.next.end - self.done(), 0.5);
    }

    /// Returns a ray that leaves a group.
    fn ray(&self, group: usize, index: u64) -> Ray {
        let Sender { triangles, ends } = &self.senders[group];
        let scene = &self.model.scene;
        let mut stream = self.streams.line(index);
        let last = triangles.len() - 1;
        let place = stream.unit() * ends[last];
        let triangle = triangles[ends.partition_point(|&end| end <= place).min(last)];
        let back = scene.is_active(triangle, Side::Back) && stream.unit() < 0.5;
        let normal = if back { -scene.normal(triangle) } else { scene.normal(triangle) };
        let origin = point_on_surface(scene, triangle, scene.corners(triangle), &mut stream);
        let line = Line { origin, direction: cosine_direction(normal, stream.point()) };
        Ray::leaving(line, triangle)
    }
}

impl<'m> Stage for ViewFactorLines<'m> {
    type Settings = ViewFactorTask<'m>;
    type Input = ();
    type Outcome = ViewFactors;
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        vec![5, settings.model.mesh.side_count() as u64, settings.settings.seed]
    }

    fn begin(settings: Self::Settings, (): (), _workers: &dyn Workers) -> Result<Self, SolveError> {
        let ViewFactorTask { model, grouping, settings } = settings;
        let groups = grouping.names().len();
        if groups > MAX_GROUPS {
            return Err(SolveError::TooManyGroups { groups, most: MAX_GROUPS });
        }
        let fewest = ViewFactorSettings::min_lines(groups);
        if settings.lines < fewest {
            return Err(SolveError::TooFewLines { lines: settings.lines, groups, fewest });
        }
        let mut senders = vec![Sender::default(); groups];
        for triangle in model.scene.triangle_ids() {
            let Sender { triangles, ends } = &mut senders[grouping.group_of(triangle)];
            triangles.push(triangle);
            ends.push(ends.last().unwrap_or(&0.0) + active_area(&model.scene, &model.mesh, triangle));
        }
        let (lines, counts) = (vec![0; groups], vec![0; groups * (groups + 2)]);
        let next = settings.next(&lines, &counts);
        let allocation = Allocation::new(&next.weights, next.end, 0.5);
        Ok(Self {
            model,
            grouping,
            settings,
            streams: Streams::new(settings.seed, Purpose::VIEW_FACTORS),
            senders,
            lines,
            round: counts.iter().map(|_| AtomicU64::new(0)).collect(),
            counts,
            next,
            allocation,
        })
    }

    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let mut stage = Self::begin(settings, (), workers)?;
        stage.visit(visitor);
        stage.plan_round();
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        self.done()..self.next.end
    }

    fn expected(&self) -> u64 {
        self.next.expected
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, _worker: usize, _chain: &mut AnyOrder, lines: Range<u64>, totals: &mut StageTotals) {
        let groups = self.senders.len();
        let (blocked, escaped, columns) = (groups, groups + 1, groups + 2);
        let scene = &self.model.scene;
        let mut tracer = self.model.accel.tracer();
        let mut rays = Vec::with_capacity(RAYS);
        let mut senders = Vec::with_capacity(RAYS);
        let mut receivers = vec![0; RAYS];
        let mut row = vec![0; columns];
        let mut first = lines.start;
        while first < lines.end {
            let end = lines.end.min(first + RAYS as u64);
            rays.clear();
            senders.clear();
            let owners = self.allocation.owners(first - self.done());
            for (index, group) in (first..end).zip(owners) {
                rays.push(self.ray(group, index));
                senders.push(group);
            }
            first = end;
            tracer.closest_each(&rays, |i, hit| {
                receivers[i] = match hit {
                    Some(hit) if scene.is_active(hit.triangle, hit.side) => {
                        self.grouping.group_of(hit.triangle)
                    }
                    Some(_) => blocked,
                    None => escaped,
                };
            });
            totals.counts.lines += rays.len() as u64;
            // Consecutive lines mostly belong to the same group. Counting each run locally first keeps contention for
            // the shared counters low.
            let mut receivers = &receivers[..rays.len()];
            for run in senders.chunk_by(|a, b| a == b) {
                let (mine, others) = receivers.split_at(run.len());
                receivers = others;
                mine.iter().for_each(|&receiver| row[receiver] += 1);
                for &receiver in mine {
                    let count = std::mem::take(&mut row[receiver]);
                    if count > 0 {
                        self.round[run[0] * columns + receiver].fetch_add(count, Relaxed);
                    }
                }
            }
        }
    }

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        let mut words: Vec<i64> = self.round.iter_mut().map(|count| *count.get_mut() as i64).collect();
        visitor.sum(&mut words);
        self.round.iter_mut().zip(words).for_each(|(count, word)| *count.get_mut() = word as u64);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        for numbers in [&mut self.lines, &mut self.counts] {
            let mut words: Vec<i64> = numbers.iter().map(|&n| n as i64).collect();
            visitor.same(&mut words);
            *numbers = words.into_iter().map(|word| word as u64).collect();
        }
        self.visit_round(visitor);
    }

    fn advance(&mut self, _workers: &dyn Workers) -> bool {
        for (sum, count) in self.counts.iter_mut().zip(&mut self.round) {
            *sum += std::mem::take(count.get_mut());
        }
        (0..self.lines.len()).for_each(|i| self.lines[i] += self.allocation.count(i));
        self.plan_round();
        !self.next.finished
    }

    /// Returns the view factors counted in all rounds.
    fn finish(self, _totals: StageTotals, _workers: &dyn Workers) -> Result<ViewFactors, SolveError> {
        Ok(ViewFactors {
            names: self.grouping.names().to_vec(),
            areas: self.grouping.areas(&self.model.scene, &self.model.mesh),
            lines: self.lines,
            counts: self.counts,
        })
    }
}
