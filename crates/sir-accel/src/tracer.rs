//! The tracer: searches for the hits of lines and rays.

use std::mem::take;

use sir_types::Line;

use crate::accel::Accel;
use crate::hit::{Hit, LineHits};
use crate::queries::{ClosestHits, Occlusions, first_on_ray};
use crate::ray::{Ray, TRange};
use crate::scratch::Scratch;
use crate::search::all_hits::{AllHits, AllHitsScratch, Part};
use crate::search::first_hit::{FirstHitScratch, FirstHits};
use crate::search::queue::MAX_LINES;
use crate::simd::dispatch::Backend;

impl Accel {
    /// Returns a tracer. Each thread needs its own. Making one is cheap: it takes over the memory of one that is dropped.
    #[must_use]
    pub fn tracer(&self) -> Tracer<'_> {
        Tracer::new(self, Backend::best())
    }
}

/// Tracer of lines and rays. It holds scratch memory, so it belongs to one thread.
///
/// The hits of a line depend only on the line and the triangles, not on other lines that are traced with it, nor on the
/// processor. A line with a coordinate that is not finite hits nothing. Directions must have unit length.
#[derive(Clone, Debug)]
pub struct Tracer<'a> {
    accel: &'a Accel,
    backend: Backend,
    first_hit: FirstHitScratch,
    all_hits: AllHitsScratch,
}

impl Drop for Tracer<'_> {
    fn drop(&mut self) {
        let (first_hit, all_hits) = (take(&mut self.first_hit), take(&mut self.all_hits));
        self.accel.scratch.put(Scratch { first_hit, all_hits });
    }
}

impl<'a> Tracer<'a> {
    pub(crate) fn new(accel: &'a Accel, backend: Backend) -> Self {
        let Scratch { first_hit, all_hits } = accel.scratch.take();
        Self { accel, backend, first_hit, all_hits }
    }

    /// Returns the acceleration structure.
    #[must_use]
    pub fn accel(&self) -> &'a Accel {
        self.accel
    }

    /// Returns the first hit of a ray. Transparent triangles that let it pass are skipped.
    pub fn closest(&mut self, ray: &Ray) -> Option<Hit> {
        let mut first = None;
        self.closest_each(std::slice::from_ref(ray), |_, hit| first = hit);
        first
    }

    /// Finds the first hits of rays. Calls `visit` with the index of each ray and its hit, in any order.
    ///
    /// Tracing many rays at once is several times faster than tracing them one by one.
    pub fn closest_each(&mut self, rays: &[Ray], mut visit: impl FnMut(usize, Option<Hit>)) {
        let mut query = ClosestHits::new(self.accel, rays, &mut visit);
        let (tree, scratch) = (&self.accel.tree, &mut self.first_hit);
        self.backend.run(FirstHits { tree, scratch, rays: &mut query });
        let (accel, stacked) = (self.accel, query.into_stacked());
        let parts: Vec<_> = stacked.iter().map(|(_, part)| *part).collect();
        let mut rays = stacked.iter().map(|&(index, _)| (index, &rays[index]));
        self.each(&parts, Self::find_crossings, |found| {
            for (range, (index, ray)) in found.lines().zip(&mut rays) {
                visit(index, first_on_ray(accel, ray, &found.hits()[range]));
            }
        });
    }

    /// Returns true exactly if [`closest`](Self::closest) finds a hit. This is faster, because any hit ends the search.
    pub fn occluded(&mut self, ray: &Ray) -> bool {
        let mut is_occluded = false;
        self.occluded_each(std::slice::from_ref(ray), |_, is| is_occluded = is);
        is_occluded
    }

    /// Determines which rays have a hit. Calls `visit` with the index of each ray and true if it has one, in any order.
    ///
    /// Tracing many rays at once is several times faster than tracing them one by one.
    pub fn occluded_each(&mut self, rays: &[Ray], visit: impl FnMut(usize, bool)) {
        let mut rays = Occlusions::new(self.accel, rays, visit);
        let (tree, scratch) = (&self.accel.tree, &mut self.first_hit);
        self.backend.run(FirstHits { tree, scratch, rays: &mut rays });
    }

    /// Returns all hits of an infinite line, in order along it, including those behind its origin. Transparent
    /// triangles that let it pass are skipped.
    pub fn all_hits(&mut self, line: &Line) -> &[Hit] {
        self.find_hits(std::slice::from_ref(line));
        self.all_hits.hits()
    }

    /// Finds all hits of infinite lines, as [`all_hits`](Self::all_hits) does. Calls `visit` with the hits of some
    /// consecutive lines at a time, in order.
    ///
    /// Tracing many lines at once is several times faster than tracing them one by one.
    pub fn all_hits_each(&mut self, lines: &[Line], visit: impl FnMut(&LineHits<'_>)) {
        self.each(lines, Self::find_hits, visit);
    }

    /// Returns the hits of [`all_hits`](Self::all_hits) whose distance lies in a range.
    pub fn all_hits_within(&mut self, line: &Line, range: impl Into<TRange>) -> &[Hit] {
        self.find_hits(&[(*line, range.into())]);
        self.all_hits.hits()
    }

    /// Finds all hits of parts of lines, as [`all_hits_each`](Self::all_hits_each) does for whole lines.
    pub fn all_hits_within_each(&mut self, parts: &[(Line, TRange)], visit: impl FnMut(&LineHits<'_>)) {
        self.each(parts, Self::find_hits, visit);
    }

    /// Finds all crossings of infinite lines, as [`all_hits_each`](Self::all_hits_each) does, but includes the
    /// transparent triangles that let a line pass. The caller applies the opacity of each hit.
    pub fn all_crossings_each(&mut self, lines: &[Line], visit: impl FnMut(&LineHits<'_>)) {
        self.each(lines, Self::find_crossings, visit);
    }

    fn each<P>(&mut self, lines: &[P], find: impl Fn(&mut Self, &[P]), mut visit: impl FnMut(&LineHits<'_>)) {
        for lines in lines.chunks(MAX_LINES) {
            find(self, lines);
            let AllHitsScratch { starts, .. } = &self.all_hits;
            visit(&LineHits::new(&starts[..=lines.len()], self.all_hits.hits()));
        }
    }

    /// Finds the crossings that stop their lines, for at most [`MAX_LINES`] lines.
    fn find_hits<P: Part>(&mut self, lines: &[P]) {
        self.find_crossings(lines);
        if let Some(test) = &self.accel.opacity {
            self.all_hits
                .retain(lines.len(), |line, hit| test.stops(lines[line].line(), hit.triangle, hit.point));
        }
    }

    /// Finds the crossings of at most [`MAX_LINES`] lines.
    fn find_crossings<P: Part>(&mut self, lines: &[P]) {
        let Self { accel: Accel { grid, tree, .. }, backend, all_hits, .. } = self;
        backend.run(AllHits { grid, tree, lines, scratch: all_hits });
        for number in 0..lines.len() {
            if all_hits.stacked[number] > 1 || all_hits.unsorted[number] {
                let range = all_hits.starts[number] as usize..all_hits.starts[number + 1] as usize;
                self.accel.contacts().sort(&mut all_hits.hits[range]);
            }
        }
        if P::HAS_ENDS {
            all_hits.retain(lines.len(), |line, hit| lines[line].range().contains(hit.t));
        }
    }
}
