//! Rays of a camera.

use glam::DVec3;
use sir_geom::{Camera, Line, Projection};

/// Generator of the rays of a camera.
pub(crate) struct CameraRays {
    eye: DVec3,
    forward: DVec3,
    /// Vectors from the middle of the picture to its right and upper edge, at distance one from the eye; for a parallel
    /// projection, in scene units.
    right: DVec3,
    up: DVec3,
    is_parallel: bool,
}

impl CameraRays {
    /// Creates the generator; `aspect` is width over height.
    pub(crate) fn new(camera: &Camera, aspect: f64) -> Self {
        let (right, up) = camera_axes(camera);
        let (half, is_parallel) = match camera.projection {
            Projection::Perspective { vertical_fov } => ((0.5 * vertical_fov).tan(), false),
            Projection::Orthographic { height } => (0.5 * height, true),
        };
        Self {
            eye: camera.eye,
            forward: camera.forward,
            right: half * aspect * right,
            up: half * up,
            is_parallel,
        }
    }

    /// Returns the ray through a point of the picture: `(0, 0)` is the upper left corner, `(1, 1)` the lower right.
    pub(crate) fn ray(&self, right: f64, down: f64) -> Line {
        let shift = (2.0 * right - 1.0) * self.right + (1.0 - 2.0 * down) * self.up;
        if self.is_parallel {
            Line { origin: self.eye + shift, direction: self.forward }
        } else {
            Line { origin: self.eye, direction: (self.forward + shift).normalize() }
        }
    }

    /// Returns the distance between the rays at the upper and the lower edge of the picture, at a distance `t` along
    /// them.
    pub(crate) fn spacing(&self, t: f64) -> f64 {
        2.0 * self.up.length() * if self.is_parallel { 1.0 } else { t }
    }
}

/// Returns the unit vectors to the right and upward in the picture of a camera.
pub(crate) fn camera_axes(camera: &Camera) -> (DVec3, DVec3) {
    let right = camera.forward.cross(camera.up);
    // If `up` is parallel to `forward`, the rotation about the axis is arbitrary.
    let right = right.try_normalize().unwrap_or_else(|| camera.forward.any_orthonormal_vector());
    (right, right.cross(camera.forward))
}
