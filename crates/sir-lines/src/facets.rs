//! Uniform lines that enter a convex body through its flat facets.

use glam::DVec3;
use sir_types::Line;

use crate::alias::AliasTable;
use crate::hull::ConvexHull;
use crate::local::{cosine_direction, point_on_triangle};

/// Surface of a convex polyhedron, prepared for sampling lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    facets: Vec<Facet>,
    by_area: AliasTable,
    surface: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Facet {
    corners: [DVec3; 3],
    inward: DVec3,
}

impl Facets {
    /// Returns the facets of a hull, or `None` if the hull has no area.
    #[must_use]
    pub fn new(hull: &ConvexHull) -> Option<Self> {
        let (mut facets, mut areas) = (Vec::new(), Vec::new());
        for &[a, b, c] in hull.facets() {
            let inward = (c - a).cross(b - a);
            // Some facets are too narrow to have a normal. They are skipped: no line enters through them.
            if let Some(normal) = inward.try_normalize() {
                facets.push(Facet { corners: [a, b, c], inward: normal });
                areas.push(0.5 * inward.length());
            }
        }
        if facets.is_empty() {
            return None;
        }
        Some(Self { facets, by_area: AliasTable::new(&areas), surface: areas.iter().sum() })
    }

    /// Returns the total area of the facets.
    #[must_use]
    pub fn surface(&self) -> f64 {
        self.surface
    }

    /// Maps a point of the unit cube to a line: its origin is uniform on the surface, its direction cosine-weighted
    /// about the inward normal. The coordinates choose the facet (two), the position on it (two) and the direction
    /// (two).
    #[inline]
    #[must_use]
    pub fn line(&self, [u, v, s, t, p, q]: [f64; 6]) -> Line {
        let facet = &self.facets[self.by_area.sample([u, v])];
        let origin = point_on_triangle([s, t]).point(facet.corners);
        Line { origin, direction: cosine_direction(facet.inward, [p, q]) }
    }
}
