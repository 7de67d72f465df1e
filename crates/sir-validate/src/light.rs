//! Scenes of named surfaces, and the mean light of each surface.

use sir_geom::{Material, MaterialId, Rgb, Scene, SceneBuilder, Side};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_parallel::{Executor, RunError, Start};
use sir_radiosity::{BatchSettings, Batches, FirstShot, Model, SecondShot, ShotSettings, Solution};

use crate::data::Surface;
use crate::error::ValidateError;
use crate::shape;

/// Exitance `M` and reflectance of a surface, per band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Paint {
    pub(crate) exitance: Rgb,
    pub(crate) reflectance: Rgb,
}

impl Paint {
    /// Returns a paint with the same values in all bands.
    pub(crate) fn gray(exitance: f64, reflectance: f64) -> Self {
        Self { exitance: Rgb::splat(exitance), reflectance: Rgb::splat(reflectance) }
    }
}

/// Builds a scene of these surfaces. Surface `i` has material `i`.
pub(crate) fn scene(
    surfaces: &[&Surface],
    paint: impl Fn(usize) -> Paint,
    segments: u32,
) -> Result<Scene, ValidateError> {
    Ok(builder(surfaces, paint, segments).build()?.scene)
}

/// Returns the builder of the same scene.
pub(crate) fn builder(surfaces: &[&Surface], paint: impl Fn(usize) -> Paint, segments: u32) -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    for (i, surface) in surfaces.iter().enumerate() {
        let Paint { exitance, reflectance } = paint(i);
        let material = Material::diffuse(&surface.name, reflectance).emitting(exitance);
        let material: MaterialId = builder.add_material(material);
        shape::add(&mut builder, &surface.shape, material, segments);
    }
    builder
}

/// Returns a model with one patch per flat polygon.
pub(crate) fn per_face(scene: Scene) -> Result<Model, ValidateError> {
    Ok(Model::new(scene, Subdivision::PerFace)?)
}

/// Light of a scene.
pub(crate) struct Light {
    /// Light directly from the sources.
    pub(crate) direct: Solution,
    /// All light.
    pub(crate) all: Solution,
}

/// Computes the light of a scene: a first and a second shot with 40 and 10 % of the lines, and batches through the
/// convex hull with the rest.
pub(crate) fn solve(
    model: &Model,
    lines: u64,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Light, RunError> {
    let first = ShotSettings::new(model, lines * 2 / 5, seed);
    let shot = executor.run::<FirstShot<'_>>(first, Start::Fresh(()))?.outcome;
    let direct = shot.solution(model);
    let second = ShotSettings::new(model, lines / 10, seed);
    let shot = executor.run::<SecondShot<'_>>(second, Start::Fresh(shot))?.outcome;
    let transport = BatchSettings::new(model, Domain::hull(model.scene.vertices()), lines / 2, seed);
    let all = executor.run::<Batches<'_>>(transport, Start::Fresh(shot))?.outcome;
    Ok(Light { direct, all: all.solution(model) })
}

/// Mean light of the front of a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mean {
    /// Irradiance `E`, averaged over the area.
    pub(crate) irradiance: Rgb,
    /// Radiosity `B`, likewise.
    pub(crate) radiosity: Rgb,
    /// Area of the front \[m²\].
    pub(crate) area: f64,
}

/// Returns the mean light of the front of every material.
pub(crate) fn means(model: &Model, solution: &Solution) -> Vec<Mean> {
    let mut means = vec![Mean::default(); model.scene.materials().len()];
    model.mesh.for_each_side(|triangle, _, side, id| {
        if side == Side::Front {
            let area = model.area(triangle, id);
            let mean = &mut means[model.scene.triangle(triangle).material.index()];
            mean.irradiance += solution.irradiance[id.index()] * area;
            mean.radiosity += solution.radiosity(model, triangle, side, id) * area;
            mean.area += area;
        }
    });
    for mean in &mut means {
        mean.irradiance /= mean.area;
        mean.radiosity /= mean.area;
    }
    means
}
