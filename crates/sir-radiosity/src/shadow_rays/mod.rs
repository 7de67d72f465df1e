//! Shadow rays: the direct light at the patches, by rays from there to the light sources.
//!
//! A first shot knows the direct light of a patch by the number of lines that happen to arrive there. A ray from the patch
//! need only find out whether the way to the source is free: how much light comes from there is known. With few sources,
//! this has much less noise for the same number of rays. With hundreds of sources it has more, as each ray tests one.
//!
//! A lamp that is small and close to a patch lights a small part of it, which few points would find. Such patches keep the
//! light of the lines.
//!
//! From each of several points of a patch goes one ray to each distant light, one to one of all lamps (emitting surfaces
//! and other lights), chosen by an estimate of its light without obstacles, and one to the sky.

mod allocation;
mod batch;
mod sources;

use std::ops::Range;
use std::sync::atomic::{AtomicI64, Ordering::Relaxed};

use sir_accel::Tracer;
use sir_geom::{Rgb, TriangleId};
use sir_lines::{LocalLines, Numbers, Purpose};
use sir_mesh::SideId;

use crate::aimed::Emitters;
use crate::error::SolveError;
use crate::focus_sides::FocusSides;
use crate::line_numbers::LineNumbers;
use crate::model::Model;
use crate::patch_side::{PatchPoint, PatchSide};
use crate::power::Quanta;
use crate::sensors::SensorStart;
use crate::shadow_rays::allocation::{POINTS, PointAllocation};
use crate::shadow_rays::batch::Batch;
use crate::shadow_rays::sources::Sources;
use crate::shot::{Points, Shot};
use crate::stage::{AnyOrder, Stage};
use crate::totals::{Counts, StageTotals};
use crate::visitor::Visitor;
use crate::workers::{BLOCK, Workers, map_sides, no_items};

/// Number of rays that are traced at a time, at least.
const RAYS: usize = 1024;

/// Settings of shadow rays.
#[derive(Clone, Copy, Debug)]
pub struct ShadowRaySettings<'m> {
    /// The scene and its patches.
    pub model: &'m Model,
    /// Number of rays of all sides, and an optional focus. A side in the focus has two points at least; bright and large
    /// ones have more. There are none on other sides.
    pub rays: LocalLines,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Points of the rays.
    pub points: Points,
    /// Every how many sides there are rays; 1 for all. Others keep the light of the first shot.
    pub every: u32,
}

/// Shadow rays from the sides of patches. The outcome is the first shot with the direct light that they know instead of that
/// of its lines, and the counts of rays. What is reflected remains that of the lines.
#[derive(Debug)]
pub struct ShadowRays<'m> {
    settings: ShadowRaySettings<'m>,
    shot: Shot,
    /// Per side, true if there are rays from it.
    with_rays: Vec<bool>,
    sources: Sources,
    numbers: LineNumbers,
    allocation: PointAllocation,
    /// Per side: received power in three bands [quanta], and the bits of its variance [quanta²]. Each is computed by one
    /// process; the others have zeros.
    gathered: Vec<[AtomicI64; WORDS]>,
}

/// Numbers of a side: power in three bands, two variances in one number, and the third in another.
const WORDS: usize = 5;

/// Returns, per side, true if there are rays from it.
fn with_rays(
    settings: &ShadowRaySettings<'_>,
    in_focus: &FocusSides,
    sources: &Sources,
    workers: &dyn Workers,
) -> Vec<bool> {
    let ShadowRaySettings { model, every, .. } = *settings;
    let has_rays = |(triangle, side): (TriangleId, SideId)| {
        (side.index() as u32).is_multiple_of(every) && in_focus.contains(side) && {
            !sources.are_close_to(model, triangle, model.mesh.patch_of_side(triangle, side))
        }
    };
    let blocks = map_sides(workers, &model.mesh, no_items(), |sides, ()| {
        sides.iter().map(has_rays).collect::<Vec<_>>()
    });
    blocks.concat()
}

impl ShadowRaySettings<'_> {
    /// Returns, per side, true if there are rays from it: it is in the focus, and no small lamp is close to it. Others keep
    /// the light of the first shot.
    #[must_use]
    pub fn sides(&self, workers: &dyn Workers) -> Vec<bool> {
        let in_focus = FocusSides::of(self.model, self.rays.focus.as_ref());
        with_rays(self, &in_focus, &Sources::of(self.model), workers)
    }
}

impl ShadowRays<'_> {
    /// Fewest points of a side.
    pub const MIN_POINTS: u64 = POINTS.0;

    /// Returns the numbers of rays from a point in a scene: to the sun and the sky, and to lamps.
    #[must_use]
    pub fn rays_per_point(model: &Model) -> [u64; 2] {
        Sources::of(model).rays_per_point()
    }

    /// Returns the number of emitting surfaces in a scene, one of which a ray is aimed at.
    #[must_use]
    pub fn emitting_surfaces(model: &Model) -> usize {
        Emitters::of(model).count()
    }
}

impl<'m> ShadowRays<'m> {
    fn new(settings: ShadowRaySettings<'m>, shot: Shot, workers: &dyn Workers) -> Self {
        let ShadowRaySettings { model, rays, seed, points, .. } = settings;
        let in_focus = FocusSides::of(model, rays.focus.as_ref());
        let sources = Sources::of(model);
        let all = rays.count / sources.rays_per_point().iter().sum::<u64>().max(1);
        let allocation = PointAllocation::new(model, &in_focus, &shot, all, workers);
        let with_rays = with_rays(&settings, &in_focus, &sources, workers);
        Self {
            settings,
            shot,
            with_rays,
            sources,
            numbers: LineNumbers::new(points, seed, Purpose::SHADOW_RAYS),
            allocation,
            gathered: (0..model.mesh.side_count()).map(|_| Default::default()).collect(),
        }
    }

    /// Adds the rays of all points of a side.
    fn aim(&self, place: PatchSide, side: SideId, points: u64, batch: &mut Batch) {
        let model = self.settings.model;
        for point in 0..points {
            let numbers = &mut self.numbers.line(side.index() as u64 * POINTS.1 + point);
            let PatchPoint { triangle, position, normal } = place.point(model, numbers);
            let start = SensorStart { origin: position, surface: Some(triangle) };
            self.sources.aim(start, normal, numbers.point(), model, batch);
        }
    }

    /// Traces the rays of a batch and notes the power of its sides. Empties the batch.
    fn gather(&self, batch: &mut Batch, tracer: &mut Tracer<'_>, counts: &mut Counts) {
        batch.trace(tracer, counts);
        let Batch { sides, irradiances, .. } = std::mem::take(batch);
        let model = self.settings.model;
        let mut values = irradiances.as_slice();
        for (triangle, side, points) in sides {
            let (of_side, others) = values.split_at(points);
            values = others;
            let n = points as f64;
            let mean = of_side.iter().fold(Rgb::ZERO, |sum, value| sum + *value) / n;
            let squares = of_side.iter().fold(Rgb::ZERO, |sum, &value| sum + (value - mean) * (value - mean));
            let area = model.area(triangle, side);
            let power = self.shot.unit.quanta(mean * area).0;
            let scale = area / self.shot.unit.quantum();
            let variance = (squares * (scale * scale / (n * (n - 1.0)))).to_array().map(|v| v as f32);
            for (word, value) in self.gathered[side.index()].iter().zip(to_words(power, variance)) {
                word.store(value, Relaxed);
            }
        }
    }
}

fn to_words([r, g, b]: [i64; 3], variance: [f32; 3]) -> [i64; WORDS] {
    let [x, y, z] = variance.map(|v| i64::from(v.to_bits()));
    [r, g, b, x << 32 | y, z]
}

fn from_words([r, g, b, xy, z]: [i64; WORDS]) -> (Quanta, [f32; 3]) {
    (Quanta([r, g, b]), [xy >> 32, xy, z].map(|bits| f32::from_bits(bits as u32)))
}

impl<'m> Stage for ShadowRays<'m> {
    type Settings = ShadowRaySettings<'m>;
    type Input = Shot;
    type Outcome = (Shot, Counts);
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        let ShadowRaySettings { model, rays, seed, points, every } = settings;
        let sides = model.mesh.side_count() as u64;
        let mut words = vec![8, sides, rays.count, *seed, *points as u64, u64::from(*every)];
        words.extend(rays.focus.iter().flat_map(|focus| focus.identity()));
        words
    }

    fn begin(settings: Self::Settings, shot: Shot, workers: &dyn Workers) -> Result<Self, SolveError> {
        Ok(Self::new(settings, shot, workers))
    }

    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let mut stage = Self::new(settings, Shot::restore(settings.model, visitor), workers);
        stage.visit_round(visitor);
        Ok(stage)
    }

    /// The units are sides.
    fn round(&self) -> Range<u64> {
        0..(self.gathered.len() as u64).div_ceil(u64::from(self.settings.every))
    }

    fn lines_per_unit(&self) -> u64 {
        self.settings.rays.count.div_ceil(self.gathered.len().max(1) as u64).max(1)
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, _worker: usize, _chain: &mut AnyOrder, units: Range<u64>, totals: &mut StageTotals) {
        let ShadowRaySettings { model, every, .. } = self.settings;
        let mut tracer = model.accel.tracer();
        let mut batch = Batch::default();
        let every = u64::from(every);
        let end = (units.end * every).min(self.gathered.len() as u64) as u32;
        let ranges = model.mesh.sides_within((units.start * every) as u32..end);
        for (triangle, side) in ranges.flat_map(|(triangle, sides)| sides.map(move |s| (triangle, SideId(s))))
        {
            if !self.with_rays[side.index()] {
                continue;
            }
            let place = PatchSide::of(model, triangle, side);
            let points = self.allocation.points(model, &self.shot, triangle, side);
            batch.sides.push((triangle, side, points as usize));
            self.aim(place, side, points, &mut batch);
            if batch.len() >= RAYS {
                self.gather(&mut batch, &mut tracer, &mut totals.counts);
            }
        }
        self.gather(&mut batch, &mut tracer, &mut totals.counts);
    }

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        let mut words = Vec::new();
        for sides in self.gathered.chunks_mut(BLOCK) {
            words.clear();
            words.extend(sides.iter_mut().flatten().map(|word| *word.get_mut()));
            visitor.sum(&mut words);
            sides.iter_mut().flatten().zip(&words).for_each(|(word, value)| *word.get_mut() = *value);
        }
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.shot.visit(visitor);
        self.visit_round(visitor);
    }

    fn finish(self, totals: StageTotals, workers: &dyn Workers) -> Result<(Shot, Counts), SolveError> {
        let Self { settings, mut shot, with_rays, gathered, .. } = self;
        shot.correction = vec![Quanta::ZERO; gathered.len()];
        let received = &mut shot.received;
        let blocks = received.power.chunks_mut(BLOCK).zip(received.variance.chunks_mut(BLOCK));
        let blocks = blocks.zip(shot.correction.chunks_mut(BLOCK)).zip(gathered.chunks(BLOCK));
        map_sides(
            workers,
            &settings.model.mesh,
            blocks,
            |sides, (((power, variance), correction), gathered)| {
                let places = power.iter_mut().zip(variance).zip(correction).zip(gathered);
                for ((_, side), (((power, variance), correction), gathered)) in sides.iter().zip(places) {
                    if with_rays[side.index()] {
                        let (by_rays, of_rays) =
                            from_words(gathered.each_ref().map(|word| word.load(Relaxed)));
                        *correction = by_rays - *power;
                        (*power, *variance) = (by_rays, of_rays);
                    }
                }
            },
        );
        Ok((shot, totals.counts))
    }
}
