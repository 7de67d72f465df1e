//! Cameras.

use ::gltf::json::camera::{Camera as Source, Type};
use ::gltf::json::validation::Checked;
use glam::{DAffine3, DVec3};

use crate::camera::{Camera, Projection};

/// Converts a camera to world space. It looks along −z, with y up (glTF 2.0 specification, section 3.10).
///
/// Returns `None` if the camera cannot form a picture, for instance with a field of view of zero.
pub(super) fn convert(source: &Source, name: &str, to_world: &DAffine3) -> Option<Camera> {
    let positive = |x: f32| (x.is_finite() && x > 0.0).then_some(f64::from(x));
    let (projection, aspect) = match source.type_ {
        Checked::Valid(Type::Perspective) => {
            let perspective = source.perspective.as_ref()?;
            let vertical_fov = positive(perspective.yfov).filter(|&fov| fov < std::f64::consts::PI)?;
            (Projection::Perspective { vertical_fov }, perspective.aspect_ratio.and_then(positive))
        }
        Checked::Valid(Type::Orthographic) => {
            let parallel = source.orthographic.as_ref()?;
            let (x, y) = (positive(parallel.xmag)?, positive(parallel.ymag)?);
            (Projection::Orthographic { height: 2.0 * y }, Some(x / y))
        }
        Checked::Invalid => return None,
    };
    let forward = to_world.transform_vector3(DVec3::NEG_Z).try_normalize()?;
    let up = to_world.transform_vector3(DVec3::Y).try_normalize()?;
    let eye = to_world.translation;
    (eye.is_finite() && forward.cross(up).length_squared() > 1e-12).then(|| Camera {
        name: name.to_owned(),
        eye,
        forward,
        up,
        projection,
        aspect,
    })
}
