//! Convex bodies from which global lines are drawn.

use std::sync::Arc;

use glam::DVec3;
use sir_types::{BoundingBox, BoundingSphere, Line};

use crate::facets::Facets;
use crate::forecast::Forecast;
use crate::hull::ConvexHull;
use crate::local::{cosine_direction, unit_vector};

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
    /// Returns the convex hull of finite points, such as the vertices of a scene.
    ///
    /// Corners of the hull are some of the points, and all points are in it, up to 10⁻¹² of its extent: the bias of the
    /// forecast is not larger than that. Where all points lie on a line to that precision, the domain is their box; without
    /// points, it is an empty box at the origin.
    #[must_use]
    pub fn hull(points: &[DVec3]) -> Self {
        match ConvexHull::of(points).and_then(|hull| Facets::new(&hull)) {
            Some(facets) => Self::Hull(facets.into()),
            None => {
                let empty = BoundingBox { min: DVec3::ZERO, max: DVec3::ZERO };
                Self::Box(BoundingBox::of(points.iter().copied()).unwrap_or(empty))
            }
        }
    }

    /// Returns the line of a point of the unit cube: a uniform line if the point is uniform. Its origin is on the surface of
    /// the body and its direction points inside.
    ///
    /// A sphere takes the first four coordinates only. Each point has a line: where two points of a sphere fall together,
    /// the line passes through its center; with random points, that has a probability below 10⁻³⁰.
    #[inline]
    #[must_use]
    pub fn line(&self, point: [f64; 6]) -> Line {
        match self {
            Self::Sphere(sphere) => {
                let [s, t, u, v, ..] = point;
                let (a, b) = (unit_vector([s, t]), unit_vector([u, v]));
                Line {
                    origin: sphere.center + sphere.radius * a,
                    direction: (b - a).try_normalize().unwrap_or(-a),
                }
            }
            Self::Box(bounds) => line_of_box(bounds, point),
            Self::Hull(facets) => facets.line(point),
        }
    }

    /// Returns a number that tells the domains of one scene apart: their surface, to the last bit.
    #[must_use]
    pub fn identity(&self) -> u64 {
        self.surface().to_bits()
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

/// A line that enters through the faces of a box. The coordinates choose the face (one), the place (one for each axis, of
/// which that across the face is ignored) and the direction (two).
#[inline]
fn line_of_box(bounds: &BoundingBox, [u, x, y, z, p, q]: [f64; 6]) -> Line {
    let areas = bounds.face_areas();
    let half = areas.element_sum();
    // The first half of the surface are the faces at the smallest coordinates.
    let mut place = 2.0 * half * u;
    let at_max = place >= half;
    if at_max {
        place -= half;
    }
    let axis = axis_of(place, areas);
    let mut share = DVec3::new(x, y, z);
    share[axis] = if at_max { 1.0 } else { 0.0 };
    let mut inward = DVec3::ZERO;
    inward[axis] = if at_max { -1.0 } else { 1.0 };
    Line { origin: bounds.min + share * bounds.size(), direction: cosine_direction(inward, [p, q]) }
}
