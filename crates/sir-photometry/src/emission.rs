//! Light of the faces of a luminous opening.

use std::f64::consts::PI;
use std::fmt;

use glam::DVec3;

use crate::bits::hash_of;
use crate::distribution::IntensityDistribution;
use crate::faces::OpeningFace;
use crate::opening::Opening;

/// Light of a luminous opening: from far away it has the intensity of a distribution, and in each direction all of the
/// opening that is seen from there is equally bright.
///
/// The radiance in the direction `ω` is `L(ω) = I(ω) / A(ω)`, with the intensity `I` and the projected area `A` of the
/// opening. A photometric file says no more about where on the opening the light comes from.
///
/// Its `Debug` text is short: the distribution, the number of faces, and a hash of their corners.
#[derive(Clone, PartialEq)]
pub struct OpeningLight {
    distribution: IntensityDistribution,
    /// Faces that emit.
    faces: Vec<OpeningFace>,
    /// Share of the flux that comes from each face; they add up to 1.
    shares: Vec<f64>,
}

impl fmt::Debug for OpeningLight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The shares follow from the distribution and the faces.
        let numbers = self.faces.iter().flat_map(|face| {
            let corners = face.corners.iter().flat_map(|corner| corner.to_array());
            std::iter::once(face.corners.len() as f64).chain(corners)
        });
        f.debug_struct("OpeningLight")
            .field("distribution", &self.distribution)
            .field("faces", &self.faces.len())
            .field("hash", &format_args!("{:032x}", hash_of(numbers)))
            .finish()
    }
}

/// Smallest share of the flux for which a face emits.
const SMALLEST_SHARE: f64 = 1e-4;

/// Largest part of a cell of the table \[°\] for the integrals over directions. Cells may be wide, such as the only one of a
/// lamp without dependence on the azimuth, but the projected area of a face changes within each quarter of a turn.
const STEP: f64 = 1.0;

/// Largest number of directions that are drawn for a line.
const MAX_TRIES: u32 = 1_000_000;

impl OpeningLight {
    /// Returns the light of an opening. Faces with less than 10⁻⁴ of the flux do not emit. Returns `None` if no face does,
    /// as for a point.
    #[must_use]
    pub fn new(distribution: IntensityDistribution, opening: &Opening) -> Option<Self> {
        let faces = opening.faces();
        let mut integrals = vec![0.0; faces.len()];
        distribution.for_each_part(STEP, |direction, flux| {
            let all: f64 = faces.iter().map(|face| projected(face, direction)).sum();
            for (integral, face) in integrals.iter_mut().zip(&faces) {
                let own = projected(face, direction);
                if own > 0.0 {
                    *integral += flux * own / all;
                }
            }
        });
        let all: f64 = integrals.iter().sum();
        let emitting = |(_, integral): &(OpeningFace, f64)| *integral > SMALLEST_SHARE * all;
        let (faces, integrals): (Vec<_>, Vec<_>) = faces.into_iter().zip(integrals).filter(emitting).unzip();
        let all: f64 = integrals.iter().sum();
        let shares = integrals.iter().map(|integral| integral / all).collect();
        (all > 0.0).then_some(Self { distribution, faces, shares })
    }

    /// Returns the faces that emit, in the frame of the luminaire.
    #[must_use]
    pub fn faces(&self) -> &[OpeningFace] {
        &self.faces
    }

    /// Returns the intensity as a function of direction.
    #[must_use]
    pub fn distribution(&self) -> &IntensityDistribution {
        &self.distribution
    }

    /// Returns the mean exitance of a face \[lm/m²\].
    #[must_use]
    pub fn exitance(&self, face: usize) -> f64 {
        self.shares[face] * self.distribution.flux() / self.faces[face].area
    }

    /// Returns the radiance of a face in a direction of unit length, relative to that of a diffuse face with the same
    /// exitance. The mean over the hemisphere, weighted by the cosine to the normal, is 1.
    #[must_use]
    pub fn relative_radiance(&self, face: usize, direction: DVec3) -> f64 {
        let area: f64 = self.faces.iter().map(|face| projected(face, direction)).sum();
        let share = projected(&self.faces[face], direction) / area;
        if share > 0.0 {
            PI * self.distribution.intensity(direction) / area / self.exitance(face)
        } else {
            0.0
        }
    }

    /// Returns a random direction of the light of a face, of unit length. `unit` returns uniform numbers below 1 and is
    /// called until a direction is accepted.
    #[must_use]
    pub fn sample(&self, face: usize, mut unit: impl FnMut() -> f64) -> DVec3 {
        for _ in 0..MAX_TRIES {
            let direction = self.distribution.sample([unit(), unit()]);
            let share = seen_share(&self.faces, face, direction);
            if share >= 1.0 || (share > 0.0 && unit() < share) {
                return direction;
            }
        }
        self.faces[face].normal
    }
}

/// Returns the area \[m²\] of a face as seen from a direction.
fn projected(face: &OpeningFace, direction: DVec3) -> f64 {
    face.area * face.normal.dot(direction).max(0.0)
}

/// Returns the share of the projected area of all faces that one of them has.
fn seen_share(faces: &[OpeningFace], face: usize, direction: DVec3) -> f64 {
    let own = projected(&faces[face], direction);
    if own > 0.0 { own / faces.iter().map(|face| projected(face, direction)).sum::<f64>() } else { 0.0 }
}
