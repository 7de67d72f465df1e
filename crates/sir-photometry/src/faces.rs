//! Faces of a luminous opening.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3Swizzles as _};

use crate::opening::{Along, Opening, Outline};

/// A flat face of a luminous opening, in the frame of the luminaire.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningFace {
    /// Corners \[m\], counterclockwise seen from outside.
    pub corners: Vec<DVec3>,
    /// Unit normal, outward.
    pub normal: DVec3,
    /// Area \[m²\].
    pub area: f64,
}

/// Number of corners of an ellipse.
const CORNERS: u32 = 16;

/// Numbers of faces of an ellipsoid around its axis, and from pole to pole.
const FACETS: [u32; 2] = [12, 6];

impl OpeningFace {
    fn new(corners: Vec<DVec3>) -> Self {
        let fan = corners.windows(2).skip(1).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]));
        let doubled: DVec3 = fan.sum();
        Self { normal: doubled.normalize_or_zero(), area: 0.5 * doubled.length(), corners }
    }
}

impl Opening {
    /// Returns the faces of the opening, none for a point. A flat opening has two, down and up. What is round has flat faces,
    /// with the areas of an ellipse or the surface of a sphere.
    #[must_use]
    pub fn faces(&self) -> Vec<OpeningFace> {
        match *self {
            Self::Point => Vec::new(),
            Self::Flat { outline, length, width } => prism(&outline.corners([length, width]), 0.0),
            Self::Solid { outline, length, width, height } => {
                prism(&outline.corners([length, width]), height)
            }
            Self::Ellipsoid { length, width, height } => ellipsoid(DVec3::new(length, width, height)),
            Self::Tube { along, length, width, height } => {
                let outline = Outline::Ellipse;
                match along {
                    Along::Length => turned(prism(&outline.corners([width, height]), length), DVec3::zxy),
                    Along::Width => turned(prism(&outline.corners([height, length]), width), DVec3::yzx),
                }
            }
        }
    }
}

/// Returns the faces of a prism along z: its bottom, its top, and its sides if it has a height.
fn prism(outline: &[DVec3], height: f64) -> Vec<OpeningFace> {
    let at = |z: f64| move |corner: &DVec3| DVec3 { z, ..*corner };
    let (low, high) = (-0.5 * height, 0.5 * height);
    let bottom = outline.iter().rev().map(at(low)).collect();
    let top = outline.iter().map(at(high)).collect();
    let mut faces = vec![OpeningFace::new(bottom), OpeningFace::new(top)];
    if height > 0.0 {
        let next = outline.iter().cycle().skip(1);
        faces.extend(
            outline
                .iter()
                .zip(next)
                .map(|(a, b)| OpeningFace::new(vec![at(low)(a), at(low)(b), at(high)(b), at(high)(a)])),
        );
    }
    faces
}

/// Returns faces whose corners have other coordinates: an even permutation of their own.
fn turned(faces: Vec<OpeningFace>, to: impl Fn(DVec3) -> DVec3) -> Vec<OpeningFace> {
    faces.into_iter().map(|face| OpeningFace::new(face.corners.into_iter().map(&to).collect())).collect()
}

/// Returns the faces of an ellipsoid: those of a polyhedron with the surface of a sphere, stretched to these extents.
fn ellipsoid(extents: DVec3) -> Vec<OpeningFace> {
    let [around, along] = FACETS;
    let at = |i: u32, k: u32| {
        let (sin, cos) = libm::sincos(f64::from(i % around) * TAU / f64::from(around));
        let (ring, z) = libm::sincos(f64::from(k) * PI / f64::from(along));
        DVec3::new(ring * cos, ring * sin, -z)
    };
    let cells = (0..along).flat_map(|k| (0..around).map(move |i| (i, k)));
    let corners: Vec<Vec<DVec3>> = cells
        .map(|(i, k)| match k {
            0 => vec![at(0, 0), at(i + 1, 1), at(i, 1)],
            _ if k + 1 == along => vec![at(i, k), at(i + 1, k), at(0, along)],
            _ => vec![at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)],
        })
        .collect();
    let surface: f64 = corners.iter().map(|corners| OpeningFace::new(corners.clone()).area).sum();
    let scale = 0.5 * (4.0 * PI / surface).sqrt() * extents;
    corners.into_iter().map(|face| OpeningFace::new(face.into_iter().map(|c| c * scale).collect())).collect()
}

impl Outline {
    /// Returns the corners around the center, counterclockwise seen from above, for extents along x and y.
    fn corners(self, [length, width]: [f64; 2]) -> Vec<DVec3> {
        match self {
            Self::Rectangle => [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
                .map(|(x, y)| DVec3::new(x * length, y * width, 0.0))
                .to_vec(),
            Self::Ellipse => {
                let step = TAU / f64::from(CORNERS);
                // The area of a polygon with corners on the unit circle is n/2 sin(2π/n).
                let radius = (step / libm::sin(step)).sqrt();
                let corner = |i: u32| {
                    let (sin, cos) = libm::sincos((f64::from(i) + 0.5) * step);
                    DVec3::new(0.5 * length * radius * cos, 0.5 * width * radius * sin, 0.0)
                };
                (0..CORNERS).map(corner).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that faces are closed and face outward, and returns their volume.
    fn volume(faces: &[OpeningFace]) -> f64 {
        let sum: DVec3 = faces.iter().map(|face| face.area * face.normal).sum();
        assert!(sum.length() < 1e-12, "{sum}");
        assert!(faces.iter().all(|face| face.normal.dot(face.corners[0]) > 0.0));
        faces.iter().map(|face| face.area * face.normal.dot(face.corners[0]) / 3.0).sum()
    }

    #[test]
    fn faces_are_closed_and_face_outward() {
        let (length, width, height) = (1.2, 0.3, 0.1);
        for outline in [Outline::Rectangle, Outline::Ellipse] {
            let area = if outline == Outline::Rectangle { length * width } else { PI / 4.0 * length * width };
            let flat = Opening::Flat { outline, length, width }.faces();
            let turned = |(face, normal): (&OpeningFace, DVec3)| face.normal.distance(normal);
            assert!(flat.iter().zip([-DVec3::Z, DVec3::Z]).map(turned).all(|distance| distance < 1e-12));
            assert!(flat.iter().all(|face| (face.area / area - 1.0).abs() < 1e-12));
            let solid = Opening::Solid { outline, length, width, height }.faces();
            assert!((volume(&solid) / (area * height) - 1.0).abs() < 1e-12);
        }
        for (along, axis) in [(Along::Length, length), (Along::Width, width)] {
            let tube = Opening::Tube { along, length, width, height }.faces();
            assert!((volume(&tube) / (PI / 4.0 * length * width * height) - 1.0).abs() < 1e-12);
            let end = tube[1].corners[0];
            let reached = if along == Along::Length { end.x } else { end.y };
            assert!((reached - 0.5 * axis).abs() < 1e-12, "{end}");
        }
        let ball = Opening::Ellipsoid { length, width: length, height: length }.faces();
        let surface: f64 = ball.iter().map(|face| face.area).sum();
        assert!((surface / (PI * length * length) - 1.0).abs() < 1e-12);
        assert!((volume(&ball) / (PI / 6.0 * length.powi(3)) - 1.0).abs() < 0.1);
        assert_eq!(Opening::Point.faces(), []);
    }
}
