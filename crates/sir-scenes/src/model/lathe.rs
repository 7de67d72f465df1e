//! Solids of revolution about the `y` axis.

use std::f64::consts::TAU;

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;

impl Model {
    /// Adds a solid of revolution.
    ///
    /// `profile` lists (radius, height) from the bottom to the top. Flat discs join its first and last point to the
    /// axis unless they lie on it.
    pub(crate) fn lathe(&mut self, profile: &[[f64; 2]], segments: usize, material: MaterialId) {
        let mut closed = profile.to_vec();
        if let (Some(first), Some(last)) = (profile.first(), profile.last()) {
            if first[0] > 0.0 {
                closed.insert(0, [0.0, first[1]]);
            }
            if last[0] > 0.0 {
                closed.push([0.0, last[1]]);
            }
        }
        for pair in closed.windows(2) {
            self.turned_band(pair[0], pair[1], segments, material);
        }
    }

    /// Adds a ring of revolution.
    ///
    /// `profile` lists (radius, height) counterclockwise (up on the outside, down on the inside), with radii above
    /// zero. `material` receives the index of the point at which a band begins.
    pub(crate) fn turned_ring(
        &mut self,
        profile: &[[f64; 2]],
        segments: usize,
        material: impl Fn(usize) -> MaterialId,
    ) {
        for i in 0..profile.len() {
            self.turned_band(profile[i], profile[(i + 1) % profile.len()], segments, material(i));
        }
    }

    /// Adds the surface that the segment between two profile points sweeps.
    fn turned_band(&mut self, low: [f64; 2], high: [f64; 2], segments: usize, material: MaterialId) {
        let at = |[radius, y]: [f64; 2], i: usize| {
            let (sin, cos) = ((i % segments) as f64 / segments as f64 * TAU).sin_cos();
            DVec3::new(radius * cos, y, -radius * sin)
        };
        for i in 0..segments {
            let corners = [at(low, i), at(low, i + 1), at(high, i + 1), at(high, i)];
            if low[0] == 0.0 {
                self.polygon(&corners[1..], material);
            } else if high[0] == 0.0 {
                self.polygon(&corners[..3], material);
            } else {
                self.polygon(&corners, material);
            }
        }
    }
}
