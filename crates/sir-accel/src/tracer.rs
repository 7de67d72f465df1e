//! Tracing lines.

use std::ops::Range;

use sir_geom::{Line, Side, TriangleId};

use crate::Accel;
use crate::grid::{GridLine, RADIUS};
use crate::hit;
use crate::hit::Hit;
use crate::kits::Kits;
use crate::leaf::Span;
use crate::search::{AllScratch, ClosestScratch, LINES, Rays};
use crate::tree::Tree;
use crate::triangle::{Crossing, GridTriangle};
use crate::veil::Veil;

/// A ray, and the surface that it leaves.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The ray starts at the origin of the line.
    pub line: Line,
    /// A ray that leaves a surface names its triangle: that triangle is not met again, and among surfaces in contact with
    /// it only those are met that lie on top of the side which the ray leaves.
    pub leaving: Option<TriangleId>,
}

impl From<Line> for Ray {
    /// A ray that leaves no surface.
    fn from(line: Line) -> Self {
        Self { line, leaving: None }
    }
}

/// Traces lines through a scene. Holds scratch memory, so it belongs to one thread.
#[derive(Clone, Debug)]
pub struct Tracer<'a> {
    accel: &'a Accel,
    kits: Kits,
    closest: ClosestScratch,
    all: AllScratch,
}

impl<'a> Tracer<'a> {
    pub(crate) fn new(accel: &'a Accel, kits: Kits) -> Self {
        Self { accel, kits, closest: ClosestScratch::default(), all: AllScratch::default() }
    }

    /// Whether some surfaces let lines pass.
    #[must_use]
    pub fn lets_lines_pass(&self) -> bool {
        self.accel.veil.is_some()
    }

    /// The first triangle that a ray meets, and that does not let it pass.
    pub fn closest(&mut self, ray: &Ray) -> Option<Hit> {
        let mut first = None;
        self.closest_each(std::slice::from_ref(ray), |_, hit| first = hit);
        first
    }

    /// The first triangles that rays meet: `visit` gets the number of a ray and its hit, in any order.
    ///
    /// Many rays at once are several times faster than each by itself.
    pub fn closest_each(&mut self, rays: &[Ray], visit: impl FnMut(usize, Option<Hit>)) {
        let mut search = ClosestHits { accel: self.accel, rays, next: 0, close: Vec::new(), visit };
        self.kits.closest(&self.accel.tree, &mut self.closest, &mut search);
    }

    /// All triangles that the infinite line crosses, in order along it, those behind its origin included and those that let
    /// it pass left out.
    pub fn all_hits(&mut self, line: &Line) -> &[Hit] {
        self.all_hits_together(std::slice::from_ref(line));
        self.all.hits()
    }

    /// As [`all_hits`](Self::all_hits) for many lines, in order: `visit` gets the hits of some of them at a time.
    ///
    /// Many lines at once are several times faster than each by itself.
    pub fn all_hits_each(&mut self, lines: &[Line], mut visit: impl FnMut(&LineHits<'_>)) {
        for lines in lines.chunks(LINES) {
            self.all_hits_together(lines);
            visit(&LineHits { starts: &self.all.starts[..=lines.len()], hits: self.all.hits() });
        }
    }

    /// As [`all_hits_each`](Self::all_hits_each), but triangles that let lines pass are among the hits: their opacity there
    /// is for the caller to find ([`Scene::opacity_at`](sir_geom::Scene::opacity_at)).
    pub fn all_crossings_each(&mut self, lines: &[Line], mut visit: impl FnMut(&LineHits<'_>)) {
        for lines in lines.chunks(LINES) {
            self.all_crossings_together(lines);
            visit(&LineHits { starts: &self.all.starts[..=lines.len()], hits: self.all.hits() });
        }
    }

    fn all_hits_together(&mut self, lines: &[Line]) {
        self.all_crossings_together(lines);
        if let Some(veil) = &self.accel.veil {
            pass(veil, lines, &mut self.all);
        }
    }

    fn all_crossings_together(&mut self, lines: &[Line]) {
        let Self { accel: Accel { grid, tree, .. }, kits, all, .. } = self;
        kits.all(grid, tree, lines, all);
        for (line, _) in all.close.iter().enumerate().filter(|(_, close)| **close) {
            let hits = &mut all.hits[all.starts[line] as usize..all.starts[line + 1] as usize];
            sort_contacts(hits, grid.length(hit::CONTACT * RADIUS), tree);
        }
    }
}

/// All hits of some consecutive lines.
#[derive(Clone, Copy, Debug)]
pub struct LineHits<'a> {
    starts: &'a [u32],
    hits: &'a [Hit],
}

impl<'a> LineHits<'a> {
    /// The hits of all lines, line by line, in order along each.
    #[must_use]
    pub fn hits(&self) -> &'a [Hit] {
        self.hits
    }

    /// Where in [`hits`](Self::hits) those of each line are.
    pub fn lines(&self) -> impl ExactSizeIterator<Item = Range<usize>> + use<'a> {
        self.starts.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }
}

/// A search for closest hits.
struct ClosestHits<'a, F> {
    accel: &'a Accel,
    rays: &'a [Ray],
    next: usize,
    /// Crossings that lie close to another one, with the number of their ray.
    close: Vec<(usize, Crossing)>,
    visit: F,
}

/// A ray that is searched for.
struct Traced {
    index: usize,
    leaving: Option<TriangleId>,
    /// The crossing with the smallest distance.
    best: Option<Crossing>,
    /// Whether there were others close to it.
    close: bool,
}

/// How many rays ahead memory is asked for.
const AHEAD: usize = 16;

/// Nothing of the scene is farther from the origin of a line on the grid \[radii\].
const FAR: f32 = 4.0;

/// Distance within which the first hits are compared by their rule \[steps of the grid\].
const SLACK: f64 = 2.0 * hit::CONTACT * RADIUS;

impl<F: FnMut(usize, Option<Hit>)> Rays for ClosestHits<'_, F> {
    type Ray = Traced;

    #[inline(always)]
    fn next(&mut self) -> Option<(Traced, GridLine, Span, u32)> {
        loop {
            let index = self.next;
            let ray = self.rays.get(index)?;
            self.next += 1;
            let tree = &self.accel.tree;
            let Some(line) = self.accel.grid.line(&ray.line) else {
                (self.visit)(index, None);
                continue;
            };
            let from = if ray.leaving.is_some() { 0.0 } else { -line.start };
            let from = ((from - SLACK) / RADIUS) as f32;
            let span = Span { from: from.clamp(-FAR, FAR), to: FAR };
            let leaving = ray.leaving.map_or(u32::MAX, |id| tree.place(id));
            // The next rays leave triangles that may not be in the caches.
            if let Some(id) = self.rays.get(index + AHEAD).and_then(|ray| ray.leaving) {
                tree.prefetch_place(id);
            }
            break Some((
                Traced { index, leaving: ray.leaving, best: None, close: false },
                line,
                span,
                leaving,
            ));
        }
    }

    #[inline(always)]
    fn cross(&mut self, ray: &mut Traced, line: &GridLine, crossing: Crossing) -> f32 {
        let tree = &self.accel.tree;
        let begins = match ray.leaving {
            Some(id) => is_ahead(id, &crossing, line, tree),
            None => crossing.t + line.start >= 0.0,
        };
        let stops = |veil: &Veil| veil.stops_at(&self.rays[ray.index].line, &crossing);
        if begins && self.accel.veil.as_ref().is_none_or(stops) {
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
    fn done(&mut self, ray: Traced, line: &GridLine) {
        let hit = match ray.best {
            Some(best) if ray.close => Some(self.first_of_close(ray.index, best, line)),
            best => best.map(|crossing| crossing.hit(&self.accel.grid, line)),
        };
        (self.visit)(ray.index, hit);
    }
}

impl<F> ClosestHits<'_, F> {
    /// Notes that two crossings are so close that a rule may put them in order: what is within the slack of the first one, in
    /// whatever order it is found.
    #[cold]
    fn note_close(&mut self, ray: &mut Traced, one: Crossing, other: Crossing) {
        ray.close = true;
        self.close.extend([(ray.index, one), (ray.index, other)]);
    }

    /// The first, by their rule, of hits that are close together.
    #[cold]
    fn first_of_close(&mut self, index: usize, best: Crossing, line: &GridLine) -> Hit {
        let Accel { grid, tree, .. } = self.accel;
        let mut hits = vec![best.hit(grid, line)];
        self.close.retain(|(of_ray, crossing)| {
            if *of_ray == index && crossing.t <= best.t + SLACK {
                hits.push(crossing.hit(grid, line));
            }
            *of_ray != index
        });
        hits.sort_unstable_by_key(|hit| hit.triangle);
        hits.dedup_by_key(|hit| hit.triangle);
        sort_contacts(&mut hits, grid.length(hit::CONTACT * RADIUS), tree);
        hits[0]
    }
}

/// Whether a crossing lies ahead of the surface that a ray leaves.
#[inline]
fn is_ahead(leaving: TriangleId, other: &Crossing, line: &GridLine, tree: &Tree) -> bool {
    if other.t.abs() > hit::CONTACT * RADIUS { other.t > 0.0 } else { is_on_top(leaving, other, line, tree) }
}

/// Whether a crossing close to the surface that a ray leaves lies ahead of it.
#[cold]
fn is_on_top(leaving: TriangleId, other: &Crossing, line: &GridLine, tree: &Tree) -> bool {
    let triangle = tree.triangle(leaving);
    if !parallel(triangle, tree.triangle(other.id)) {
        return other.t > 0.0;
    }
    // The side that the ray does not leave: it would face the origin if the line were followed from behind.
    let along = triangle.scaled_normal().dot(line.direction) > 0.0;
    let side = if along { Side::Back } else { Side::Front };
    // A line that does not cross the start itself left it on an edge, and this is its neighbour there.
    triangle.cross(line).is_some()
        && hit::contact_rank(leaving, side) < hit::contact_rank(other.id, other.side)
}

/// Puts hits in contact, of those of a line in order of distance, in the order of their rule.
#[cold]
fn sort_contacts(hits: &mut [Hit], contact: f64, tree: &Tree) {
    let rank = |hit: &Hit| hit::contact_rank(hit.triangle, hit.side);
    // Copies of a triangle are met at the same distance: many of them must not take the square of their number below.
    hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(rank(a).cmp(&rank(b))));
    for i in 1..hits.len() {
        for j in (1..=i).rev() {
            let (first, second) = (hits[j - 1], hits[j]);
            let apart = (first.t - second.t).abs() > contact
                || !parallel(tree.triangle(first.triangle), tree.triangle(second.triangle));
            if apart || rank(&first) < rank(&second) {
                break;
            }
            hits.swap(j - 1, j);
        }
    }
}

/// Leaves out the hits that let their lines pass.
#[cold]
fn pass(veil: &Veil, lines: &[Line], all: &mut AllScratch) {
    let AllScratch { starts, hits, .. } = all;
    let (mut from, mut kept) = (0, 0);
    for (line, start) in lines.iter().zip(1..) {
        let to = starts[start] as usize;
        for i in from..to {
            let hit = hits[i];
            hits[kept] = hit;
            kept += usize::from(veil.stops(line, &hit));
        }
        from = to;
        starts[start] = kept as u32;
    }
    starts[lines.len()..=LINES].fill(kept as u32);
}

/// Whether two triangles are parallel: the squared sine of their angle is small.
fn parallel(a: &GridTriangle, b: &GridTriangle) -> bool {
    let (a, b) = (a.scaled_normal(), b.scaled_normal());
    a.cross(b).length_squared() <= hit::PARALLEL * a.length_squared() * b.length_squared()
}
