//! Cameras of images.

use glam::DVec3;
use sir_geom::{Camera, Scene};

use crate::plan::{CameraChoice, Image, Output, Pipeline};
use crate::text::diagnostic::Diagnostic;
use crate::text::suggest::did_you_mean;

/// Returns a problem for each camera that an image refers to and the scene does not have.
pub(crate) fn camera_problems(pipeline: &Pipeline, scene: &Scene) -> Vec<Diagnostic> {
    let names: Vec<&str> = scene.cameras().iter().map(|c| c.name.as_str()).collect();
    let known = match names.len() {
        0 => "the scene has no camera; leave `camera` out, or describe one with `Camera(eye: …, target: …)`"
            .into(),
        n => format!("the scene has {n}, by number from 0: {}", names.join(", ")),
    };
    let mut problems = Vec::new();
    for output in pipeline.outputs() {
        let Output::Image(Image { camera: Some(camera), .. }) = output else { continue };
        let span = camera.span.0.clone();
        match &camera.value {
            CameraChoice::Number(number) if *number as usize >= names.len() => problems.push(Diagnostic {
                span,
                message: format!("the scene has no camera number {number}"),
                help: known.clone(),
            }),
            CameraChoice::Name(name) if !names.contains(&name.as_str()) => problems.push(Diagnostic {
                span,
                message: format!("the scene has no camera \"{name}\""),
                help: did_you_mean(name, &names).unwrap_or_else(|| known.clone()),
            }),
            _ => {}
        }
    }
    problems
}

/// Returns the camera of an image, from the scene or the pipeline. Returns `None` if the image specifies none and the
/// scene has none. `up` is the up direction of the scene.
#[must_use]
pub(crate) fn chosen_camera(image: &Image, scene: &Scene, up: DVec3) -> Option<Camera> {
    let cameras = scene.cameras();
    match image.camera.as_ref().map(|camera| &camera.value) {
        None => cameras.first().cloned(),
        Some(CameraChoice::Number(number)) => cameras.get(*number as usize).cloned(),
        Some(CameraChoice::Name(name)) => cameras.iter().find(|c| c.name == *name).cloned(),
        Some(CameraChoice::Own(camera)) => camera.to_scene(up),
    }
}
