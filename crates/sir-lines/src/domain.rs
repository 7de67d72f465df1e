//! Domains: convex bodies through which global lines are drawn.

use std::sync::Arc;

use glam::DVec3;
use sir_types::{BoundingBox, BoundingSphere, Line};

use crate::facets::Facets;
use crate::forecast::Forecast;
use crate::hull::ConvexHull;
use crate::local::{cosine_direction, unit_vector};

/// Convex body around the scene, with the uniform (isotropic) lines through it.
///
/// A uniform line enters at a point that is uniform by area on the surface, in a direction with the density `cos θ/π`
/// about the inward normal (Santaló 1976, *Integral Geometry and Geometric Probability*, ch. 12). The distribution of
/// the lines that meet the scene does not depend on the domain. But in a domain of surface `S`, only the share
/// `S_hull/S` of the lines passes through the convex hull of the scene; the others are wasted.
///
/// Cloning is cheap.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// Sphere. A line through two independent uniform points of a sphere is a uniform line
    /// (Santaló 1976; used for radiosity by Sbert 1993).
    Sphere(BoundingSphere),
    /// Axis-aligned box. It may be flat along one axis, but not along two.
    Box(BoundingBox),
    /// Convex hull: the smallest possible domain.
    Hull(Arc<Facets>),
}

impl Domain {
    /// Returns the convex hull of finite points, such as the vertices of a scene.
    ///
    /// The corners of the hull are some of the points. All points lie in it, up to 10⁻¹² of its extent; the bias of the
    /// forecast is not larger than that. If all points lie on a line to that precision, the domain is their bounding
    /// box. Without points, it is an empty box at the origin.
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

    /// Maps a point of the unit cube to a line: a uniform point gives a uniform line. The origin of the line is on the
    /// surface of the domain, and its direction points inside.
    ///
    /// A sphere uses only the first four coordinates. If the two points on the sphere coincide, the line passes through
    /// the center; for random points, that has a probability below 10⁻³⁰.
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

    /// Returns a number that distinguishes the domains of one scene: the bits of the surface.
    #[must_use]
    pub fn identity(&self) -> u64 {
        self.surface().to_bits()
    }

    /// Returns the name of the kind of domain.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere(_) => "Sphere",
            Self::Box(_) => "Box",
            Self::Hull(_) => "Hull",
        }
    }

    /// Returns the surface of the domain, in the square of the scene's unit of length. A flat domain has two sides.
    #[must_use]
    pub fn surface(&self) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.surface_area(),
            Self::Box(bounds) => 2.0 * bounds.face_areas().element_sum(),
            Self::Hull(facets) => facets.surface(),
        }
    }

    /// Returns the forecast for this number of lines.
    #[must_use]
    pub fn forecast(&self, lines: u64) -> Forecast {
        Forecast { lines, surface: self.surface() }
    }
}

/// Returns the index of the area that contains `place` when the three areas are laid out one after the other.
pub(crate) fn axis_of(place: f64, areas: DVec3) -> usize {
    if place < areas.x {
        0
    } else if place < areas.x + areas.y {
        1
    } else {
        2
    }
}

/// Maps a point of the unit cube to a uniform line through a box. The coordinates choose the face (one), the position
/// on it (one per axis; the one perpendicular to the face is ignored) and the direction (two).
#[inline]
fn line_of_box(bounds: &BoundingBox, [u, x, y, z, p, q]: [f64; 6]) -> Line {
    let areas = bounds.face_areas();
    let half = areas.element_sum();
    // The first half of the surface consists of the faces at the minimum of each axis.
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
