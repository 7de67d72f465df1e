//! Cameras and lamp materials that the rooms share.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::{Camera, Material, Rgb, SceneBuilder};

/// Name of a camera, position of the eye, target point, and vertical field of view in degrees.
pub(crate) type View = (&'static str, [f64; 3], [f64; 3], f64);

/// Adds cameras with the aspect ratio 16:9.
pub(crate) fn add_cameras(builder: &mut SceneBuilder, views: &[View]) {
    for &(name, eye, target, degrees) in views {
        let (eye, target) = (DVec3::from_array(eye), DVec3::from_array(target));
        if let Some(camera) = Camera::looking_at(eye, target, DVec3::Y, degrees.to_radians()) {
            builder.add_camera(Camera { name: name.to_owned(), aspect: Some(16.0 / 9.0), ..camera });
        }
    }
}

/// Returns a material that emits a radiance \[W/(m² sr)\] and has a reflectance of 0.3.
pub(crate) fn lamp(name: &str, radiance: Rgb) -> Material {
    Material::diffuse(name, Rgb::splat(0.3)).emitting(PI * radiance)
}
