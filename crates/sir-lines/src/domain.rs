//! Convex bodies from which global lines are drawn.

use std::sync::Arc;

use glam::DVec3;
use sir_geom::{BoundingBox, BoundingSphere, ConvexHull, Line, Scene};

use crate::facets::Facets;
use crate::forecast::Forecast;
use crate::local::{cosine_direction, unit_vector};
use crate::stream::Stream;

/// A convex body around the scene, and the uniform (isotropic) lines through it.
///
/// A uniform line enters at a point that is uniform by area on the surface, in a direction with the density `cos θ/π` about
/// the normal that points inside (Santaló 1976, *Integral Geometry and Geometric Probability*, ch. 12). In whatever body the
/// lines are drawn, those that meet the scene are distributed alike; but in a body of surface `S` only the share
/// `S_hull/S` of the lines passes through the convex hull of the scene, and the others are wasted.
///
/// Cloning is cheap.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// A sphere. A line through two independent uniform points of a sphere is a uniform line
    /// (Santaló 1976; used for radiosity by Sbert 1993).
    Sphere(BoundingSphere),
    /// An axis-aligned box. It may be flat, but not along two axes.
    Box(BoundingBox),
    /// A body of flat facets: the convex hull, the smallest body there is.
    Hull(Arc<Facets>),
}

impl Domain {
    /// The convex hull of the triangles of a scene.
    ///
    /// Corners of the hull are vertices, and all triangles are in it, but for 10⁻¹² of its extent: the bias of the forecast
    /// is not larger than that. Where all vertices lie on a line to that precision, it is their box.
    #[must_use]
    pub fn hull(scene: &Scene) -> Self {
        let facets = ConvexHull::of(scene.vertices()).and_then(|hull| Facets::new(&hull));
        facets.map_or(Self::Box(scene.bounding_box()), |facets| Self::Hull(facets.into()))
    }

    /// A random line; its origin is on the surface of the body and its direction points inside.
    #[inline]
    pub fn sample(&self, stream: &mut Stream) -> Line {
        match self {
            Self::Sphere(sphere) => loop {
                let (a, b) = (unit_vector(stream), unit_vector(stream));
                if let Some(direction) = (b - a).try_normalize() {
                    break Line { origin: sphere.centre + sphere.radius * a, direction };
                }
            },
            Self::Box(bounds) => sample_box(bounds, stream),
            Self::Hull(facets) => facets.sample(stream),
        }
    }

    /// What the body is called.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere(_) => "Sphere",
            Self::Box(_) => "Box",
            Self::Hull(_) => "Hull",
        }
    }

    /// Surface of the body, in the square of the scene's unit of length. Of a flat body, both sides.
    #[must_use]
    pub fn surface(&self) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.surface_area(),
            Self::Box(bounds) => 2.0 * bounds.face_areas().element_sum(),
            Self::Hull(facets) => facets.surface(),
        }
    }

    /// What to expect of this number of lines.
    #[must_use]
    pub fn forecast(&self, lines: u64) -> Forecast {
        Forecast { lines, surface: self.surface() }
    }
}

/// To which of three areas, one after the other, a place belongs.
pub(crate) fn axis_of(place: f64, areas: DVec3) -> usize {
    if place < areas.x {
        0
    } else if place < areas.x + areas.y {
        1
    } else {
        2
    }
}

fn sample_box(bounds: &BoundingBox, stream: &mut Stream) -> Line {
    let areas = bounds.face_areas();
    let half = areas.element_sum();
    // The first half of the surface are the faces at the smallest coordinates.
    let mut place = 2.0 * half * stream.unit();
    let at_max = place >= half;
    if at_max {
        place -= half;
    }
    let axis = axis_of(place, areas);
    let mut share = DVec3::new(stream.unit(), stream.unit(), stream.unit());
    share[axis] = if at_max { 1.0 } else { 0.0 };
    let mut inward = DVec3::ZERO;
    inward[axis] = if at_max { -1.0 } else { 1.0 };
    Line { origin: bounds.min + share * bounds.size(), direction: cosine_direction(inward, stream) }
}
