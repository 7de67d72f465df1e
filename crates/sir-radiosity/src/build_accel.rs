//! The acceleration structure of a scene.

use sir_accel::{Accel, AccelError, Barycentric, Opacity, Options, TriangleId};
use sir_geom::{Opacities, Scene};

/// Builds the acceleration structure over the triangles of a scene, with their opacities.
///
/// Of surfaces in contact, those later in the scene lie on top. That is the order of the triangles, and therefore the
/// default of [`Options::contact_priorities`].
///
/// # Errors
///
/// If there are too many triangles, or the scene is too large or too small for its lengths to be squared.
pub fn build_accel(scene: &Scene) -> Result<Accel, AccelError> {
    let indices: Vec<[u32; 3]> =
        scene.triangles().iter().map(|triangle| triangle.vertices.map(|v| v.0)).collect();
    let options = match Opacities::of(scene) {
        Some(opacities) => {
            let is_transparent = scene.triangle_ids().map(|t| scene.is_transparent(t)).collect();
            Options::default().opacity(is_transparent, SceneOpacity(opacities))
        }
        None => Options::default(),
    };
    Accel::build(scene.vertices(), &indices, options)
}

/// The opacities of a scene.
struct SceneOpacity(Opacities);

impl Opacity for SceneOpacity {
    fn opacity(&self, triangle: TriangleId, point: Barycentric) -> f64 {
        self.0.at(triangle, point).unwrap_or(1.0)
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}
