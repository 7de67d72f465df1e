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

use std::ops::Range;
use std::sync::atomic::{AtomicI64, Ordering::Relaxed};

use glam::DVec3;
use sir_accel::Ray;
use sir_geom::{LightKind, Rgb, Side, TriangleId};
use sir_lines::{LocalLines, Numbers, Purpose, cosine_direction};
use sir_mesh::SideId;

use crate::aimed::{Aim, Emitters};
use crate::emitter::point_on_surface;
use crate::error::SolveError;
use crate::focus_sides::FocusSides;
use crate::line_numbers::LineNumbers;
use crate::model::Model;
use crate::patch_side::{MergedPatches, PatchSide};
use crate::power::Quanta;
use crate::sensors::SensorStart;
use crate::shot::{Points, Shot};
use crate::stage::{AnyOrder, Stage};
use crate::totals::{Counts, StageTotals};
use crate::visitor::Visitor;
use crate::workers::{BLOCK, Workers, map_sides, no_items};

/// Number of rays that are traced at a time, at least.
const RAYS: usize = 1024;

/// Fewest and most points of a side. The spread of one point is not known.
const POINTS: (u64, u64) = (2, 1 << 16);

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
    merged: MergedPatches,
    numbers: LineNumbers,
    allocation: PointAllocation,
    /// Per side: received power in three bands [quanta], and the bits of its variance [quanta²]. Each is computed by one
    /// process; the others have zeros.
    gathered: Vec<[AtomicI64; WORDS]>,
}

/// Numbers of a side: power in three bands, two variances in one number, and the third in another.
const WORDS: usize = 5;

/// How many points the sides have: two, and more in proportion to the root of the area times the irradiance by the lines of
/// the first shot, to which the mean is added. If the noise of one point is in proportion to the light, this has the smallest
/// area-weighted variance (Neyman 1934).
#[derive(Clone, Copy, Debug, Default)]
struct PointAllocation {
    /// Mean irradiance \[quanta/m²\].
    mean: f64,
    /// Further points per weight.
    density: f64,
}

impl PointAllocation {
    /// Returns the allocation of `points` to the sides in the focus, whether all of these have rays or not.
    fn new(model: &Model, in_focus: &FocusSides, shot: &Shot, points: u64, workers: &dyn Workers) -> Self {
        let sum = |of: &(dyn Fn(TriangleId, SideId) -> [f64; 2] + Sync)| {
            let blocks = map_sides(workers, &model.mesh, no_items(), |sides, ()| {
                let sides = sides.iter().filter(|(_, side)| in_focus.contains(*side));
                sides.map(|(triangle, side)| of(triangle, side)).fold([0.0; 2], add)
            });
            blocks.into_iter().fold([0.0; 2], add)
        };
        let [power, area] =
            sum(&|triangle, side| [shot.received.power[side.index()].total(), model.area(triangle, side)]);
        let mut all = Self { mean: if area > 0.0 { power / area } else { 0.0 }, density: 0.0 };
        let [count, weight] = sum(&|triangle, side| [1.0, all.weight(model, shot, triangle, side)]);
        let further = (points as f64 - POINTS.0 as f64 * count).max(0.0);
        all.density = if weight > 0.0 { further / weight } else { 0.0 };
        all
    }

    fn weight(&self, model: &Model, shot: &Shot, triangle: TriangleId, side: SideId) -> f64 {
        let area = model.area(triangle, side);
        if area > 0.0 {
            area.sqrt() * (shot.received.power[side.index()].total() / area + self.mean)
        } else {
            0.0
        }
    }

    /// Returns the number of points of a side.
    fn points(&self, model: &Model, shot: &Shot, triangle: TriangleId, side: SideId) -> u64 {
        let further = self.density * self.weight(model, shot, triangle, side);
        (POINTS.0 + further as u64).min(POINTS.1)
    }
}

fn add([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a + c, b + d]
}

/// The sources of light as seen from a point.
#[derive(Debug)]
struct Sources {
    distant: Vec<LightKind>,
    /// Lights at a point.
    local: Vec<LightKind>,
    surfaces: Emitters,
    has_sky: bool,
    /// Centers and radii of spheres around lamps: lights at a point, and emitting surfaces.
    lamps: Vec<(DVec3, f64)>,
}

/// Largest distance of a lamp from the center of a patch that it is close to, in radii of the patch, and radius of a small
/// lamp.
const CLOSE: f64 = 2.0;
const SMALL: f64 = 0.5;

/// Rays of some points, with what they bring if they arrive.
#[derive(Default)]
struct Batch {
    /// Rays that arrive if nothing is in the way.
    free: Vec<Ray>,
    /// Rays that arrive if they hit a side of a triangle.
    aimed: Vec<Ray>,
    targets: Vec<(TriangleId, Side)>,
    /// Number of the point, and irradiance \[W/m²\], of each ray.
    of_free: Vec<(usize, Rgb)>,
    of_aimed: Vec<(usize, Rgb)>,
    /// Sides of the points, and the number of points of each.
    sides: Vec<(TriangleId, SideId, usize)>,
    /// Irradiance of each point.
    irradiances: Vec<Rgb>,
}

impl Sources {
    fn of(model: &Model) -> Self {
        let lights = model.scene.lights().iter().map(|light| light.kind);
        let (distant, local): (Vec<_>, Vec<_>) =
            lights.partition(|kind| matches!(kind, LightKind::Distant { .. }));
        let surfaces = Emitters::of(model);
        let at = |kind: &LightKind| match kind {
            LightKind::Point { position, .. } => Some((*position, 0.0)),
            LightKind::Distant { .. } => None,
        };
        let lamps = local.iter().filter_map(at).chain(surfaces.corners().map(around)).collect();
        Self { distant, local, surfaces, has_sky: model.scene.sky().is_some(), lamps }
    }

    /// True if a small lamp is close to a triangle.
    fn are_close_to(&self, corners: [DVec3; 3]) -> bool {
        let (center, radius) = around(corners);
        self.lamps
            .iter()
            .any(|&(lamp, size)| size < SMALL * radius && lamp.distance(center) < CLOSE * radius + size)
    }

    /// Returns the numbers of rays from a point: to distant lights and the sky, and to lamps.
    fn rays_per_point(&self) -> [u64; 2] {
        let has_lamps = !self.local.is_empty() || self.surfaces.count() > 0;
        [self.distant.len() as u64 + u64::from(self.has_sky), u64::from(has_lamps)]
    }
}

/// Returns the center and the radius of a sphere around a triangle.
fn around(corners @ [a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let center = (a + b + c) / 3.0;
    (center, corners.iter().map(|corner| corner.distance(center)).fold(0.0, f64::max))
}

/// Returns, per side, true if there are rays from it.
fn with_rays(
    settings: &ShadowRaySettings<'_>,
    in_focus: &FocusSides,
    sources: &Sources,
    merged: &MergedPatches,
    workers: &dyn Workers,
) -> Vec<bool> {
    let ShadowRaySettings { model, every, .. } = *settings;
    let has_rays = |(triangle, side): (TriangleId, SideId)| {
        (side.index() as u32).is_multiple_of(every) && in_focus.contains(side) && {
            let place = PatchSide::of(model, triangle, side);
            merged.parts(place).all(|part| !sources.are_close_to(part.corners(model)))
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
        with_rays(self, &in_focus, &Sources::of(self.model), &MergedPatches::of(self.model), workers)
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
        let merged = MergedPatches::of(model);
        let with_rays = with_rays(&settings, &in_focus, &sources, &merged, workers);
        Self {
            settings,
            shot,
            with_rays,
            sources,
            merged,
            numbers: LineNumbers::new(points, seed, Purpose::SHADOW_RAYS),
            allocation,
            gathered: (0..model.mesh.side_count()).map(|_| Default::default()).collect(),
        }
    }

    /// Adds the rays of all points of a side.
    fn aim(&self, place: PatchSide, side: SideId, points: u64, batch: &mut Batch) {
        let model = self.settings.model;
        let (of_side, normal) = (place.corners(model), place.normal(model));
        for point in 0..points {
            let numbers = &mut self.numbers.line(side.index() as u64 * POINTS.1 + point);
            let part = self.merged.part_of(place, model, numbers);
            let corners = if part == place { of_side } else { part.corners(model) };
            let origin = point_on_surface(&model.scene, part.triangle, corners, numbers);
            let start = SensorStart { origin, surface: Some(part.triangle) };
            self.aim_from(start, normal, numbers.point(), batch);
        }
    }

    /// Adds the rays of a point.
    fn aim_from(&self, start: SensorStart, normal: DVec3, random: [f64; 2], batch: &mut Batch) {
        let model = self.settings.model;
        let number = batch.irradiances.len();
        batch.irradiances.push(Rgb::ZERO);
        for light in &self.sources.distant {
            if let Some((ray, irradiance)) = to_light(light, start, normal, model) {
                batch.free.push(ray);
                batch.of_free.push((number, irradiance));
            }
        }
        self.aim_at_lamp(start, normal, random, number, batch);
        if let (true, Some(sky)) = (self.sources.has_sky, model.scene.sky()) {
            let direction = cosine_direction(normal, random);
            let irradiance = std::f64::consts::PI * sky.radiance(direction);
            if irradiance != Rgb::ZERO {
                batch.free.push(start.ray(direction));
                batch.of_free.push((number, irradiance));
            }
        }
    }

    /// Adds a ray to one of all lamps.
    fn aim_at_lamp(
        &self,
        start: SensorStart,
        normal: DVec3,
        [u, v]: [f64; 2],
        number: usize,
        batch: &mut Batch,
    ) {
        let Sources { local, surfaces, .. } = &self.sources;
        let choice = surfaces.from(start.origin, normal);
        let rays = local.iter().filter_map(|light| to_light(light, start, normal, self.settings.model));
        let lights: Vec<(Ray, Rgb)> = rays.collect();
        let of_lights: f64 = lights.iter().map(|(_, irradiance)| irradiance.element_sum()).sum();
        let total = choice.total + of_lights;
        let mut rest = u * total;
        if rest < choice.total {
            let share = choice.total / total;
            if let Some(aim) = choice.aim_alone([rest / choice.total, v]) {
                let Aim { direction, triangle, side, contribution } = aim;
                batch.aimed.push(start.ray(direction));
                batch.targets.push((triangle, side));
                batch.of_aimed.push((number, contribution / share));
            }
            return;
        }
        rest -= choice.total;
        for (i, &(ray, irradiance)) in lights.iter().enumerate() {
            let weight = irradiance.element_sum();
            if rest < weight || i + 1 == lights.len() {
                batch.free.push(ray);
                batch.of_free.push((number, irradiance * (total / weight)));
                return;
            }
            rest -= weight;
        }
    }

    /// Traces the rays of a batch and notes the power of its sides. Empties the batch.
    fn gather(&self, batch: &mut Batch, tracer: &mut sir_accel::Tracer<'_>, counts: &mut Counts) {
        let Batch { free, aimed, targets, of_free, of_aimed, sides, irradiances } = batch;
        counts.lines += (free.len() + aimed.len()) as u64;
        let mut arrives = vec![false; free.len()];
        tracer.occluded_each(free, |i, is_occluded| arrives[i] = !is_occluded);
        let mut add = |(number, irradiance): (usize, Rgb), arrives: bool| {
            if arrives { irradiances[number] += irradiance } else { counts.empty += 1 }
        };
        // Rays are traced in any order, but floats have to be added in a fixed order.
        of_free.iter().zip(arrives).for_each(|(&ray, arrives)| add(ray, arrives));
        let mut arrives = vec![false; aimed.len()];
        tracer.closest_each(aimed, |i, hit| {
            arrives[i] = hit.is_some_and(|hit| (hit.triangle, hit.side) == targets[i]);
        });
        of_aimed.iter().zip(arrives).for_each(|(&ray, arrives)| add(ray, arrives));
        let model = self.settings.model;
        let mut values = irradiances.as_slice();
        for &(triangle, side, points) in &*sides {
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
        *batch = Batch::default();
    }
}

/// Returns the ray to a light without a surface, and the irradiance \[W/m²\] that it brings.
fn to_light(light: &LightKind, start: SensorStart, normal: DVec3, model: &Model) -> Option<(Ray, Rgb)> {
    let arrival = light.arrival(start.origin)?;
    let cosine = arrival.towards.dot(normal);
    (cosine > 0.0).then(|| {
        let ray = start.ray_to_light(arrival.towards, arrival.distance, model);
        (ray, cosine * arrival.irradiance)
    })
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
            if batch.free.len() + batch.aimed.len() >= RAYS {
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
