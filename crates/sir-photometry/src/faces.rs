//! Faces of a luminous opening.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::opening::{Opening, Outline};

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
const CORNERS: u32 = 32;

impl OpeningFace {
    fn new(corners: Vec<DVec3>) -> Self {
        let fan = corners.windows(2).skip(1).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]));
        let doubled: DVec3 = fan.sum();
        Self { normal: doubled.normalize_or_zero(), area: 0.5 * doubled.length(), corners }
    }
}

impl Opening {
    /// Returns the faces of the opening, none for a point. A flat opening has two, down and up. An ellipse is a polygon of the
    /// same area.
    #[must_use]
    pub fn faces(&self) -> Vec<OpeningFace> {
        let (outline, height) = match *self {
            Self::Point => return Vec::new(),
            Self::Flat { outline, length, width } => (outline.corners(length, width), 0.0),
            Self::Solid { outline, length, width, height } => (outline.corners(length, width), height),
        };
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
}

impl Outline {
    /// Returns the corners around the center, counterclockwise seen from above.
    fn corners(self, length: f64, width: f64) -> Vec<DVec3> {
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
    use std::f64::consts::PI;

    #[test]
    fn faces_are_closed_and_face_outward() {
        let (length, width, height) = (1.2, 0.3, 0.1);
        for outline in [Outline::Rectangle, Outline::Ellipse] {
            let area = if outline == Outline::Rectangle { length * width } else { PI / 4.0 * length * width };
            let flat = Opening::Flat { outline, length, width }.faces();
            assert_eq!(flat.iter().map(|face| face.normal).collect::<Vec<_>>(), [-DVec3::Z, DVec3::Z]);
            assert!(flat.iter().all(|face| (face.area / area - 1.0).abs() < 1e-12));
            let solid = Opening::Solid { outline, length, width, height }.faces();
            // The vectors of a closed surface add up to zero, and its volume is positive.
            let sum: DVec3 = solid.iter().map(|face| face.area * face.normal).sum();
            assert!(sum.length() < 1e-12, "{sum}");
            let volume: f64 =
                solid.iter().map(|face| face.area * face.normal.dot(face.corners[0]) / 3.0).sum();
            assert!((volume / (area * height) - 1.0).abs() < 1e-12, "{volume}");
        }
        assert_eq!(Opening::Point.faces(), []);
    }
}
