//! Cameras.

use glam::DVec3;

/// A camera: position, orientation and projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name given by the author, or an empty string.
    pub name: String,
    /// Position of the eye.
    pub eye: DVec3,
    /// Viewing direction, of unit length.
    pub forward: DVec3,
    /// Upward direction of the picture, of unit length; need not be perpendicular to `forward`.
    pub up: DVec3,
    /// Projection to the picture.
    pub projection: Projection,
    /// Intended aspect ratio (width over height), if stated.
    pub aspect: Option<f64>,
}

/// Projection of a [`Camera`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective projection with the given full vertical field of view in radians.
    Perspective {
        /// Full vertical field of view \[rad\].
        vertical_fov: f64,
    },
    /// Parallel projection with the given full height of the picture in scene units.
    Orthographic {
        /// Full height of the picture \[m\].
        height: f64,
    },
}

impl Camera {
    /// Returns a perspective camera at `eye` that looks at `target`, with `vertical_fov` in radians.
    ///
    /// Returns `None` if the two points coincide or `up` is parallel to the view.
    #[must_use]
    pub fn looking_at(eye: DVec3, target: DVec3, up: DVec3, vertical_fov: f64) -> Option<Self> {
        let forward = (target - eye).try_normalize()?;
        let up = up.try_normalize()?;
        if forward.cross(up).length_squared() < 1e-12 {
            return None;
        }
        Some(Self {
            name: String::new(),
            eye,
            forward,
            up,
            projection: Projection::Perspective { vertical_fov },
            aspect: None,
        })
    }
}
