//! Random walks: local lines that send on what is unshot when the global lines end.
//!
//! A walk starts at a side with a share of the unshot power, and goes on from every patch that it hits until it is
//! absorbed, blocked or leaves the scene (a shooting random walk: Pattanaik and Mudur 1992). Walks therefore carry all
//! further reflections, and leave nothing unshot but what chance gives and takes: a sum with mean zero.
//!
//! Walks are allocated in proportion to the amount of unshot power, which is negative for sides that have sent more
//! than they held. All walks carry the same amount: a walk that is reflected goes on with the probability `p` that its
//! amount is, and then carries what is reflected over `p`.

use std::ops::Range;

use sir_accel::Hit;
use sir_geom::Rgb;
use sir_lines::{Allocation, Purpose, Stream, Streams};
use sir_mesh::SideId;

use crate::model::Model;
use crate::patch_side::PatchSide;
use crate::power::Quanta;
use crate::tallies::WorkerTallies;
use crate::totals::StageTotals;
use crate::workers::{Workers, map_sides, no_items};

/// Number of walks that are traced together.
const WALKS: u64 = 1024;

/// Walks that start at one side.
#[derive(Clone, Copy, Debug)]
struct Start {
    /// End of the numbers of these walks, exclusive.
    end: u64,
    place: PatchSide,
    /// Power of each walk.
    power: Quanta,
}

/// A set of random walks from the sides that hold unshot power.
#[derive(Debug)]
pub(super) struct Walks {
    starts: Vec<Start>,
    streams: Streams,
    count: u64,
    /// Mean power of a walk over a walk's power, per band: Σp²/Σ|p|.
    mean: [f64; 3],
}

/// A walk between two rays.
struct Walk {
    stream: Stream,
    power: Quanta,
}

impl Walks {
    /// Returns `count` walks that start with the unshot power, indexed by [`SideId`].
    pub(super) fn new(
        model: &Model,
        unshot: impl Fn(SideId) -> Quanta + Sync,
        count: u64,
        seed: u64,
        workers: &dyn Workers,
    ) -> Self {
        let (mesh, purpose) = (&model.mesh, Purpose::WALKS);
        let weights = map_sides(workers, mesh, no_items(), |sides, ()| {
            sides.iter().map(|(_, side)| unshot(side).amount()).collect::<Vec<f64>>()
        });
        let weights = weights.concat();
        let total: f64 = weights.iter().sum();
        let offset = Streams::new(seed, Purpose::ALLOCATION).line(purpose.0).unit();
        let allocation = Allocation::new(&weights, count, offset);
        let (mut starts, mut end) = (Vec::new(), 0);
        let (mut squares, mut amounts) = ([0.0; 3], [0.0; 3]);
        mesh.for_each_side(|triangle, patch, side, id| {
            let walks = allocation.count(id.index());
            if walks == 0 {
                return;
            }
            end += walks;
            // The expected number of walks is `count` times the share of the side.
            let share = total / (count as f64 * weights[id.index()]);
            let power = unshot(id).scaled(Rgb::splat(share));
            for band in 0..3 {
                let amount = (power.0[band] as f64).abs();
                squares[band] += walks as f64 * amount * amount;
                amounts[band] += walks as f64 * amount;
            }
            starts.push(Start { end, place: PatchSide { triangle, patch, side }, power });
        });
        let mean =
            [0, 1, 2].map(|band| if amounts[band] > 0.0 { squares[band] / amounts[band] } else { 0.0 });
        Self { starts, streams: Streams::new(seed, purpose), count, mean }
    }

    /// Returns the number of walks.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Returns the variance of the power that walks bring to a side \[quanta²\]: that of a sum of a random number of
    /// walks which all bring the mean.
    pub(super) fn variance(&self, power: Quanta) -> [f64; 3] {
        [0, 1, 2].map(|band| (power.0[band] as f64).abs() * self.mean[band])
    }

    /// Traces some walks to their ends. `emitted` of the balance is the power of all their rays.
    pub(super) fn trace(
        &self,
        model: &Model,
        walks: Range<u64>,
        tallies: WorkerTallies<'_>,
        totals: &mut StageTotals,
    ) {
        let mut tracer = model.accel.tracer();
        let (mut rays, mut going) = (Vec::new(), Vec::new());
        let mut first = walks.start;
        while first < walks.end {
            let end = walks.end.min(first + WALKS);
            let mut start = self.starts.partition_point(|start| start.end <= first);
            for number in first..end {
                while self.starts[start].end <= number {
                    start += 1;
                }
                let Start { place, power, .. } = self.starts[start];
                let mut stream = self.streams.line(number);
                rays.push(place.ray(model, &mut stream));
                going.push(Walk { stream, power });
            }
            first = end;
            while !rays.is_empty() {
                let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
                tracer.closest_each(&rays, |i, hit| hits[i] = hit);
                rays.clear();
                let before = std::mem::take(&mut going);
                for (mut walk, hit) in before.into_iter().zip(hits) {
                    totals.balance.emitted += walk.power;
                    let Some(hit) = hit else {
                        totals.balance.escaped += walk.power;
                        continue;
                    };
                    let Some(side) = model.mesh.side_at(hit.triangle, hit.point, hit.side) else {
                        totals.balance.blocked += walk.power;
                        continue;
                    };
                    tallies.receive(side, walk.power);
                    if let Some(power) =
                        reflected(walk.power, model.reflectance(hit.triangle, side), &mut walk.stream)
                    {
                        let patch = model.mesh.patch_at(hit.triangle, hit.point);
                        let place = PatchSide { triangle: hit.triangle, patch, side: hit.side };
                        rays.push(place.ray(model, &mut walk.stream));
                        going.push(Walk { power, ..walk });
                    }
                }
            }
        }
    }
}

/// Returns the power with which a walk goes on from a surface, or `None` if it ends there.
fn reflected(power: Quanta, reflectance: Rgb, stream: &mut Stream) -> Option<Quanta> {
    let whole = power.scaled(reflectance);
    let probability = whole.amount() / power.amount();
    (stream.unit() < probability).then(|| power.scaled(reflectance / probability))
}
