//! Directional light of a surface.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use sir_photometry::OpeningLight;

/// Angular distribution of the light of a surface that is a face of a luminous opening.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    light: Arc<OpeningLight>,
    /// Axes of the luminaire.
    frame: DMat3,
    face: usize,
}

impl Beam {
    /// Returns the distribution of the light of a face of an opening, by its number, of a luminaire whose axes are the columns
    /// of `frame`, a rotation. Returns `None` if there is no such face.
    #[must_use]
    pub fn new(light: Arc<OpeningLight>, frame: DMat3, face: usize) -> Option<Self> {
        (face < light.faces().len()).then_some(Self { light, frame, face })
    }

    /// Returns the radiance in a direction of unit length, away from the surface, relative to that of a diffuse surface with
    /// the same exitance.
    #[must_use]
    pub fn relative_radiance(&self, direction: DVec3) -> f64 {
        self.light.relative_radiance(self.face, self.frame.transpose() * direction)
    }

    /// Returns a random direction of its light, of unit length. `unit` returns uniform numbers below 1 and is called
    /// until a direction is accepted.
    #[must_use]
    pub fn sample(&self, unit: impl FnMut() -> f64) -> DVec3 {
        self.frame * self.light.sample(self.face, unit)
    }
}
