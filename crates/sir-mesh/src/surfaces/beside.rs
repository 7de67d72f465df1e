//! Flat surfaces and their neighbors.

use std::collections::BTreeSet;

use sir_geom::{BoundingBox, Scene};

use crate::surfaces::adjacency::Adjacency;
use crate::surfaces::flat::{FlatSurface, flat_surfaces};

/// Flat surfaces of a scene, with those beside each.
pub(crate) struct Surfaces {
    pub(crate) adjacency: Adjacency,
    /// In the order of their first triangles.
    pub(crate) flat: Vec<FlatSurface>,
    /// Offset of the neighbors of each surface, and their number at the end.
    starts: Vec<u32>,
    /// Surfaces that a surface continues in, across an edge and bent.
    neighbors: Vec<u32>,
}

impl Surfaces {
    /// Finds the surfaces of a scene. Those whose centroid is not in the box, if one is given, are not to be cut.
    pub(crate) fn new(scene: &Scene, bounds: Option<BoundingBox>) -> Self {
        let adjacency = Adjacency::new(scene);
        let (flat, of_triangle) = flat_surfaces(scene, &adjacency, bounds);
        let (mut starts, mut neighbors) = (Vec::with_capacity(flat.len() + 1), Vec::new());
        for (number, surface) in (0..).zip(&flat) {
            starts.push(neighbors.len() as u32);
            let beyond = surface.triangles.iter().flat_map(|&t| adjacency.of(t));
            let others = beyond.map(|(_, t)| of_triangle[t.index()]).filter(|&other| other != number);
            neighbors.extend(others.collect::<BTreeSet<u32>>());
        }
        starts.push(neighbors.len() as u32);
        Self { adjacency, flat, starts, neighbors }
    }

    /// Returns the surfaces beside a surface.
    pub(crate) fn beside(&self, surface: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|i| self.starts[surface as usize + i] as usize);
        &self.neighbors[start..end]
    }
}
