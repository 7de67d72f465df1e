//! Queries for rays: the closest hit, and occlusion (any hit).

use sir_types::Line;

use crate::accel::Accel;
use crate::contact::key;
use crate::grid::{GridLine, RADIUS};
use crate::hit::Hit;
use crate::line_f32::{SLACK, Span};
use crate::ray::{Ray, TRange};
use crate::search::first_hit::Rays;
use crate::triangle::Crossing;

/// Number of rays by which prefetching runs ahead.
const AHEAD: usize = 16;

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
            let span = Span::new(start, grid.steps(ray.range.end) - line.start);
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
    /// Rays whose first hit the order of contacts decides, with the end of the part of the line to be searched for it.
    stacked: Vec<(usize, f64)>,
    visit: F,
}

/// Closest hit of a ray so far.
pub(crate) struct Closest {
    index: usize,
    /// Crossing with the smallest distance.
    best: Option<Crossing>,
    /// Distance beyond it within which neighbors in its stack may lie \[steps of the grid\].
    reach: f64,
    /// Number of crossings of triangles in stacks.
    stacked: u32,
}

impl<'a, F> ClosestHits<'a, F> {
    pub(crate) fn new(accel: &'a Accel, rays: &'a [Ray], visit: F) -> Self {
        Self { feed: Feed { accel, rays, next: 0 }, stacked: Vec::new(), visit }
    }

    /// Returns the rays that were not visited because the order of contacts decides which of several hits is the first
    /// one. With each comes the part of its line in which these hits lie.
    pub(crate) fn into_stacked(self) -> Vec<(usize, (Line, TRange))> {
        let Self { feed, stacked, .. } = self;
        let part = |(index, end): (usize, f64)| {
            let Ray { line, range, leaving } = feed.rays[index];
            // Where the order of contacts decides, the ray may begin before its origin.
            let start = if leaving.is_some() { f64::NEG_INFINITY } else { range.start };
            (index, (line, TRange { start, end }))
        };
        stacked.into_iter().map(part).collect()
    }
}

/// Returns the first of some hits that stops a ray. The hits are those of a part of its line, in order.
pub(crate) fn first_on_ray(accel: &Accel, ray: &Ray, hits: &[Hit]) -> Option<Hit> {
    let Ray { line, range, leaving } = ray;
    let (contacts, opacity) = (accel.contacts(), accel.opacity.as_ref());
    let own = leaving.and_then(|id| hits.iter().position(|hit| hit.triangle == id));
    // As `Feed::is_hit`, without computing the crossings again.
    let is_ahead = |place: usize, hit: &Hit| match (leaving, own) {
        (None, _) => range.start <= hit.t,
        (Some(id), _) if hit.triangle == *id || (range.start > 0.0 && hit.t < range.start) => false,
        (Some(id), Some(own)) if contacts.are_together(*id, hit.triangle) => own < place,
        (Some(_), Some(_)) => hit.t > 0.0,
        // The line starts on the edge of the triangle that it leaves, and does not cross it.
        (Some(id), None) => accel.grid.line(line).is_some_and(|grid_line| {
            let crossing = accel.tree.triangle(hit.triangle).and_then(|triangle| triangle.cross(&grid_line));
            crossing.is_some_and(|crossing| contacts.is_ahead(*id, &crossing, &grid_line))
        }),
    };
    let stops = |hit: &Hit| opacity.is_none_or(|test| test.stops(line, hit.triangle, hit.point));
    let mut numbered = hits.iter().enumerate();
    let first = numbered.find(|(place, hit)| is_ahead(*place, hit) && hit.t < range.end && stops(hit));
    first.map(|(_, hit)| *hit)
}

impl<F: FnMut(usize, Option<Hit>)> Rays for ClosestHits<'_, F> {
    type Ray = Closest;
    const FIRST_ENDS: bool = false;

    #[inline(always)]
    fn next(&mut self) -> Option<(Closest, GridLine, Span, u32)> {
        let (index, line, span, leaving) = self.feed.next(|index| (self.visit)(index, None))?;
        Some((Closest { index, best: None, reach: 0.0, stacked: 0 }, line, span, leaving))
    }

    #[inline(always)]
    fn cross(&mut self, ray: &mut Closest, line: &GridLine, crossing: Crossing) -> f32 {
        if self.feed.is_hit(ray.index, line, &crossing) {
            ray.stacked += u32::from(crossing.is_stacked());
            let order = |crossing: &Crossing| (crossing.t, key(crossing.side, crossing.id.0));
            if ray.best.is_none_or(|best| order(&crossing) < order(&best)) {
                ray.best = Some(crossing);
                ray.reach = self.feed.accel.contacts().reach(&crossing, line);
            }
        }
        ray.best.map_or(f32::INFINITY, |best| ((best.t + ray.reach + SLACK) / RADIUS) as f32)
    }

    #[inline(always)]
    fn done(&mut self, ray: Closest, line: &GridLine) {
        let Closest { index, best, reach, stacked } = ray;
        let grid = &self.feed.accel.grid;
        match best {
            Some(best) if best.is_stacked() && stacked > 1 => {
                let end = grid.length(best.t + line.start + reach + SLACK);
                self.stacked.push((index, end));
            }
            best => (self.visit)(index, best.map(|crossing| crossing.hit(grid, line))),
        }
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
