//! Queries for rays: the closest hit, and occlusion (any hit).

use crate::accel::Accel;
use crate::contact::CONTACT;
use crate::grid::{GridLine, RADIUS};
use crate::hit::Hit;
use crate::line_f32::Span;
use crate::ray::Ray;
use crate::search::first_hit::Rays;
use crate::triangle::Crossing;

/// Number of rays by which prefetching runs ahead.
const AHEAD: usize = 16;

/// Distance from the nearest hit within which the contact order chooses the first hit \[steps of the grid\].
const SLACK: f64 = 2.0 * CONTACT;

/// Source of rays, which it converts to the grid one by one.
struct Feed<'a> {
    accel: &'a Accel,
    rays: &'a [Ray],
    next: usize,
}

impl Feed<'_> {
    /// Returns the next ray that comes near the scene: its index, its line, the part of the line that is searched, and
    /// the place of the triangle that it leaves. Calls `miss` with the indices of rays that pass far from the scene.
    #[inline(always)]
    fn next(&mut self, mut miss: impl FnMut(usize)) -> Option<(usize, GridLine, Span, u32)> {
        loop {
            let index = self.next;
            let ray = self.rays.get(index)?;
            self.next += 1;
            let Accel { tree, grid, .. } = self.accel;
            let Some(line) = grid.line(&ray.line) else {
                miss(index);
                continue;
            };
            let start = grid.steps(ray.range.start) - line.start;
            let start = match ray.leaving {
                Some(_) if ray.range.start > 0.0 => start.max(0.0),
                Some(_) => 0.0,
                None => start,
            };
            let span = Span::new(start, grid.steps(ray.range.end) - line.start, SLACK);
            let leaving = ray.leaving.and_then(|id| tree.place(id)).unwrap_or(u32::MAX);
            // The triangles that the next rays leave may not be in the cache.
            if let Some(id) = self.rays.get(index + AHEAD).and_then(|ray| ray.leaving) {
                tree.prefetch_place(id);
            }
            break Some((index, line, span, leaving));
        }
    }

    /// Returns true if a crossing lies on a ray and stops it.
    #[inline(always)]
    fn is_hit(&self, index: usize, line: &GridLine, crossing: &Crossing) -> bool {
        let Accel { grid, opacity, .. } = self.accel;
        let Ray { line: exact, range, leaving } = &self.rays[index];
        let t = grid.length(crossing.t + line.start);
        let is_ahead = match leaving {
            Some(id) => {
                (range.start <= 0.0 || t >= range.start)
                    && self.accel.contacts().is_ahead(*id, crossing, line)
            }
            None => t >= range.start,
        };
        is_ahead
            && t < range.end
            && opacity.as_ref().is_none_or(|test| test.stops(exact, crossing.id, crossing.point))
    }
}

/// Query for closest hits.
pub(crate) struct ClosestHits<'a, F> {
    feed: Feed<'a>,
    /// Crossings that are close to another one, with the index of their ray.
    close: Vec<(usize, Crossing)>,
    visit: F,
}

/// Closest hit of a ray so far.
pub(crate) struct Closest {
    index: usize,
    /// Crossing with the smallest distance.
    best: Option<Crossing>,
    /// True if another crossing is close to it.
    close: bool,
}

impl<'a, F> ClosestHits<'a, F> {
    pub(crate) fn new(accel: &'a Accel, rays: &'a [Ray], visit: F) -> Self {
        Self { feed: Feed { accel, rays, next: 0 }, close: Vec::new(), visit }
    }

    /// Records two crossings so close that the contact order may apply to them. This records all crossings within
    /// [`SLACK`] of the nearest one, in whatever order they are found.
    #[cold]
    fn note_close(&mut self, ray: &mut Closest, one: Crossing, other: Crossing) {
        ray.close = true;
        self.close.extend([(ray.index, one), (ray.index, other)]);
    }

    /// Returns the first of the hits that are close together, by the contact order.
    #[cold]
    fn first_of_close(&mut self, index: usize, best: Crossing, line: &GridLine) -> Hit {
        let grid = &self.feed.accel.grid;
        let mut hits = vec![best.hit(grid, line)];
        self.close.retain(|(of_ray, crossing)| {
            if *of_ray == index && crossing.t <= best.t + SLACK {
                hits.push(crossing.hit(grid, line));
            }
            *of_ray != index
        });
        hits.sort_unstable_by_key(|hit| hit.triangle);
        hits.dedup_by_key(|hit| hit.triangle);
        self.feed.accel.contacts().sort(&mut hits, grid.length(CONTACT));
        hits[0]
    }
}

impl<F: FnMut(usize, Option<Hit>)> Rays for ClosestHits<'_, F> {
    type Ray = Closest;
    const FIRST_ENDS: bool = false;

    #[inline(always)]
    fn next(&mut self) -> Option<(Closest, GridLine, Span, u32)> {
        let (index, line, span, leaving) = self.feed.next(|index| (self.visit)(index, None))?;
        Some((Closest { index, best: None, close: false }, line, span, leaving))
    }

    #[inline(always)]
    fn cross(&mut self, ray: &mut Closest, line: &GridLine, crossing: Crossing) -> f32 {
        if self.feed.is_hit(ray.index, line, &crossing) {
            if let Some(best) = ray.best
                && (crossing.t - best.t).abs() <= SLACK
            {
                self.note_close(ray, crossing, best);
            }
            if ray.best.is_none_or(|best| (crossing.t, crossing.id) < (best.t, best.id)) {
                ray.best = Some(crossing);
            }
        }
        ray.best.map_or(f32::INFINITY, |best| ((best.t + SLACK) / RADIUS) as f32)
    }

    #[inline(always)]
    fn done(&mut self, ray: Closest, line: &GridLine) {
        let hit = match ray.best {
            Some(best) if ray.close => Some(self.first_of_close(ray.index, best, line)),
            best => best.map(|crossing| crossing.hit(&self.feed.accel.grid, line)),
        };
        (self.visit)(ray.index, hit);
    }
}

/// Query for any hit.
pub(crate) struct Occlusions<'a, F> {
    feed: Feed<'a>,
    visit: F,
}

/// Occlusion of a ray so far.
pub(crate) struct Occlusion {
    index: usize,
    is_occluded: bool,
}

impl<'a, F> Occlusions<'a, F> {
    pub(crate) fn new(accel: &'a Accel, rays: &'a [Ray], visit: F) -> Self {
        Self { feed: Feed { accel, rays, next: 0 }, visit }
    }
}

impl<F: FnMut(usize, bool)> Rays for Occlusions<'_, F> {
    type Ray = Occlusion;
    const FIRST_ENDS: bool = true;

    #[inline(always)]
    fn next(&mut self) -> Option<(Occlusion, GridLine, Span, u32)> {
        let (index, line, span, leaving) = self.feed.next(|index| (self.visit)(index, false))?;
        Some((Occlusion { index, is_occluded: false }, line, span, leaving))
    }

    #[inline(always)]
    fn cross(&mut self, ray: &mut Occlusion, line: &GridLine, crossing: Crossing) -> f32 {
        ray.is_occluded = ray.is_occluded || self.feed.is_hit(ray.index, line, &crossing);
        if ray.is_occluded { f32::NEG_INFINITY } else { f32::INFINITY }
    }

    #[inline(always)]
    fn done(&mut self, ray: Occlusion, _: &GridLine) {
        (self.visit)(ray.index, ray.is_occluded);
    }
}
