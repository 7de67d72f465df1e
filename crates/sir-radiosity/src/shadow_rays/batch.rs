//! Rays of some points, which are traced together.

use sir_accel::{Ray, Tracer};
use sir_geom::{Rgb, Side, TriangleId};
use sir_mesh::SideId;

use crate::totals::Counts;

/// Rays of some points, with what they bring if they arrive.
#[derive(Default)]
pub(super) struct Batch {
    /// Rays that arrive if nothing is in the way.
    free: Vec<Ray>,
    /// Rays that arrive if they hit a side of a triangle.
    aimed: Vec<Ray>,
    targets: Vec<(TriangleId, Side)>,
    /// Number of the point, and irradiance \[W/m²\], of each ray.
    of_free: Vec<(usize, Rgb)>,
    of_aimed: Vec<(usize, Rgb)>,
    /// Sides of the points, and the number of points of each.
    pub(super) sides: Vec<(TriangleId, SideId, usize)>,
    /// Irradiance \[W/m²\] of each point. The rays that are added are those of the last point.
    pub(super) irradiances: Vec<Rgb>,
}

impl Batch {
    /// Returns the number of rays.
    pub(super) fn len(&self) -> usize {
        self.free.len() + self.aimed.len()
    }

    /// Adds a ray that brings an irradiance if nothing is in the way.
    pub(super) fn push(&mut self, ray: Ray, irradiance: Rgb) {
        self.free.push(ray);
        self.of_free.push((self.irradiances.len() - 1, irradiance));
    }

    /// Adds a ray that brings an irradiance if it hits a side of a triangle.
    pub(super) fn push_aimed(&mut self, ray: Ray, target: (TriangleId, Side), irradiance: Rgb) {
        self.aimed.push(ray);
        self.targets.push(target);
        self.of_aimed.push((self.irradiances.len() - 1, irradiance));
    }

    /// Traces all rays, and adds what they bring to the irradiances.
    pub(super) fn trace(&mut self, tracer: &mut Tracer<'_>, counts: &mut Counts) {
        counts.lines += self.len() as u64;
        let Self { free, aimed, targets, of_free, of_aimed, irradiances, .. } = self;
        let mut add = |(number, irradiance): (usize, Rgb), arrives: bool| {
            if arrives { irradiances[number] += irradiance } else { counts.empty += 1 }
        };
        // Rays are traced in any order, but floats have to be added in a fixed order.
        let mut arrives = vec![false; free.len()];
        tracer.occluded_each(free, |i, is_occluded| arrives[i] = !is_occluded);
        of_free.iter().zip(arrives).for_each(|(&ray, arrives)| add(ray, arrives));
        let mut arrives = vec![false; aimed.len()];
        tracer.closest_each(aimed, |i, hit| {
            arrives[i] = hit.is_some_and(|hit| (hit.triangle, hit.side) == targets[i]);
        });
        of_aimed.iter().zip(arrives).for_each(|(&ray, arrives)| add(ray, arrives));
    }
}
